"""Read a study from configuration files.

`python -m replication.config.reading FILE` reports why a file is not valid YAML. Snakemake reads
the file before the project does, and does not name it in its own message.
"""

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import reduce
from os import PathLike

from pydantic import ValidationError

from replication.config.messages import InvalidConfiguration, Mistake
from replication.config.refusals import refusals
from replication.config.study import Study
from replication.config.values import Place, Placed, from_file, from_mapping, shown

Source = str | PathLike[str] | Mapping[str, object] | Placed
Check = Callable[[Study], Iterable[Mistake]]


def read_study(path: Source, *overlays: Source, checks: Iterable[Check] = ()) -> Study:
    """The study of a configuration file.

    Args:
        overlays: files, or mappings from the command line, that override the file in this order:
            mappings key by key, anything else as a whole.
        checks: checks of the study beyond its types; each runs only if those before found nothing.

    Raises InvalidConfiguration, with file, line and column of every mistake. The file alone is
    assumed to be valid: if one of its values contradicts an overlay, the mistake is reported for
    the last overlay, without a line.
    """
    sources = [*map(placed, (path, *overlays))]
    whole = reduce(Placed.under, sources)
    own = [str(source.place[0]) for source in (sources[1:] or sources)]
    try:
        study = Study.model_validate(whole.plain())
    except ValidationError as error:
        raise _at_its_place(refusals(error, whole.plain()), whole, own) from None
    for find in checks:
        if mistakes := list(find(study)):
            raise _at_its_place(mistakes, whole, own)
    return study


def placed(source: Source) -> Placed:
    """The values of a file or of a mapping. Raises InvalidConfiguration."""
    if isinstance(source, Placed):
        return source
    return from_mapping(source) if isinstance(source, Mapping) else from_file(source)


def _at_its_place(
    mistakes: Iterable[Mistake], whole: Placed, own: Sequence[str]
) -> InvalidConfiguration:
    """Mistakes with their lines in the user's `own` sources; a mistake in an anchor only once."""
    lines: dict[tuple[Place, str], Mistake] = {}
    for mistake in mistakes:
        places = [whole.at(path).place for path in (mistake.path, *mistake.also)]
        place = next((place for place in places if place[0] in own), own[-1:])
        lines.setdefault((tuple(place), mistake.fault), mistake)
    ordered = sorted(lines.items(), key=lambda line: line[0][0])
    return InvalidConfiguration([f"{shown(place)}: {mistake}" for (place, _), mistake in ordered])


if __name__ == "__main__":
    try:
        from_file(sys.argv[1])
    except InvalidConfiguration as error:
        sys.exit(str(error))
