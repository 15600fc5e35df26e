"""The learners that are compared: what each is called, what it needs to know, and how it is made.

The paper's are made from their settings (`replication.training.tuned`). They make two moves an
iteration; today's, the peers, make one.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from recalib.learners.kinds import KINDS, class_of
from recalib.learners.uncorrected import UncorrectedLearner
from recalib.loop.interfaces import Learner
from recalib.nominal.robots import Robot
from replication.config.switches import RITTER

MOVES = 2  # of an iteration of the paper's learners
UNCORRECTED = "uncorrected"  # the peer that learns nothing
TWIN = "hybrid"  # the one that identifies a twin: it explains more than geometry


class Peer(NamedTuple):
    """One of today's learners that is compared."""

    label: str  # what it is called
    needs: str  # what it needs to know
    kind: str  # one of `recalib.learners.kinds`; empty for the one that learns nothing
    settings: Mapping[str, Any]  # what it is made with


def peers() -> dict[str, Peer]:
    """All of them by name."""
    learning = [
        Peer(label, entry.needs, kind, settings)
        for kind, entry in KINDS.items()
        for label, settings in entry.peers.items()
    ]
    named = {peer.label.lower().replace(" ", "_"): peer for peer in learning}
    return {UNCORRECTED: Peer(UNCORRECTED, "nothing", "", {})} | named


def make_peer(name: str, runs: int, robot: Robot) -> Learner:
    """The peer of this name, which has learned nothing yet, for a nominal robot."""
    peer = peers()[name]
    if name == UNCORRECTED:
        return UncorrectedLearner()
    return class_of(peer.kind).from_settings(peer.settings, runs, robot)


def label_of(name: str) -> str:
    """What a learner is called."""
    known = peers()
    if name in known:
        return known[name].label
    return name.capitalize() if name == RITTER else name.replace("_", " ")
