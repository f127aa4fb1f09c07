"""What `preview` can be told."""

from dataclasses import dataclass

from fullpose.errors import MethodError
from fullpose.options import Options, ranged

MOST_STAGES = 1000


@dataclass(frozen=True)
class PreviewOptions(Options):
    """How far ahead, how often and how thoroughly. Raises `MethodError` where an option is out of its range.

    preview_s: future that is known [s], of a flight from a file; live, the source sends it. horizon_s: how far the way
    goes [s] (where more is known, as far as that). replan_s: flight time between two ways [s]. delay_s: flight time
    until a way is there [s], to simulate a slow re-plan. settling_s: how long the body's acceleration is taken to last
    [s]; 0: the prediction is the present rate.
    """

    preview_s: float = ranged(0.0, 0.0)
    horizon_s: float = ranged(1.5, 0.0, open=True)
    replan_s: float = ranged(0.05, 0.0, open=True)
    delay_s: float = ranged(0.0, 0.0)
    settling_s: float = ranged(0.3, 0.0)
    stage_s: float = ranged(0.05, 0.0, open=True)
    # At the most of the next three a search takes 150 MB and some seconds: live, the rig waits at rest for the first.
    beam: int = ranged(192, 1, 4096)  # states kept a stage
    smoothing: int = ranged(3, 0, 100)  # iterations of the refinement; 0: the trajectory as the search found it
    slides: int = ranged(5, 2, 64)  # tried from each
    reserve: float = ranged(0.1, 0.0, 0.99)  # share of the acceleration limits left to what was not foreseen
    foresight_s: float = ranged(1.0, 0.0, open=True)  # the weight of what is predicted falls by e over this
    singularity_cost: float = ranged(0.3, 0.0)  # [1/s]; the next too
    range_cost: float = ranged(1.0, 0.0)
    room_cost: float = ranged(1.0, 0.0)  # [1/s] where there is room for 54 deg/s in any direction, and no more
    room_s: float = ranged(0.5, 0.0, open=True)  # [s] that the room must last
    rate_cost: float = ranged(1.0, 0.0)
    acceleration_cost: float = ranged(0.1, 0.0)
    excess_cost: float = ranged(1e3, 0.0)
    end_cost: float = ranged(1.0, 0.0)  # [s] of standing at the last stage
    following: float = ranged(20.0, 0.0, open=True)  # [1/s] bandwidth with which the trajectory is followed
    avoidance: float = ranged(2.0, 0.0)  # as in `exact`, without a trajectory to follow
    centring: float = ranged(2.0, 0.0)
    recovery: float = ranged(0.5, 0.0, 1.0, open=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        stages = max(self.horizon_s, self.preview_s) / self.stage_s
        if stages > MOST_STAGES:
            raise MethodError(
                f"options horizon_s = {self.horizon_s!r}, preview_s = {self.preview_s!r}, stage_s = {self.stage_s!r}: "
                f"expected {MOST_STAGES} stages at most, these are {stages:.3g}"
            )
