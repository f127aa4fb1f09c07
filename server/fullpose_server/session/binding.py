"""What `load` bound together."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Binding:
    """A plan (or a live source's settings), a rig, and their hashes."""

    plan_id: str
    plan_hash: str
    rig: str
    rig_hash: str
    live: bool = False  # follows a live source: there is no path to start
