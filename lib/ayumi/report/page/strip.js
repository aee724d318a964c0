// The stability strip: one lane of colour over time for each margin or share of a limit.

import { byId, element, fixed, seconds } from "./dom.js";
import { colorOf, heightOf, strain, worstIn } from "./strip_colors.js";

const worded = (lane, value) => value === null || value === undefined ? "no value"
  : fixed(value, lane.digits ?? 1) + " " + lane.unit;

/// The name of the lane and, in words, where the motion is nearest to the limit.
function summary(lane, dt) {
  const worst = worstIn(lane, dt, 0, Infinity);
  if (!worst) return `${lane.name}: no value`;
  const joint = lane.worst?.[worst.index];
  return `${lane.name}: at worst ${worded(lane, lane.values[worst.index])}` +
    (joint ? ` (${joint})` : "") + ` at ${seconds(worst.index * dt)}; the limit is ${worded(lane, lane.limit)}`;
}

export class Strip {
  constructor(page) {
    this.page = page;
    this.lanes = [];
  }

  render() {
    const box = byId("strip"), { lanes, dt, own } = this.page.strip();
    this.dt = dt;
    this.lanes = lanes.map((lane) => {
      const canvas = element("canvas", { role: "img", "aria-label": summary(lane, dt), title: summary(lane, dt) });
      const value = element("span", { class: "value" });
      const button = element("button", { type: "button", class: "label", title: "Go to the time of the worst value",
        "aria-label": summary(lane, dt) + ". Go there.",
        onclick: () => {
          const worst = worstIn(lane, dt, 0, Infinity);
          if (worst) this.page.show(worst.index * dt);
        } }, element("span", {}, lane.name), value);
      return { lane, canvas, value, row: element("div", { class: "lane strip" }, button,
        element("div", { class: "plot" }, canvas)) };
    });
    const shown = byId("which").selectedOptions[0];
    box.replaceChildren(...shown && shown.value !== "plan" ? [element("p", { class: "soft of-pattern" },
      own ? `Picture, strip and curves show: ${shown.textContent}.`
        : `The strip shows the pattern; the picture and the curves show: ${shown.textContent}.`)] : [], ...this.lanes.map((one) => one.row));
    this.draw();
    this.moved(this.page.time);
  }

  draw() {
    const { axis } = this.page, scale = Math.min(2, devicePixelRatio);
    for (const { lane, canvas } of this.lanes) {
      const wide = Math.round(canvas.parentElement.clientWidth * scale);
      const high = Math.round(canvas.parentElement.clientHeight * scale);
      if (!wide || !high) continue;
      canvas.width = wide;
      canvas.height = high;
      const pen = canvas.getContext("2d");
      for (let x = 0; x < wide; ++x) {
        const from = axis.timeOf(x / wide), to = axis.timeOf((x + 1) / wide);
        if (from > (lane.values.length - 0.5) * this.dt) break;
        const worst = worstIn(lane, this.dt, from, to);
        if (!worst) continue;
        const tall = Math.max(1, Math.round(high * heightOf(worst.share)));
        pen.fillStyle = colorOf(worst.share);
        pen.fillRect(x, high - tall, 1, tall);
      }
    }
  }

  moved(time) {
    for (const { lane, value } of this.lanes) {
      const i = Math.max(0, Math.min(lane.values.length - 1, Math.round(time / this.dt)));
      const joint = lane.worst?.[i];
      value.textContent = worded(lane, lane.values[i]) + (joint ? ` ${joint}` : "");
      const share = strain(lane, lane.values[i]);
      value.classList.toggle("bad", share !== null && share > 1);
    }
  }
}
