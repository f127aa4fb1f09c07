"""Tags and notes of runs: a file beside each record that has some, all of them kept in memory by one server."""

import contextlib
import json
import threading
from dataclasses import asdict
from pathlib import Path

from fullpose_server.formats.labels import NO_LABELS, LabelError, Labels, labels_of
from fullpose_server.formats.output_file import write_text

LABELS = ".labels"  # of the file beside a record


class RunLabels:
    """Of the records in one folder; read when they are first asked for, changed by nobody else."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._changing = threading.Lock()
        self._known: dict[str, Labels] | None = None

    def get(self, run: str) -> Labels:
        """Those of a run."""
        return self.all().get(run, NO_LABELS)

    def put(self, run: str, labels: Labels) -> None:
        """In place of those that it has."""
        known, file = self.all(), self._folder / f"{run}{LABELS}"
        with self._changing:
            if labels == NO_LABELS:
                file.unlink(missing_ok=True)
                known.pop(run, None)
            else:
                write_text(file, json.dumps(asdict(labels)))
                known[run] = labels

    def all(self) -> dict[str, Labels]:
        """By run, of those that have some."""
        with self._changing:
            if self._known is None:
                self._known = {}
                for file in self._folder.glob(f"*{LABELS}"):
                    # One that is none says nothing; whoever labels the run again writes it anew.
                    with contextlib.suppress(OSError, ValueError, TypeError, KeyError, LabelError):
                        told = json.loads(file.read_text("utf-8"))
                        self._known[file.name.removesuffix(LABELS)] = labels_of(told["tags"], told["notes"])
            return self._known
