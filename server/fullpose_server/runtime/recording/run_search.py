"""Runs that are searched for: by what their summaries say, by their labels, and by plans that somebody else found."""

from collections.abc import Callable, Collection, Iterable, Iterator
from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple

from fullpose_server.formats.labels import search_text
from fullpose_server.runtime.recording.record_names import RECORD
from fullpose_server.runtime.recording.run_labels import RunLabels
from fullpose_server.runtime.recording.run_summary import kept_summary

# Each part of what is searched for, and what tells the plans that have it: of these alone, or of all there are (None).
Sought = tuple[tuple[str, Callable[[Collection[str] | None], frozenset[str]]], ...]
# So many of the newest are tried before all plans are looked through: what most runs have fills a page out of them.
FIRST = 512


class _Text(NamedTuple):
    text: str
    plan: str | None


class RunSearch:
    """Of the records in one folder. What has been read once is kept in memory."""

    def __init__(self, folder: Path, labels: RunLabels) -> None:
        self._folder = folder
        self._labels = labels
        self._texts: dict[str, _Text] = {}

    def among(self, runs: Iterable[str], sought: Sought) -> Iterator[str]:
        """Those of the runs that have each part; one without a summary yet is known by its id and its labels alone."""
        labels, rest = self._labels.all(), iter(runs)

        def told(run: str) -> _Text:
            text, plan = self._texts.get(run) or self._read(run)
            return _Text(f"{text}\n{search_text(labels[run])}", plan) if run in labels else _Text(text, plan)

        first = [(run, told(run)) for run in islice(rest, FIRST)]
        plans = {text.plan for _, text in first if text.plan is not None}
        yield from _fitting(first, [(part, having(plans)) for part, having in sought])
        more = ((run, told(run)) for run in rest)
        if (one := next(more, None)) is not None:
            yield from _fitting(chain((one,), more), [(part, having(None)) for part, having in sought])

    def forget(self, run: str) -> None:
        """It is gone."""
        self._texts.pop(run, None)

    def _read(self, run: str) -> _Text:
        try:
            summary = kept_summary(self._folder / f"{run}{RECORD}")
        except OSError:  # the record is gone
            summary = None
        if summary is None:  # not there yet, or of another version
            return _Text(run.casefold(), None)
        said = (summary.id, summary.rig, summary.who, summary.end, summary.incident, summary.plan_id)
        found = _Text("\n".join(each for each in said if each is not None).casefold(), summary.plan_id)
        if summary.complete:
            self._texts[run] = found
        return found


def _fitting(runs: Iterable[tuple[str, _Text]], sought: Collection[tuple[str, frozenset[str]]]) -> Iterator[str]:
    for run, (text, plan) in runs:
        if all(part in text or plan in plans for part, plans in sought):
            yield run
