"""What has a fast implementation in the library, written out slowly and literally.

The paper's learning cycle cell by cell, (1) to (9), and the identification of an arm.
"""

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.stats import chi2


class SlowMap:
    """One hierarchical map that computes the coordinates `rows` of the command.

    `start`: theta of each cell (k, l) instead of its centre, all six coordinates.
    """

    def __init__(self, w_k, w_kl, rows, start=None):
        self.w_k, self.w_kl = w_k, w_kl
        self.theta = {
            (k, l): (np.concatenate([w_k[k], w_kl[l]]) if start is None else start[k, l])[rows]
            for k in range(len(w_k))
            for l in range(len(w_kl))
        }
        self.A = {cell: np.eye(6)[rows] for cell in self.theta}

    def winner(self, u):
        k = int(np.argmin([np.linalg.norm(u[:3] - w) for w in self.w_k]))
        return k, int(np.argmin([np.linalg.norm(u[3:] - w) for w in self.w_kl]))

    def output(self, u):
        k, l = self.winner(u)
        return self.theta[k, l] + self.A[k, l] @ (
            u - np.concatenate([self.w_k[k], self.w_kl[l]])
        )  # (1)


def cycle(
    maps, u, execute, rate, widths, theta_increments, jacobian_increments, units, width_units
):
    """One iteration of every map for the desired pose u; `widths`: of g_k and g_kl for each map.

    `execute` returns the pose that a command leads to, and whether it was executed.
    Poses are measured in coordinates; (3) and (8) are taken where `units` of them are one, widths
    are given where `width_units` are.
    """
    winners = [(m.winner(u), m.theta[m.winner(u)].copy(), m.A[m.winner(u)].copy()) for m in maps]
    command = np.concatenate([m.output(u) for m in maps])
    u1, first = execute(command)
    correction = np.concatenate([A @ (u - u1) for _, _, A in winners])
    u2, second = execute(command + correction)
    du = u2 - u1
    for m, (cell, theta, A), (width_k, width_kl) in zip(maps, winners, widths, strict=True):
        d_theta = A @ (u - u1)
        there, du_there = A / units, units * du  # d theta / d (units u), and units du
        error = np.outer(d_theta - there @ du_there, du_there) / (du_there @ du_there) * units
        theta_star = d_theta if theta_increments else theta + d_theta  # (6) or (2)
        A_star = error if jacobian_increments else A + error  # (8) or (3)
        for i, j in m.theta:
            far_k = (m.w_k[i] - m.w_k[cell[0]]) * width_units[:3]
            far_kl = (m.w_kl[j] - m.w_kl[cell[1]]) * width_units[3:]
            g_k = np.exp(-(np.linalg.norm(far_k) ** 2) / (2 * width_k**2))
            g_kl = np.exp(-(np.linalg.norm(far_kl) ** 2) / (2 * width_kl**2))
            c = rate * g_k * g_kl * first  # nothing of a refused move
            m.theta[i, j] = m.theta[i, j] + c * (
                theta_star if theta_increments else theta_star - m.theta[i, j]
            )  # (7) or (4)
            m.A[i, j] = m.A[i, j] + c * second * (
                A_star if jacobian_increments else A_star - m.A[i, j]
            )  # (9) or (5)


def identify(linearise, deviations, measured):
    """The most probable arm, as `recalib.identification.estimation` describes it, slowly.

    Linearised anew in every step, one measurement after the other, until little moves.

    Args:
        linearise: from parameters (P,) to poses (n, 4, 4) [m] and their Jacobians (n, 6, P).
        deviations: (P,) of the prior.
        measured: poses (n, 4, 4) or positions (n, 3) [m].

    Returns parameters (P,), noise (kind,), weights (n,), and the log evidence up to what depends on
    the data alone.
    """
    count, kinds = len(deviations), 1 if measured.ndim == 2 else 2
    limit = chi2.ppf(0.99, 3 * kinds)
    p, v = np.zeros(count), np.ones(count)
    noise, weights = np.full(kinds, 1e-4), np.ones(len(measured))
    for step in range(60):
        poses, jacobians = linearise(p * deviations)
        r = [_residuals(pose, observed) for pose, observed in zip(poses, measured, strict=True)]
        J = (jacobians * deviations)[:, : 3 * kinds].reshape(len(measured), kinds, 3, count)
        if step > 0:
            for i in range(len(measured)):
                s = sum(r[i][k] @ r[i][k] / noise[k] ** 2 for k in range(kinds))
                weights[i] = 1 if s <= limit else limit / s
        H, g = np.diag(1 / v), -p / v
        by_kind = np.zeros((kinds, count, count))
        for i in range(len(measured)):
            for k in range(kinds):
                by_kind[k] += weights[i] * J[i, k].T @ J[i, k] / noise[k] ** 2
                g = g + weights[i] * J[i, k].T @ r[i][k] / noise[k] ** 2
        H = H + by_kind.sum(axis=0)
        change, C = np.linalg.solve(H, g), np.linalg.inv(H)
        p = p + change
        r = [r[i] - J[i] @ change for i in range(len(measured))]
        # noise: squared residuals over the degrees of freedom that the parameters leave
        free, total = np.zeros(kinds), np.zeros(kinds)
        for k in range(kinds):
            squares = np.array([r[i][k] @ r[i][k] for i in range(len(measured))])
            if step < 3:  # by medians, at the start
                free[k], total[k] = 3 * len(measured), 0
                total[k] = np.median(squares) / chi2.ppf(0.5, 3) * free[k]
            else:
                free[k], total[k] = 3 * (weights**2).sum(), (weights**2) @ squares
            free[k] = max(free[k] - np.trace(C @ by_kind[k]), 1e-3 * free[k])
        shared = total.sum() / free.sum()  # believed alike, as by ten measurements
        last, noise = noise, np.maximum(np.sqrt((total + 10 * shared) / (free + 10)), 1e-6)
        # variances: a belief of 0.05 degrees of freedom in a common scale, of 20 more in that
        common = (20 + count) / (20 + (1 / v).sum())
        v = np.minimum((0.05 * common + p**2 + np.diag(C)) / 1.05, 9)
        # a tenth of what is not known of the parameters, and a tenth of the noise
        if step >= 3 and np.sqrt(change @ H @ change) < 0.1 and all(abs(noise / last - 1) < 0.1):
            break
    evidence = -np.log(np.linalg.eigvalsh(H)).sum() / 2
    for i in range(len(measured)):
        s = sum(r[i][k] @ r[i][k] / noise[k] ** 2 for k in range(kinds))
        evidence -= s / 2 if s <= limit else limit / 2 * (1 + np.log(s / limit))
        evidence -= 3 * np.log(noise).sum()
    # inverse gamma distributions of the variances about their scale, and of that about 1
    for j in range(count):
        evidence -= p[j] ** 2 / (2 * v[j]) + np.log(v[j]) / 2
        evidence += 0.05 / 2 * (np.log(common / v[j]) - common / v[j] + 1)
    evidence += 0.05 / 2 * 20 * (np.log(common) - common + 1)
    return p * deviations, noise, weights, evidence


def _residuals(pose, measured):
    """What takes a pose to the measured one (kind, 3): translation [m], and turn [rad] if any."""
    if measured.ndim == 1:
        return np.array([measured - pose[:3, 3]])
    turn = Rotation.from_matrix(measured[:3, :3] @ pose[:3, :3].T).as_rotvec()
    return np.array([measured[:3, 3] - pose[:3, 3], turn])
