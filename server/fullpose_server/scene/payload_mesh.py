"""The payload's mesh from a file beside the rig file."""

from pathlib import Path

import numpy as np
import trimesh

from fullpose_server.scene.errors import PayloadMeshError

MOST_FACES = 200_000  # what a tablet's browser still turns smoothly


def load_mesh(path: Path) -> trimesh.Trimesh:
    """The mesh, in body axes [m]. Raises `PayloadMeshError` naming the file and what is wrong with it."""
    if not path.is_file():
        raise PayloadMeshError(str(path), "there is no such file")
    try:
        mesh = trimesh.load_mesh(path)
    except Exception as error:
        raise PayloadMeshError(str(path), f"not readable ({error})") from error
    if len(mesh.faces) == 0:
        raise PayloadMeshError(str(path), "it holds no triangles")
    if len(mesh.faces) > MOST_FACES:
        raise PayloadMeshError(str(path), f"it has {len(mesh.faces)} triangles, more than {MOST_FACES}")
    if not np.isfinite(mesh.vertices).all() or not 1e-3 <= float(np.ptp(mesh.bounds, axis=0).max()) <= 20.0:
        raise PayloadMeshError(str(path), "it must be between 1 mm and 20 m long")
    return mesh
