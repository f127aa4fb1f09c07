"""The scenes of all rigs: one viser server a rig, and the one thread that writes to them.

viser's handles are not made for several writers, so everything that reaches a browser goes through this thread: 30
times a second it takes each rig's newest sample and brings the scene to it. Nothing here is in the rig's loop.

viser and trimesh take as long to load as the rest of the server: they are loaded when a scene is first wanted, or ahead
of it by `prewarm`.
"""

import logging
import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from fullpose.rig import Rig
from fullpose_server.formats.rig_file import DEFAULT_SIZE_M, Payload
from fullpose_server.runtime.contract.rig_paths import SocketAddress
from fullpose_server.scene.errors import UnknownSceneError
from fullpose_server.scene.pose import Pose

if TYPE_CHECKING:
    from fullpose_server.scene.rig_scene import RigScene

UPDATES_HZ = 30.0
log = logging.getLogger(__name__)


@dataclass
class _Running:
    scene: "RigScene"
    latest: Callable[[], Any] | None
    sample: Any = None
    failing: bool = False


def prewarm() -> None:
    """Load what draws, so that the first scene starts at once. Seconds; for a thread of its own."""
    import fullpose_server.scene.rig_scene  # noqa: F401


class SceneServer:
    """Starts, feeds and stops the scenes. Its methods may be called from any thread."""

    def __init__(self) -> None:
        self._scenes: dict[str, _Running] = {}
        self._lock = threading.Lock()
        self._work: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._writer: threading.Thread | None = None

    def start(
        self,
        rig: Rig,
        payload: Payload,
        name: str,
        latest: Callable[[], Any] | None = None,
        folder: Path | None = None,
    ) -> None:
        """Serve `rig` as `name`.

        `latest` answers with the newest telemetry sample or None, from this class's thread; without it, call `update`.
        `folder` is where the payload's mesh file is. A scene of that name that is running is replaced. Raises
        `PayloadMeshError` where the mesh cannot be shown, `SceneSocketError` where viser cannot be kept private.
        """
        from fullpose_server.scene.rig_scene import RigScene

        mesh = None if payload.mesh is None else (folder or Path()) / payload.mesh
        scene = RigScene(rig, name, payload.size_m or DEFAULT_SIZE_M, mesh)
        with self._lock:
            before = self._scenes.get(name)
            self._scenes[name] = _Running(scene, latest)
            if self._writer is None:
                self._writer = threading.Thread(target=self._write, name="scene-writer", daemon=True)
                self._writer.start()
        if before is not None:
            before.scene.stop()

    def address(self, name: str) -> SocketAddress:
        """Of the socket that a scene is reached by. Raises `UnknownSceneError`."""
        return self._running(name).scene.address()

    def viewers(self, name: str) -> int:
        """How many browsers look at a scene. Raises `UnknownSceneError`."""
        return self._running(name).scene.viewers

    def names(self) -> list[str]:
        """The scenes that are running."""
        with self._lock:
            return sorted(self._scenes)

    def update(self, name: str, sample: Any) -> None:
        """Show a telemetry sample (fields `measured`, `demand` [deg], `target`) at the next of the 30 updates."""
        self._running(name).sample = sample

    def show_pose(self, name: str, angles: ArrayLike | None, target: ArrayLike | None = None) -> None:
        """Show a planned pose beside the rig: angles (4,) [rad], target (4,) quaternion. None takes it away.

        It is a ghost of its own colour: the measured rig keeps showing what the rig does, to every viewer.
        """
        scene = self._running(name).scene
        self._call(lambda: scene.preview(angles, target))

    def stop(self, name: str) -> None:
        """Stop one scene. Raises `UnknownSceneError`."""
        with self._lock:
            running = self._scenes.pop(name, None)
        if running is None:
            raise UnknownSceneError(name)
        self._call(running.scene.stop)

    def close(self) -> None:
        """Stop all scenes and the thread."""
        with self._lock:
            scenes = list(self._scenes.values())
            self._scenes.clear()
            writer, self._writer = self._writer, None
        if writer is not None:
            self._work.put(None)
            writer.join()
        for running in scenes:
            running.scene.stop()

    # The writer -----------------------------------------------------------------------------------------------------

    def _running(self, name: str) -> _Running:
        with self._lock:
            running = self._scenes.get(name)
        if running is None:
            raise UnknownSceneError(name)
        return running

    def _call(self, work: Callable[[], None]) -> None:
        """Run `work` on the writer's thread and wait for it; its exception is the caller's."""
        done: Future[None] = Future()

        def run() -> None:
            try:
                work()
            except Exception as error:  # noqa: BLE001 - handed to the caller
                done.set_exception(error)
            else:
                done.set_result(None)

        self._work.put(run)
        done.result(timeout=10.0)

    def _write(self) -> None:
        due = time.monotonic()
        while True:
            due = max(due + 1.0 / UPDATES_HZ, time.monotonic())
            while (left := due - time.monotonic()) > 0.0:
                try:
                    work = self._work.get(timeout=left)
                except queue.Empty:
                    break
                if work is None:
                    return
                work()
            with self._lock:
                scenes = list(self._scenes.items())
            for name, running in scenes:
                self._bring(name, running)

    def _bring(self, name: str, running: _Running) -> None:
        try:
            sample = running.sample if running.latest is None else running.latest()
            if sample is not None:
                pose = pose_of(sample)
                if pose is not None:
                    running.scene.show(pose)
        except Exception:
            # One rig's trouble must not freeze the others' scenes; said once, until it works again.
            if not running.failing:
                log.exception("scene %s: no update", name)
            running.failing = True
        else:
            running.failing = False


def pose_of(sample: Any) -> Pose | None:
    """What a telemetry sample shows; None before the first measurement."""
    measured = np.radians(np.array(sample["measured"], dtype=np.float64))
    if not np.isfinite(measured).all():
        return None
    commanded = np.radians(np.array(sample["demand"], dtype=np.float64))
    target = np.array(sample["target"], dtype=np.float64)
    return Pose(
        measured,
        commanded if np.isfinite(commanded).all() else None,
        target if np.isfinite(target).all() and float(np.linalg.norm(target)) > 0.5 else None,
    )
