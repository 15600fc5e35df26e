"""From configuration files to a study."""

from collections.abc import Callable, Iterable, Mapping
from functools import reduce
from os import PathLike

from pydantic import ValidationError

from recalib.study.configuration.checks import check
from recalib.study.configuration.messages import InvalidConfiguration, Mistake
from recalib.study.configuration.refusals import refusals
from recalib.study.configuration.study import Study
from recalib.study.configuration.values import Placed, from_file, from_mapping, shown

Source = str | PathLike | Mapping | Placed
Check = Callable[[Study], Iterable[Mistake]]


def read_study(path: Source, *overlays: Source, checks: Iterable[Check] = (check,)) -> Study:
    """The study of a configuration file.

    Args:
        overlays: files, or mappings from the command line, that are laid over it in this order:
            mappings key by key, anything else as a whole.
        checks: what to ask of the study beyond its types, each where those before found nothing.

    Raises InvalidConfiguration, with file, line and column of every mistake.
    """
    whole = reduce(Placed.under, map(placed, (path, *overlays)))
    try:
        study = Study.model_validate(whole.plain())
    except ValidationError as error:
        raise _at_its_place(refusals(error), whole) from None
    for each in checks:
        if mistakes := list(each(study)):
            raise _at_its_place(mistakes, whole)
    return study


def placed(source: Source) -> Placed:
    """The values of a file or of a mapping. Raises InvalidConfiguration."""
    match source:
        case Placed():
            return source
        case Mapping():
            return from_mapping(source)
    return from_file(source)


def _at_its_place(mistakes: Iterable[Mistake], whole: Placed) -> InvalidConfiguration:
    """The mistakes where they stand, in that order; what many uses of an anchor share, once."""
    lines = {}
    for mistake in mistakes:
        value = whole.at(mistake.path)
        lines.setdefault((value.origin, mistake.fault), (value.place, mistake))
    ordered = sorted(lines.values(), key=lambda line: line[0])
    return InvalidConfiguration([f"{shown(place)}: {mistake}" for place, mistake in ordered])
