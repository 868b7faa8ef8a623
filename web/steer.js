// Moves the camera: eye, lookat and up as the lecture has them. Each function returns the fields to set.
import { add, cross, dot, length, rotate, scale, sub, unit } from "./vec.js";

// The camera's axes: right, true up, forward.
function axes(c) {
  const forward = unit(sub(c.lookat, c.eye));
  let right = cross(forward, c.up);
  if (length(right) < 1e-9) right = cross(forward, Math.abs(forward[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]);
  right = unit(right);
  return { forward, right, up: cross(right, forward) };
}

// -1 for a pose that mirrors, whose image has left and right exchanged.
function handedness(c) {
  const m = c.world_from_camera, x = [m[0], m[4], m[8]], y = [m[1], m[5], m[9]], z = [m[2], m[6], m[10]];
  return dot(cross(x, y), z) < 0 ? -1 : 1;
}

// Keeps the angle between the view direction and up away from 0 and 180 degrees.
function pitch(direction, up, right, angle) {
  const now = Math.acos(Math.max(-1, Math.min(1, dot(unit(direction), unit(up)))));
  const next = Math.max(0.01, Math.min(Math.PI - 0.01, now - angle));
  return rotate(direction, right, now - next);
}

export function orbit(c, dx, dy) {
  const { right } = axes(c), up = unit(c.up), s = handedness(c);
  let arm = sub(c.lookat, c.eye);
  arm = pitch(arm, up, right, -dy);
  arm = rotate(arm, up, -dx * s);
  return { eye: sub(c.lookat, arm) };
}

export function look(c, dx, dy) {
  const { right } = axes(c), up = unit(c.up), s = handedness(c);
  let arm = sub(c.lookat, c.eye);
  arm = pitch(arm, up, right, -dy);
  arm = rotate(arm, up, -dx * s);
  return { lookat: add(c.eye, arm) };
}

// By pixels of the image, so that the point under the pointer stays there.
export function pan(c, dx, dy) {
  const { right, up } = axes(c), s = handedness(c);
  const flat = c.projection === "orthographic", depth = flat ? 1 : length(sub(c.lookat, c.eye));
  const move = add(scale(right, -dx * s * depth / c.fx), scale(up, dy * depth / c.fy));
  return { eye: add(c.eye, move), lookat: add(c.lookat, move) };
}

// Nearer for a factor below 1. Parallel projections zoom instead.
export function dolly(c, factor) {
  if (c.projection === "orthographic") return { zoom: c.zoom / factor };
  return { eye: sub(c.lookat, scale(sub(c.lookat, c.eye), factor)) };
}

// In camera space: right, up, forward, in units of the distance to lookat.
export function fly(c, x, y, z) {
  const { right, up, forward } = axes(c), n = length(sub(c.lookat, c.eye)), s = handedness(c);
  const move = scale(add(add(scale(right, x * s), scale(up, y)), scale(forward, z)), n);
  return { eye: add(c.eye, move), lookat: add(c.lookat, move) };
}

export function roll(c, degrees) {
  return { roll: (c.roll || 0) + degrees };
}

// Turns round a point from now on: it becomes lookat's distance along the axis, and the view stays.
export function pivot(c, point) {
  const { forward } = axes(c), depth = dot(sub(point, c.eye), forward);
  return depth > 0 ? { lookat: add(c.eye, scale(forward, depth)) } : {};
}

// The pose world_from_camera, looking as far as before.
export function takePose(c, m) {
  const eye = [m[3], m[7], m[11]], arm = length(sub(c.lookat, c.eye));
  return { eye, lookat: add(eye, scale([m[2], m[6], m[10]], arm)), up: [-m[1], -m[5], -m[9]], roll: 0 };
}
