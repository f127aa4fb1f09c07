"""From a live source's settings to the step that flies it, and every such step's kernels."""

import numpy as np

from fullpose.rig import Rig
from fullpose_server.runtime.live.settings import LiveError, LiveSettings
from fullpose_server.runtime.live.steppers import LiveStep


def live_step(rig: Rig, settings: LiveSettings, dt: float) -> LiveStep:
    """The step for one rig and settings. Raises `LiveError` where they do not go together.

    Waits for nothing: its kernels are there (see `compile_steps`), and the planner of a preview starts beside the loop.
    """
    # Heavier than the rest of the rig process together, which is to be importable without them.
    from fullpose.registry import REGISTRY, Sees
    from fullpose_server.runtime.live.method_stepper import MethodStep
    from fullpose_server.runtime.live.preview_stepper import PreviewStep

    known = [row.name for row in REGISTRY.values() if row.sees is not Sees.FLIGHT]
    if settings.method not in known:
        raise LiveError(f"method {settings.method!r}: expected one of {', '.join(known)}")
    make = PreviewStep if REGISTRY[settings.method].sees is Sees.AHEAD else MethodStep
    return make(rig, settings, dt)


def compile_steps(rig: Rig, dt: float) -> None:
    """Compile (or load from the cache) the kernels of every method that can fly `rig` live."""
    from fullpose.errors import MethodError
    from fullpose.registry import REGISTRY, Sees
    from fullpose_server.runtime.live.method_stepper import MethodStep
    from fullpose_server.runtime.live.preview_stepper import compile_preview

    for row in REGISTRY.values():
        try:
            if row.sees is Sees.AHEAD:
                compile_preview(rig, dt)
            elif row.sees is Sees.SAMPLE and row.claims_limits:
                step = MethodStep(rig, LiveSettings(row.name), dt)
                step.begin(rig.home.copy())  # writable, as in flight: to Numba a type of its own
                step.follow(np.array([1.0, 0.0, 0.0, 0.0]))
        except (LiveError, MethodError):
            continue  # of the other kind of rig
