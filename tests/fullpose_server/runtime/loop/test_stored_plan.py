"""What was edited of a stored plan, or of the rig's file, is refused at load, or at arm where it was edited between."""

import dataclasses
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.formats.plan_folder import PlanInfo, read_plan, rig_hash, sealed_plan, write_plan
from fullpose_server.runtime.contract import messages
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.session.states import State
from tests.fullpose_server.runtime.rigs import plan_of
from tests.support.made_up_rig import MadeUpRig, made_up_rig

RATE = 500.0
RIG = builtin_rigs()["vertical-limited"]
KEYS = [field.name for field in dataclasses.fields(PlanInfo)]
ARRAYS = ("angles", "target", "error")


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[MadeUpRig]:
    with made_up_rig(RigConfig("test", RIG, tmp_path / "rig", tmp_path / "runs", RATE, min_free_mb=0.0)) as made:
        yield made


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    write_plan(tmp_path / "plan", plan_of(RIG, 0.5, RATE))
    return tmp_path / "plan"


def edit_key(folder: Path, key: str) -> None:
    path = folder / "plan.json"
    content = json.loads(path.read_text())
    match content[key]:
        case bool() as value:
            content[key] = not value
        case int() | float() as value:
            content[key] = value + 1
        case str() as value:
            content[key] = f"{value}a"
        case None:
            content[key] = 0.5
        case _ as digests:
            content[key] = {name: digest[::-1] for name, digest in digests.items()}
    path.write_text(json.dumps(content))


def edit_array(folder: Path, name: str) -> None:
    array = np.load(folder / f"{name}.npy")
    array[len(array) // 2] += 1e-9
    np.save(folder / f"{name}.npy", array)


EDITS = [(edit_key, key, "plan.json") for key in KEYS] + [(edit_array, name, f"{name}.npy") for name in ARRAYS]
Edit = Callable[[Path, str], None]


def refusal(reply: messages.Reply) -> messages.ErrorBody:
    assert reply.error is not None, reply
    assert reply.state_after == reply.state_before
    return reply.error


def loaded(rig: MadeUpRig, **args: Any) -> None:
    rig.ready(**args)
    assert rig.state is State.READY


@pytest.mark.parametrize(("edit", "what", "file"), EDITS, ids=[what for _, what, _ in EDITS])
def test_a_plan_edited_before_it_is_loaded_is_refused(
    rig: MadeUpRig, plan: Path, edit: Edit, what: str, file: str
) -> None:
    rig.take()
    rig.tick()
    rig.must("connect")
    edit(plan, what)
    error = refusal(rig.say("load", plan_folder=str(plan)))
    assert error.code == "bad_plan"
    assert error.message.startswith(f"{file}: ")


@pytest.mark.parametrize(("edit", "what", "file"), EDITS, ids=[what for _, what, _ in EDITS])
def test_a_plan_edited_between_load_and_arm_is_refused(
    rig: MadeUpRig, plan: Path, edit: Edit, what: str, file: str
) -> None:
    loaded(rig, plan_folder=str(plan))
    edit(plan, what)
    error = refusal(rig.say("arm"))
    assert error.code == "bad_plan"
    assert error.message.startswith(f"{file}: ")


def resealed(folder: Path) -> None:
    """Half the rate, and a seal that is right: what a person could write who knows the format."""
    stored = read_plan(folder)
    slower = dataclasses.replace(stored.info, rate_hz=0.5 * stored.info.rate_hz)
    write_plan(folder, sealed_plan(dataclasses.replace(stored, info=slower)))


def test_another_sound_plan_in_the_place_of_the_one_that_was_made_is_refused_at_load(
    rig: MadeUpRig, plan: Path
) -> None:
    made = read_plan(plan).info.plan_hash
    resealed(plan)
    rig.take()
    rig.tick()
    rig.must("connect")
    error = refusal(rig.say("load", plan_folder=str(plan), plan_hash=made))
    assert error.message.startswith("plan.json: plan_hash is ")
    assert made[:16] in error.message


def test_another_sound_plan_in_the_place_of_the_one_that_was_loaded_is_refused_at_arm(
    rig: MadeUpRig, plan: Path
) -> None:
    loaded(rig, plan_folder=str(plan), plan_hash=read_plan(plan).info.plan_hash)
    resealed(plan)
    error = refusal(rig.say("arm"))
    assert error.message.startswith("plan.json: rate_hz was 500.0, is 250.0 since the plan was loaded")


def test_a_plan_that_is_not_feasible_is_refused(rig: MadeUpRig, tmp_path: Path) -> None:
    sound = plan_of(RIG, 0.5, RATE)
    beyond = dataclasses.replace(sound, info=dataclasses.replace(sound.info, feasible=False))
    write_plan(tmp_path / "beyond", sealed_plan(beyond))
    rig.take()
    rig.tick()
    rig.must("connect")
    assert "feasible is false" in refusal(rig.say("load", plan_folder=str(tmp_path / "beyond"))).message


def test_what_the_rig_s_file_says_by_now_must_be_what_its_process_flies(rig: MadeUpRig, plan: Path) -> None:
    slower = dataclasses.replace(RIG.frames[0], max_rate=0.5 * RIG.frames[0].max_rate)
    other = rig_hash(dataclasses.replace(RIG, frames=(slower, *RIG.frames[1:])))
    rig.take()
    rig.tick()
    rig.must("connect")
    error = refusal(rig.say("load", plan_folder=str(plan), rig_file_hash=other))
    assert (error.code, "restart the server" in error.message) == ("rig_changed", True)
    rig.must("load", plan_folder=str(plan), rig_file_hash=rig_hash(RIG))
    rig.tick()
    assert refusal(rig.say("arm", rig_file_hash=other)).code == "rig_changed"
    rig.must("arm", rig_file_hash=rig_hash(RIG))
    assert rig.state is State.ARMED
