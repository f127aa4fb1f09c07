"""The machine's solids: where bearings and shafts are, that they turn free of each other, and meshes as payload."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from fullpose.rig import FRAMES, Geometry
from fullpose_server.scene.errors import PayloadMeshError
from fullpose_server.scene.machine import Machine, build
from fullpose_server.scene.payload_mesh import load_mesh

SIZE = (0.3, 0.2, 0.2)


@pytest.fixture(params=list(Geometry))
def geometry(request: pytest.FixtureRequest) -> Geometry:
    return request.param


def test_one_stage_a_frame_on_its_own_axis(geometry: Geometry) -> None:
    machine = build(geometry, SIZE)
    assert [stage.frame for stage in machine.stages] == [FRAMES[i] for i in geometry.frames]
    assert [stage.axis for stage in machine.stages] == [geometry.axes[i] for i in geometry.frames]


def radii(machine: Machine, stage: int) -> tuple[float, float]:
    """Least and largest distance of a stage's main part from the centre."""
    part = next(part for part in machine.stages[stage].parts if part.main)
    distance = np.linalg.norm(part.mesh.vertices, axis=1)
    return float(distance.min()), float(distance.max())


def test_rings_nest_without_touching(geometry: Geometry) -> None:
    machine = build(geometry, SIZE)
    for outer in range(len(machine.stages) - 2):
        assert radii(machine, outer)[0] > radii(machine, outer + 1)[1]


def test_payload_clears_the_yoke_at_every_roll(geometry: Geometry) -> None:
    machine = build(geometry, SIZE)
    half = 0.5 * float(np.linalg.norm(SIZE))
    assert radii(machine, len(machine.stages) - 2)[0] > half
    assert machine.floor < -machine.reach * 0.9


def test_shafts_reach_the_bearings_of_the_frame_around(geometry: Geometry) -> None:
    machine = build(geometry, SIZE)
    for around, stage in zip(machine.stages, machine.stages[1:-1], strict=False):
        bearings = next(part for part in around.parts if part.name == "bearings").mesh
        shafts = next(part for part in stage.parts if part.name == "shafts").mesh
        e = np.eye(3)[stage.axis]
        # In the frame around, the next one's axis does not move: both lie along it.
        assert np.ptp(np.abs(bearings.vertices @ e)) < np.abs(bearings.vertices @ e).max()
        assert np.abs(shafts.vertices @ e).max() > np.abs(bearings.vertices @ e).min()
        off_axis = shafts.vertices - np.outer(shafts.vertices @ e, e)
        assert np.linalg.norm(off_axis, axis=1).max() < 0.1 * machine.reach


def test_mesh_payload_sets_the_size(geometry: Geometry, tmp_path: Path) -> None:
    path = tmp_path / "seeker.stl"
    trimesh.creation.cylinder(radius=0.5, height=2.0).export(path)
    machine = build(geometry, SIZE, load_mesh(path))
    assert machine.clear > 1.0
    assert [part.name for part in machine.payload] == ["body"]


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [
        ("missing.stl", None, "there is no such file"),
        ("text.stl", b"not a mesh", ""),
        ("table.csv", b"a,b\n1,2\n", ""),
        ("empty.obj", b"# nothing\n", ""),
    ],
)
def test_bad_mesh_is_one_clear_error(tmp_path: Path, name: str, content: bytes | None, why: str) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(PayloadMeshError) as caught:
        load_mesh(path)
    assert name in str(caught.value)
    assert why in str(caught.value)


def test_absurd_size_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "millimetres.stl"
    trimesh.creation.box(extents=(300.0, 200.0, 200.0)).export(path)
    with pytest.raises(PayloadMeshError, match="between 1 mm and 20 m"):
        load_mesh(path)
