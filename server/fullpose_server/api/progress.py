"""How far a job is, on the wire."""

from fullpose_server.api.schemas.plans import ProgressOut
from fullpose_server.planning.job import Progress
from fullpose_server.store.jobs import JobStatus


def progress_out(status: JobStatus, now: Progress | None) -> ProgressOut:
    """Of a job with this status; `now` is what its runner says while it is in work."""
    if now is None or status.finished:
        ended = int(status.finished)
        return ProgressOut(phase=status, done=ended, total=1, fraction=float(ended))
    fraction = min(1.0, now.done / now.total) if now.total else 0.0
    return ProgressOut(phase=now.phase, done=now.done, total=now.total, fraction=fraction)
