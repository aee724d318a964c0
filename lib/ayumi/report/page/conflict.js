// Handles two versions of the pattern: the file has changed on disk since the page read it. Nothing
// is written until the author has chosen one.

import { byId, element } from "./dom.js";
import { nearDifferences, sideBySide } from "./text_difference.js";

/// Returns the choice of the author: "theirs" or "mine".
export function chooseVersion({ theirs, mine }) {
  const rows = nearDifferences(sideBySide(theirs, mine));
  const cell = (words, other) => element("td", { class: words === null ? "none" : other }, words ?? "");
  byId("versions").replaceChildren(...rows.map((row) => row.gap
    ? element("tr", { class: "gap" }, element("td", { colspan: "2" },
      row.gap === 1 ? "1 equal line" : `${row.gap} equal lines`))
    : element("tr", {}, cell(row.left, row.same ? "" : "old"), cell(row.right, row.same ? "" : "new"))));
  const dialog = byId("conflict");
  dialog.returnValue = "theirs";
  dialog.showModal();
  return new Promise((resolve) => dialog.addEventListener("close", () =>
    resolve(dialog.returnValue === "mine" ? "mine" : "theirs"), { once: true }));
}
