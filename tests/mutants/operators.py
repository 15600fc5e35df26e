"""Errors that a scientist makes, as operators of cosmic-ray in addition to its own.

Each of them rewrites a node of the syntax tree in a few ways; a way that Python refuses, or that
ends at once, is as good as noticed.
"""

import ast
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

from cosmic_ray.operators.operator import Operator
from cosmic_ray.plugins import OPERATOR_PROVIDERS
from parso.python.tree import Name
from parso.tree import NodeOrLeaf, search_ancestor

PROVIDER = "science"
METHODS = {  # of arrays and frames; those that stand alone in `FUNCTIONS`
    "mean": ("min", "max"),
    "median": ("mean", "min"),
    "min": ("max", "mean"),
    "max": ("min", "mean"),
    "argmin": ("argmax",),
    "argmax": ("argmin",),
    "idxmin": ("idxmax",),
    "maximum": ("minimum",),
    "minimum": ("maximum",),
    "std": ("var",),
    "var": ("std",),
    "any": ("all",),
    "all": ("any",),
}
FUNCTIONS = {"min": ("max",), "max": ("min",), "any": ("all",), "all": ("any",)}
QUANTILES = {
    "0.95": "0.9",
    "95": "90",
    "0.975": "0.95",
    "97.5": "95",
    "0.025": "0.05",
    "2.5": "5",
    "0.05": "0.1",
    "0.9": "0.95",
    "90": "95",
    "0.99": "0.95",
    "0.75": "0.5",
    "0.25": "0.5",
}
STREAMS = "SCENARIO", "TWIN", "SEARCH"  # members of `Stream`: named, nameless, of a search
LEAKS = (("desired", "tests"), ("SearchPoses", "ResultPoses"), ("LEARNING", "MEASURING"))
LEAKS += (("known", "unknown"), ("training", "held_out"))
COUNTERPARTS = {**dict(LEAKS), **{second: first for first, second in LEAKS}}
LISTS = {"arglist", "testlist_star_expr", "testlist", "exprlist"}


def _code(*nodes: NodeOrLeaf) -> str:
    """The code of nodes, without the space before."""
    first, *rest = nodes
    return first.get_code(include_prefix=False) + "".join(node.get_code() for node in rest)


def _value(leaf: NodeOrLeaf | None) -> str:
    return getattr(leaf, "value", "")


def _is_argument(node: NodeOrLeaf) -> bool:
    """Whether a call gets this, by its place or by a name."""
    around = node.parent
    if around.type == "argument":
        return _value(around.children[1]) == "=" and node is around.children[2]
    called = around.parent if around.type == "arglist" else around
    return called.type == "trailer" and _value(called.children[0]) == "("


def _whole(name: NodeOrLeaf) -> NodeOrLeaf:
    """The expression that ends with a name: `plan.seed` of `seed`."""
    trailer = name.parent
    ends = _value(name.get_previous_leaf()) == "." and trailer is trailer.parent.children[-1]
    return trailer.parent if ends else name


def means(node: NodeOrLeaf) -> Iterator[str]:
    """The smallest instead of the mean, the largest instead of the smallest."""
    if node.type == "name" and _value(node.get_next_leaf()) == "(":
        before = _value(node.get_previous_leaf())
        table = METHODS if before == "." else {} if before == "def" else FUNCTIONS
        yield from table.get(node.value, ())


def quantiles(node: NodeOrLeaf) -> Iterator[str]:
    """Another quantile than the stated one."""
    if node.type == "number" and node.value in QUANTILES:
        yield QUANTILES[node.value]


def swaps(node: NodeOrLeaf) -> Iterator[str]:
    """Two neighbours swapped: arguments, returned or unpacked values."""
    if node.type not in LISTS or node.parent.type == "classdef":
        return
    parts = node.children
    for index in range(0, len(parts) - 2, 2):
        first, comma, second = parts[index : index + 3]
        pair = [node.children if node.type == "argument" else [node] for node in (first, second)]
        if len(pair[0]) != len(pair[1]) or any(_value(nodes[0]) in ("*", "**") for nodes in pair):
            continue
        (*first_keyword, first_value), (*second_keyword, second_value) = pair
        if _code(first_value) == _code(second_value) or not _alike(first_value, second_value):
            continue
        before = _code(*parts[:index]) + first.get_first_leaf().prefix if index else ""
        rest = "".join(each.get_code() for each in parts[index + 3 :])
        keywords = first_keyword, second_keyword
        start, end = (_code(*keyword) if keyword else "" for keyword in keywords)
        between = _code(comma) + second.get_first_leaf().prefix
        yield f"{before}{start}{_code(second_value)}{between}{end}{_code(first_value)}{rest}"


def _alike(*nodes: NodeOrLeaf) -> bool:
    """Whether values may have one shape, by their names, so that a swap may run."""
    if {node.type for node in nodes} & {"string", "strings", "number", "fstring", "lambdef"}:
        return False
    kinds = [annotations().get(_value(node.get_last_leaf())) for node in nodes]
    return None in kinds or bool(kinds[0] & kinds[1])


@cache
def annotations() -> dict[str, set[str]]:
    """The annotations of the project's parameters and fields, by their names."""
    kinds: dict[str, set[str]] = {}
    for path in Path("recalib").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(node, ast.arg) and node.annotation:
                kinds.setdefault(node.arg, set()).add(ast.unparse(node.annotation))
            elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                kinds.setdefault(node.target.id, set()).add(ast.unparse(node.annotation))
    return kinds


def drops(node: NodeOrLeaf) -> Iterator[str]:
    """A missing term of a sum or factor of a product."""
    if node.type not in ("arith_expr", "term"):
        return
    operators = {_value(each) for each in node.children[1::2]}
    texts = any(each.type in ("string", "fstring", "strings") for each in node.children[::2])
    if operators & {"//", "%"} or texts:
        return
    parts = node.children
    if parts[1].value != "/":
        yield ("-" if parts[1].value == "-" else "") + _code(*parts[2:])
    for index in range(2, len(parts), 2):
        yield _code(*parts[: index - 1], *parts[index + 1 :])


def seeds(node: NodeOrLeaf) -> Iterator[str]:
    """Another seed, or the same random numbers for two purposes."""
    if node.type == "name" and node.value == "seed" and _is_argument(_whole(node)):
        yield "seed + 1"
    if node.type == "arglist" and _value(node.get_previous_leaf().get_previous_leaf()) in (
        "generator",
        "random",
    ):
        for index in range(2, len(node.children), 2):
            yield _code(*node.children[: index - 1], *node.children[index + 1 :])


def streams(node: NodeOrLeaf) -> Iterator[str]:
    """Poses from the random stream of another purpose."""
    dot = node.get_previous_leaf() if node.type == "name" else None
    if _value(dot) == "." and _value(dot.get_previous_leaf()) == "Stream":
        yield from (name for name in STREAMS if name != node.value)


def leaks(node: NodeOrLeaf) -> Iterator[str]:
    """Training on test data, or testing on training data."""
    if node.type == "name" and (counterpart := COUNTERPARTS.get(node.value)):
        member = _value(node.get_previous_leaf()) == "." or _value(node.get_next_leaf()) == "."
        around = search_ancestor(node, "funcdef")
        if member or (_is_argument(node) and around and counterpart in around.get_code()):
            yield counterpart


def _operator(rewrites: Callable[[NodeOrLeaf], Iterator[str]]) -> type[Operator]:
    """An operator of cosmic-ray that rewrites a node in each of these ways."""

    class Rewriting(Operator):
        def mutation_positions(self, node):
            return [(node.start_pos, node.end_pos) for _ in rewrites(node)]

        def mutate(self, node, index):
            prefix = node.get_first_leaf().prefix
            return Name(list(rewrites(node))[index], node.start_pos, prefix)

        @classmethod
        def examples(cls):
            return ()

    return Rewriting


OPERATORS = {
    rewrites.__name__: _operator(rewrites)
    for rewrites in (means, quantiles, swaps, drops, seeds, streams, leaks)
}


def register() -> None:
    """Register them with cosmic-ray, which by itself finds those of installed packages alone."""
    OPERATOR_PROVIDERS[PROVIDER] = OPERATORS
