"""The rigs as MuJoCo models: the peers' benchmark runs on them."""

from fullpose.rig import FRAMES, Rig

AXIS = ("1 0 0", "0 1 0", "0 0 1")


def mjcf(rig: Rig) -> str:
    """Nested bodies base, outer, middle, inner with one hinge each [rad]; the inner one carries the payload.

    MuJoCo turns actively, so `xmat` of the inner body is the transpose of our body-from-reference matrix.
    """
    opening = []
    for i in rig.geometry.frames:
        limits = rig.frames[i]
        bounded = "" if limits.continuous else f' limited="true" range="{limits.min!r} {limits.max!r}"'
        opening.append(
            f'<body name="{FRAMES[i]}"><joint name="{FRAMES[i]}" type="hinge" axis="{AXIS[rig.geometry.axes[i]]}"'
            f'{bounded}/><geom type="sphere" size="0.1" mass="1"/>'
        )
    return (
        '<mujoco><compiler angle="radian"/><option gravity="0 0 0"/><worldbody>'
        + "".join(opening)
        + "</body>" * len(opening)
        + "</worldbody></mujoco>"
    )
