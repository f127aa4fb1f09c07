"""After the warm-up no kernel is first met in flight, where compiling it would miss seconds of deadlines."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from tests.support.repository import ROOT

# In a process of its own: in this one other tests have called most kernels already.
COMMON = """
import json, math, socket, sys, time
from pathlib import Path
import numpy as np
from numba.core.dispatcher import Dispatcher
from fullpose_server.formats.plan_folder import read_plan, write_plan
from fullpose_server.runtime.loop import prewarm
from fullpose_server.runtime.contract.config import LiveConfig, RigConfig
from fullpose_server.runtime.motion.limit_guard import Guard
from fullpose_server.runtime.live.links import open_links
from fullpose_server.runtime.live.source import LiveSource
from fullpose_server.runtime.live.settings import LiveSettings
from fullpose_server.runtime.live.packets import Kind, encode_sample
from fullpose_server.runtime.live.provenance import digest_of
from fullpose_server.runtime.motion.generator import Mode, Motion
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.session.states import Event
from fullpose.rig import builtin_rigs

def compiled():
    kernels = {}
    for name, module in list(sys.modules.items()):
        if name.split(".")[0] in ("fullpose_server", "fullpose"):
            for word, value in vars(module).items():
                if isinstance(value, Dispatcher):
                    kernels[f"{value.py_func.__module__}.{word}"] = len(value.signatures)
    return kernels

rig = builtin_rigs()["vertical-4"]
folder = Path(sys.argv[1])
config = RigConfig("vertical-4", rig, folder, folder)
prewarm.kernels(config)
motion, guard = Motion(rig, config.motion, 1000.0), Guard(rig, config.guard, 1e-3)
motion.rest_at(rig.home.copy())

def tick():
    guard.measured(motion.x1, motion.x1, motion.q1)
    event = motion.tick()
    if event is Event.SOURCE_LOST:
        motion.brake(fastest=False)
        event = motion.tick()
    found = guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a)
    assert found is None, found
    motion.solve_error(rig.axes)
    motion.commit()
    return event
"""
LIVE = """
live = LiveConfig(delay_ms=4.0)
source = LiveSource(rig, live, 1e-3, open_links(RigPaths(folder), live), time.monotonic)
before = compiled()  # a load is in the loop's time, too
source.bind(source.ready(LiveSettings(sys.argv[2]), "a key"))
link = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
link.connect(str(folder / "live.sock"))
source.begin(motion.x1, 0.0)
motion.follow(source)
done = 0
for k in range(400):
    now = k * 1e-3
    rates = (0.0, 20.0, 0.0) if k % 20 else ()
    if k % 10 == 0 and k < 300:
        sample = encode_sample(Kind.EULER, k, now, (40.0 * math.sin(now), 20.0 * now, 0.0), rates)
        link.send(sample + digest_of("a key"))
    source.poll(now)
    tick()
    source.reply(motion.x, 0.0, guard.margin, now)
    done += source.view().heard
source.close()
"""
PATH = """
from tests.fullpose_server.runtime.rigs import plan_of
write_plan(folder / "plan", plan_of(rig, seconds=0.5))
before = compiled()
motion.load(read_plan(folder / "plan"))
motion.go(motion.plan_start(), Event.AT_START)
while tick() is not Event.AT_START:
    pass
motion.run()
done = 0
while tick() is not Event.END:
    done += 1
    if done in (800, 1200):
        motion.hold(done == 800)
motion.go(motion.plan_start(), Event.AT_START)
while tick() is not Event.AT_START:
    pass
motion.run()
for _ in range(1200):
    tick()
motion.brake(fastest=False)
while tick() is not Event.AT_REST:
    pass
motion.go(motion.plan_move(rig.home.copy()), Event.THERE)
tick()
"""
REPORT = """
print(json.dumps({"done": done, "late": [k for k, n in compiled().items() if n != before.get(k, 0)]}))
"""


def fly(script: str, *arguments: str) -> dict[str, Any]:
    done = subprocess.run(
        [sys.executable, "-c", COMMON + script + REPORT, *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    said: dict[str, Any] = json.loads(done.stdout)
    return said


def test_a_live_flight_meets_no_kernel_for_the_first_time(tmp_path: Path) -> None:
    for method in ("exact", "alm", "clamped", "preview"):
        folder = tmp_path / method
        folder.mkdir()
        said = fly(LIVE, str(folder), method)
        assert said["done"] > 300
        assert said["late"] == []


def test_a_path_flight_meets_no_kernel_for_the_first_time(tmp_path: Path) -> None:
    said = fly(PATH, str(tmp_path))
    assert said["done"] > 2000
    assert said["late"] == []
