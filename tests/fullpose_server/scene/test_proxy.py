"""The proxy: a real viser server behind a real HTTP server, over real sockets."""

import httpx
import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from fullpose.kinematics import payload_attitude
from fullpose.rig import builtin_rigs
from fullpose_server.scene.proxy import HIDE_CHROME
from tests.fullpose_server.scene.browser_side import CAMERA, Viewer, browser_message, sample
from tests.fullpose_server.scene.conftest import Served
from tests.support.sockets import connect


def test_page_comes_through_without_visers_controls(served: Served) -> None:
    answer = httpx.get(f"http://{served.address}/scene/vertical-4/?darkMode")
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/html")
    assert answer.headers["content-security-policy"] == "frame-ancestors 'self'"
    with served.scenes.address("vertical-4") as path, httpx.Client(transport=httpx.HTTPTransport(uds=path)) as client:
        direct = client.get("http://scene/").content
    assert answer.content == direct.replace(b"</head>", HIDE_CHROME + b"</head>", 1) != direct


def test_slash_is_added_and_the_query_kept(served: Served) -> None:
    answer = httpx.get(f"http://{served.address}/scene/vertical-4?darkMode")
    assert answer.status_code == 307
    assert answer.headers["location"] == "/scene/vertical-4/?darkMode"


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/scene/nowhere/", 404),
        ("/scene/vertical-4/no-such-file", 404),
        ("/scene/vertical-4/" + "a" * 3000, 404),
        ("/scene/vertical-4/" + "a/" * 3000, 404),
        ("/scene/vertical-4/..%2f..%2f_viser.py", 404),
        ("/scene/vertical-4/?websocket=ws://elsewhere.example/", 400),
        ("/scene/vertical-4/?playbackPath=https://elsewhere.example/scene.viser", 400),
    ],
)
def test_what_is_not_ours_is_refused(served: Served, path: str, status: int) -> None:
    assert httpx.get(f"http://{served.address}{path}").status_code == status


def test_visers_own_address_in_the_query_is_accepted(served: Served) -> None:
    # Its page writes this into the address bar when it sits behind a path; a reload must work.
    address = f"http://{served.address}/scene/vertical-4/?websocket=ws://{served.address}/scene/vertical-4"
    assert httpx.get(address).status_code == 200


@pytest.mark.parametrize("slash", ["", "/"])
def test_websocket_carries_subprotocol_and_binary_frames(served: Served, slash: str) -> None:
    angles = [10.0, 20.0, -30.0, 40.0]
    served.scenes.update("vertical-4", sample(angles))
    F = np.empty((3, 3))
    payload_attitude(builtin_rigs()["vertical-4"].axes, np.radians(angles), F)
    path = ("machine", "base", "outer", "middle", "inner")

    def there(viewer: Viewer) -> bool:
        return "/" + "/".join(path) in viewer.nodes and bool(np.allclose(viewer.quaternion(*path), F.T, atol=1e-6))

    with Viewer(f"ws://{served.address}/scene/vertical-4{slash}") as viewer:
        assert str(viewer.socket.subprotocol).startswith("viser-v")
        viewer.until(there)
        assert served.scenes.viewers("vertical-4") == 0
        viewer.socket.send(CAMERA)  # what makes viser count a browser in
        served.scenes.update("vertical-4", sample([0.0] * 4))
        viewer.until(lambda _: served.scenes.viewers("vertical-4") == 1)


def test_no_browser_can_open_visers_tunnel_to_the_internet(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    opened = []
    monkeypatch.setattr("viser._viser.ViserTunnel", lambda *arguments: opened.append(arguments))
    with Viewer(f"ws://{served.address}/scene/vertical-4/") as viewer:
        viewer.socket.send(browser_message("ShareUrlRequest"))
        viewer.socket.send(CAMERA)
        viewer.until(lambda _: served.scenes.viewers("vertical-4") == 1)
    served.scenes.close()  # waits for what viser was asked to do
    assert opened == []


def test_unknown_rig_has_no_websocket(served: Served) -> None:
    with pytest.raises(InvalidStatus) as refused:
        connect(f"ws://{served.address}/scene/nowhere/")
    assert refused.value.response.status_code == 403


def test_stopping_the_scene_closes_the_browsers_socket(served: Served) -> None:
    with Viewer(f"ws://{served.address}/scene/vertical-4/") as viewer:
        viewer.until(lambda v: "/machine/base" in v.nodes)
        served.scenes.stop("vertical-4")
        with pytest.raises(ConnectionClosed):
            viewer.until(lambda _: False, patience=10.0)


def test_a_browser_that_does_not_read_does_not_hold_up_another(served: Served) -> None:
    stuck = connect(
        f"ws://{served.address}/scene/vertical-4/", max_queue=1, max_size=None, compression=None, proxy=None
    )
    try:
        with Viewer(f"ws://{served.address}/scene/vertical-4/") as viewer:
            for k in range(60):
                served.scenes.update("vertical-4", sample([float(k), 0.0, 0.0, 0.0]))
                viewer.read(0.05)
            half = np.radians(59.0) / 2.0
            viewer.until(
                lambda v: bool(
                    np.allclose(v.nodes.get("/machine/base", {}).get("wxyz", ()), [np.cos(half), 0, np.sin(half), 0])
                    if "wxyz" in v.nodes.get("/machine/base", {})
                    else False
                )
            )
    finally:
        stuck.close()
