// The parts of a drag in the picture, as vectors [x, y, z] of the world.

const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);

/// The larger part of a movement in the picture: the level part, or the part up and down. `right`
/// and `up` are the directions of the picture; `right` is level. In a view from high above, only
/// level movements are possible.
export function largerPart(way, right, up) {
  const across = dot(way, right), along = dot(way, up), level = Math.hypot(up[0], up[1]);
  if (up[2] < 0.5) return [0, 1].map((i) => right[i] * across + up[i] / level ** 2 * along).concat(0);
  return Math.abs(along) > Math.abs(across) ? [0, 0, along / up[2]] : [right[0] * across, right[1] * across, 0];
}

/// The smallest sine of the angle at which the view meets the ground for a drag to follow the pointer
/// on it. Below (6 degrees), a pixel is more than ten pixels of a level drag.
const lowView = 0.1;

/// A movement of a foot in the picture, as a movement in the world: over the ground, or up and down
/// when `upright`. `right` and `up` are the directions of the picture; `right` is level. In a view
/// from the side the ground is a line, so the foot moves along it; in a view from straight above
/// nothing moves up.
export function footWay(way, right, up, upright) {
  const across = dot(way, right), along = dot(way, up), level = Math.hypot(up[0], up[1]);
  if (upright) return [0, 0, level > 1 - lowView ** 2 ? 0 : along / Math.max(up[2], lowView)];
  const ahead = level > lowView ? along / level ** 2 : 0;
  return [0, 1].map((i) => right[i] * across + up[i] * ahead).concat(0);
}

/// The direction of the view. If it is within 13 degrees of an axis of the world, returns this axis
/// instead. So a drag in the side view does not change the sideways coordinate y.
export function nearAxis(way) {
  const most = Math.max(...way.map(Math.abs));
  return most > 0.975 ? way.map((value) => Math.abs(value) === most ? Math.sign(value) : 0) : way;
}
