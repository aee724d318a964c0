// The posture at the time of the cursor: sliders of the joints, and places of feet, hands, trunk
// and COG. The picture shows the requested posture, which is written into the pattern as a key.

import { legWords } from "./edits.js";
import { byId, element, fixed, seconds } from "./dom.js";

const words = { x: "forward", y: "left", z: "up" };

export class Pose {
  constructor(page) {
    this.page = page;
    this.asked = null;
    this.answer = null;
    byId("joint-filter").addEventListener("input", () => this.filter());
    byId("handle").addEventListener("change", () => this.fillPlace());
    for (const axis of ["x", "y", "z"])
      byId("place-" + axis).addEventListener("input", () => this.typed());
    byId("write-pose").addEventListener("click", () => this.write());
    byId("drop-pose").addEventListener("click", () => this.drop());
  }

  render() {
    const { state } = this.page;
    byId("joints-part").hidden = !this.page.can("pose.joints");
    byId("place-part").hidden = !this.page.can("pose.drag");
    const handles = byId("handle"), chosen = handles.value;
    handles.replaceChildren(...state.handles.map((one) =>
      element("option", { value: one.name }, one.label)));
    if (chosen) handles.value = chosen;
    const names = state.joints.map((one) => one.name).join();
    if (names !== this.names) this.sliders(state.joints);
    this.names = names;
    this.moved(this.page.row());
  }

  unitOf(joint) {
    if (joint.prismatic) return { unit: "mm", scale: 1000 };
    return this.page.state.angle_unit === "rad" ? { unit: "rad", scale: 1 }
      : { unit: "deg", scale: 180 / Math.PI };
  }

  sliders(joints) {
    this.rows = joints.map((joint) => {
      const { unit, scale } = this.unitOf(joint), step = unit === "rad" ? 0.005 : 0.5;
      const range = { min: (scale * joint.low).toFixed(3), max: (scale * joint.high).toFixed(3) };
      const slide = element("input", { type: "range", ...range, step: "any",
        "aria-label": `${joint.name} in ${unit}` });
      const number = element("input", { type: "number", ...range, step,
        "aria-label": `${joint.name} in ${unit}` });
      const take = (value) => {
        if (value === "" || !Number.isFinite(Number(value))) return;
        const bounded = Math.min(joint.high, Math.max(joint.low, Number(value) / scale));
        this.ask({ joints: { ...this.asked?.joints, [joint.name]: bounded } });
      };
      slide.addEventListener("input", () => { number.value = Number(slide.value).toFixed(1); take(slide.value); });
      slide.addEventListener("keydown", (event) => {
        const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
        if (!way) return;
        event.preventDefault();
        slide.value = String(Number(slide.value) + way * step);
        slide.dispatchEvent(new Event("input"));
      });
      number.addEventListener("input", () => { slide.value = number.value; take(number.value); });
      return { joint, scale, slide, number, row: element("div", { class: "joint" },
        element("span", { class: "name", title: joint.name }, joint.name), slide, number,
        element("span", { class: "unit" }, unit)) };
    });
    byId("joints").replaceChildren(...this.rows.map((one) => one.row));
    this.filter();
  }

  filter() {
    const wanted = byId("joint-filter").value.trim().toLowerCase();
    for (const { joint, row } of this.rows || []) row.hidden = !joint.name.toLowerCase().includes(wanted);
  }

  /// Makes the sliders and places follow the motion, except a value that is being typed.
  moved(row) {
    if (byId("tab-pose").hidden) return;
    const columns = this.page.motion.columns;
    for (const { joint, scale, slide, number } of this.rows || []) {
      const value = scale * row[columns["q." + joint.name]];
      if (document.activeElement !== slide) slide.value = String(value);
      if (document.activeElement !== number) number.value = fixed(value, scale === 1 ? 3 : 1);
    }
    byId("pose-time").textContent = seconds(this.page.time);
    if (this.asked?.drag === undefined) this.fillPlace();
  }

  handle() {
    return this.page.state.handles.find((one) => one.name === byId("handle").value);
  }

  fillPlace() {
    const handle = this.handle();
    if (!handle || !this.page.handles) return;
    const at = this.page.handles.placeOf(handle, this.page.row());
    this.shownPlace = {};
    for (const axis of Object.keys(words)) {
      const shown = fixed(1000 * at[axis], 1);
      this.shownPlace[axis] = { value: at[axis], words: shown };
      if (document.activeElement !== byId("place-" + axis)) byId("place-" + axis).value = shown;
    }
  }

  typed() {
    // A coordinate that is not typed keeps all its digits.
    const axes = Object.keys(words), from = axes.map((axis) => this.shownPlace[axis].value);
    const to = axes.map((axis, i) => {
      const { value } = byId("place-" + axis);
      return value === this.shownPlace[axis].words ? from[i] : Number(value) / 1000;
    });
    if (to.every(Number.isFinite)) this.ask({ drag: byId("handle").value, from, to });
  }

  /// Asks the server. Only one question is sent at a time; while it is being answered, only the
  /// latest further question is kept.
  async ask(wanted) {
    this.asked = wanted;
    byId("pose-buttons").hidden = false;
    if (this.waiting) return this.waiting;
    this.waiting = (async () => {
      await this.page.showPlan();
      let sent = null;
      while (this.asked && this.asked !== sent) {
        sent = this.asked;
        const { status, value } = await this.page.server.ask("POST", "pose", { time: this.page.time, ...sent });
        if (!this.asked) break;
        this.answer = status === 200 ? value : null;
        const legs = Object.keys(sent.joints ?? {}).map((name) => legWords(this.page.state, name)).find(Boolean) ?? "";
        byId("pose-words").textContent = status === 200 ? [value.message, legs].filter(Boolean).join(" ") : value.message || "The server cannot make this change. Please reload the page.";
        // The author looks at the picture during a drag, so the message about what is impossible is
        // shown there.
        if (sent.drag || sent.target) this.page.say(byId("pose-words").textContent);
        if (this.answer?.row) this.page.preview(Float32Array.from(this.answer.row));
      }
    })();
    await this.waiting;
    this.waiting = null;
  }

  async write() {
    await this.waiting;
    const edits = this.answer?.edits || [], words = byId("pose-words").textContent;
    if (!edits.length && words) this.page.say(words + " Nothing was written.");
    const kept = edits.length > 0;
    if (kept) await this.page.edit(edits);
    this.forget();
    if (!kept) this.page.preview(null);
  }

  /// Shows the motion as it is written again.
  drop() {
    this.forget();
    this.page.preview(null);
  }

  forget() {
    this.asked = this.answer = null;
    byId("pose-buttons").hidden = true;
    byId("pose-words").textContent = "";
  }
}
