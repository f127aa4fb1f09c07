"""What every beam search does: of the states found for a stage the cheapest are kept."""

from typing import Protocol

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers


class Found(Protocol):
    """The states found for a stage: a NamedTuple with these and what else a search keeps of them."""

    @property
    def pose(self) -> Array:
        """(space, 4) [rad]"""

    @property
    def rate(self) -> Array:
        """(space, 4) [rad/s]"""

    @property
    def cost(self) -> Array:
        """(space,)"""

    @property
    def parent(self) -> Counts:
        """(space,) the state of the stage before"""


@kernel
def cheapest(found: Found, count: int, beam: int, stage: int, kept: Found) -> Integers:
    """kept <- the cheapest `beam` of the first `count` found; returns which those are, cheapest first. (w,)

    kept: pose (k, width, 4) and parent (k, width) of every stage, rate (width, 4) and cost (width,) of the last one.
    """
    slots = np.argsort(found.cost[:count])[: min(count, beam)]
    for b in range(slots.size):
        slot = slots[b]
        for i in range(4):
            kept.pose[stage, b, i] = found.pose[slot, i]
            kept.rate[b, i] = found.rate[slot, i]
        kept.cost[b] = found.cost[slot]
        kept.parent[stage, b] = found.parent[slot]
    return slots
