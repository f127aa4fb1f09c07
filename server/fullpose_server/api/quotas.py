"""Bounds on what is asked of the planner: how long a flight, how many jobs."""

from collections.abc import Iterator
from contextlib import contextmanager
from uuid import uuid4

from fullpose_server.api.problems import ApiError
from fullpose_server.planning.runner import Pending
from fullpose_server.settings import Settings


def check_span(duration_s: float, settings: Settings) -> None:
    """Raise `ApiError` 422 where a flight has too many samples at the rigs' rate."""
    rate_hz = settings.rig_rate_hz
    longest_s = settings.max_plan_samples / rate_hz
    if duration_s > longest_s:
        raise ApiError(422, "too-long", f"a flight of {duration_s:.6g} s: at most {longest_s:.6g} s at {rate_hz:g} Hz")


@contextmanager
def queue_slot(pending: Pending, who: str, settings: Settings) -> Iterator[None]:
    """Keep a place for a job while it is being submitted: who comes meanwhile finds it taken.

    Raises `ApiError` 429 where there are jobs enough, of all clients or of this one.
    """
    if pending.total >= settings.max_queued_jobs:
        raise ApiError(429, "queue-full", f"{pending.total} jobs are waiting or in work: ask again when some are done")
    mine = pending.of(who)
    if mine >= settings.max_queued_jobs_per_client:
        told = f"{mine} jobs of {who} are waiting or in work: wait for them, or cancel some"
        raise ApiError(429, "queue-full", told)
    slot = uuid4().hex
    pending.add(slot, who)
    try:
        yield
    finally:
        pending.remove(slot)
