// How near a quantity is to its limit, as a colour and as a height, so that the strip can also be
// read without colours.

/// 0 where the value is comfortably good, 1 at the limit, above 1 beyond it; null without a value.
export function strain(lane, value) {
  if (value === null || value === undefined || Number.isNaN(value)) return null;
  const span = Math.abs(lane.limit - lane.warn) || 1e-12;
  return lane.sense === "low" ? 1 - (value - lane.limit) / span : 1 - (lane.limit - value) / span;
}

const stops = [[47, 143, 111], [226, 174, 42], [211, 106, 26], [190, 24, 24]];

/// Good is one colour, from the warning to the limit it goes to orange, beyond the limit it is red.
export function colorOf(share) {
  if (share === null) return "transparent";
  if (share > 1) return `rgb(${stops[3]})`;
  const at = Math.max(0, share) * 2, low = Math.min(1, Math.floor(at));
  const mixed = stops[low].map((c, i) => Math.round(c + (at - low) * (stops[low + 1][i] - c)));
  return `rgb(${mixed})`;
}

/// Share of the lane's height that is filled: a half where all is good, all of it beyond the limit.
export function heightOf(share) {
  if (share === null) return 0;
  return share > 1 ? 1 : 0.4 + 0.35 * Math.max(0, share);
}

/// The most strained sample with a time in [from, to), at least the one at `from`.
export function worstIn(lane, dt, from, to) {
  const first = Math.max(0, Math.min(lane.values.length - 1, Math.round(from / dt)));
  const end = Math.max(first + 1, Math.min(lane.values.length, Math.ceil(to / dt)));
  let best = null;
  for (let i = first; i < end; ++i) {
    const share = strain(lane, lane.values[i]);
    if (share !== null && (best === null || share > best.share)) best = { share, index: i };
  }
  return best;
}
