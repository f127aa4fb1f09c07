"""Node paths of a flight: the cheapest on a grid, and those of the beam search."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Integers, Progress
from fullpose.plan.beam_path import Breadth, attainable_rates, beam_path, first_poses
from fullpose.plan.three_axis import turns_into_range
from fullpose.trajectory.beam_search import Start
from fullpose.trajectory.nodes import lattice
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.shortest_path import Avoid, NodePath, Programme, Terms

NONE = NodePath(np.empty((0, 4)), math.inf, 0)


@dataclass(frozen=True)
class Query:
    """What a node path is looked for with."""

    samples: Integers  # of the stages
    turns: NDArray[np.bool_]  # (4,) frames whose turns are counted as states
    grid: float  # [rad]
    slack: float = 0.0  # [rad] that every range and edge is widened by
    avoid: tuple[Avoid, ...] = ()
    margin_gain: float = 1.0  # times the price on the singularity
    stretch: float = 1.0  # times the rate limits that an edge may take,
    violation_cost: float = 0.0  # at this cost of going over one by its whole


def cheapest(problem: Problem, query: Query, progress: Progress | None) -> tuple[NodePath, Query]:
    """The cheapest node path, and the query as it was answered.

    Turns of wide frames are counted only as far as their ranges need it: the answered query counts more of them.
    """
    rig = problem.rig
    low, high = rig.position_min, rig.position_max
    while True:
        node_path = _cheapest_once(problem, query, progress)
        if not node_path.found:
            return node_path, query
        free = np.isfinite(high) & (high - low >= 2.0 * math.pi) & ~query.turns
        angles = node_path.angles
        if problem.start is None and free.any():
            shift = np.zeros(4)
            shift[free] = turns_into_range(angles[:, free], low[free], high[free])
            angles += shift
        outside = free & ((angles.min(axis=0) < low - query.slack) | (angles.max(axis=0) > high + query.slack))
        if not outside.any():
            return node_path, query
        query = replace(query, turns=query.turns | outside)


def _cheapest_once(problem: Problem, query: Query, progress: Progress | None) -> NodePath:
    """The cheapest node path with the turns counted that the query counts."""
    motion = None
    if problem.start is not None and problem.start_rate is not None:
        motion = problem.start, problem.start_rate
    terms = Terms(query.slack, query.avoid, query.margin_gain, query.stretch, query.violation_cost, motion)
    programme = _programme(problem, query, terms)
    node_path = programme.run(problem.start, progress)
    if not node_path.found and programme.bounded:  # the verdict rests on all that the limits allow
        node_path = _programme(problem, query, replace(terms, everywhere=True)).run(problem.start, progress)
    return node_path


def _programme(problem: Problem, query: Query, terms: Terms) -> Programme:
    return Programme(
        problem.time[query.samples], problem.attitude[query.samples], problem.rig,
        lattice(problem.rig, query.grid, query.turns, query.slack), problem.options, terms,
    )  # fmt: skip


def searched(problem: Problem, samples: Integers, breadth: Breadth, progress: Progress | None) -> NodePath:
    """The node path of the beam search; none where no pose is inside the ranges at the first sample."""
    stages = replace(
        problem, time=problem.time[samples], attitude=np.ascontiguousarray(problem.attitude[samples]), start_rate=None
    )
    poses = first_poses(stages.attitude[0], problem.rig) if problem.start is None else problem.start[None].copy()
    if not len(poses):
        return NONE
    first = Start(poses, np.zeros_like(poses), 0.0)
    if problem.start_rate is not None:
        past = float(problem.time[1] - problem.time[0])
        rate = attainable_rates(problem.attitude[1], past, problem.rig, poses, problem.start_rate)
        first = Start(poses, rate, past)
    return NodePath(beam_path(stages, breadth, first, progress), math.nan, len(samples))
