"""The rigs as MuJoCo models: an oracle of their kinematics that shares no code with them."""

import mujoco
import numpy as np

from fullpose.rig import FRAMES, Rig

PAYLOAD = FRAMES[3]


def mujoco_rig(rig: Rig) -> mujoco.MjModel:
    """Nested bodies base, outer, middle, inner, each turned by a hinge [rad] about its axis; no gravity.

    MuJoCo turns actively, so `xmat` of the inner body is the transpose of our body-from-reference matrix.
    """
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.gravity = np.zeros(3)
    body = spec.worldbody
    for frame in rig.geometry.frames:
        body = body.add_body(name=FRAMES[frame])
        body.add_joint(name=FRAMES[frame], type=mujoco.mjtJoint.mjJNT_HINGE, axis=np.eye(3)[rig.geometry.axes[frame]])
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.1, 0.0, 0.0], mass=1.0)
    return spec.compile()
