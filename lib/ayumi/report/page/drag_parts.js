// What a drag in the picture asks for, as vectors [x, y, z] of the world.

const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);

/// The larger part of a way in the picture: level, or up and down. `right` and `up` are those of the
/// picture, `right` level. From high above, nothing goes up and down in the picture.
export function largerPart(way, right, up) {
  const across = dot(way, right), along = dot(way, up), level = Math.hypot(up[0], up[1]);
  if (up[2] < 0.5) return [0, 1].map((i) => right[i] * across + up[i] / level ** 2 * along).concat(0);
  return Math.abs(along) > Math.abs(across) ? [0, 0, along / up[2]] : [right[0] * across, right[1] * across, 0];
}

/// The way the picture is looked at, or the axis of the world that it nearly has: in the view from
/// the side nothing moves to the left.
export function nearAxis(way) {
  const most = Math.max(...way.map(Math.abs));
  return most > 0.975 ? way.map((value) => Math.abs(value) === most ? Math.sign(value) : 0) : way;
}
