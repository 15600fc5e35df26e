"""The learners in comparisons: their names, the information that they need, and their creation.

The paper's learners are created from their settings (`replication.training.tuned`) and make two
moves an iteration; today's learners, the peers, make one.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from recalib.learners.kinds import KINDS, class_of
from recalib.learners.uncorrected import UncorrectedLearner
from recalib.loop.interfaces import Learner
from recalib.nominal.robots import Robot
from replication.config.switches import RITTER

MOVES = 2  # in an iteration of the paper's learners
UNCORRECTED = "uncorrected"  # the peer that learns nothing
TWIN = "hybrid"  # the peer that identifies a twin: it models more than geometry


class Peer(NamedTuple):
    """One of today's learners."""

    label: str  # display name
    needs: str  # the information that it needs
    kind: str  # one of `recalib.learners.kinds`; empty for `UNCORRECTED`
    settings: Mapping[str, Any]  # for `from_settings`


def peers() -> dict[str, Peer]:
    """All peers by name."""
    learning = [
        Peer(label, entry.needs, kind, settings)
        for kind, entry in KINDS.items()
        for label, settings in entry.peers.items()
    ]
    named = {peer.label.lower().replace(" ", "_"): peer for peer in learning}
    return {UNCORRECTED: Peer(UNCORRECTED, "nothing", "", {})} | named


def make_peer(name: str, runs: int, robot: Robot) -> Learner:
    """An untrained peer, by its name, for a nominal robot."""
    peer = peers()[name]
    if name == UNCORRECTED:
        return UncorrectedLearner()
    return class_of(peer.kind).from_settings(peer.settings, runs, robot)


def label_of(name: str) -> str:
    """The display name of a learner."""
    known = peers()
    if name in known:
        return known[name].label
    return name.capitalize() if name == RITTER else name.replace("_", " ")
