"""The paper's learning cycle written out cell by cell, slowly and literally: (1) to (9)."""

import numpy as np


class SlowMap:
    """One hierarchical map that computes the coordinates `rows` of the command."""

    def __init__(self, w_k, w_kl, rows):
        self.w_k, self.w_kl = w_k, w_kl
        self.theta = {
            (k, l): np.concatenate([w_k[k], w_kl[l]])[rows]
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


def cycle(maps, u, execute, rate, widths, theta_increments, jacobian_increments, units):
    """One iteration of every map for the desired pose u; `widths`: of g_k and g_kl for each map.

    Poses are measured in coordinates; (3) and (8) are taken where `units` of them are one.
    """
    winners = [(m.winner(u), m.theta[m.winner(u)].copy(), m.A[m.winner(u)].copy()) for m in maps]
    command = np.concatenate([m.output(u) for m in maps])
    u1 = execute(command)
    correction = np.concatenate([A @ (u - u1) for _, _, A in winners])
    u2 = execute(command + correction)
    du = u2 - u1
    for m, (cell, theta, A), (width_k, width_kl) in zip(maps, winners, widths, strict=True):
        d_theta = A @ (u - u1)
        there, du_there = A / units, units * du  # d theta / d (units u), and units du
        error = (
            np.outer(d_theta - there @ du_there, du_there) / np.linalg.norm(du_there) ** 2
        ) * units
        theta_star = d_theta if theta_increments else theta + d_theta  # (6) or (2)
        A_star = error if jacobian_increments else A + error  # (8) or (3)
        for i, j in m.theta:
            g_k = np.exp(-(np.linalg.norm(m.w_k[i] - m.w_k[cell[0]]) ** 2) / (2 * width_k**2))
            g_kl = np.exp(-(np.linalg.norm(m.w_kl[j] - m.w_kl[cell[1]]) ** 2) / (2 * width_kl**2))
            c = rate * g_k * g_kl
            m.theta[i, j] = m.theta[i, j] + c * (
                theta_star if theta_increments else theta_star - m.theta[i, j]
            )  # (7) or (4)
            m.A[i, j] = m.A[i, j] + c * (
                A_star if jacobian_increments else A_star - m.A[i, j]
            )  # (9) or (5)
