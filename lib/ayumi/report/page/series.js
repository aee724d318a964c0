// The quantities of a run over time, as one table of rows whose first column is the time, and the
// convex hull that makes a support polygon of the soles.

export function clampTime({ table, width, rows }, t) {
  const first = table[0], last = table[(rows - 1) * width];
  return Math.min(last, Math.max(first, Number.isFinite(t) ? t : first));
}

/// The index of the last row that is not after t.
function indexAt({ table, width, rows }, t) {
  let low = 0, high = rows - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (table[middle * width] <= t + 1e-6) low = middle;
    else high = middle - 1;
  }
  return low;
}

export function rowAt(series, t) {
  const start = indexAt(series, t) * series.width;
  return series.table.subarray(start, start + series.width);
}

/// The row at t, interpolated between two rows; columns whose names end in _planned keep the value
/// of the earlier row.
export function sampleAt(series, t) {
  const at = clampTime(series, t), index = indexAt(series, at), { table, width, columns } = series;
  const a = table.subarray(index * width, (index + 1) * width);
  if (index + 1 >= series.rows) return a;
  const b = table.subarray((index + 1) * width, (index + 2) * width);
  const share = Math.min(1, Math.max(0, (at - a[0]) / (b[0] - a[0])));
  const row = a.map((value, i) => value + share * (b[i] - value));
  for (const [name, i] of Object.entries(columns)) if (name.endsWith("_planned")) row[i] = a[i];
  return row;
}

/// The corners of the hull seen from above, counter-clockwise; points are [x, y, z].
export function convexHull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = (list) => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), p) <= 0) chain.pop();
      chain.push(p);
    }
    chain.pop();
    return chain;
  };
  return sorted.length < 3 ? sorted : [...half(sorted), ...half([...sorted].reverse())];
}

/// Whether a row has a ZMP. In flight there is none, although the row still has a place. `least` is
/// the force [N] from which on there is a ZMP, kLeastZmpForce of the program.
export const hasZmp = (row, columns, least) => row[columns.fz] >= least;

/// Whether a row has a reference ZMP: a foot is planned to stand.
export const hasReferenceZmp = (row, columns) =>
  ["left", "right"].some((side) => row[columns[side + "_planned"]] > 0.5);
