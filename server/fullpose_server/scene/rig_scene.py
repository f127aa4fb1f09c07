"""One rig in one viser server: its nodes, and the poses written to them. The only file that draws with viser.

Node tree, each frame relative to the one around it:

    /machine/base/outer/middle/inner/payload     measured, solid (a three-axis rig begins at outer)
    /commanded/base/...                          commanded, translucent; shown where it differs to the eye
    /preview/base/...                            a planned pose, while someone looks at one
    /target                                      the flight's attitude, a triad
"""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
import rich
import trimesh
import viser
from numpy.typing import ArrayLike
from trimesh.visual.material import PBRMaterial

from fullpose._typing import Array
from fullpose.rig import Rig
from fullpose_server.runtime.contract.rig_paths import SocketAddress
from fullpose_server.scene import palette
from fullpose_server.scene.machine import Part, build
from fullpose_server.scene.payload_mesh import load_mesh
from fullpose_server.scene.pose import Pose, frame_quaternions
from fullpose_server.scene.private_socket import PrivateSocket, host_for
from fullpose_server.scene.shapes import arrow, joined

APART_RAD = np.radians(0.15)  # commanded and measured closer than this look the same: no ghost
MOVED_RAD = np.radians(5e-3)  # under a tenth of a pixel: not sent, so encoder noise costs nothing
GHOST_SCALE = 1.008  # outside the solid it may coincide with, or the two flicker
AXIS_NAMES = ("x nose", "y up", "z right")


class _Viser(viser.ViserServer):
    """viser without the tunnel to its makers' servers, which any browser could otherwise ask for."""

    def request_share_url(self, verbose: bool = True) -> str | None:  # noqa: ARG002
        return None


@contextmanager
def _quiet() -> Iterator[None]:
    """viser prints through rich when it starts and stops, whatever `verbose` says; stdout belongs to the program."""
    console = rich.get_console()
    before, console.quiet = console.quiet, True
    try:
        yield
    finally:
        console.quiet = before


class RigScene:
    """A viser server on a private socket that shows one rig. Not thread-safe: one thread writes."""

    def __init__(
        self, rig: Rig, name: str, size_m: tuple[float, float, float] | None, mesh: Path | None = None
    ) -> None:
        """Start serving. Raises `PayloadMeshError` where the mesh cannot be shown, `SceneSocketError`, OSError."""
        payload = None if mesh is None else load_mesh(mesh)
        self._rig = rig
        self._machine = build(rig.geometry, size_m or (0.3, 0.2, 0.2), payload)
        self._socket = PrivateSocket()
        with _quiet(), ExitStack() as undo:
            undo.callback(self._socket.close)
            with host_for(self._socket) as host:
                self._server = _Viser(host=host, port=0, label=name, verbose=False)
                undo.callback(self._server.stop)
            undo.pop_all()
        self._shown: Pose | None = None
        self._previewed: tuple[Array, Array | None] | None = None
        with self._server.atomic():
            self._stage()
            self._measured = self._nested_frames("/machine")
            self._commanded = self._nested_frames("/commanded", palette.GHOST, 0.35)
            self._preview = self._nested_frames("/preview", palette.PREVIEW, 0.35)
            self._triads()
        self.show(Pose(rig.home, None, None))

    def address(self) -> SocketAddress:
        """Of the socket that viser listens on."""
        return self._socket.address()

    @property
    def viewers(self) -> int:
        """How many browsers are looking."""
        return len(self._server.get_clients())

    def stop(self) -> None:
        """Close the server and every browser's connection to it."""
        with _quiet():
            self._server.stop()
        self._socket.close()

    def show(self, pose: Pose) -> bool:
        """Bring the nodes to `pose`; returns whether anything was sent."""
        before = self._shown
        if before is not None and _same(pose, before):
            return False
        # Everything is computed before `atomic`: an exception inside it would silence viser's buffer.
        measured = frame_quaternions(self._rig, pose.measured)
        apart = pose.commanded is not None and float(np.abs(pose.commanded - pose.measured).max()) > APART_RAD
        commanded = frame_quaternions(self._rig, pose.measured if pose.commanded is None else pose.commanded)
        with self._server.atomic():
            _turn(self._measured, measured)
            if apart:
                _turn(self._commanded, commanded)
            self._commanded_root.visible = apart
            if pose.target is not None:
                self._target.wxyz = pose.target
            self._target.visible = pose.target is not None
        self._shown = pose
        return True

    def preview(self, angles: ArrayLike | None, target: ArrayLike | None = None) -> None:
        """Show a planned pose (4,) [rad] as a ghost of its own; None takes it away. The measured rig is not moved."""
        if angles is None:
            self._preview_root.visible = False
            return
        quaternions = frame_quaternions(self._rig, angles)
        attitude = None if target is None else np.asarray(target, dtype=np.float64)
        with self._server.atomic():
            _turn(self._preview, quaternions)
            self._preview_root.visible = True
            if attitude is not None:
                self._preview_target.wxyz = attitude
            self._preview_target.visible = attitude is not None

    # Building -----------------------------------------------------------------------------------------------------

    def _stage(self) -> None:
        """Floor, light, camera, what does not move; and viser's own controls out of the way."""
        scene, machine = self._server.scene, self._machine
        self._server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="small")
        self._server.gui.main_panel.minimize()
        scene.set_up_direction("+y")
        scene.world_axes.visible = False
        reach = machine.reach
        scene.configure_environment_map("studio", environment_intensity=0.3)
        scene.configure_default_lights(enabled=False)
        scene.add_light_hemisphere("/light/sky", sky_color=(255, 255, 255), ground_color=(120, 124, 130), intensity=0.6)
        scene.add_light_directional(
            "/light/key", intensity=1.35, cast_shadow=True, position=(2.5 * reach, 6.0 * reach, 3.5 * reach)
        )
        scene.add_light_directional("/light/fill", intensity=0.5, position=(-4.0 * reach, 2.0 * reach, -3.0 * reach))
        cell = 0.1 if reach < 0.8 else 0.5
        scene.add_grid(
            "/floor",
            plane="xz",
            infinite_grid=True,
            cell_size=cell,
            section_size=5.0 * cell,
            cell_color=(150, 156, 163),
            section_color=(120, 127, 135),
            cell_thickness=0.6,
            section_thickness=1.0,
            fade_distance=9.0 * reach,
            fade_from="origin",
            shadow_opacity=0.25,
            position=(0.0, machine.floor, 0.0),
        )
        for part in machine.static:
            self._solid(f"/static/{part.name}", part)
        centre = 0.56 * machine.floor + 0.44 * reach
        camera = self._server.initial_camera
        camera.look_at = np.array([0.0, centre, 0.0])
        camera.up = np.array([0.0, 1.0, 0.0])
        camera.fov = np.radians(38.0)
        camera.position = np.array([2.8, 1.3, 2.2]) * reach + np.array([0.0, centre, 0.0])
        camera.near = 0.02 * reach
        camera.far = 100.0 * reach

    def _nested_frames(self, root: str, ghost: str | None = None, opacity: float = 1.0) -> list[viser.FrameHandle]:
        """The nested frames under `root`, outside in; as a ghost: main parts only, in one colour."""
        scene = self._server.scene
        top = scene.add_frame(root, show_axes=False, visible=ghost is None)
        if root == "/commanded":
            self._commanded_root = top
        elif root == "/preview":
            self._preview_root = top
        nodes, path = [], root
        for stage in self._machine.stages:
            path = f"{path}/{stage.frame}"
            nodes.append(scene.add_frame(path, show_axes=False))
            for part in stage.parts:
                if ghost is None:
                    self._solid(f"{path}/{part.name}", part)
                elif part.main:
                    self._ghost(f"{path}/{part.name}", part, ghost, opacity)
            if ghost is None:
                scene.add_label(
                    f"{path}/label",
                    stage.frame,
                    position=stage.label_at,
                    anchor="center-center",
                    font_size_mode="screen",
                    font_screen_scale=0.8,
                )
        for part in self._machine.payload:
            if ghost is None:
                self._solid(f"{path}/payload/{part.name}", part)
            elif part.main:
                self._ghost(f"{path}/payload/{part.name}", part, ghost, opacity)
        return nodes

    def _triads(self) -> None:
        """Body axes on the payload, the flight's attitude, the reference on the floor."""
        scene, machine = self._server.scene, self._machine
        clear = machine.clear
        inner = "/machine/" + "/".join(stage.frame for stage in machine.stages)
        for i, (name, colour) in enumerate(zip(AXIS_NAMES, palette.AXIS_COLOURS, strict=True)):
            e = np.eye(3)[i]
            body = joined(arrow(e, 0.0, 1.12 * clear, 0.018 * clear))
            self._solid(f"{inner}/axes/{name[0]}", Part(name, body, colour))
        self._target = self._attitude_triad("/target", palette.TARGET, clear)
        self._preview_target = self._attitude_triad("/preview/target", palette.PREVIEW, clear)
        corner = np.array([-1.15 * machine.reach, machine.floor, 1.05 * machine.reach])
        for i, text in enumerate(("x north", "y up", "z east")):
            e = np.eye(3)[i]
            mesh = joined(arrow(e, 0.0, 0.34 * machine.reach, 0.011 * machine.reach))
            self._solid(f"/reference/{text[0]}", Part(text, mesh, palette.AXIS_COLOURS[i]), corner)
            scene.add_label(
                f"/reference/{text[0]}/label",
                text,
                position=0.42 * machine.reach * e,
                anchor="center-center",
                font_screen_scale=0.7,
            )

    def _attitude_triad(self, path: str, colour: str, clear: float) -> viser.FrameHandle:
        """Thin rods beyond the body's arrows, a bead on each: on the arrows' tips where the attitude is reproduced."""
        node = self._server.scene.add_frame(path, show_axes=False, visible=False)
        for i, axis in enumerate("xyz"):
            e = np.eye(3)[i]
            rod = trimesh.creation.cylinder(0.008 * clear, segment=(0.2 * clear * e, 1.55 * clear * e), sections=12)
            bead = trimesh.creation.icosphere(subdivisions=2, radius=0.05 * clear)
            bead.apply_translation(1.55 * clear * e)
            self._ghost(f"{path}/{axis}/rod", Part(axis, rod, colour), palette.AXIS_COLOURS[i], 0.9)
            self._ghost(f"{path}/{axis}/bead", Part(axis, bead, colour), colour, 0.95)
        return node

    def _solid(self, path: str, part: Part, position: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        metal = part.colour in (palette.SHAFT, palette.BEARING)
        mesh = part.mesh.copy()
        # glTF colours are linear; ours are sRGB as on screen.
        channels = np.array(palette.rgb(part.colour)) / 255.0
        linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
        material = PBRMaterial(  # type: ignore[no-untyped-call]
            baseColorFactor=np.append(np.round(linear * 255.0), 255.0).astype(np.uint8),
            metallicFactor=0.75 if metal else 0.1,
            roughnessFactor=0.4 if metal else 0.55,
        )
        mesh.visual = trimesh.visual.TextureVisuals(material=material)  # type: ignore[no-untyped-call]
        _ = mesh.vertex_normals  # computed, or the export leaves them out and curves show their facets
        self._server.scene.add_mesh_trimesh(path, mesh, position=np.asarray(position, dtype=np.float64))

    def _ghost(self, path: str, part: Part, colour: str, opacity: float) -> None:
        self._server.scene.add_mesh_simple(
            path,
            GHOST_SCALE * np.asarray(part.mesh.vertices),
            np.asarray(part.mesh.faces),
            color=palette.rgb(colour),
            opacity=opacity,
            cast_shadow=False,
            receive_shadow=False,
        )


def _turn(nodes: list[viser.FrameHandle], quaternions: list[Array]) -> None:
    for node, q in zip(nodes, quaternions, strict=True):
        node.wxyz = q


def _same(a: Pose, b: Pose) -> bool:
    def close(p: Array | None, q: Array | None) -> bool:
        if p is None or q is None:
            return p is q
        return bool(np.abs(p - q).max() < MOVED_RAD)

    return close(a.measured, b.measured) and close(a.commanded, b.commanded) and close(a.target, b.target)
