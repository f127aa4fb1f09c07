"""Plans, their reports and jobs on the wire."""

from datetime import datetime
from typing import Annotated

from pydantic import Field

from fullpose.vocabulary import Certainty, Consequence
from fullpose_server.api.schemas.base import (
    FieldProblem,
    Four,
    FrameName,
    LimitName,
    Name,
    Notice,
    Options,
    OptionValue,
    Sha256,
    Wire,
    Word,
)
from fullpose_server.api.schemas.labels import LabelledOut
from fullpose_server.api.schemas.remedies import RemedyOut
from fullpose_server.store.jobs import JobStatus

ToleranceDeg = Annotated[float, Field(gt=0.0, le=90.0, description="The attitude may differ from the flight's by that")]


class PlanIn(Wire):
    """What to plan. Without `start_deg` the start pose is free; without `tolerance_deg` the flight is as it is."""

    trajectory: Sha256
    rig: Name
    method: Word = "plan"
    options: Options = Field(default={})
    start_deg: Four | None = None
    tolerance_deg: ToleranceDeg | None = None


class ProgressOut(Wire):
    """How far a job is."""

    phase: str
    done: int
    total: int
    fraction: float = Field(ge=0.0, le=1.0)


class IterationsOut(Wire):
    median: float
    max: int


class StepTimeOut(Wire):
    median: float
    p99: float


class PeakOut(Wire):
    position_deg: float
    rate_deg_s: float
    acceleration_deg_s2: float
    jerk_deg_s3: float | None = Field(default=None, description="Of the samples' third differences")
    jerk_percent: float | None = Field(default=None, description="Of the frame's limit; null: it has none")


class PeaksOut(Wire):
    base: PeakOut | None = None
    outer: PeakOut
    middle: PeakOut
    inner: PeakOut


class ViolationOut(Wire):
    """A run of samples beyond a limit, at its worst one."""

    time_s: float
    frame: FrameName
    limit: LimitName
    value: float = Field(description="deg, deg/s, deg/s^2 or deg/s^3, by the limit")
    samples: int = Field(description="Length of the run")


class BlockingOut(Wire):
    time_s: float
    frame: FrameName
    limit: LimitName


class LimitMetOut(Wire):
    """A frame and one of its limits: `value` against `bound`, in deg, deg/s, deg/s^2 or deg/s^3 by the limit."""

    time_s: float
    frame: FrameName
    limit: LimitName
    value: float
    bound: float


class VerdictOut(Wire):
    """What the verdict of method plan rests on."""

    decided_by: str = Field(
        description="checked; tolerance; or the limit that closes the way, start_rate, or three-axis"
    )
    statement: str
    what_happens: str | None = Field(
        default=None,
        description="Why it is not flown exactly: what happens first and what then; null: it is, or unknown",
    )
    first: LimitMetOut | None = Field(default=None, description="The limit that a frame reaches first, and when")
    then: LimitMetOut | None = Field(
        default=None,
        description="What the attitude would need from there; of the same frame, bound is where it is then",
    )
    consequence: Consequence | None = Field(default=None, description="Which frame cannot follow from there")
    closed: BlockingOut | None = Field(default=None, description="Where the search for an exact path came to its end")
    certainty: Certainty | None = Field(default=None, description="How sure the verdict is")
    how_sure: str | None = Field(default=None, description="What that rests on, in words")
    grid_deg: float | None = Field(description="Of the search; null where there was none")
    least_tolerance_deg: float | None = Field(
        default=None,
        description="The smallest attitude tolerance found for which the flight is inside every limit; 0: exact; null: "
        "not looked for",
    )
    max_matrix_error_between_samples: float | None


class LeadsOut(Wire):
    """The ways from rest to the first sample and from the last one to rest."""

    lead_in_s: float
    lead_out_s: float
    refusal: str | None = Field(description="Why there is none")


class DeviationOut(Wire):
    """By how much the flight that is flown differs from the samples as they were given."""

    max: float
    rms: float


class ReportOut(Wire):
    """The report of `fullpose solve --report`, key by key; keys may be added, not renamed."""

    method: str
    rig: str
    samples: int
    feasible: bool = Field(description="Inside every limit, no sample given up for one; see exact_samples")
    exact_samples: int | None = Field(default=None, description="Within 1e-9 deg of the attitude")
    exact_percent: float | None = Field(default=None, description="In hundredths, rounded down")
    max_error_deg: float = Field(description="To the flight as it was given")
    max_matrix_error: float
    iterations: IterationsOut
    step_us: StepTimeOut | None
    solve_s: float | None
    peak: PeaksOut
    limit_violations: list[ViolationOut]
    limit_violation_samples: int = Field(description="All of them; the list is cut at a thousand runs")
    limited_samples: int
    limited_by: list[dict[str, str | int]] = Field(description="frame, limit, samples")
    blocking: BlockingOut | None
    tolerance_deg: float | None = Field(default=None, description="That the flight was planned within")
    within_tolerance: bool | None = Field(default=None, description="Whether every sample is")
    deviation_deg: DeviationOut | None = Field(default=None, description="That the tolerance was used for")
    suggested_tolerance_deg: float | None = Field(default=None, description="Null where none is needed")
    tolerance_floor_deg: float | None = Field(default=None, description="Below it no tolerance helps")
    smoothing: str | None = Field(default=None, description="What was taken away, in words")
    warnings: list[Notice] = Field(default=[])
    verdict: VerdictOut | None = Field(default=None, description="Of method plan")
    leads: LeadsOut | None = Field(default=None, description="Of method plan")


class MarginOut(Wire):
    """The smallest distance to a limit, and when; negative beyond it."""

    value: float
    time_s: float


class FrameMargins(Wire):
    """Null: no limit. deg, deg/s, deg/s^2, deg/s^3."""

    position_deg: MarginOut | None
    rate_deg_s: MarginOut | None
    acceleration_deg_s2: MarginOut | None
    jerk_deg_s3: MarginOut | None = None


class MarginsOut(Wire):
    """Of every frame; `singularity` is the smallest sin^2(outer) + cos^2(middle), zero at the rig's singularity."""

    base: FrameMargins | None = None
    outer: FrameMargins
    middle: FrameMargins
    inner: FrameMargins
    singularity: MarginOut | None


class JobErrorOut(Wire):
    """Why a job failed."""

    code: str
    message: str
    errors: list[FieldProblem] = Field(default=[])


class PlanOut(LabelledOut):
    """A plan and its job. `flyable` plans can be loaded; the others say why not in `refusal`."""

    id: str
    status: JobStatus
    progress: ProgressOut
    trajectory: Sha256
    trajectory_name: str
    rig: Name
    rig_hash: str
    method: str
    options: dict[str, OptionValue]
    start_deg: Four | None
    tolerance_deg: float | None
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    error: JobErrorOut | None
    feasible: bool | None
    flyable: bool
    refusal: str | None
    plan_hash: str | None
    rate_hz: float | None
    resampling: str | None = Field(description="How the flight was brought to the rig's rate")
    samples: int | None
    duration_s: float | None
    lead_in_s: float | None
    lead_out_s: float | None
    report: ReportOut | None
    verdict: str | None = Field(description="What the verdict rests on, in words")
    margins: MarginsOut | None
    remedy: RemedyOut | None = Field(description="Null: the flight as it is")


class PlanSamples(Wire):
    """A thinned plan for plots, lead-in and lead-out included; time zero is the flight's first sample.

    Error and attitude are null in the leads. Peaks of every column are kept by the thinning.
    """

    id: str
    samples: int
    time_s: list[float]
    angles_deg: dict[FrameName, list[float]]
    rates_deg_s: dict[FrameName, list[float]]
    accelerations_deg_s2: dict[FrameName, list[float]]
    jerks_deg_s3: dict[FrameName, list[float]]
    error_deg: list[float | None]
    q: list[Four | None]
    lead_in_s: float
    lead_out_s: float


class MethodOut(Wire):
    """A method the server can solve with."""

    name: str
    source: str
    claims_limits: bool
    options: dict[str, OptionValue] = Field(description="Names and defaults")
