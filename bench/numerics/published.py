"""The papers' figures, measured on our runs: python -m bench.numerics.published

Prints what docs/guide/methods.md sets beside the published numbers. The flights are ours (`fullpose.scenarios`), the
papers' not being at hand; where an amplitude or a rule matters, it is varied.
"""

from dataclasses import replace

import numpy as np

from bench.machine import machine
from fullpose.attitude import dcm_from_quaternion
from fullpose.kinematics import jacobian
from fullpose.methods.alm import AlmOptions
from fullpose.resample import resample
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import DEG, SCENARIOS, Angle, Ramp, Scenario, Sine
from fullpose.solution import Solution
from fullpose.solve import solve
from fullpose.verify import attitude_errors, payload_attitudes, verify

RIGS = builtin_rigs()
# The papers' rigs have position limits only.
POSITION_ONLY = Rig(
    "vertical, inner +-60 deg, no other limit",
    Geometry.VERTICAL_4,
    (FrameLimits(), FrameLimits(), FrameLimits(), FrameLimits(-60 * DEG, 60 * DEG)),
)
# f of the paper has no term that moves the frames of their own.
PAPER = AlmOptions(mode="open_loop", avoidance=0.0, centring=0.0, homing=0.0)
CLOSED = replace(PAPER, mode="closed_loop")
EXACT = replace(PAPER, mode="exact")


def main() -> None:
    print(machine())
    small_angles()
    large_angles()
    over_the_limit()
    smoothness()


def small_angles() -> None:
    """Zhao 2025, small angles, open loop: alm 1e-6..1e-7, Xu's method 1e-4..1e-5."""
    print("\nsmall angles at 1 kHz, largest matrix error (published: alm 1e-6..1e-7, lagrange 1e-4..1e-5)")
    print(f"{'amplitude':>12}{'alm open':>12}{'lagrange':>12}{'rate at start':>15}{'alm closed':>12}{'alm exact':>12}")
    for scale in (4.0, 2.0, 1.0, 0.5, 0.25):
        scenario = scaled(SCENARIOS["small_angles"], scale)
        rig = RIGS["vertical-4"]
        errors = [
            run(scenario, rig, "alm", PAPER).matrix_error.max(),
            run(scenario, rig, "lagrange").matrix_error.max(),
            forward_rate(scenario, rig),
            run(scenario, rig, "alm", CLOSED).matrix_error.max(),
            run(scenario, rig, "alm", EXACT).matrix_error.max(),
        ]
        widths = (12, 12, 15, 12, 12)
        cells = "".join(f"{error:{width}.1e}" for error, width in zip(errors, widths, strict=True))
        print(f"{4 * scale:6g}-{6 * scale:g} deg".rjust(12) + cells)


def large_angles() -> None:
    """Zhao 2025, large angles: two to three orders above small ones."""
    print("\nlarge angles, no limit reached, largest matrix error (published: 2-3 orders above small angles)")
    for name in ("large_no_limit", "both_beyond_90", "loop"):
        rig = RIGS["vertical-4"]
        found = [run(SCENARIOS[name], rig, "alm", options).matrix_error.max() for options in (PAPER, CLOSED, EXACT)]
        print(f"{name:24}open {found[0]:.1e}  closed {found[1]:.1e}  exact {found[2]:.1e}")


def over_the_limit() -> None:
    """Zhao 2025, a limit binds: below 1e-3; distorted beyond about 120 deg of pitch; 6 to 10 iterations."""
    print("\nover the limit: inner +-60 deg, no other limit (published: below 1e-3; distorted past 120 deg of pitch)")
    for name in ("over_limit_small_pitch", "over_limit", "over_limit_large_pitch", "over_limit_loop"):
        scenario = SCENARIOS[name]
        for label, options in (("open", PAPER), ("closed", CLOSED), ("exact", EXACT)):
            solution = run(scenario, POSITION_ONLY, "alm", options)
            bound = np.abs(np.abs(solution.angles[:, 3]) - 60 * DEG) < 1e-9
            peaks = verify(solution.time, solution.angles, POSITION_ONLY).peaks
            count = f"{np.median(solution.iterations[bound]):g}" if bound.any() else "-"
            print(
                f"{name:24}{label:8}at the limit {100 * bound.mean():4.1f} % of the time, {count:>2} iterations there,"
                f" {solution.limited_samples} limited, matrix error {solution.matrix_error.max():.1e},"
                f" peak rate {np.degrees(peaks[:, 1].max()):.0f} deg/s"
            )


def smoothness() -> None:
    """Lin 2022, pitch and yaw beyond 90 deg: errors of 1.1e-9, 4.9e-9, 7.1e-11 deg; smooth rates and accelerations."""
    print("\npitch and yaw beyond 90 deg (published: dwln errors 7e-11..5e-9 deg, smooth; the three-axis rigs blow up)")
    for rig_name in ("vertical-4", "horizontal-4"):
        for method in ("dwln", "exact", "plan", "three_axis"):
            solution = run(SCENARIOS["both_beyond_90"], RIGS[rig_name], method)
            peaks = np.degrees(verify(solution.time, solution.angles, RIGS[rig_name]).peaks.max(axis=0))
            print(
                f"{rig_name:14}{method:12}error {np.degrees(solution.error.max()):.1e} deg,"
                f" peak rate {peaks[1]:6.1f} deg/s, peak acceleration {peaks[2]:7.1f} deg/s^2"
            )


def run(scenario: Scenario, rig: Rig, method: str, options: AlmOptions | None = None) -> Solution:
    return solve(scenario.time, dcm_from_quaternion(scenario.quaternion), rig, method, options=options)


def forward_rate(scenario: Scenario, rig: Rig) -> float:
    """The matrix error of the least-norm step with the body rate at the start of each interval, w(t) dt, as Euler's
    method has it, in place of the mean rate that two attitude samples give."""
    C = dcm_from_quaternion(scenario.quaternion)
    flight = resample(scenario.time, scenario.quaternion, scenario.rate)
    angles = np.empty((len(C), 4))
    angles[0] = solve(scenario.time[:1], C[:1], rig, "lagrange").angles[0]
    J = np.empty((3, 4))
    for k, step in enumerate(np.diff(scenario.time)):
        jacobian(rig.axes, angles[k], J)
        angles[k + 1] = angles[k] + J.T @ np.linalg.solve(J @ J.T, flight.body_rate[k] * step)
    return float(attitude_errors(payload_attitudes(rig, angles), C)[1].max())


def scaled(scenario: Scenario, scale: float) -> Scenario:
    """The scenario with every angle times `scale`."""

    def times(angle: Angle) -> Angle:
        terms = [
            replace(t, amplitude=t.amplitude * scale) if isinstance(t, Sine) else replace(t, change=t.change * scale)
            for t in angle.terms
            if isinstance(t, Sine | Ramp)
        ]
        return Angle(angle.constant * scale, tuple(terms))

    return replace(scenario, yaw=times(scenario.yaw), pitch=times(scenario.pitch), roll=times(scenario.roll))


if __name__ == "__main__":
    main()
