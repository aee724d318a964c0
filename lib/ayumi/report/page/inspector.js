// What is selected on the timeline, with its values to be typed; and new keys at the cursor.

import { byId, element, seconds } from "./dom.js";
import { addSwing, appendPhase, putKey, putPart, putTarget, removeKey, splitPhase, valueFromRow, written } from "./edits.js";
import { nameOfTrack } from "./timeline.js";

/// Unit of a value by the names that lead to it.
export function unitOf(path, angle) {
  const name = path.at(-1), track = path[0];
  if (["t", "after", "at", "until", "duration"].includes(name)) return "s";
  if (["x", "y", "z", "height", "lift", "radius", "forward", "side", "up"].includes(name)) return "m";
  if (["roll", "pitch", "yaw", "turn"].includes(name) || track === "joints" || track === "joint" ||
    (track === "posture" && path.length > 1)) return angle;
  if (track === "zmp" || track === "cog" || name === "to" || path.includes("to") || track === "position" || track === "point")
    return path.includes("to") && path.at(-1) === 3 ? angle : "m";
  if (track === "feet" || track === "foot") return path.at(-1) === 3 ? angle : "m";
  return { fz: "N", impulse: "N s", force: "N", torque: "N m", mass: "kg", latency: "s", coulomb: "N m" }[name] || "";
}

const places = ["forward", "left", "up", "yaw"];
const millimetre = (value) => Number(value.toFixed(4));
const words = { to: "lands", joint: "angle", zmp: "ZMP", cog: "COG", fz: "force", t: "time", x: "forward", y: "left" };
const zmpWords = { left: "Put it under the left foot", center: "Put it in the middle", right: "Put it under the right foot" };
const wholes = ["cog", "torso", "feet", "posture", "swing"];

/// What a value is called, by the names that lead to it.
export function nameOf(path) {
  const from = wholes.includes(path[0]) && path.length > 1 ? 1 : 0;
  return path.slice(from).map((name) => typeof name === "number" ? places[name] ?? String(name + 1)
    : words[name] || name).join(" ");
}

const isTarget = (track) => track.kind === "hand" || track.kind === "gaze";

export class Inspector {
  constructor(page) {
    this.page = page;
    byId("add-key").addEventListener("submit", (event) => {
      event.preventDefault();
      this.addKey();
    });
  }

  /// One input for each value of a JSON text; a change is an edit of that value alone.
  inputs(pointer, value, path, choices = {}) {
    if (value && typeof value === "object")
      return Object.entries(value).flatMap(([name, part]) => this.inputs(`${pointer}/${name.replaceAll("~", "~0").replaceAll("/", "~1")}`,
        part, [...path, Array.isArray(value) ? Number(name) : name], choices));
    const unit = unitOf(path, this.page.state.angle_unit), last = path.at(-1);
    const name = nameOf(path);
    const options = choices[last];
    const input = options
      ? element("select", {}, ...options.map((one) => element("option", { value: one }, one)))
      : element("input", { type: "text", inputmode: "decimal", spellcheck: "false", autocomplete: "off" });
    input.value = String(value);
    input.dataset.id = pointer;
    input.dataset.written = String(value);
    input.disabled = !this.page.can("edit");
    input.addEventListener("change", () => {
      const next = typeof value === "boolean" ? input.value === "true" : written(input.value);
      if (next !== value && next !== "") this.page.edit([{ kind: "set", pointer, value: next }]);
    });
    return [element("label", { class: "value" }, element("span", {}, name), input,
      element("span", { class: "unit" }, options ? "" : unit))];
  }

  selected() {
    const { state, selection } = this.page;
    if (!selection) return null;
    if (selection.kind === "phase") return state.phases.find((one) => one.pointer === selection.pointer);
    if (selection.kind === "disturbance")
      return state.disturbances.find((one) => one.pointer === selection.pointer);
    for (const track of state.tracks)
      for (const key of track.keys) if (key.pointer === selection.pointer) return { ...key, track, original: key };
    return null;
  }

  render() {
    const thing = this.selected(), box = byId("selected"), { selection, state } = this.page;
    const active = document.activeElement, typed = box.contains(active) && active.matches("input") ? active.value : null;
    box.replaceChildren(...!thing ? [element("p", { class: "soft" },
      "Nothing is selected. Choose a key, a phase or a disturbance on the timeline.")]
      : this[selection.kind](thing, state));
    this.restore(box, active?.dataset?.id, typed !== active?.dataset?.written ? typed : null);
    byId("add-key").hidden = !this.page.can("edit");
    this.offerTracks(state);
    this.moved();
  }

  /// What was being typed when a new version came is still there.
  restore(box, id, typed) {
    const same = id && [...box.querySelectorAll("[data-id]")].find((one) => one.dataset.id === id);
    if (!same) return;
    same.focus();
    if (typed !== null) same.value = typed;
  }

  button(edits, words) {
    return this.page.can("edit") ? element("button", { type: "button",
      onclick: () => this.page.edit(edits()) }, words) : null;
  }

  key(key, state) {
    const name = nameOfTrack(key.track);
    const named = typeof key.value === "string" && !key.value.includes("${");
    const choices = !named ? {} : key.track.name === "posture" ? { posture: state.postures }
      : key.track.name === "zmp" ? { zmp: ["left", "center", "right"] } : {};
    if (isTarget(key.track)) choices.frame = ["world", "trunk"];
    const path = isTarget(key.track) ? Array.isArray(key.value) ? ["position"] : typeof key.value === "string" ? ["target"] : []
      : key.track.kind === "joint" ? ["joint"] : key.track.kind === "foot" ? ["feet"] : [key.track.name];
    const frame = state.keyframes.find((one) => key.pointer.startsWith(one.pointer + "/"));
    const others = state.tracks.flatMap((track) => track.keys.filter((one) =>
      one.time_pointer === key.time_pointer && one.pointer !== key.pointer).map(() => nameOfTrack(track)));
    return [element("h3", {}, `${name} key at ${seconds(key.time)}`),
      ...this.inputs(key.time_pointer, key.time_value, [key.time_pointer.split("/").at(-1)]),
      ...this.inputs(key.pointer, key.value, path, choices),
      others.length ? element("p", { class: "soft" }, `This keyframe also has keys of: ${others.join(", ")}. All keys of a keyframe move together.`) : null,
      ...key.track.name === "zmp" && !named ? ["left", "center", "right"].map((place) =>
        this.button(() => [{ kind: "set", pointer: key.pointer, value: place }], zmpWords[place])) : [],
      key.track.name === "zmp" && named && this.page.can("edit") ? element("button", { type: "button",
        title: "Write the point [x, y] in place of the name", onclick: () => this.page.edit([{ kind: "set", pointer: key.pointer,
          value: valueFromRow("zmp", this.page.row(), this.page.motion.columns, state.angle_unit) }]) }, "Write the point as numbers") : null,
      ...isTarget(key.track) ? this.targetButtons(key) : [],
      frame && this.page.can("mirror") ? element("button", { type: "button", title: "Exchange left and right in this keyframe",
        onclick: () => this.page.mirror(frame.pointer) }, "Mirror this keyframe") : null,
      this.button(() => removeKey(state, key.original), "Remove this key")].filter(Boolean);
  }

  /// The handle that a key of a hand or the gaze moves, if there is one.
  handleOf(track) {
    const link = track.name.replace(/ hand$|^link /, "");
    return this.page.state.handles.find((one) => track.kind === "gaze" ? one.gaze : one.link === link);
  }

  /// A target can be let go, be where the hand is now, and say where the hand points.
  targetButtons(key) {
    const handle = this.handleOf(key.track), set = (value) => [{ kind: "set", pointer: key.pointer, value }];
    const place = () => this.page.handles.placeOf(handle, this.page.row()).toArray().map(millimetre);
    if (typeof key.value === "string")
      return handle ? [this.button(() => set(place()), "Hold the present place")] : [];
    const written = Array.isArray(key.value) ? key.value : key.value.position;
    const points = key.track.kind === "hand" && handle && !key.value.direction;
    return [this.button(() => set("free"), "Let it go free here"),
      points ? this.button(() => set({ ...Array.isArray(key.value) ? {} : key.value, position: written,
        direction: this.page.handles.directionOf(handle).toArray().map(millimetre) }), "Also hold its direction") : null];
  }

  phase(phase, state) {
    const index = state.phases.indexOf(phase);
    return [element("h3", {}, `Phase ${index + 1}, ${seconds(phase.from)} to ${seconds(phase.until)}`),
      ...this.inputs(phase.until_pointer, phase.until_value, [phase.until_pointer.split("/").at(-1)]),
      ...phase.support ? this.inputs(phase.pointer + "/support", phase.support, ["support"],
        { support: ["both", "left", "right", "none"] }) : [],
      ...phase.swing ? this.inputs(phase.pointer + "/swing", phase.swing, ["swing"], { foot: ["left", "right"] }) : [],
      ...this.swingButtons(phase),
      this.splitter = this.button(() => splitPhase(phase, this.page.time), "Cut at the cursor"),
      index === state.phases.length - 1 ? this.button(() => appendPhase(state.phases), "Add a phase after this one") : null,
      state.phases.length > 1 ? this.button(() => [{ kind: "remove", pointer: phase.pointer }], "Remove this phase") : null].filter(Boolean);
  }

  /// On one foot, the other one may swing; where it lands is then typed, or dragged in the picture.
  swingButtons(phase) {
    const pointer = phase.pointer + "/swing";
    if (phase.swing) return [this.button(() => [{ kind: "remove", pointer }], "Remove its swing")];
    const foot = { left: "right", right: "left" }[phase.support];
    return foot ? [this.button(() => addSwing(phase, foot), `Let the ${foot} foot swing`)] : [];
  }

  disturbance(one) {
    return [element("h3", {}, `Disturbance at ${seconds(one.from)}`),
      ...Object.entries(one.value || {}).flatMap(([name, value]) => this.inputs(`${one.pointer}/${name}`, value, [name])),
      this.button(() => [{ kind: "remove", pointer: one.pointer }], "Remove this disturbance")].filter(Boolean);
  }

  offerTracks(state) {
    const select = byId("key-track"), chosen = select.value;
    const targets = state.handles.filter((one) => one.link || one.gaze);
    const known = [["zmp", "ZMP"], ["cog", "COG"], ["cog height", "COG height"], ["fz", "vertical force"], ["torso", "trunk"]];
    select.replaceChildren(...known.map(([value, label]) => element("option", { value }, label)),
      ...targets.length ? [element("optgroup", { label: "Hands and gaze" }, ...targets.map((one) =>
        element("option", { value: "target " + one.name }, one.label)))] : [],
      element("optgroup", { label: "Joints" }, ...state.joints.map((one) => element("option", { value: one.name }, one.name))));
    if (chosen) select.value = chosen;
  }

  addKey() {
    const { state } = this.page, track = byId("key-track").value;
    const handle = state.handles.find((one) => track === "target " + one.name);
    if (handle) {
      const place = this.page.handles.placeOf(handle, this.page.row()).toArray().map(millimetre);
      return void this.page.edit(putTarget(state.keyframes, this.page.time, handle, place));
    }
    if (track === "cog height")
      return void this.page.edit(putPart(state.keyframes, this.page.time, "cog", "height",
        valueFromRow("cog", this.page.row(), this.page.motion.columns).height));
    const value = valueFromRow(track, this.page.row(), this.page.motion.columns, state.angle_unit);
    const whole = ["zmp", "cog", "fz", "torso"].includes(track);
    this.page.edit(whole ? putKey(state.keyframes, this.page.time, track, value)
      : putPart(state.keyframes, this.page.time, "joints", track, value));
  }

  moved() {
    byId("key-time").textContent = seconds(this.page.time);
    const thing = this.page.selection?.kind === "phase" ? this.selected() : null;
    if (thing && this.splitter) this.splitter.hidden = !splitPhase(thing, this.page.time).length;
  }
}
