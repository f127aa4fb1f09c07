"""What a rig's process compiles before it is ready: every live method that can fly the rig, of every kind of rig."""

import pytest

from fullpose.registry import REGISTRY, Sees
from fullpose.rig import builtin_rigs
from fullpose_server.runtime.live.factory import compile_steps, live_step
from fullpose_server.runtime.live.settings import LiveError, LiveSettings

RIGS = builtin_rigs()


@pytest.mark.parametrize("name", RIGS)
def test_every_rig_has_its_steps_compiled(name: str) -> None:
    compile_steps(RIGS[name], 1e-3)


def test_a_method_of_the_other_kind_of_rig_is_refused() -> None:
    with pytest.raises(LiveError, match="fourth axis"):
        live_step(RIGS["vertical-3"], LiveSettings("preview"), 1e-3)
    with pytest.raises(LiveError, match="expected one of"):
        live_step(RIGS["vertical-3"], LiveSettings("plan"), 1e-3)
    assert REGISTRY["plan"].sees is Sees.FLIGHT
