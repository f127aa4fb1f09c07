"""Errors of the scene."""


class SceneError(Exception):
    """Root of this package's errors."""


class PayloadMeshError(SceneError):
    """A payload mesh that cannot be shown: which file, and why."""

    def __init__(self, file: str, why: str) -> None:
        super().__init__(f"payload mesh {file}: {why}; give an STL, OBJ, PLY or GLB file in metres, in body axes")
        self.file = file
        self.why = why


class SceneSocketError(SceneError):
    """viser cannot be kept to a socket that no browser can open."""


class UnknownSceneError(SceneError):
    """No scene of that name is running."""

    def __init__(self, name: str) -> None:
        super().__init__(f"no scene {name!r} is running")
        self.name = name
