"""Compiled loops of learners whose cells hold theta and Jacobians: equations (1) to (9).

Each function handles all runs in one call. All are in one file because Numba's cache checks only
the file of the called function for changes, not the files of functions that it calls in turn.

An iteration updates every cell, but reads only one cell of each map. So updates are queued, and
`recalib.learners.hierarchical` applies `WAITING` of them at once, as one matrix product. A cell
that is read meanwhile gets its pending updates first.
"""

from typing import NamedTuple, TypeVar

import numpy as np

from recalib.numerics.compiled import compiled, inner

WAITING = 32  # pending updates, at most: with more, slower reading costs more than is saved
THETA, JACOBIAN = 0, 1  # indices into pairs of settings or numbers
# Workspace coordinates. For a shorter move, (3) and (8) would divide rounding errors by rounding
# errors.
SHORTEST_MOVE = 1e-6


Number = TypeVar("Number", float, np.ndarray)


class Cells(NamedTuple):
    """The cells of all maps in each run, and the pending updates.

    A map has K cells in its supernet, and L cells in each subnet. It computes o coordinates of the
    command; map 0 computes the first o, map 1 the next o.

    Attributes:
        w_k (K, 3), w_kl (L, 3): centres.
        squares_k (K, K), squares_kl (L, L): squared distances between them, in units of widths.
        theta: (run, map, K, L, o) the command at each centre.
        jacobian: (run, map, K, L, 6 o) its derivative with respect to the desired pose.
        g_k (run, map, WAITING, K), g_kl (run, map, WAITING, L): neighbourhoods of pending updates.
        theta_star (run, map, WAITING, o), jacobian_star (run, map, WAITING, 6 o): values or
            increments that pending updates propagate.
        rates: (run, WAITING, 2) learning rates of pending updates, for theta and for Jacobians.
    """

    w_k: np.ndarray
    w_kl: np.ndarray
    squares_k: np.ndarray
    squares_kl: np.ndarray
    theta: np.ndarray
    jacobian: np.ndarray
    g_k: np.ndarray
    g_kl: np.ndarray
    theta_star: np.ndarray
    jacobian_star: np.ndarray
    rates: np.ndarray


@compiled
def fall(start: Number, end: Number, fraction: Number | float, power: float) -> Number:
    """The value of a quantity whose power falls linearly from start to end; see `schedules`."""
    if power == 0:
        return start * (end / start) ** fraction
    if power == 1:
        return start + (end - start) * fraction
    return (start**power + (end**power - start**power) * fraction) ** (1 / power)


@inner
def nearest(point: np.ndarray, centres: np.ndarray) -> int:
    """Index of the nearest of the centres (cells, d) to a point (d,)."""
    found, least = 0, np.inf
    for cell in range(len(centres)):
        square = 0.0
        for number in range(len(point)):
            square += (point[number] - centres[cell, number]) ** 2
        if square < least:
            found, least = cell, square
    return found


@compiled
def nearest_of(points: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Index (n,) of the nearest of the centres (cells, d) to each of the points (n, d)."""
    found = np.empty(len(points), dtype=np.int64)
    for index in range(len(points)):
        found[index] = nearest(points[index], centres)
    return found


@compiled
def commands(plain: tuple[np.ndarray, ...], desired: np.ndarray) -> np.ndarray:
    """Pose commands (run, pose, 6) for the desired poses (run, pose, 6), by (1).

    There must be no pending updates.
    """
    cells = Cells(*plain)
    found, outputs = np.empty(desired.shape), cells.theta.shape[-1]
    for run in range(desired.shape[0]):
        for pose in range(desired.shape[1]):
            u = desired[run, pose]
            k, l = nearest(u[:3], cells.w_k), nearest(u[3:], cells.w_kl)
            for row in range(6):
                map_, output = row // outputs, row % outputs
                total = cells.theta[run, map_, k, l, output]
                for column in range(6):
                    centre = cells.w_k[k, column] if column < 3 else cells.w_kl[l, column - 3]
                    slope = cells.jacobian[run, map_, k, l, 6 * output + column]
                    total += slope * (u[column] - centre)
                found[run, pose, row] = total
    return found


@compiled
def respond(
    plain: tuple[np.ndarray, ...],
    waiting: int,
    increments: tuple[bool, bool],
    desired: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The first command of an iteration, by (1), and the winning cells that it comes from.

    Args:
        plain: `Cells` as a plain tuple.
        waiting: number of pending updates.
        increments: whether to propagate increments (or values) of theta, and of Jacobians.
        desired: (run, 6) poses.

    Returns the commands (run, 6), the winning cells (run, 2), and their theta (run, 6) and
    Jacobians (run, 6, 6).
    """
    cells = Cells(*plain)
    runs, outputs = len(desired), cells.theta.shape[-1]
    command, winners = np.empty((runs, 6)), np.empty((runs, 2), dtype=np.int64)
    theta, jacobian = np.empty((runs, 6)), np.empty((runs, 6, 6))
    for run in range(runs):
        u = desired[run]
        k, l = nearest(u[:3], cells.w_k), nearest(u[3:], cells.w_kl)
        winners[run, 0], winners[run, 1] = k, l
        for row in range(6):
            map_, output = row // outputs, row % outputs
            theta[run, row] = cells.theta[run, map_, k, l, output]
            for column in range(6):
                jacobian[run, row, column] = cells.jacobian[run, map_, k, l, 6 * output + column]
        for map_ in range(6 // outputs):
            first = map_ * outputs
            for update in range(waiting):
                neighbourhood = cells.g_k[run, map_, update, k] * cells.g_kl[run, map_, update, l]
                rate_theta = cells.rates[run, update, THETA] * neighbourhood
                rate_jacobian = cells.rates[run, update, JACOBIAN] * neighbourhood
                for output in range(outputs):
                    star = cells.theta_star[run, map_, update, output]
                    if not increments[THETA]:
                        star -= theta[run, first + output]
                    theta[run, first + output] += rate_theta * star
                    for column in range(6):
                        star = cells.jacobian_star[run, map_, update, 6 * output + column]
                        if not increments[JACOBIAN]:
                            star -= jacobian[run, first + output, column]
                        jacobian[run, first + output, column] += rate_jacobian * star
        for row in range(6):
            total = theta[run, row]
            for column in range(6):
                centre = cells.w_k[k, column] if column < 3 else cells.w_kl[l, column - 3]
                total += jacobian[run, row, column] * (u[column] - centre)
            command[run, row] = total
    return command, winners, theta, jacobian


@compiled
def corrections(jacobian: np.ndarray, desired: np.ndarray, achieved: np.ndarray) -> np.ndarray:
    """A_kl (u - u') (run, 6): the second movement of an iteration, and the increment in (6).

    Args:
        achieved: (run, 1, 6) the pose u' after the first movement.
    """
    found = np.zeros(desired.shape)
    for run in range(len(desired)):
        for output in range(6):
            for column in range(6):
                found[run, output] += jacobian[run, output, column] * (
                    desired[run, column] - achieved[run, 0, column]
                )
    return found


@compiled
def learn(
    plain: tuple[np.ndarray, ...],
    waiting: int,
    increments: tuple[bool, bool],
    winners: np.ndarray,
    theta: np.ndarray,
    jacobian: np.ndarray,
    correction: np.ndarray,
    first: np.ndarray,
    first_executed: np.ndarray,
    second: np.ndarray,
    second_executed: np.ndarray,
    metric: np.ndarray,
    widths: tuple[np.ndarray, np.ndarray, float],
    rate: tuple[np.ndarray, np.ndarray, float],
    fraction: float,
) -> None:
    """Queue one update of each map from the outcome of an iteration.

    Updates follow (2) and (3), or (6) and (8). If the first move was refused, theta does not
    change; if either move was refused, Jacobians do not change.

    Args:
        plain, waiting, increments: see `respond`.
        winners, theta, jacobian: as `respond` returned them.
        correction: (run, 6) A_kl (u - u').
        first, second: (run, 1, 6) the achieved poses u' and u''.
        first_executed, second_executed: (run, 1) whether these moves were executed.
        metric: (6,) squared units of the norm in (3) and (8).
        widths: initial and final widths (run, map, 2) of g_k and g_kl, and the power of their fall.
        rate: initial and final learning rates c' (run,), and the power of their fall.
        fraction: part of the training that is done.
    """
    cells = Cells(*plain)
    moved, direction, outputs = np.empty(6), np.empty(6), cells.theta.shape[-1]
    for run in range(len(first)):
        square, length = 0.0, 0.0
        for column in range(6):  # du = u'' - u', and du^T / |du|^2
            moved[column] = second[run, 0, column] - first[run, 0, column]
            direction[column] = metric[column] * moved[column]
            square += moved[column] ** 2
            length += direction[column] * moved[column]
        far = square > SHORTEST_MOVE**2
        both = first_executed[run, 0] and second_executed[run, 0]
        c = fall(rate[0][run], rate[1][run], fraction, rate[2])
        cells.rates[run, waiting, THETA] = c if first_executed[run, 0] else 0.0
        cells.rates[run, waiting, JACOBIAN] = c if both and far else 0.0
        k, l = winners[run]
        for map_ in range(6 // outputs):
            width = fall(widths[0][run, map_, 0], widths[1][run, map_, 0], fraction, widths[2])
            _neighbours(cells.squares_k[k], width, cells.g_k[run, map_, waiting])
            width = fall(widths[0][run, map_, 1], widths[1][run, map_, 1], fraction, widths[2])
            _neighbours(cells.squares_kl[l], width, cells.g_kl[run, map_, waiting])
        for row in range(6):
            map_, output = row // outputs, row % outputs
            error = correction[run, row]
            for column in range(6):
                error -= jacobian[run, row, column] * moved[column]
            error = error / length if far else 0.0
            star = correction[run, row]  # (6)
            if not increments[THETA]:
                star += theta[run, row]  # (2)
            cells.theta_star[run, map_, waiting, output] = star
            for column in range(6):
                star = error * direction[column]  # (8)
                if not increments[JACOBIAN]:
                    star += jacobian[run, row, column]  # (3)
                cells.jacobian_star[run, map_, waiting, 6 * output + column] = star


@inner
def _neighbours(squares: np.ndarray, width: float, weights: np.ndarray) -> None:
    """Write the Gaussian neighbourhood (cells,) of a winner, from squared distances to it."""
    for cell in range(len(squares)):
        weights[cell] = np.exp(-squares[cell] / (2 * width**2))


@compiled
def spread_over(g_kl: np.ndarray, star: np.ndarray) -> np.ndarray:
    """Products (update, L n) of neighbourhoods (update, L) and propagated values (update, n)."""
    updates, cells, numbers = len(star), g_kl.shape[1], star.shape[1]
    products = np.empty((updates, cells * numbers))
    for update in range(updates):
        for l in range(cells):
            for number in range(numbers):
                products[update, l * numbers + number] = g_kl[update, l] * star[update, number]
    return products


@compiled
def lasting(rate: np.ndarray, g_k: np.ndarray, g_kl: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Final weights (update, K L) of updates towards values, after all later updates.

    Each later update multiplies earlier weights by 1 - its own weight. Also returns the final
    weights (K L) of the values before all updates.
    """
    updates, supernet, subnet = len(rate), g_k.shape[1], g_kl.shape[1]
    weights, remaining = np.empty((updates, supernet * subnet)), np.ones(supernet * subnet)
    for update in range(updates - 1, -1, -1):
        for k in range(supernet):
            for l in range(subnet):
                cell, weight = k * subnet + l, rate[update] * g_k[update, k] * g_kl[update, l]
                weights[update, cell] = weight * remaining[cell]
                remaining[cell] *= 1 - weight
    return weights, remaining


@compiled
def draw(values: np.ndarray, remaining: np.ndarray, drawn: np.ndarray) -> None:
    """Multiply cells (K, L, n) by their remaining weights (K L), then add `drawn` (K L, n)."""
    cells = values.reshape(drawn.shape)
    for cell in range(drawn.shape[0]):
        rest = remaining[cell]
        for number in range(drawn.shape[1]):
            cells[cell, number] = cells[cell, number] * rest + drawn[cell, number]


@compiled
def propagate(
    theta: np.ndarray, g_k: np.ndarray, g_kl: np.ndarray, star: np.ndarray, increments: bool
) -> None:
    """Add increments to theta (run, K, L, o), (7), or draw it towards values, (4).

    Args:
        g_k (run, K), g_kl (run, L): neighbourhoods, one of them times the learning rate.
        star: (run, o) the increment or value to propagate.
    """
    for run, k, l in np.ndindex(theta.shape[:3]):
        weight = g_k[run, k] * g_kl[run, l]
        for output in range(star.shape[1]):
            change = star[run, output]
            if not increments:
                change -= theta[run, k, l, output]
            theta[run, k, l, output] += weight * change
