// Pushes in words, and as arrows in the picture.

/// A disturbance in words without its time, such as "impulse of 2 N s on cog towards 180 degrees".
export function wordsOfPush({ type, text, size, unit, link, direction }) {
  if (size === undefined) return text;
  const [x, y, z] = direction || [0, 0, 0], turn = Math.round(Math.atan2(y, x) * 180 / Math.PI);
  const way = type === "torque" || !direction ? "" : Math.hypot(x, y) < 1e-6 ? z > 0 ? " upwards" : " downwards" : ` towards ${turn} degrees`;
  return `${type} of ${Number(size.toPrecision(6))} ${unit} on ${link}${way}`;
}

/// The pushes at the COG in the form in which the picture draws them.
export const arrowsOf = (disturbances) => disturbances.filter((one) => one.direction && one.link === "cog" && one.type !== "torque")
  .map(({ from, until, direction }) => ({ begin: from, end: until, from_cog: [0, 0, 0],
    direction: direction.map((x) => x / Math.hypot(...direction)) }));
