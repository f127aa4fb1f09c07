"""Files of the server's own that are not what it wrote: moved aside with a note, never deleted, named in health."""

import logging
import shutil
import time
from collections.abc import Sequence
from pathlib import Path
from uuid import uuid4

REASON = "why.txt"
log = logging.getLogger(__name__)


class Quarantine:
    """One folder; each entry is a folder with what was moved and why. A person looks at it, and removes the entry."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._stuck: list[str] = []  # what could not be moved

    def take(self, kind: str, name: str, paths: Sequence[Path], why: str) -> None:
        """Move the files or folders of a damaged thing aside; what is not there is left out."""
        told = f"{kind} {name} is damaged ({why})"
        entry = self.folder / f"{time.strftime('%Y%m%dT%H%M%S', time.gmtime())}-{kind}-{name}-{uuid4().hex[:6]}"
        try:
            entry.mkdir(parents=True)
            for path in paths:
                if path.exists():
                    shutil.move(path, entry / path.name)
            (entry / REASON).write_text(f"{told}\n", encoding="utf-8")
        except OSError as error:
            self._stuck.append(f"{told}, and could not be moved aside: {error.strerror}")
        log.warning("%s: moved to %s", told, entry)

    def findings(self) -> list[str]:
        """What is in it, in words."""
        found = list(self._stuck)
        if self.folder.is_dir():
            for entry in sorted(self.folder.iterdir()):
                reason = entry / REASON
                told = reason.read_text("utf-8", "replace").strip() if reason.is_file() else "damaged"
                where = (
                    f"{self.folder.name}/{entry.name} of the data folder"  # clients are told no paths of this machine
                )
                found.append(f"{told}: it is in {where}; remove it there when it is of no more use")
        return found
