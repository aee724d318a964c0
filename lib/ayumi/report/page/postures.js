// Named postures: they are captured from the motion, either as they are or mirrored, and put on a
// key.

import { byId, element, seconds } from "./dom.js";
import { putKey } from "./edits.js";

export class Postures {
  constructor(page) {
    this.page = page;
    byId("capture").addEventListener("submit", (event) => {
      event.preventDefault();
      this.capture(event.submitter?.value === "mirror");
    });
  }

  async capture(mirror) {
    const name = byId("posture-name").value.trim();
    if (!name) return;
    // For a run, the captured joints are those that are shown.
    const columns = this.page.motion.columns, row = this.page.row();
    const joints = this.page.showsPlan() ? {} : Object.fromEntries(this.page.state.joints.map((one) => [one.name, row[columns["q." + one.name]]]));
    const { status, value } = await this.page.server.ask("POST", "posture",
      { time: this.page.time, name, mirror, joints });
    if (status !== 200) return this.page.say(value.message || "The posture cannot be captured.");
    if (await this.page.edit(value.edits)) byId("posture-name").value = "";
  }

  put(name, time) {
    return this.page.edit(putKey(this.page.state.keyframes, time, "posture", name));
  }

  render() {
    const { state } = this.page;
    byId("capture").hidden = !this.page.can("posture");
    const own = new Set(state.own_postures);
    byId("postures").replaceChildren(...state.postures.map((name) => {
      const words = `Put ${name} on the key at the cursor`;
      const chip = element("li", { draggable: this.page.can("edit") ? "true" : null },
        element("span", { class: "name" }, name),
        element("span", { class: "soft" }, own.has(name) ? "of this file" : ""),
        this.page.can("edit") ? element("button", { type: "button", title: words, "aria-label": words,
          onclick: () => this.put(name, this.page.time) }, "Put at the cursor") : null);
      chip.addEventListener("dragstart", (event) => {
        event.dataTransfer.setData("text/ayumi-posture", name);
        event.dataTransfer.effectAllowed = "copy";
      });
      return chip;
    }));
    this.moved();
  }

  moved() {
    byId("posture-time").textContent = seconds(this.page.time) + (this.page.showsPlan() ? "" : ` (${byId("which").selectedOptions[0].textContent})`);
  }
}
