"""How far a long piece of work is, on stderr: a bar on a terminal; elsewhere, where that is asked for, lines."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic

EVERY_S = 5.0  # a line in a log file


@contextmanager
def progress_bar(label: str, *, lines: bool = False) -> Iterator[Callable[[int, int], None] | None]:
    """A callback (done, total) that draws on stderr; where stderr is no terminal `lines` at times, or None."""
    if not sys.stderr.isatty():
        yield line_at_times(label) if lines else None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(label, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def line_at_times(label: str, clock: Callable[[], float] = monotonic) -> Callable[[int, int], None]:
    """A callback (done, total) that says every few seconds how far it is; what is done before says nothing."""
    told: list[float] = []

    def tell(done: int, total: int) -> None:
        if not told:
            told.append(clock())
        elif clock() - told[0] >= EVERY_S:
            told[0] = clock()
            sys.stderr.write(f"fullpose: {label}: {100 * done // max(total, 1)} %\n")
            sys.stderr.flush()

    return tell
