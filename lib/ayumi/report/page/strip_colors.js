// Shows how near a quantity is to its limit, as a colour and as a height, so that the strip can
// also be read without colours.

/// 0 at the warning or better, 1 at the limit, and above 1 beyond it; null without a value.
export function strain(lane, value) {
  if (value === null || value === undefined || Number.isNaN(value)) return null;
  const span = Math.abs(lane.limit - lane.warn) || 1e-12;
  return lane.sense === "low" ? 1 - (value - lane.limit) / span : 1 - (lane.limit - value) / span;
}

const stops = [[47, 143, 111], [226, 174, 42], [211, 106, 26], [190, 24, 24]];

/// Good values have one colour. From the warning to the limit, the colour changes to orange; beyond
/// the limit it is red.
export function colorOf(share) {
  if (share === null) return "transparent";
  if (share > 1) return `rgb(${stops[3]})`;
  const at = Math.max(0, share) * 2, low = Math.min(1, Math.floor(at));
  const mixed = stops[low].map((c, i) => Math.round(c + (at - low) * (stops[low + 1][i] - c)));
  return `rgb(${mixed})`;
}

/// The share of the lane's height that is filled: 0.4 for good values, up to 0.75 at the limit, and
/// all of it beyond the limit.
export function heightOf(share) {
  if (share === null) return 0;
  return share > 1 ? 1 : 0.4 + 0.35 * Math.max(0, share);
}

/// The worst sample with a time in [from, to); the interval contains at least the sample at `from`.
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
