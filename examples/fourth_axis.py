"""What the fourth axis buys: a loop through the vertical on three axes and on four.

python examples/fourth_axis.py
"""

import numpy as np

from fullpose.attitude import dcm_from_euler
from fullpose.rig import builtin_rigs
from fullpose.solve import solve
from fullpose.verify import verify

# 12 s at 1 kHz: a loop in a plane that leans by 1 degree, so that the nose passes beside the vertical, as real ones do.
time = np.arange(12_001) / 1000.0
turn = 0.5 * (1.0 - np.cos(np.pi * np.clip(time / 12.0, 0.0, 1.0)))  # smooth from 0 to 1
pitch = 2.0 * np.pi * turn
attitude = dcm_from_euler(0.0, pitch, 0.0) @ dcm_from_euler(0.0, 0.0, np.radians(1.0))

rigs = builtin_rigs()
for rig_name, method in (("vertical-3", "three_axis"), ("vertical-4", "exact")):
    rig = rigs[rig_name]
    solution = solve(time, attitude, rig, method=method)
    check = verify(time, solution.angles, rig, attitude)
    fastest = np.degrees(check.peaks[:, 1]).max()
    print(
        f"{rig_name}: fastest frame {fastest:.0f} deg/s, largest error {np.degrees(check.max_error):.1e} deg, "
        f"{len(check.violations)} stretches beyond a limit"
    )
