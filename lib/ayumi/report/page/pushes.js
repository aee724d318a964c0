// Pushes on the robot: typed, or drawn as an arrow in the picture, at the time of the cursor.

import { Vector3 } from "three";
import { byId, element, seconds } from "./dom.js";
import { addDisturbance } from "./edits.js";
import { addOther, disturbances } from "./parts.js";
import { wordsOfPush } from "./push_parts.js";

const units = { impulse: "N s", force: "N" };

/// The size of the push for an arrow. An arrow as long as half of the robot's height stands for a
/// push that changes the COG's velocity by 0.3 m/s, about the largest push that a robot on level
/// ground survives. A force acts for `duration`.
export function sizeOfArrow(length, height, weight, type, duration) {
  const impulse = 0.3 * (weight / 9.80665) * length / (0.5 * height);
  const size = type === "impulse" ? impulse : impulse / Math.max(0.001, duration);
  return Number(size.toPrecision(2));
}

export class Pushes {
  constructor(page) {
    this.page = page;
    byId("push-type").addEventListener("change", () => this.units());
    byId("new-push").addEventListener("submit", (event) => {
      event.preventDefault();
      this.add();
    });
    byId("draw-push").addEventListener("click", () => this.draw(!this.page.drawing));
    byId("other-type").replaceChildren(...disturbances.map((one) => element("option", { value: one.type }, one.words)));
    byId("new-other").addEventListener("submit", (event) => {
      event.preventDefault();
      this.addOther();
    });
    this.units();
  }

  units() {
    byId("push-unit").textContent = units[byId("push-type").value];
  }

  draw(on) {
    this.page.drawing = on;
    byId("draw-push").setAttribute("aria-pressed", String(on));
    this.page.say(on ? "Drag an arrow in the picture, away from the robot's COG. Escape ends the drawing." : "");
  }

  /// Called while an arrow is drawn; `done` is true when it is released.
  drawn(way, done) {
    const { config } = this.page.viewer, type = byId("push-type").value;
    const size = sizeOfArrow(way.length(), config.height, config.weight, type, Number(byId("push-duration").value));
    byId("push-size").value = String(size);
    byId("push-angle").value = String(Math.round(Math.atan2(way.y, way.x) * 180 / Math.PI));
    this.page.say(`Push of ${size} ${units[type]} towards ${byId("push-angle").value} degrees`);
    if (!done) return;
    this.draw(false);
    this.add();
  }

  add() {
    const angle = Number(byId("push-angle").value) * Math.PI / 180;
    const direction = new Vector3(Math.cos(angle), Math.sin(angle), 0).toArray()
      .map((x) => Number(x.toFixed(3)) + 0);
    return this.page.edit(addDisturbance({ type: byId("push-type").value, at: this.page.time,
      duration: Number(byId("push-duration").value), size: Number(byId("push-size").value), direction }));
  }

  /// Adds another disturbance, and then shows it with its values.
  async addOther() {
    const { page } = this, { length } = page.state.disturbances;
    if (await page.edit(addOther(byId("other-type").value, page.time, page.state)))
      page.select({ kind: "disturbance", pointer: `/scenario/${length}` });
  }

  render() {
    const { state } = this.page;
    for (const id of ["new-push", "new-other"]) byId(id).hidden = !this.page.can("edit");
    byId("pushes").replaceChildren(...state.disturbances.map((one) => element("li", {},
      element("button", { type: "button", class: "line",
        onclick: () => this.page.select({ kind: "disturbance", pointer: one.pointer }, one.from) },
      `${seconds(one.from)}: ${wordsOfPush(one)}`))));
    byId("no-pushes").hidden = Boolean(state.disturbances.length);
    this.moved();
  }

  moved() {
    byId("push-time").textContent = seconds(this.page.time);
  }
}
