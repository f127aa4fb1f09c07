"""After a start: is what is stored still what was written? What is not goes into quarantine, and is named."""

import contextlib
import json
import re
from pathlib import Path

from fullpose_server.errors import DamagedError
from fullpose_server.formats.flight_folder import read_arrays
from fullpose_server.formats.plan_folder import PlanFolder, PlanFolderError, read_plan
from fullpose_server.planning.compare_request import REPORT
from fullpose_server.planning.comparisons import Comparisons
from fullpose_server.runtime.recording.run_index import RunFiles
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.quarantine import Quarantine
from fullpose_server.store.trajectories import TrajectoryStore


def scrub(
    plans: PlanStore, trajectories: TrajectoryStore, comparisons: Comparisons, runs: RunFiles, quarantine: Quarantine
) -> None:
    """Look at every plan, flight, comparison and record: whether it can be read, not whether each bit is right."""
    for plan in plans.done():
        with contextlib.suppress(DamagedError):
            open_plan(plan, plans, quarantine)
    for flight in trajectories.all():
        try:
            read_arrays(trajectories.folder(flight.sha256), flight.samples)
        except DamagedError as error:
            quarantine.take("flight", flight.sha256[:16], [trajectories.folder(flight.sha256)], str(error))
            trajectories.lost(flight.sha256)
    for job in comparisons.done():
        try:
            json.loads((job.folder / REPORT).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            comparisons.damaged(job.id, quarantine, str(error))
    for run, why in runs.damaged():
        quarantine.take("run", run, runs.files(run), why)


def open_plan(plan: str, plans: PlanStore, quarantine: Quarantine) -> PlanFolder:
    """The plan's arrays, mapped. Raises `DamagedError`: then its files are in quarantine, and its row says so."""
    folder = plans.folder(plan)
    try:
        return read_plan(folder)
    except PlanFolderError as error:
        quarantine.take("plan", plan, [folder], error.told)
        plans.damaged(plan, error.told)
        raise DamagedError(f"plan {plan} is damaged ({error.told}): make it again") from None


def scrub_rigs(folder: Path, quarantine: Quarantine) -> None:
    """Move rig files aside that no person has written so: cut off to nothing, or no text. The rest is for a person."""
    for path in sorted(folder.glob("*.toml")):
        with contextlib.suppress(OSError):
            data = path.read_bytes()
            if not data.strip() or re.search(rb"[\0-\x08\x0e-\x1f]", data):
                quarantine.take("rig", path.stem, [path], "its file is empty" if not data.strip() else "it is no text")
