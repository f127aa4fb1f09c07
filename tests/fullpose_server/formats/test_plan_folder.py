"""Plans as files: what is written is read, what was touched is noticed."""

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.formats.plan_folder import (
    PlanFolderError,
    PlanOrigin,
    PlanPath,
    make_plan,
    read_plan,
    rig_hash,
    write_plan,
)
from tests.fullpose_server.runtime.rigs import plan_of

RIG = builtin_rigs()["vertical-limited"]


def test_a_plan_comes_back_as_it_was(tmp_path: Path) -> None:
    plan = plan_of(RIG, 0.5)
    write_plan(tmp_path / "plan", plan)
    again = read_plan(tmp_path / "plan")
    assert again.info == plan.info
    for name in ("angles", "target", "error"):
        np.testing.assert_array_equal(getattr(again, name), getattr(plan, name))
        assert not getattr(again, name).flags.writeable
    lead = plan.info.lead_in_samples
    assert np.isnan(again.target[:lead]).all()
    assert np.isfinite(again.target[lead]).all()
    assert [p.name for p in tmp_path.iterdir()] == ["plan"]  # no draft is left


def test_writing_again_replaces_the_whole(tmp_path: Path) -> None:
    write_plan(tmp_path / "plan", plan_of(RIG, 0.5))
    longer = plan_of(RIG, 0.7, plan_id="second")
    write_plan(tmp_path / "plan", longer)
    assert read_plan(tmp_path / "plan").info == longer.info


def test_added_keys_are_no_matter(tmp_path: Path) -> None:
    write_plan(tmp_path / "plan", plan_of(RIG, 0.5))
    path = tmp_path / "plan" / "plan.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"colour": "green"}))
    read_plan(tmp_path / "plan")


def test_touched_arrays_are_noticed(tmp_path: Path) -> None:
    write_plan(tmp_path / "plan", plan_of(RIG, 0.5))
    path = tmp_path / "plan" / "angles.npy"
    array = np.load(path)
    array[10, 2] += 1e-9
    np.save(path, array)
    with pytest.raises(PlanFolderError, match="hash"):
        read_plan(tmp_path / "plan")


@pytest.mark.parametrize(
    ("damage", "match"),
    [
        (lambda f: (f / "angles.npy").unlink(), "angles.npy"),
        (lambda f: (f / "error.npy").write_bytes(b"no array"), "error.npy"),
        (lambda f: np.save(f / "target.npy", np.zeros((3, 4))), "expected float64"),
        (lambda f: np.save(f / "error.npy", np.zeros(5, "f4")), "float32"),
        (lambda f: (f / "plan.json").write_text("{"), "plan.json"),
        (lambda f: (f / "plan.json").write_text("{}"), "plan.json"),
        (lambda f: (f / "plan.json").unlink(), "plan.json"),
    ],
)
def test_what_is_no_plan_names_the_file(tmp_path: Path, damage: object, match: str) -> None:
    write_plan(tmp_path / "plan", plan_of(RIG, 0.5))
    damage(tmp_path / "plan")  # type: ignore[operator]
    with pytest.raises(PlanFolderError, match=match):
        read_plan(tmp_path / "plan")


def test_target_signs_are_made_continuous() -> None:
    plan = plan_of(RIG, 1.0)
    lead = plan.info.lead_in_samples
    flipped = np.array(plan.target)
    flipped[lead + 100 : lead + 300] *= -1.0
    path = PlanPath(plan.angles, flipped, plan.error, lead, plan.info.lead_out_samples)
    again = make_plan(PlanOrigin("x", "", ""), RIG, 1000.0, path, feasible=True)
    np.testing.assert_allclose(again.target, plan.target, atol=1e-15)


def test_the_rig_s_hash_is_about_its_limits_and_not_its_name() -> None:
    assert rig_hash(dataclasses.replace(RIG, name="other")) == rig_hash(RIG)
    frame = dataclasses.replace(RIG.frames[3], max_rate=RIG.frames[3].max_rate * (1 + 1e-15))
    assert rig_hash(dataclasses.replace(RIG, frames=(*RIG.frames[:3], frame))) != rig_hash(RIG)
