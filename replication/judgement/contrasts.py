"""Contrasts: the ratio of the errors of two variants, in the same setup and on the same poses."""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
import pandas as pd

from replication.judgement.hierarchy import Model, model
from replication.training.measured import KINDS

SHARES = [f"{kind}_share" for kind in KINDS]
KEYS = ["setup", "replicate"]
Error = Literal["both", "position", "orientation"]


class Values(NamedTuple):
    """A number in each setup, on a logarithmic scale.

    Attributes:
        table: (setup, replicate) the numbers; NaN where it was not measured.
        bounds: likewise; see `replication.judgement.hierarchy.model`.
        unsettled: in how many of them a search has not converged.
    """

    table: pd.DataFrame
    bounds: pd.DataFrame
    unsettled: int

    def model(self) -> Model:
        """What all setups say together."""
        return model(self.table.to_numpy(), self.bounds.to_numpy())


@dataclass(frozen=True)
class Remaining:
    """What a variant leaves of the arm's errors.

    Attributes:
        variant: its name.
        iterations: of the training.
        error: the larger share of both errors, or that of one of them.
    """

    variant: str
    iterations: int
    error: Error = "both"

    def values(self, outcomes: pd.DataFrame) -> Values:
        """The logarithm of the share in each setup."""
        its = outcomes.query("variant == @self.variant and iterations == @self.iterations")
        which = SHARES if self.error == "both" else [f"{self.error}_share"]
        return _values(its.assign(value=np.log(its[which].max(axis=1)), bound=0))


@dataclass(frozen=True)
class Contrast:
    """The error of one variant over that of another one."""

    ours: Remaining
    theirs: Remaining

    def values(self, outcomes: pd.DataFrame) -> Values:
        """The logarithm of the ratio in each setup."""
        return _less(self.ours.values(outcomes), self.theirs.values(outcomes))


@dataclass(frozen=True)
class Difference:
    """By which factor one contrast is larger than another one."""

    one: Contrast
    other: Contrast

    def values(self, outcomes: pd.DataFrame) -> Values:
        """The logarithm of the ratio of ratios in each setup."""
        return _less(self.one.values(outcomes), self.other.values(outcomes))


@dataclass(frozen=True)
class Compromise:
    """The error of a map that is tuned for both errors, over what it could leave of each by itself.

    The larger share tuned for both, over the larger one of the shares of which each is tuned alone.
    """

    both: Remaining
    position: Remaining
    orientation: Remaining

    def values(self, outcomes: pd.DataFrame) -> Values:
        """The logarithm of the ratio in each setup: 0 if both errors have the same optimum."""
        alone = [its.values(outcomes) for its in (self.position, self.orientation)]
        larger = Values(
            np.maximum(*(its.table for its in alone)),
            alone[0].bounds,
            sum(its.unsettled for its in alone),
        )
        return _less(self.both.values(outcomes), larger)


@dataclass(frozen=True)
class Crossing:
    """How many times as many iterations a slow variant needs for the errors of a fast one.

    Both errors have to be reached, each by a training that is tuned for so many iterations.

    Attributes:
        slow: its name.
        fast: what is to be reached.
    """

    slow: str
    fast: Remaining

    def values(self, outcomes: pd.DataFrame) -> Values:
        """The logarithm of the factor in each setup, or a bound at an end of what was tried."""
        goal = self.fast.values(outcomes)
        rows = []
        for (setup, replicate), its in outcomes[outcomes["variant"] == self.slow].groupby(KEYS):
            its = its.sort_values("iterations")
            errors = np.log(its[SHARES].max(axis=1).to_numpy())
            lengths = np.log(its["iterations"].to_numpy() / self.fast.iterations)
            value, bound = crossing(lengths, errors - goal.table.loc[setup, replicate])
            settled = its["settled"].min()
            rows.append((setup, replicate, value, bound, settled))
        table = pd.DataFrame(rows, columns=[*KEYS, "value", "bound", "settled"])
        return _values(table)._replace(unsettled=int((1 - table["settled"]).sum()) + goal.unsettled)


def crossing(lengths: np.ndarray, above: np.ndarray) -> tuple[float, int]:
    """Where a falling curve crosses zero, interpolated, and which bound that is.

    Args:
        lengths: ascending.
        above: the curve there.

    Returns the first crossing and 0; or the first length and -1, where it begins below zero; or the
    last length and 1, where it does not get there.
    """
    reached = np.flatnonzero(above <= 0)
    if not len(reached):
        return float(lengths[-1]), 1
    after = reached[0]
    if after == 0:
        return float(lengths[0]), -1
    before = after - 1
    part = above[before] / (above[before] - above[after])
    return float(lengths[before] + part * (lengths[after] - lengths[before])), 0


def _less(one: Values, other: Values) -> Values:
    return Values(one.table - other.table, one.bounds, one.unsettled + other.unsettled)


def _values(rows: pd.DataFrame) -> Values:
    table, bounds = (
        rows.pivot(index="setup", columns="replicate", values=name) for name in ("value", "bound")
    )
    return Values(table, bounds.fillna(0), int((1 - rows["settled"]).sum()))


Estimand = Remaining | Contrast | Difference | Compromise | Crossing
