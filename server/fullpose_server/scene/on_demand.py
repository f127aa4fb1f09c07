"""Scenes as they are looked at: of a rig, or of a source that someone replays. Each starts with its first viewer."""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

from fullpose_server.formats.rig_file import RigStore
from fullpose_server.scene.errors import UnknownSceneError
from fullpose_server.scene.scenes import SceneServer

Latest = Callable[[], Any]


@dataclass(frozen=True)
class _Source:
    rig: str
    latest: Latest


class ScenesOnDemand:
    """A `SceneServer` that knows where rigs, payload meshes and samples are.

    `latest(rig)` answers with a rig's newest telemetry sample, or None. Methods may take a second: call from a thread.
    """

    def __init__(self, scenes: SceneServer, rigs: RigStore, latest: Callable[[str], Any]) -> None:
        self._scenes = scenes
        self._rigs = rigs
        self._latest = latest
        self._sources: dict[str, _Source] = {}
        self._starting = threading.Lock()

    def running(self, name: str) -> bool:
        """Whether a scene of that name has been started."""
        return name in self._scenes.names()

    def open(self, name: str) -> None:
        """Start the scene of that name where it is not running.

        Raises `NotFoundError` where neither rig nor source has the name, `PayloadMeshError` where a payload cannot be
        shown.
        """
        with self._starting:
            if self.running(name):
                return
            source = self._sources.get(name)
            rig = name if source is None else source.rig
            entry = self._rigs.get(rig)
            latest = (lambda: self._latest(rig)) if source is None else source.latest
            self._scenes.start(entry.rig, entry.payload, name, latest, self._rigs.folder)

    def show_pose(self, rig: str, angles: ArrayLike | None, target: ArrayLike | None = None) -> None:
        """Show a planned pose (4,) [rad] in the rig's scene, None takes it away. Raises as `open`."""
        if angles is None and not self.running(rig):
            return
        self.open(rig)
        self._scenes.show_pose(rig, angles, target)

    def add(self, name: str, rig: str, latest: Latest) -> None:
        """Give the samples of `latest`, on that rig, a scene called `name`, which no rig can be called."""
        with self._starting:
            self._sources[name] = _Source(rig, latest)

    def remove(self, name: str) -> None:
        """Take an added scene away from whoever looks at it."""
        with self._starting:
            self._sources.pop(name, None)
            try:
                self._scenes.stop(name)
            except UnknownSceneError:
                return  # nobody has looked
