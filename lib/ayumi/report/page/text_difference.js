// The lines of two texts side by side, for the choice between two versions of a file.

/// Returns a list of { left, right, same }; a side without a line is null. If the part that differs
/// has more than `most` lines, its two sides are put beside each other without a search for common
/// lines.
export function sideBySide(left, right, most = 1500) {
  const a = left.split("\n"), b = right.split("\n");
  let head = 0;
  while (head < a.length && head < b.length && a[head] === b[head]) ++head;
  let tail = 0;
  while (tail < a.length - head && tail < b.length - head && a.at(-1 - tail) === b.at(-1 - tail)) ++tail;
  const rows = a.slice(0, head).map((line) => ({ left: line, right: line, same: true }));
  rows.push(...middle(a.slice(head, a.length - tail), b.slice(head, b.length - tail), most));
  for (const line of a.slice(a.length - tail)) rows.push({ left: line, right: line, same: true });
  return rows;
}

function middle(a, b, most) {
  const rows = [];
  const pair = (as, bs) => {
    for (let i = 0; i < Math.max(as.length, bs.length); ++i)
      rows.push({ left: as[i] ?? null, right: bs[i] ?? null, same: false });
  };
  if (Math.max(a.length, b.length) > most) {
    pair(a, b);
    return rows;
  }
  // The length of the longest common part of the lines after line i of a and those after line j of
  // b.
  const width = b.length + 1, longest = new Uint16Array((a.length + 1) * width);
  for (let i = a.length - 1; i >= 0; --i)
    for (let j = b.length - 1; j >= 0; --j)
      longest[i * width + j] = a[i] === b[j] ? longest[(i + 1) * width + j + 1] + 1
        : Math.max(longest[(i + 1) * width + j], longest[i * width + j + 1]);
  let i = 0, j = 0, as = [], bs = [];
  while (i < a.length || j < b.length) {
    if (i < a.length && j < b.length && a[i] === b[j]) {
      pair(as, bs);
      as = [];
      bs = [];
      rows.push({ left: a[i], right: b[j], same: true });
      ++i;
      ++j;
    } else if (j >= b.length || (i < a.length &&
      longest[(i + 1) * width + j] >= longest[i * width + j + 1])) as.push(a[i++]);
    else bs.push(b[j++]);
  }
  pair(as, bs);
  return rows;
}

/// Only the lines near a difference; a gap of equal lines becomes one row { gap: number of lines }.
export function nearDifferences(rows, around = 3) {
  const near = rows.map(() => false);
  rows.forEach((row, i) => {
    if (!row.same) for (let k = i - around; k <= i + around; ++k) if (k in near) near[k] = true;
  });
  const shown = [];
  rows.forEach((row, i) => {
    if (near[i]) shown.push(row);
    else if (shown.at(-1)?.gap) ++shown.at(-1).gap;
    else shown.push({ gap: 1 });
  });
  return shown;
}
