"""What is compiled ahead is all that a diagnosis and a tolerance need."""

import subprocess
import sys
from pathlib import Path

import numpy as np

from fullpose.scenarios import random_flight
from fullpose_server.api.offload.tolerance import LONGEST_KEPT, diagnosis_of, tolerance_effect
from fullpose_server.formats.flight_folder import write_flight
from fullpose_server.formats.trajectory import Convention, Trajectory

# In a process of its own, where no other test has compiled anything.
COVERED = """
import sys
import numpy as np
from numba.core.dispatcher import Dispatcher
from bench.numerics.recorded import DEGRADATIONS
from fullpose.attitude import dcm_from_quaternion
from fullpose.recorded import effect_of, smooth
from fullpose.rig import builtin_rigs
from fullpose_server.api.offload.prewarm import prewarm
from fullpose_server.formats.diagnosis import diagnosis_document

def compiled():
    found = {}
    for name, module in list(sys.modules.items()):
        if name.startswith("fullpose"):
            for word, value in vars(module).items():
                if isinstance(value, Dispatcher):
                    found[f"{name}.{word}"] = {str(each) for each in value.signatures}
    return found

prewarm()
before = compiled()
assert sum(map(len, before.values())) > 5, before
for kind, record in DEGRADATIONS.items():
    time, q = (column[:900] for column in record(0)[:2])
    diagnosis_document(time, q, builtin_rigs()["vertical-limited"])
    for tolerance in (None, 1e-5, 1e-3):
        effect_of(time, q, smooth(time, dcm_from_quaternion(q), tolerance))
    after = compiled()
    late = {name: each - before.get(name, set()) for name, each in after.items() if each - before.get(name, set())}
    assert not late, (kind, late)
print("covered")
"""


def test_nothing_is_compiled_for_a_recording_of_any_kind_once_it_is_warm() -> None:
    done = subprocess.run([sys.executable, "-c", COVERED], capture_output=True, text=True, timeout=600, check=False)
    assert done.stdout == "covered\n", done.stderr[-2000:]


def test_a_slider_that_is_moved_asks_for_one_diagnosis_and_is_told_as_without_it(tmp_path: Path) -> None:
    time_s, q = random_flight(3, 4.0, 100.0, 0.5)
    q = q + 1e-4 * np.random.default_rng(3).normal(size=q.shape)
    flight = Trajectory(time_s, q / np.linalg.norm(q, axis=1)[:, None], Convention.NUE)
    kept, fresh = tmp_path / "kept", tmp_path / "fresh"
    for folder in (kept, fresh):
        folder.mkdir()
        write_flight(folder, flight)
    assert len(time_s) <= LONGEST_KEPT
    diagnosis_of.cache_clear()
    for tolerance in (0.05, 0.02, 0.1, None):
        told = tolerance_effect(kept, tolerance, 50)
        assert diagnosis_of.cache_info().misses == 1
        diagnosis_of.cache_clear()
        assert tolerance_effect(fresh, tolerance, 50) == told
        diagnosis_of.cache_clear()
        assert tolerance_effect(kept, tolerance, 50) == told
