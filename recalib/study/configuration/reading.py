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

Source = str | PathLike | Mapping
Check = Callable[[Study], Iterable[Mistake]]


def read_study(path: Source, *overlays: Source, checks: Iterable[Check] = (check,)) -> Study:
    """The study of a configuration file.

    Args:
        overlays: files, or mappings from the command line, that are laid over it in this order:
            mappings key by key, anything else as a whole.
        checks: what to ask of the study beyond its types, each where those before found nothing.

    Raises InvalidConfiguration, with file, line and column of every mistake.
    """
    sources = [
        from_mapping(each) if isinstance(each, Mapping) else from_file(each)
        for each in (path, *overlays)
    ]
    whole = reduce(Placed.under, sources)
    try:
        study = Study.model_validate(whole.plain())
    except ValidationError as error:
        raise _placed(refusals(error), whole) from None
    for each in checks:
        if mistakes := list(each(study)):
            raise _placed(mistakes, whole)
    return study


def _placed(mistakes: Iterable[Mistake], whole: Placed) -> InvalidConfiguration:
    """The mistakes where they stand, in that order; what many uses of an anchor share, once."""
    lines = {}
    for mistake in mistakes:
        value = whole.at(mistake.path)
        lines.setdefault((value.origin, mistake.fault), (value.place, mistake))
    ordered = sorted(lines.values(), key=lambda line: line[0])
    return InvalidConfiguration([f"{shown(place)}: {mistake}" for place, mistake in ordered])
