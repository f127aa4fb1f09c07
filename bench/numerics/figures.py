"""The papers' figures, redrawn from our runs into docs/guide/figures: python -m bench.numerics.figures"""

from pathlib import Path

import matplotlib as mpl
import numpy as np

from bench.numerics.published import CLOSED, EXACT, PAPER, POSITION_ONLY, RIGS, run
from fullpose.rig import FRAMES
from fullpose.scenarios import SCENARIOS
from fullpose.solution import Solution
from fullpose.verify import differences

mpl.use("svg")
mpl.rcParams.update(
    {
        "svg.hashsalt": "fullpose",  # the same file from the same run
        "font.size": 8,
        "axes.grid": True,
        "grid.color": "#e4e7eb",
        "axes.edgecolor": "#6a7382",
        "lines.linewidth": 1.1,
        "legend.frameon": False,
    }
)
from matplotlib import pyplot as plt  # noqa: E402  the backend is chosen first

FOLDER = Path(__file__).parents[2] / "docs" / "guide" / "figures"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")
POINTS = 800


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    matrix_error_at_small_angles()
    over_the_limit()
    beyond_90()


def matrix_error_at_small_angles() -> None:
    """Zhao 2025: the matrix error over time, the methods side by side."""
    scenario, rig = SCENARIOS["small_angles"], RIGS["vertical-4"]
    figure, axes = plt.subplots(figsize=(7, 2.8))
    cases = (
        ("lagrange, open loop", run(scenario, rig, "lagrange"), "-"),
        ("alm, open loop", run(scenario, rig, "alm", PAPER), "--"),
        ("alm, closed loop", run(scenario, rig, "alm", CLOSED), "-"),
        ("alm, exact", run(scenario, rig, "alm", EXACT), "-"),
    )
    for (label, solution, dash), colour in zip(cases, COLOURS, strict=True):
        rows = _rows(solution)
        axes.semilogy(
            solution.time[rows], np.maximum(solution.matrix_error[rows], 1e-17), dash, color=colour, label=label
        )
    axes.set(xlabel="time (s)", ylabel="matrix error", xlim=(0, 10), ylim=(1e-17, 1e-4))
    axes.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    _save(figure, "small_angles.svg")


def over_the_limit() -> None:
    """Zhao 2025: frame angles with a limit in the way, and the error that is left."""
    scenario = SCENARIOS["over_limit_large_pitch"]
    free = run(scenario, RIGS["vertical-4"], "lagrange")
    bound = run(scenario, POSITION_ONLY, "alm", EXACT)
    figure, (angles, rates) = plt.subplots(2, 1, figsize=(7, 4.6), sharex=True)
    for k, (frame, colour) in enumerate(zip(FRAMES, COLOURS, strict=True)):
        rows = _rows(bound)
        angles.plot(bound.time[rows], np.degrees(bound.angles[rows, k]), color=colour, label=f"{frame}, alm")
        angles.plot(free.time[rows], np.degrees(free.angles[rows, k]), ":", color=colour)
        rate = np.degrees(differences(bound.time, bound.angles)[0])
        rates.plot(bound.time[1:][rows[:-1]], rate[rows[:-1], k], color=colour)
    for sign in (-1, 1):
        angles.axhline(60 * sign, color="#b3261e", linestyle="--", linewidth=0.8)
    angles.axhspan(60, 150, color="#fbe9e7", zorder=0)
    angles.axhspan(-150, -60, color="#fbe9e7", zorder=0)
    angles.set(ylabel="angle (deg)", ylim=(-150, 150), xlim=(0, 10))
    angles.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    rates.set(xlabel="time (s)", ylabel="rate (deg/s)")
    _save(figure, "over_limit_large_pitch.svg")


def beyond_90() -> None:
    """Lin 2022: frame rates and accelerations through pitch and yaw beyond 90 deg, four axes and three."""
    scenario = SCENARIOS["both_beyond_90"]
    figure, panels = plt.subplots(3, 2, figsize=(7, 5.6), sharex=True)
    for column, (method, rig) in enumerate((("dwln", "horizontal-4"), ("three_axis", "horizontal-4"))):
        solution = run(scenario, RIGS[rig], method)
        rate, acceleration = differences(solution.time, solution.angles)
        rows = _rows(solution)
        tables = (solution.angles, rate, acceleration)
        names = ("angle (deg)", "rate (deg/s)", "acceleration (deg/s²)")
        for panel, table, name in zip(panels[:, column], tables, names, strict=True):
            inside = rows[rows < len(table)]
            for k, (frame, colour) in enumerate(zip(FRAMES, COLOURS, strict=True)):
                panel.plot(solution.time[inside], np.degrees(table[inside, k]), color=colour, label=frame)
            if column == 0:
                panel.set_ylabel(name)
        panels[0, column].set_title(f"{method}, {rig}", fontsize=8)
        panels[2, column].set(xlabel="time (s)", xlim=(0, 10))
    figure.legend(*panels[0, 0].get_legend_handles_labels(), ncols=4, loc="upper center", bbox_to_anchor=(0.5, 1.03))
    _save(figure, "both_beyond_90.svg")


def _rows(solution: Solution) -> np.ndarray:
    return np.unique(np.linspace(0, len(solution.time) - 1, POINTS).astype(int))


def _save(figure: plt.Figure, name: str) -> None:
    figure.tight_layout()
    figure.savefig(FOLDER / name, bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
    print(FOLDER / name)


if __name__ == "__main__":
    main()
