// Curves over time of the quantities that the reader chooses. Quantities of one unit share a panel.

import { byId, element, fixed, refill, shape } from "./dom.js";
import { rowAt, hasReferenceZmp, hasZmp } from "./series.js";

const high = 84, top = 8, bottom = 6, letters = 11;
const colors = ["#0b6fc2", "#c2570b", "#0a8754", "#9b2fae", "#b01e3c", "#6b6b00"];
/// The smallest range of an axis. Changes that are much smaller count as none, so that a COG that
/// moves by less than a millimetre is drawn as a straight line.
const leastRange = { mm: 10, deg: 0.5, "deg/s": 1, N: 1, "N m": 0.01 };
const axisWords = { x: "x (forward)", y: "y (left)", z: "z (up)" };

/// The properties of a column for a reader: { label, unit, scale, group }; null if it is not a
/// curve.
export function quantityOf(column) {
  if (column === "fz") return { label: "vertical force f_z", unit: "N", scale: 1, group: "Ground" };
  const [head, tail] = [column.slice(0, column.indexOf(".")), column.slice(column.indexOf(".") + 1)];
  const place = { cog: ["COG", "Robot"], zmp: ["ZMP", "Ground"], ref_zmp: ["reference ZMP", "Ground"],
    base: ["trunk", "Robot"] }[head];
  if (place && axisWords[tail] && !(head !== "cog" && head !== "base" && tail === "z"))
    return { label: `${place[0]} ${axisWords[tail]}`, unit: "mm", scale: 1000, group: place[1] };
  const force = { left_force: "force on the left foot,", right_force: "force on the right foot," }[head];
  if (force && axisWords[tail])
    return { label: `${force} ${axisWords[tail]}`, unit: "N", scale: 1, group: "Ground" };
  const degrees = 180 / Math.PI;
  if (head === "q") return { label: tail, unit: "deg", scale: degrees, group: "Joint angles", joint: tail };
  if (head === "dq") return { label: tail + " speed", unit: "deg/s", scale: degrees, group: "Joint speeds" };
  if (head === "tau") return { label: tail + " torque", unit: "N m", scale: 1, group: "Joint torques" };
  return null;
}

/// Two to five round values in [low, high].
export function levels(low, high_) {
  const rough = (high_ - low) / 2 || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = [5, 2, 1].map((m) => m * power).find((s) => s <= rough * (1 + 1e-9));
  const values = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high_ + 1e-9; ++k) values.push(Number((k * step).toPrecision(6)));
  return values;
}

/// Whether a row has this quantity. `least` is the force [N] from which on there is a ZMP.
export const isKnown = (name, row, columns, least) => name.startsWith("zmp.") ? hasZmp(row, columns, least)
  : !name.startsWith("ref_zmp.") || hasReferenceZmp(row, columns);

/// The parts of a curve between its gaps, which are null.
export function partsOf(points) {
  const parts = [[]];
  for (const point of points)
    if (point) parts.at(-1).push(point);
    else if (parts.at(-1).length) parts.push([]);
  return parts.filter((part) => part.length);
}

/// The points of a line through a part, as SVG writes them. One point alone is written twice: with
/// round ends, this line is a dot.
export const linePoints = (part) => (part.length === 1 ? [part[0], part[0]] : part)
  .map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" ");

export class Curves {
  constructor(page) {
    this.page = page;
    this.chosen = ["cog.y", "zmp.y"];
    byId("add-curve").addEventListener("change", (event) => {
      const name = event.target.value;
      event.target.value = "";
      if (name && !this.chosen.includes(name)) this.chosen.push(name);
      this.render();
    });
  }

  /// Shows the curves that a finding is about.
  bring(name) {
    if (!this.chosen.includes(name)) this.chosen.push(name);
    this.render();
  }

  offer() {
    const { state } = this.page, groups = new Map();
    for (const column of state.replay.columns) {
      const quantity = quantityOf(column);
      if (!quantity || this.chosen.includes(column)) continue;
      if (!groups.has(quantity.group)) groups.set(quantity.group, []);
      groups.get(quantity.group).push(element("option", { value: column }, `${quantity.label} [${quantity.unit}]`));
    }
    byId("add-curve").replaceChildren(element("option", { value: "" }, "Add a curve …"),
      ...[...groups].map(([label, options]) => element("optgroup", { label }, ...options)));
  }

  render() {
    const { state } = this.page, known = new Set(state.replay.columns);
    this.chosen = this.chosen.filter((name) => known.has(name));
    this.offer();
    const units = new Map();
    this.chosen.forEach((name) => {
      const quantity = quantityOf(name);
      // A joint's angle has a panel of its own, with its limits.
      const panel = quantity.joint ? name : quantity.unit;
      if (!units.has(panel)) units.set(panel, []);
      units.get(panel).push({ name, ...quantity, color: colors[units.get(panel).length % colors.length] });
    });
    this.panels = [...units].map(([id, list]) => this.panel(id, list));
    refill(byId("curves"), this.panels.map((panel) => panel.row));
    this.draw();
    this.moved(this.page.time);
  }

  panel(id, list) {
    const svg = shape("svg", { role: "img", height: high, preserveAspectRatio: "none" });
    svg.append(shape("title", {}), shape("g", {}));
    const chips = list.map((one) => {
      one.value = element("span", { class: "value" });
      return element("div", { class: "chip" }, element("i", { style: `background:${one.color}` }),
        element("span", { class: "name" }, one.label), one.value,
        element("button", { type: "button", class: "close", "data-id": "curve " + one.name,
          "aria-label": `Remove the curve ${one.label}`, title: "Remove",
          onclick: () => {
            this.chosen = this.chosen.filter((name) => name !== one.name);
            this.render();
          } }, "×"));
    });
    return { id, list, svg, row: element("div", { class: "lane curve" },
      element("div", { class: "label" }, ...chips), element("div", { class: "plot" }, svg)) };
  }

  /// The motions that are drawn: the shown one, and the ghost with dashes.
  motions() {
    const { motion, ghostMotion } = this.page;
    return ghostMotion ? [{ series: ghostMotion, dashes: "4 3" }, { series: motion, dashes: "" }]
      : [{ series: motion, dashes: "" }];
  }

  draw() {
    const { axis, state, viewer } = this.page, least = viewer.config.least_zmp_force;
    for (const { list, svg } of this.panels || []) {
      const wide = svg.parentElement.clientWidth;
      if (!wide) continue;
      svg.setAttribute("viewBox", `0 0 ${wide} ${high}`);
      svg.setAttribute("width", wide);
      const inner = shape("g", {});
      let low = Infinity, most = -Infinity;
      const lines = [];
      for (const { series, dashes } of this.motions())
        for (const one of list) {
          const column = series.columns[one.name], points = [];
          for (let i = 0; i < series.rows; ++i) {
            const t = series.table[i * series.width];
            if (t < axis.from - 0.05 || t > axis.to + 0.05) continue;
            const row = series.table.subarray(i * series.width, (i + 1) * series.width);
            if (!isKnown(one.name, row, series.columns, least)) {
              points.push(null);
              continue;
            }
            const value = one.scale * row[column];
            low = Math.min(low, value);
            most = Math.max(most, value);
            points.push([t, value]);
          }
          lines.push({ points, dashes, color: one.color });
        }
      if (!Number.isFinite(low)) [low, most] = [0, 0];
      const lacking = (leastRange[list[0].unit] ?? 1e-6) - (most - low);
      if (lacking > 0) [low, most] = [low - lacking / 2, most + lacking / 2];
      const room = 0.06 * (most - low);
      [low, most] = [low - room, most + room];
      const y = (value) => top + (high - top - bottom) * (most - value) / (most - low);
      const labelled = [], words = [];
      for (const value of levels(low, most)) {
        inner.append(shape("line", { class: "level", x1: 0, x2: wide, y1: y(value), y2: y(value) }));
        // The label is above its line, or below it at the top of the picture, unless another label is there.
        const place = y(value) < letters + 2 ? y(value) + letters : y(value) - 2;
        if (labelled.some((other) => Math.abs(other - place) < letters)) continue;
        labelled.push(place);
        words.push(shape("text", { class: "scale", x: 3, y: place }, `${value} ${list[0].unit}`));
      }
      const joint = list[0].joint && state.joints.find((one) => one.name === list[0].joint);
      for (const limit of joint ? [joint.low, joint.high] : []) {
        const value = limit * list[0].scale;
        if (value > low && value < most)
          inner.append(shape("line", { class: "limit", x1: 0, x2: wide, y1: y(value), y2: y(value) }));
      }
      for (const { points, dashes, color } of lines)
        for (const part of partsOf(points))
          inner.append(shape("polyline", { fill: "none", stroke: color, "stroke-width": dashes ? 1 : 1.6,
            "stroke-linecap": "round", "stroke-dasharray": part.length > 1 ? dashes : "",
            points: linePoints(part.map(([t, value]) => [wide * axis.shareOf(t), y(value)])) }));
      inner.append(...words);  // above the curves, with a halo, so that no curve strikes them out
      svg.lastChild.replaceWith(inner);
      svg.querySelector("title").textContent = `${list.map((one) => one.label).join(", ")} in ${list[0].unit}` +
        ` from ${(low + room).toFixed(1)} to ${(most - room).toFixed(1)}`;
    }
  }

  moved(time) {
    const { motion, viewer } = this.page;
    const row = rowAt(motion, time);
    for (const { list } of this.panels || [])
      for (const one of list)
        one.value.textContent = isKnown(one.name, row, motion.columns, viewer.config.least_zmp_force)
          ? `${fixed(one.scale * row[motion.columns[one.name]], 1)} ${one.unit}` : "none";
  }
}
