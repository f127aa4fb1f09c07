"""The diagnosis of a flight on the wire. Degrees and seconds; `null` where nothing was found."""

from typing import Literal

from pydantic import Field

from fullpose_server.api.schemas.base import FrameName, Wire

Axes = tuple[float, float, float]


class Finding(Wire):
    """One thing found, as a sentence with its figure."""

    code: str
    level: Literal["warning", "remark"]
    sentence: str


class StepsOut(Wire):
    """Steps between samples [s]."""

    median: float
    min: float
    max: float


class QuantumOut(Wire):
    """What the attitude is rounded to."""

    deg: float
    unit: float = Field(description="In what is rounded: degrees, or a quaternion's component")
    of: Literal["angles_deg", "quaternion", "counts"]


class HeldOut(Wire):
    """Samples that repeat the one before although the flight moves."""

    samples: int
    length: float = Field(description="Samples a run, on average, where the flight is held at one rate; else 1")
    rate_hz: float | None


class StampsOut(Wire):
    """How regular the stamps are."""

    jitter_rms_s: float
    jitter_max_s: float
    quantum_s: float
    regular_rate_hz: float | None = Field(description="Of the regular clock that explains the jitter")


class NearDuplicate(Wire):
    """A sample whose stamp all but repeats the one before."""

    sample: int
    time_s: float


class GapOut(Wire):
    """A time without samples."""

    start_s: float
    end_s: float
    steps: float = Field(description="In median steps of its neighbours")


class OutlierOut(Wire):
    """A sample off its neighbours."""

    sample: int
    time_s: float
    size_deg: float
    sigmas: float


class BodyPeakOut(Wire):
    """The largest of a vector, and about each body axis, with times."""

    max: float
    time_s: float
    axes: Axes
    axes_time_s: Axes


class NoiseCost(Wire):
    """Standard deviations of a frame's acceleration, over the flight."""

    median: float
    max: float


class FrameCost(Wire):
    """What the noise costs a frame, beside its limits."""

    noise_acceleration_deg_s2: NoiseCost
    max_rate_deg_s: float | None
    max_acceleration_deg_s2: float | None


class RigCost(Wire):
    """What the noise costs a rig's frames."""

    name: str
    frames: dict[FrameName, FrameCost]


class NoisePlot(Wire):
    """Noise over time: the largest divided difference of each stretch."""

    time_s: list[float]
    x_deg: list[float]
    y_deg: list[float]
    z_deg: list[float]


class StepsPlot(Wire):
    """How many steps are between each edge and the next."""

    edge_s: list[float]
    count: list[int]


class DiagnosisPlots(Wire):
    """What the console draws."""

    noise: NoisePlot
    steps: StepsPlot


class DiagnosisOut(Wire):
    """What a flight is made of and what is wrong with it."""

    samples: int
    duration_s: float
    step_s: StepsOut
    white_noise_deg: Axes = Field(description="Standard deviation per body axis")
    noise_measured: bool
    noise_acceleration_deg_s2: Axes = Field(description="What noise or rounding alone costs the body")
    quantum: QuantumOut | None
    held: HeldOut | None
    stamps: StampsOut
    near_duplicate_samples: int
    near_duplicates: list[NearDuplicate] = Field(description="The first 100")
    gap_count: int
    gaps: list[GapOut] = Field(description="The first 100")
    outlier_samples: int
    outliers: list[OutlierOut] = Field(description="The first 100")
    body_rate_deg_s: BodyPeakOut
    body_acceleration_deg_s2: BodyPeakOut
    rig: RigCost | None
    findings: list[Finding] = Field(description="Warnings first")
    plots: DiagnosisPlots
