"""Solids that the machine is put together from. Lengths [m]; directions are unit vectors; all meshes are closed."""

import math
from typing import cast

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from fullpose._typing import Array

SECTIONS = 96  # around a full turn


def placed(mesh: trimesh.Trimesh, x: ArrayLike, y: ArrayLike, z: ArrayLike, origin: ArrayLike) -> trimesh.Trimesh:
    """The mesh moved so that its own axes lie along `x`, `y`, `z` (a right-handed triad) at `origin`."""
    M = np.eye(4)
    M[:3, 0], M[:3, 1], M[:3, 2], M[:3, 3] = x, y, z, origin
    mesh.apply_transform(M)
    return mesh


def _across(direction: Array) -> Array:
    """Some unit vector square to `direction`."""
    side = np.cross(direction, np.eye(3)[int(np.argmin(np.abs(direction)))])
    return np.asarray(side / np.linalg.norm(side))


def arc(
    radius: float, width: float, depth: float, normal: ArrayLike, first: ArrayLike, turn: float = math.tau
) -> trimesh.Trimesh:
    """A ring of chamfered rectangular section, or the part of it from `first` through `turn` [rad] about `normal`.

    `width` is along the normal, `depth` along the radius; `radius` is to the middle of the section.
    """
    c = 0.18 * min(width, depth)
    h, r = 0.5 * width, 0.5 * depth
    section = np.array(
        [(r, h - c), (r - c, h), (c - r, h), (-r, h - c), (-r, c - h), (c - r, -h), (r - c, -h), (r, c - h)]
    )
    closed = turn >= math.tau - 1e-9
    count = max(8, math.ceil(SECTIONS * turn / math.tau))
    angles = np.linspace(0.0, turn, count, endpoint=False) if closed else np.linspace(0.0, turn, count + 1)
    k, m = len(angles), len(section)
    rho = radius + section[:, 0]
    vertices = np.stack(
        [np.outer(np.cos(angles), rho), np.outer(np.sin(angles), rho), np.tile(section[:, 1], (k, 1))], axis=-1
    ).reshape(-1, 3)
    faces = []
    for i in range(k if closed else k - 1):
        here, there = i * m, (i + 1) % k * m
        for j in range(m):
            a, b = here + j, here + (j + 1) % m
            c_, d = there + j, there + (j + 1) % m
            faces += [(a, b, d), (a, d, c_)]
    if not closed:  # the section is convex: a fan closes it
        last = (k - 1) * m
        for j in range(1, m - 1):
            faces += [(0, j + 1, j), (last, last + j, last + j + 1)]
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    mesh.fix_normals()
    n, f = np.asarray(normal, float), np.asarray(first, float)
    return placed(mesh, f, np.cross(n, f), n, np.zeros(3))


def drum(
    radius: float, start: ArrayLike, stop: ArrayLike, end_radius: float | None = None, sections: int = 64
) -> trimesh.Trimesh:
    """A cylinder from `start` to `stop`, or a cone's frustum that ends with `end_radius`; edges slightly chamfered."""
    a, b = np.asarray(start, float), np.asarray(stop, float)
    length = float(np.linalg.norm(b - a))
    top = radius if end_radius is None else end_radius
    c = 0.06 * min(radius, top, 0.5 * length)
    profile = np.array(
        [(0.0, 0.0), (radius - c, 0.0), (radius, c), (top, length - c), (top - c, length), (0.0, length)]
    )
    mesh = trimesh.creation.revolve(profile, sections=sections)
    axis = (b - a) / length
    side = _across(axis)
    return placed(mesh, side, np.cross(axis, side), axis, a)


def slab(size: ArrayLike, centre: ArrayLike) -> trimesh.Trimesh:
    """A box of `size` along x, y, z."""
    box = trimesh.creation.box(extents=np.asarray(size, float))
    x, y, z = np.eye(3)
    return placed(box, x, y, z, centre)


def tower(
    bottom: tuple[float, float], top: tuple[float, float], start: float, stop: float, z: float
) -> trimesh.Trimesh:
    """An upright with a rectangular foot narrowing to its head: (x, z) sizes at heights y = `start` and `stop`."""
    corners = []
    for (sx, sz), y in ((bottom, start), (top, stop)):
        corners += [(px * sx / 2, y, z + pz * sz / 2) for px in (-1, 1) for pz in (-1, 1)]
    return cast(trimesh.Trimesh, trimesh.convex.convex_hull(np.array(corners)))


def arrow(direction: ArrayLike, start: float, length: float, radius: float) -> trimesh.Trimesh:
    """A shaft with a head along `direction` from the origin's `start` to `length`."""
    d = np.asarray(direction, float)
    neck = length - 6.0 * radius
    shaft = drum(radius, d * start, d * neck, sections=20)
    return joined(shaft, drum(2.6 * radius, d * neck, d * length, end_radius=0.15 * radius, sections=24))


def joined(*meshes: trimesh.Trimesh) -> trimesh.Trimesh:
    """One mesh of many, shaded smooth on curves and sharp on edges."""
    joined = cast(trimesh.Trimesh, trimesh.util.concatenate(list(meshes)))
    joined.merge_vertices()
    return cast(trimesh.Trimesh, trimesh.graph.smooth_shade(joined, angle=math.radians(35.0)))
