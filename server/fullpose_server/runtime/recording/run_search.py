"""Runs that are searched for: by what their summaries say, by their labels, and by plans that somebody else found."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from fullpose_server.formats.labels import search_text
from fullpose_server.runtime.recording.record_names import RECORD
from fullpose_server.runtime.recording.run_labels import RunLabels
from fullpose_server.runtime.recording.run_summary import kept_summary

# Each part of what is searched for, with the plans that have it.
Sought = tuple[tuple[str, frozenset[str]], ...]


class _Text(NamedTuple):
    text: str
    plan: str | None


class RunSearch:
    """Of the records in one folder. What has been read once is kept in memory."""

    def __init__(self, folder: Path, labels: RunLabels) -> None:
        self._folder = folder
        self._labels = labels
        self._texts: dict[str, _Text] = {}

    def by(self, sought: Sought) -> Callable[[str], bool]:
        """Whether a run has each part; one without a summary yet is known by its id and its labels alone."""
        labels, texts = self._labels.all(), self._texts

        def fits(run: str) -> bool:
            text, plan = texts.get(run) or self._read(run)
            if run in labels:
                text = f"{text}\n{search_text(labels[run])}"
            return all(part in text or plan in plans for part, plans in sought)

        return fits

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
