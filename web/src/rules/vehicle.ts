/** A vehicle at an attitude as a drawing: seen from the south-west and above, without perspective. */
import type { Convention } from "../contract/types";

export type Vector = readonly [number, number, number];
export type Point = readonly [x: number, y: number];
type Quaternion = readonly [w: number, x: number, y: number, z: number];

/** In our axes: reference x north, y up, z east; body x nose, y up, z right wing. */
const AXES: Record<Convention, { world: [string, Vector][]; body: [string, Vector][] }> = {
  nue: {
    world: [
      ["North", [1, 0, 0]],
      ["Up", [0, 1, 0]],
      ["East", [0, 0, 1]],
    ],
    body: [
      ["x", [1, 0, 0]],
      ["y", [0, 1, 0]],
      ["z", [0, 0, 1]],
    ],
  },
  ned: {
    world: [
      ["North", [1, 0, 0]],
      ["East", [0, 0, 1]],
      ["Down", [0, -1, 0]],
    ],
    body: [
      ["x", [1, 0, 0]],
      ["y", [0, 0, 1]],
      ["z", [0, -1, 0]],
    ],
  },
  enu: {
    world: [
      ["East", [0, 0, 1]],
      ["North", [1, 0, 0]],
      ["Up", [0, 1, 0]],
    ],
    body: [
      ["x", [1, 0, 0]],
      ["y", [0, 0, -1]],
      ["z", [0, 1, 0]],
    ],
  },
};
const PARTS: Record<string, Vector[]> = {
  hull: [
    [1, 0, 0],
    [0.5, 0, 0.1],
    [-0.9, 0, 0.07],
    [-0.9, 0, -0.07],
    [0.5, 0, -0.1],
  ],
  wing: [
    [0.25, 0, 0],
    [-0.15, 0, 0.95],
    [-0.35, 0, 0.95],
    [-0.2, 0, 0],
    [-0.35, 0, -0.95],
    [-0.15, 0, -0.95],
  ],
  tail: [
    [-0.65, 0, 0],
    [-0.85, 0, 0.35],
    [-0.95, 0, 0.35],
    [-0.9, 0, -0.35],
    [-0.85, 0, -0.35],
  ],
  fin: [
    [-0.6, 0, 0],
    [-0.9, 0.38, 0],
    [-0.98, 0.38, 0],
    [-0.9, 0, 0],
  ],
};
const AZIMUTH = -0.55;
const ELEVATION = 0.45;

/** v turned by a unit quaternion. */
export function turned([w, x, y, z]: Quaternion, [a, b, c]: Vector): Vector {
  const [u, v, t] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * u + y * t - z * v, b + w * v + z * u - x * t, c + w * t + x * v - y * u];
}

/** Where a point (north, up, east) is seen: x to the right, y downwards, and how far away it is. */
export function seen([north, up, east]: Vector): { at: Point; depth: number } {
  const right = east * Math.cos(AZIMUTH) + north * Math.sin(AZIMUTH);
  const away = north * Math.cos(AZIMUTH) - east * Math.sin(AZIMUTH);
  const high = up * Math.cos(ELEVATION) + away * Math.sin(ELEVATION);
  return { at: [right, -high], depth: away * Math.cos(ELEVATION) - up * Math.sin(ELEVATION) };
}

/** The axes of a convention, each by its name and where it ends. */
export function axesSeen(convention: Convention, q: Quaternion | null): { name: string; at: Point }[] {
  const drawn = q === null ? AXES[convention].world : AXES[convention].body;
  return drawn.map(([name, axis]) => ({ name, at: seen(q === null ? axis : turned(q, axis)).at }));
}

/** The vehicle's parts, what is farthest away first. */
export function vehicleSeen(q: Quaternion): { name: string; points: string }[] {
  const parts = Object.entries(PARTS).map(([name, corners]) => {
    const all = corners.map((corner) => seen(turned(q, corner)));
    const depth = all.reduce((sum, each) => sum + each.depth, 0) / all.length;
    return { name, depth, points: all.map(({ at: [x, y] }) => `${x.toFixed(3)},${y.toFixed(3)}`).join(" ") };
  });
  return parts.sort((a, b) => b.depth - a.depth);
}
