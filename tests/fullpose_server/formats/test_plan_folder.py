"""Plans as files: what is written is read, what was touched is noticed."""

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fullpose.rig import FrameLimits, Geometry, builtin_rigs
from fullpose_server.formats.plan_folder import (
    PlanFolderError,
    PlanInfo,
    PlanOrigin,
    PlanPath,
    changed_since,
    make_plan,
    read_plan,
    read_sealed_plan,
    rig_hash,
    sealed_plan,
    write_plan,
)
from tests.fullpose_server.runtime.rigs import plan_of

RIG = builtin_rigs()["vertical-limited"]


def test_a_plan_comes_back_as_it_was(tmp_path: Path) -> None:
    plan = plan_of(RIG, 0.5)
    write_plan(tmp_path / "plan", plan)
    again = read_sealed_plan(tmp_path / "plan")
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
    assert read_sealed_plan(tmp_path / "plan").info == longer.info


ARRAYS = ("angles", "target", "error")
KEYS = [field.name for field in dataclasses.fields(PlanInfo)]


def edit(folder: Path, **changes: Any) -> None:
    path = folder / "plan.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


def other(value: Any) -> Any:
    """A value of the same kind that a plan could have."""
    match value:
        case None:
            return 0.5
        case bool():
            return not value
        case int() | float():
            return value * 0.5 if isinstance(value, float) and value else value + 1
        case str():
            return f"{value[:-1]}{'a' if value[-1:] != 'a' else 'b'}"
        case _:
            return {key: other(one) for key, one in value.items()}


@pytest.mark.parametrize("key", KEYS)
def test_a_plan_with_any_key_changed_cannot_be_flown_and_is_told_by_file_and_key(tmp_path: Path, key: str) -> None:
    plan = plan_of(RIG, 0.5)
    write_plan(tmp_path / "plan", plan)
    edit(tmp_path / "plan", **{key: other(getattr(plan.info, key))})
    told = "format 3" if key == "format" else "duration_s" if key == "sealed" else key
    with pytest.raises(PlanFolderError, match=rf"plan\.json: .*{told}.*make the plan again") as refused:
        read_sealed_plan(tmp_path / "plan")
    assert refused.value.path == tmp_path / "plan" / "plan.json"


@pytest.mark.parametrize("key", KEYS)
def test_a_plan_without_any_one_of_its_keys_cannot_be_flown(tmp_path: Path, key: str) -> None:
    plan = plan_of(RIG, 0.5)
    named = dataclasses.replace(plan.info, name="loop", start_s=2.0, tolerance_deg=0.05)
    write_plan(tmp_path / "plan", sealed_plan(dataclasses.replace(plan, info=named)))
    path = tmp_path / "plan" / "plan.json"
    edited = json.loads(path.read_text())
    del edited[key]
    path.write_text(json.dumps(edited))
    with pytest.raises(PlanFolderError, match=r"plan\.json"):
        read_sealed_plan(tmp_path / "plan")


@pytest.mark.parametrize("name", ARRAYS)
def test_a_plan_with_any_array_changed_cannot_be_flown_and_is_told_by_its_file(tmp_path: Path, name: str) -> None:
    write_plan(tmp_path / "plan", plan_of(RIG, 0.5))
    path = tmp_path / "plan" / f"{name}.npy"
    array = np.load(path)
    array[tuple(n // 2 for n in array.shape)] += 1e-9
    np.save(path, array)
    read_plan(tmp_path / "plan")
    with pytest.raises(PlanFolderError, match=rf"{name}\.npy: {name}: not as the plan was made"):
        read_sealed_plan(tmp_path / "plan")


def test_a_key_that_no_seal_covers_is_refused(tmp_path: Path) -> None:
    write_plan(tmp_path / "plan", plan_of(RIG, 0.5))
    edit(tmp_path / "plan", colour="green")
    with pytest.raises(PlanFolderError, match=r"plan\.json: colour: not a key of a plan"):
        read_plan(tmp_path / "plan")


def test_a_plan_of_the_first_format_can_be_looked_at_and_not_flown(tmp_path: Path) -> None:
    plan = plan_of(RIG, 0.5)
    write_plan(tmp_path / "plan", plan)
    path = tmp_path / "plan" / "plan.json"
    old = {key: value for key, value in json.loads(path.read_text()).items() if key not in ("format", "sealed")}
    path.write_text(json.dumps(old | {"plan_hash": "0" * 64}))
    np.testing.assert_array_equal(read_plan(tmp_path / "plan").angles, plan.angles)
    with pytest.raises(PlanFolderError, match=r"format 1.*: make the plan again") as refused:
        read_sealed_plan(tmp_path / "plan")
    assert "\n" not in str(refused.value)


def test_what_was_changed_since_is_told_with_both_values() -> None:
    plan = plan_of(RIG, 0.5)
    angles = plan.angles + 0.0
    angles[3, 1] += 1e-12
    changed = sealed_plan(dataclasses.replace(plan, info=dataclasses.replace(plan.info, rate_hz=500.0), angles=angles))
    assert changed_since(plan.info, plan.info) == []
    assert changed_since(plan.info, changed.info) == ["rate_hz was 1000.0, is 500.0", "angles.npy is another"]


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


def test_the_rig_s_hash_covers_all_of_a_rig_but_its_name() -> None:
    assert {field.name for field in dataclasses.fields(RIG)} == {"name", "geometry", "frames"}
    assert rig_hash(dataclasses.replace(RIG, name="other")) == rig_hash(RIG)
    changed = {rig_hash(dataclasses.replace(RIG, geometry=Geometry.HORIZONTAL_4))}
    finite = FrameLimits(-1.0, 1.0, 2.0, 3.0, 1.0, 0.25, 4.0)
    rig = dataclasses.replace(RIG, frames=(finite,) * 4)
    changed.add(rig_hash(rig))
    for k in range(4):
        for field in dataclasses.fields(FrameLimits):
            frame = dataclasses.replace(finite, **{field.name: getattr(finite, field.name) * (1.0 + 1e-15)})
            changed.add(rig_hash(dataclasses.replace(rig, frames=(*rig.frames[:k], frame, *rig.frames[k + 1 :]))))
    assert rig_hash(RIG) not in changed
    assert len(changed) == 2 + 4 * len(dataclasses.fields(FrameLimits))


def test_a_plan_without_a_tolerance_is_sealed_as_it_was_before_there_were_any(tmp_path: Path) -> None:
    write_plan(tmp_path / "plan", plan_of(RIG, 0.5))
    path = tmp_path / "plan" / "plan.json"
    made = json.loads(path.read_text())
    assert "tolerance_deg" not in made["sealed"]
    del made["tolerance_deg"]
    path.write_text(json.dumps(made))
    assert read_sealed_plan(tmp_path / "plan").info.tolerance_deg is None
    path.write_text(json.dumps(made | {"tolerance_deg": 0.5}))
    with pytest.raises(PlanFolderError, match="tolerance_deg: not as the plan was made"):
        read_sealed_plan(tmp_path / "plan")
