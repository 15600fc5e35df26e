"""How far a training is, for people who watch it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tqdm import tqdm


@contextmanager
def progress_bar(title: str, iterations: int) -> Iterator[Callable[[int, float, float], None]]:
    """A bar with the errors so far, for the `progress` of `train`. Silent without a terminal."""
    with tqdm(total=iterations, desc=title, unit="it", leave=False, disable=None) as bar:

        def show(iteration: int, position_cm: float, orientation_deg: float) -> None:
            bar.set_postfix_str(f"{position_cm:.3g} cm, {orientation_deg:.3g} deg", refresh=False)
            bar.update(iteration - bar.n)

        yield show
