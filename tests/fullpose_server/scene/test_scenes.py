"""The scenes: real viser servers, read back as a browser would."""

import stat
import threading
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
import viser
import websockets.asyncio.server
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from fullpose.attitude import quaternion_from_dcm
from fullpose.kinematics import payload_attitude
from fullpose.rig import FRAMES, builtin_rigs
from fullpose_server.formats.rig_file import Payload
from fullpose_server.scene.errors import PayloadMeshError, SceneSocketError, UnknownSceneError
from fullpose_server.scene.private_socket import PrivateSocket, host_for
from fullpose_server.scene.scenes import SceneServer, pose_of
from tests.fullpose_server.scene.browser_side import Viewer, sample, subprotocol
from tests.support.sockets import connect
from tests.support.waiting import until

SERVE = websockets.asyncio.server.serve
RIGS = builtin_rigs()


def attitude(name: str, deg: list[float]) -> np.ndarray:
    F = np.empty((3, 3))
    payload_attitude(RIGS[name].axes, np.radians(deg), F)
    return F


def chain(name: str, root: str = "machine") -> tuple[str, ...]:
    return (root, *(FRAMES[i] for i in RIGS[name].geometry.frames))


def settled(viewer: Viewer, path: tuple[str, ...], expected: np.ndarray) -> bool:
    known = "/" + "/".join(path) in viewer.nodes
    return known and bool(np.abs(viewer.quaternion(*path) - expected).max() < 1e-6)


@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4", "vertical-3", "horizontal-3"])
def test_browser_sees_the_measured_attitude_commanded_and_target(scenes: SceneServer, name: str) -> None:
    measured, demand = [25.0, -40.0, 55.0, 130.0], [26.0, -39.0, 55.0, 128.0]
    if not RIGS[name].geometry.redundant:
        measured[0] = demand[0] = 0.0
    scenes.start(RIGS[name], Payload(), name)
    target = quaternion_from_dcm(attitude(name, demand)[None])[0]
    scenes.update(name, sample(measured, demand, list(target)))
    with Viewer(scenes.address(name)) as viewer:
        viewer.until(lambda v: settled(v, chain(name), attitude(name, measured).T))
        viewer.until(lambda v: settled(v, chain(name, "commanded"), attitude(name, demand).T))
        viewer.until(lambda v: settled(v, ("target",), attitude(name, demand).T))
        assert viewer.nodes["/commanded"]["visible"] is True
        assert viewer.nodes["/target"]["visible"] is True


def test_ghost_and_target_go_where_there_is_nothing_to_tell(scenes: SceneServer) -> None:
    scenes.start(RIGS["vertical-4"], Payload(), "vertical-4")
    apart = sample([0.0, 10.0, 0.0, 0.0], [0.0, 12.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0])
    scenes.update("vertical-4", apart)
    with Viewer(scenes.address("vertical-4")) as viewer:
        viewer.until(lambda v: v.nodes.get("/commanded", {}).get("visible") is True)
        scenes.update("vertical-4", sample([0.0, 12.0, 0.0, 0.0]))
        viewer.until(lambda v: v.nodes["/commanded"]["visible"] is False and v.nodes["/target"]["visible"] is False)


def test_nothing_is_sent_while_nothing_changes(scenes: SceneServer) -> None:
    asked = 0

    def latest() -> np.void:
        nonlocal asked
        asked += 1
        return sample([0.0, 10.0, 0.0, 0.0])

    scenes.start(RIGS["vertical-4"], Payload(), "vertical-4", latest)
    with Viewer(scenes.address("vertical-4")) as viewer:
        viewer.until(lambda v: settled(v, chain("vertical-4"), attitude("vertical-4", [0, 10, 0, 0]).T))
        while viewer.read(0.5):
            pass
        frames, before = viewer.frames, asked
        while asked < before + 15:
            assert not viewer.read(0.1)
        assert viewer.frames == frames


def test_a_rig_that_fails_to_answer_does_not_stop_the_others(
    scenes: SceneServer, caplog: pytest.LogCaptureFixture
) -> None:
    def broken() -> None:
        raise OSError("ring is gone")

    scenes.start(RIGS["vertical-3"], Payload(), "broken", broken)
    scenes.start(RIGS["vertical-4"], Payload(), "vertical-4")
    scenes.update("vertical-4", sample([30.0, 0.0, 0.0, 0.0]))
    with Viewer(scenes.address("vertical-4")) as viewer:
        viewer.until(lambda v: settled(v, chain("vertical-4"), attitude("vertical-4", [30, 0, 0, 0]).T))
    failures = [record for record in caplog.records if "broken" in record.getMessage()]
    assert len(failures) == 1, "said once, not thirty times a second"


def test_preview_is_a_ghost_of_its_own(scenes: SceneServer) -> None:
    scenes.start(RIGS["vertical-4"], Payload(), "vertical-4")
    scenes.update("vertical-4", sample([5.0, 0.0, 0.0, 0.0]))
    planned = [50.0, 60.0, -20.0, 10.0]
    scenes.show_pose("vertical-4", np.radians(planned))
    with Viewer(scenes.address("vertical-4")) as viewer:
        viewer.until(lambda v: settled(v, chain("vertical-4", "preview"), attitude("vertical-4", planned).T))
        viewer.until(lambda v: settled(v, chain("vertical-4"), attitude("vertical-4", [5, 0, 0, 0]).T))
        assert viewer.nodes["/preview"]["visible"] is True
        scenes.show_pose("vertical-4", None)
        viewer.until(lambda v: v.nodes["/preview"]["visible"] is False)


def listening() -> set[int]:
    """The TCP ports that this process listens on."""
    inodes = {str(path.readlink()) for path in Path("/proc/self/fd").iterdir() if path.is_symlink()}
    rows = [line.split() for name in ("tcp", "tcp6") for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]]
    return {int(row[1].split(":")[1], 16) for row in rows if row[3] == "0A" and f"socket:[{row[9]}]" in inodes}


def test_no_page_of_any_origin_can_reach_viser_but_through_the_server(scenes: SceneServer) -> None:
    before = listening()
    scenes.start(RIGS["vertical-4"], Payload(), "vertical-4")
    assert scenes.names() == ["vertical-4"]
    for port in listening() - before:  # a page of anywhere, as the operator's browser would send it
        with pytest.raises((InvalidHandshake, OSError)):
            connect(f"ws://127.0.0.1:{port}/", origin="https://elsewhere.example", subprotocols=[subprotocol()]).close()
        with pytest.raises(httpx.HTTPError):
            httpx.get(f"http://127.0.0.1:{port}/")
    assert listening() == before
    with scenes.address("vertical-4") as path:
        folder = Path(path).resolve().parent
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    scenes.stop("vertical-4")
    with pytest.raises(UnknownSceneError):
        scenes.address("vertical-4")
    assert not folder.exists()


def test_a_viser_that_listens_in_another_way_is_not_used() -> None:
    private = PrivateSocket()
    try:
        with pytest.raises(SceneSocketError), host_for(private) as host:
            assert host == "127.0.0.1"
        with pytest.raises(ZeroDivisionError), host_for(private):
            _ = 1 / 0  # what went wrong inside is told as it is
        assert websockets.asyncio.server.serve is SERVE
    finally:
        private.close()


def test_one_that_did_is_stopped_and_its_port_closed(scenes: SceneServer, monkeypatch: pytest.MonkeyPatch) -> None:
    begin = viser.ViserServer.__init__

    def plainly(server: viser.ViserServer, host: str, **options: Any) -> None:
        begin(server, host=str(host), **options)

    monkeypatch.setattr(viser.ViserServer, "__init__", plainly)
    before = listening()
    with pytest.raises(SceneSocketError):
        scenes.start(RIGS["vertical-4"], Payload(), "vertical-4")
    until(lambda: listening() == before)
    assert scenes.names() == []


def test_starting_again_replaces(scenes: SceneServer) -> None:
    scenes.start(RIGS["vertical-4"], Payload(), "rig")
    with Viewer(scenes.address("rig")) as first:
        first.until(lambda v: "/machine/base" in v.nodes)
        scenes.start(RIGS["horizontal-4"], Payload((0.6, 0.4, 0.4)), "rig")
        with pytest.raises(ConnectionClosed):
            first.until(lambda _: False)
    with Viewer(scenes.address("rig")) as second:
        second.until(lambda v: "/machine/base" in v.nodes)


def test_close_ends_the_writer(scenes: SceneServer) -> None:
    scenes.start(RIGS["vertical-4"], Payload(), "vertical-4")
    scenes.close()
    assert "scene-writer" not in [thread.name for thread in threading.enumerate()]


def test_a_missing_mesh_is_said_and_nothing_starts(scenes: SceneServer, tmp_path: Path) -> None:
    with pytest.raises(PayloadMeshError, match=r"seeker\.stl: there is no such file"):
        scenes.start(RIGS["vertical-4"], Payload(None, "seeker.stl"), "vertical-4", folder=tmp_path)
    assert scenes.names() == []


def test_stdout_stays_the_programs(scenes: SceneServer, capsys: pytest.CaptureFixture[str]) -> None:
    scenes.start(RIGS["vertical-4"], Payload(), "vertical-4")
    scenes.stop("vertical-4")
    scenes.close()  # its threads have said what they had to say
    assert capsys.readouterr().out == ""


def test_sample_without_measurement_or_target() -> None:
    assert pose_of(sample([float("nan")] * 4)) is None
    pose = pose_of(sample([1.0, 2.0, 3.0, 4.0], [float("nan")] * 4))
    assert pose is not None
    assert pose.commanded is None
    assert pose.target is None
    np.testing.assert_allclose(pose.measured, np.radians([1.0, 2.0, 3.0, 4.0]))
