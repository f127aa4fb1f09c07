"""Runs that are searched for: by what their summaries say, by their labels, and by plans that somebody else found."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from fullpose_server.formats.labels import search_text
from fullpose_server.runtime.recording.run_labels import RunLabels

# Each part of what is searched for, with the plans that have it.
Sought = tuple[tuple[str, frozenset[str]], ...]
_SAID = ("id", "rig", "who", "end", "incident", "plan_id")


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
            told: Any = json.loads((self._folder / f"{run}.json").read_text(encoding="utf-8"))
            said = [str(told[name]) for name in _SAID if told[name] is not None]
            found = _Text("\n".join(said).casefold(), told["plan_id"])
            final = bool(told["complete"])
        except (OSError, ValueError, TypeError, KeyError):  # not there yet, or of another version
            return _Text(run.casefold(), None)
        if final:
            self._texts[run] = found
        return found
