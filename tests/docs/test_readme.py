"""The README's Python example, run as it stands."""

import re

from tests.support.repository import ROOT


def test_a_first_figure_in_three_lines() -> None:
    (example,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert sum(bool(line) for line in example.splitlines()) == 3
    names: dict[str, object] = {}
    exec(example, names)
    solution = names["solution"]
    assert solution.method == "plan"  # type: ignore[attr-defined]
    assert solution.angles.shape == (len(solution.time), 4)  # type: ignore[attr-defined]
    assert solution.matrix_error.max() < 1e-14  # type: ignore[attr-defined]
