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

/// The direction of the view. If it is within 13 degrees of an axis of the world, returns this axis
/// instead. So a drag in the side view does not change the sideways coordinate y.
export function nearAxis(way) {
  const most = Math.max(...way.map(Math.abs));
  return most > 0.975 ? way.map((value) => Math.abs(value) === most ? Math.sign(value) : 0) : way;
}
