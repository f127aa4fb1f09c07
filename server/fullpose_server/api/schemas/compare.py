"""Comparisons on the wire."""

from datetime import datetime
from typing import Annotated

from pydantic import Field

from fullpose_server.api.schemas.base import Four, FrameName, LimitName, Name, Options, OptionValue, Sha256, Wire, Word
from fullpose_server.api.schemas.plans import (
    BlockingOut,
    DeviationOut,
    IterationsOut,
    JobErrorOut,
    PeaksOut,
    ProgressOut,
    StepTimeOut,
    ToleranceDeg,
    ViolationOut,
)
from fullpose_server.store.jobs import JobStatus


class MethodIn(Wire):
    """A method with options (GET /methods lists them), and what it is called in the table."""

    method: Word
    options: Options = Field(default={})
    label: str | None = Field(
        default=None, min_length=1, max_length=64, description="Of its own; null: the name and the options given"
    )


class CompareIn(Wire):
    """What to compare; in a text, options come after colons: alm:mode=open_loop.

    Without `start_deg` every method starts at its own choice of pose."""

    trajectory: Sha256
    rig: Name
    methods: list[Annotated[str, Field(max_length=1000)] | MethodIn] = Field(min_length=1, max_length=32)
    start_deg: Four | None = None
    tolerance_deg: ToleranceDeg | None = Field(default=None, description="Every method is given the flight within it")


class FailureOut(Wire):
    """Samples that miss the attitude for one reason."""

    reason: str
    samples: int
    first_s: float
    max_error_deg: float | None


class MethodFiguresOut(Wire):
    """One method: the keys of a solve's report and what sets it apart.

    A method that does not apply to the rig has `refusal` and no figures.
    """

    label: str = Field(description="Unlike every other of the comparison")
    method: str
    options: dict[str, OptionValue] = Field(default={}, description="The ones that were given")
    source: str
    claims_limits: bool
    refusal: str | None
    rig: str | None = None
    samples: int | None = None
    feasible: bool | None = None
    exact_share: float | None = Field(default=None, description="0..1, of the samples")
    exact_samples: int | None = None
    exact_percent: float | None = Field(
        default=None, description="The share as tables show it: in hundredths, rounded down"
    )
    max_error_deg: float | None = None
    rms_error_deg: float | None = None
    max_matrix_error: float | None = None
    iterations: IterationsOut | None = None
    step_us: StepTimeOut | None = None
    solve_s: float | None = None
    peak: PeaksOut | None = None
    total_variation_deg: dict[FrameName, float] | None = None
    limit_violations: list[ViolationOut] | None = None
    limit_violation_samples: int | None = None
    limit_violation_counts: dict[FrameName, dict[LimitName, int]] | None = None
    limited_samples: int | None = None
    limited_by: list[dict[str, str | int]] | None = None
    blocking: BlockingOut | None = None
    failures: list[FailureOut] | None = None
    why: str | None = Field(
        default=None, description="What keeps it from every limit and attitude, first and then, in one sentence"
    )
    how_sure: str | None = Field(default=None, description="What a verdict of the planner rests on, in words")


class ComparisonReportOut(Wire):
    """The report of `fullpose compare --report`, key by key; keys may be added, not renamed."""

    schema_: str = Field(alias="schema")
    flight: str
    rig: str
    geometry: str
    samples: int
    duration_s: float
    resampling: str | None
    tolerance_deg: float | None = None
    deviation_deg: DeviationOut | None = None
    suggested_tolerance_deg: float | None = None
    tolerance_floor_deg: float | None = None
    smoothing: str | None = None
    exact_within_deg: float
    methods: list[MethodFiguresOut]


class ComparisonOut(Wire):
    """A comparison and its job; once it is done, its report and the path of its page."""

    id: str
    status: JobStatus
    progress: ProgressOut
    trajectory: Sha256
    trajectory_name: str
    rig: Name
    methods: list[str] = Field(description="Their labels")
    rate_hz: float
    created_at: datetime
    error: JobErrorOut | None
    page: str | None = Field(description="Path of the page with table and plots")
    report: ComparisonReportOut | None
