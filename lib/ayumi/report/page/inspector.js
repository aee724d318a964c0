// The values of the thing that is selected on the timeline, which can be typed, and new keys at the
// cursor.

import { byId, element, seconds } from "./dom.js";
import { addSwing, appendPhase, countedFrom, goalOf, goals, joinKeyframe, keysWithin, legWords, putGoal, putKey, putPart, putSupport, putTarget, removeKey, removeValue, repeatPhases, roomOfKey, roundsOf, roundedTime, sameTime, setRounds, splitPhase, stillWanted, valueFromRow, written } from "./edits.js";
import { missingFields, optionalField, optionsOf, token, valueAt } from "./fields.js";
import { addField, addFloorMotion, addQuantity, addToGround, addUncertainPush, axesOf, distributions, growField, putShape, quantities, removeItem, shapes } from "./parts.js";
import { sampleAt } from "./series.js";
import { nameOfTrack } from "./timeline.js";

/// The unit of a value, by the names on its path. `document` is the pattern as written.
export function unitOf(path, angle, document) {
  const name = path.at(-1), track = path[0];
  if (track === "uncertainty") return unitOfUncertain(path, angle, document?.uncertainty?.[path[1]]?.[path[2]]);
  if (["t", "after", "at", "until", "duration"].includes(name)) return "s";
  if (track === "viip" && name === "turn") return angle + "/s";
  if (path.includes("velocity") || path.includes("cog_velocity")) return "m/s";
  if (["x", "y", "z", "height", "cog_height", "lift", "stoop", "radius", "forward", "side", "up"].includes(name)) return "m";
  if (["blocks", "patches"].includes(path[1]) && ["x", "y", "position"].includes(path[3])) return "m";
  if (path[1] === "field" || path.includes("shift")) return "m";
  if (track === "viip" && path[1] === "cog") return "m";
  if (["roll", "pitch", "yaw", "turn"].includes(name) || track === "joints" || track === "joint" ||
    (track === "posture" && path.length > 1)) return angle;
  if (track === "zmp" || track === "cog" || name === "to" || path.includes("to") || track === "position" || track === "point")
    return path.includes("to") && path.at(-1) === 3 ? angle : "m";
  if (track === "feet" || track === "foot") return path.at(-1) === 3 ? angle : "m";
  return { fz: "N", impulse: "N s", force: "N", torque: "N m", mass: "kg", latency: "s", coulomb: "N m", frequency: "Hz", offset: angle,
    load: "N", viscous: "N m s/rad", margin: "m" }[name] || (track === "gyro" ? angle + "/s" : "");
}

/// The unit of a value of an uncertain quantity or push, `item`. Numbers have it; weights and
/// correlations do not.
function unitOfUncertain(path, angle, item) {
  const [, list, , part] = path, inUnit = (unit = "") => unit.replace("angle", angle);
  if (list === "quantities") {
    if (part === "point") return "m";
    return distributions.includes(part) ? inUnit(quantities.find((one) => one.what === item?.what)?.unit) : "";
  }
  if (part === "duration") return "s";
  if (path.length > 4 && !distributions.includes(path[4])) return "";
  return { direction: angle, time: item?.time === "phases" ? "" : "s", size: item?.unit ?? "" }[part] ?? "";
}

const bounds = { uniform: ["from", "to"], normal: ["mean", "standard deviation"], truncated: ["mean", "standard deviation", "from", "to"] };

const places = ["forward", "left", "up", "yaw"];
const millimetre = (value) => Number(value.toFixed(4));
const words = { to: "lands", joint: "angle", zmp: "ZMP", cog: "COG", fz: "force", t: "time", x: "forward", y: "left",
  cog_height: "COG height", cog_model: "COG model", cog_velocity: "COG velocity" };
const zmpWords = { left: "Put it under the left foot", center: "Put it in the middle", right: "Put it under the right foot" };
const wholes = ["cog", "torso", "feet", "posture", "swing", "viip", "defaults", "world", "parameters"];

/// The name of a value for people, by the names on its path.
export function nameOf(path) {
  // The sides of a block or a patch: { "x": [from, to], "y": [from, to] }.
  if (["blocks", "patches"].includes(path[1]) && path.length === 5)
    return `${words[path[3]] ?? path[3]} ${path[3] === "position" ? places[path[4]] : ["from", "to"][path[4]] ?? path[4] + 1}`;
  if (["blocks", "patches", "motion"].includes(path[1]) && path.length === 4) return words[path[3]] ?? path[3];
  if (path[1] === "motion" && path.length === 5) return `${path[3]} ${places[path[4]]}`;
  if (path[1] === "field") return `${path[2]} ${places[path[3]] ?? ""}`.trim();
  if (path[0] === "uncertainty")
    return path.slice(3).map((name, i, all) => typeof name === "number" ? bounds[all[i - 1]]?.[name] ?? String(name + 1) : name).join(" ");
  const from = wholes.includes(path[0]) && path.length > 1 ? 1 : 0;
  return path.slice(from).map((name) => typeof name === "number" ? places[name] ?? String(name + 1)
    : words[name] || name).join(" ");
}

/// The name of a value among those of other tracks: "COG forward", "trunk pitch".
export function nameAmongOthers(path) {
  const track = { cog: "COG", torso: "trunk" }[path[0]];
  return path[0] === "fz" ? "vertical force" : track && path.length > 1 ? `${track} ${nameOf(path)}` : nameOf(path);
}

const noRoom = "Between the rounds of a block that repeats there is no room for a key.";
const isTarget = (track) => track.kind === "hand" || track.kind === "gaze";

export class Inspector {
  constructor(page) {
    this.page = page;
    byId("add-key").addEventListener("submit", (event) => {
      event.preventDefault();
      this.addKey();
    });
    byId("key-time").addEventListener("change", (event) => {
      const time = Number(event.target.value);
      if (Number.isFinite(time)) this.page.show(Math.max(0, time));
    });
    // Enter moves the cursor and adds no key.
    byId("key-time").addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault();
      event.target.dispatchEvent(new Event("change"));
    });
    byId("whole").addEventListener("click", () => this.page.select({ kind: "pattern", pointer: "" }));
  }

  /// One input for each value of a JSON text. A change is an edit of this value alone, or the edits
  /// that `edits` makes of it.
  inputs(pointer, value, path, choices = {}, edits = null) {
    if (path[1] === "field" && Array.isArray(value) && Array.isArray(value[0])) return [this.grid(pointer, value, path)];
    if (value && typeof value === "object")
      return Object.entries(value).flatMap(([name, part]) => this.inputs(pointer + token(name),
        part, [...path, Array.isArray(value) ? Number(name) : name], choices, edits));
    // If the robot cannot do what is written, the shown motion is older than the text.
    if (this.page.state.error) value = valueAt(this.page.document, pointer) ?? value;
    const unit = unitOf(path, this.page.state.angle_unit, this.page.document), last = path.at(-1);
    const name = nameOf(path);
    const options = choices[last];
    const input = options
      ? element("select", {}, ...optionsOf(options, value, this.optional(pointer)).map(([one, words]) => element("option", { value: one }, words)))
      : element("input", { type: "text", inputmode: "decimal", spellcheck: "false", autocomplete: "off" });
    input.value = String(value);
    input.dataset.id = pointer;
    input.dataset.written = String(value);
    input.disabled = !this.page.can("edit");
    input.addEventListener("change", () => {
      const next = typeof value === "boolean" ? input.value === "true" : written(input.value);
      if (next === "" && this.optional(pointer))
        this.page.edit(removeValue(this.page.document, pointer)).then((done) => { if (!done && options) input.value = String(value); });
      else if (next !== value && next !== "") {
        const list = edits ? edits(next) : [{ kind: "set", pointer, value: next }];
        if (list) this.page.edit(list);
        else input.value = String(value);
      }
    });
    return [element("label", { class: "value" }, element("span", {}, name), input,
      element("span", { class: "unit" }, options || !unit ? "" : " " + unit))];
  }

  /// The heights of a field as a table of numbers; a field with too many of them stays in the text.
  grid(pointer, rows, path) {
    if (rows.length * rows[0].length > 100)
      return element("p", { class: "soft" }, `${nameOf(path)}: ${rows.length} × ${rows[0].length} numbers, to be changed in the text`);
    // Up in the table is ahead and left is left, as in a picture from above.
    return element("table", { class: "grid" }, element("caption", {}, "Heights in m, seen from above: ahead is up"),
      element("tbody", {}, ...rows.map((row, i) => element("tr", {}, ...row.map((value, j) => {
        const [input] = this.inputs(`${pointer}/${i}/${j}`, value, ["world", "field", "height"]).map((one) => one.querySelector("input"));
        input.setAttribute("aria-label", `height of node ${i + 1} ahead, ${j + 1} to the left, in m`);
        return element("td", {}, input);
      }).reverse())).reverse()));
  }

  /// The written thing to which the selection belongs: { kind, pointer, value }.
  written() {
    const { state, selection, document } = this.page;
    const frame = selection?.kind === "key" && state.keyframes.find((one) => selection.pointer.startsWith(one.pointer + "/"));
    const kind = selection?.kind === "key" ? "keyframe" : selection?.kind, pointer = frame ? frame.pointer : selection?.pointer;
    const value = pointer === undefined ? undefined : valueAt(document, pointer);
    return value && typeof value === "object" ? { kind, pointer, value } : null;
  }

  /// The field at a pointer, if its value can be removed.
  optional(pointer) {
    const there = this.written();
    return there ? optionalField(there.kind, there.pointer, there.value, this.page.state, pointer) : undefined;
  }

  /// The values that may be written here but are missing, each with the value that applies without
  /// it.
  missing() {
    const there = this.written();
    if (!there || !this.page.can("edit")) return [];
    const fields = missingFields(there.kind, there.pointer, there.value, this.page.state);
    if (!fields.length) return [];
    return [element("h4", {}, "Not written"), ...fields.map(({ path, otherwise, choices, pointer }) => {
      const input = choices ? element("select", {}, ...optionsOf(choices, undefined, { otherwise }).map(([one, words]) => element("option", { value: one }, words)))
        : element("input", { type: "text", spellcheck: "false", autocomplete: "off", placeholder: otherwise, title: `Without it: ${otherwise}` });
      input.dataset.id = pointer;
      input.dataset.written = "";
      input.addEventListener("change", () => {
        const next = written(input.value);
        if (next !== "") this.page.edit([{ kind: "set", pointer, value: next }]);
      });
      const name = there.kind === "keyframe" ? nameAmongOthers(path) : nameOf(path);
      return element("label", { class: "value missing" }, element("span", {}, name), input,
        element("span", { class: "unit" }, choices ? "" : " " + unitOf(path, this.page.state.angle_unit)));
    })];
  }

  pattern() {
    const value = this.page.document || {}, shown = ["name", "profile", "defaults", "start", "world", "controller", "repair", "tolerances"];
    const parts = shown.filter((name) => value[name] !== undefined);
    const ground = ["blocks", "patches", "field", "motion"], without = (name) => name !== "world" ? value[name]
      : Object.fromEntries(Object.entries(value.world).filter(([part]) => !ground.includes(part)));
    return [element("h3", {}, "The whole pattern"),
      ...parts.flatMap((name) => this.inputs("/" + name, without(name), [name], this.choicesOf("pattern"))),
      this.weights("/repair/weights", value.repair?.weights, "Weight of a joint in a repair", 10),
      ...this.onGround("blocks", value), ...this.onGround("patches", value), ...this.field(value.world), ...this.motions(value),
      ...this.parameters(value.parameters ?? {}), ...this.uncertainty(value)].filter(Boolean);
  }

  /// Items of a list that can be added and removed; `words` name one item.
  items(path, words, inputs = (item, i, pointer) => this.inputs(pointer, item, [...path, i])) {
    const document = this.page.document, list = path.reduce((value, name) => value?.[name], document) ?? [];
    return list.flatMap((item, i) => [element("h4", {}, `${words} ${i + 1}`), ...inputs(item, i, `/${path.join("/")}/${i}`),
      this.button(() => removeItem(document, path, i), `Remove this ${words[0].toLowerCase()}${words.slice(1)}`, () => {}, `remove ${path.join(" ")} ${i}`)]);
  }

  /// The button that adds an item. Then the item gets the focus.
  adder(path, edits, words) {
    const count = path.reduce((value, name) => value?.[name], this.page.document)?.length ?? 0;
    return this.button(edits, words, () => this.focusValues(`/${path.join("/")}/${count}/`));
  }

  /// Blocks and patches of the ground.
  onGround(list, value) {
    return [...this.items(["world", list], { blocks: "Block", patches: "Patch of other friction" }[list]),
      this.adder(["world", list], () => addToGround(list, value.world, this.page.solesAtStart()), { blocks: "Add a block to the ground", patches: "Add a patch of other friction" }[list])];
  }

  /// The height field of the ground. There is at most one, with any number of nodes.
  field(world) {
    if (!world?.field)
      return [this.button(() => addField(world, this.page.solesAtStart()), "Add a height field to the ground", () => this.focusValues("/world/field/"))];
    return [element("h4", {}, "Height field"), ...this.inputs("/world/field", world.field, ["world", "field"]),
      this.button(() => growField(world.field, "x"), "One more row of nodes ahead"),
      this.button(() => growField(world.field, "y"), "One more row of nodes to the left"),
      this.button(() => removeValue(this.page.document, "/world/field"), "Remove the height field")];
  }

  /// Motions of the whole floor, at the time of the cursor.
  motions(value) {
    const unit = this.page.state.angle_unit;
    return [...this.items(["world", "motion"], "Motion of the floor", (item, i, pointer) =>
      [...this.inputs(pointer + "/shape", item.shape ?? "ramp", ["shape"], { shape: shapes }, (next) => putShape(pointer, item, next)),
        ...Object.entries(item).filter(([name]) => name !== "shape").flatMap(([name, one]) => this.inputs(`${pointer}/${name}`, one, ["world", "motion", i, name])),
        ...["roll", "pitch"].filter((name) => item[name] === undefined).map((name) =>
          this.button(() => [{ kind: "set", pointer: `${pointer}/${name}`, value: 0 }], `Give its ${name}`, () => this.focusValues(`${pointer}/${name}`), `${pointer} ${name}`)),
        this.shift(pointer, item)]),
    this.adder(["world", "motion"], () => addFloorMotion(this.page.time, unit), "Add a motion of the floor at the cursor")];
  }

  /// The button that gives a motion of the floor a shift.
  shift(pointer, motion) {
    return motion.shift !== undefined ? null : this.button(() => [{ kind: "set", pointer: pointer + "/shift", value: [0, 0, 0] }], "Give its shift",
      () => this.focusValues(pointer + "/shift"), pointer + " shift");
  }

  /// The uncertain quantities, for `ayumi certify`.
  uncertainty() {
    const unit = this.page.state.angle_unit, kind = element("select", { "aria-label": "What is uncertain" },
      ...quantities.map((one) => element("option", { value: one.what }, one.words)));
    kind.dataset.id = "new quantity";
    const words = (what) => quantities.find((one) => one.what === what)?.words ?? what;
    const count = this.page.document?.uncertainty?.quantities?.length ?? 0;
    return [element("h4", {}, "Uncertainty (for ayumi certify)"),
      ...this.items(["uncertainty", "quantities"], "Uncertain quantity", (item, i, pointer) =>
        [element("p", { class: "soft" }, words(item.what)), ...this.inputs(pointer, item, ["uncertainty", "quantities", i], { axis: axesOf(item.what), each: ["true", "false"] })]),
      ...this.items(["uncertainty", "pushes"], "Uncertain push", (item, i, pointer) =>
        this.inputs(pointer, item, ["uncertainty", "pushes", i], { unit: ["B", "N s"] })),
      ...this.page.can("edit") ? [element("form", { class: "value", onsubmit: (event) => {
        event.preventDefault();
        return this.page.edit(addQuantity(kind.value, unit)).then((done) => { if (done) this.focusValues(`/uncertainty/quantities/${count}/`); });
      } }, kind, element("button", { type: "submit" }, "Add"))] : [],
      this.adder(["uncertainty", "pushes"], () => addUncertainPush(unit), "Add an uncertain push")];
  }

  /// Adds the weight of one more joint: the author chooses a joint and types a number.
  weights(pointer, written, words, otherwise) {
    const others = this.page.state.joints.filter((one) => written?.[one.name] === undefined);
    if (!this.page.can("edit") || !others.length) return null;
    const joint = element("select", { "aria-label": words }, ...others.map((one) => element("option", { value: one.name }, one.name)));
    const number = element("input", { type: "number", min: "0.001", step: "any", value: String(otherwise), required: true, "aria-label": `${words}: the weight` });
    joint.dataset.id = pointer + " joint";
    number.dataset.id = pointer + " weight";
    number.dataset.written = String(otherwise);
    return element("form", { class: "value", onsubmit: (event) => {
      event.preventDefault();
      return this.page.edit([{ kind: "set", pointer: pointer + token(joint.value), value: Number(number.value) }])
        .then((done) => { if (done) this.focusValues(pointer + token(joint.value)); });
    } }, element("span", {}, words), joint, number, element("button", { type: "submit" }, "Add"));
  }

  /// The parameters, and a field for a new one. Elsewhere, ${name} stands for the value of the
  /// parameter.
  parameters(written) {
    const name = element("input", { type: "text", size: "10", required: true, pattern: "[A-Za-z_][A-Za-z0-9_]*", spellcheck: "false", autocomplete: "off",
      placeholder: "name", "aria-label": "Name of the new parameter" });
    const number = element("input", { type: "number", step: "any", required: true, placeholder: "value", "aria-label": "Value of the new parameter" });
    name.dataset.id = "new parameter";
    number.dataset.id = "new parameter value";
    return [element("h4", {}, "Parameters"), ...this.inputs("/parameters", written, ["parameters"]),
      this.page.can("edit") ? element("form", { class: "value", onsubmit: (event) => {
        event.preventDefault();
        if (written[name.value] !== undefined) return this.page.say(`There is a parameter ${name.value} already. Nothing was written.`);
        return this.page.edit([{ kind: "set", pointer: "/parameters" + token(name.value), value: Number(number.value) }])
          .then((done) => {
            if (!done) return;
            this.page.say(`From now on, \${${name.value}} stands for this number in every field.`);
            this.emptied(["new parameter", "new parameter value"]);
          });
      } }, name, number, element("button", { type: "submit" }, "New")) : null];
  }

  /// Names that a value may have, by its last name.
  choicesOf(kind) {
    return Object.fromEntries(missingFields(kind, "", {}, this.page.state).filter(({ choices }) => choices)
      .map(({ path, choices }) => [path.at(-1), choices]));
  }

  /// The edits for a typed time. The key joins a keyframe that is already at this time, and stays
  /// between its neighbours.
  timeEdits(key, state) {
    return (next) => {
      if (typeof next !== "number") return [{ kind: "set", pointer: key.time_pointer, value: next }];
      const time = next + (key.time_base || 0), frame = state.keyframes.find((one) => key.pointer.startsWith(one.pointer + "/"));
      const there = state.keyframes.find((one) => one !== frame && sameTime(one.time, time));
      const joined = there && joinKeyframe(state, this.page.document, frame, there);
      if (joined) {
        // The edit changes the places of keyframes, so afterwards the key is searched by its time.
        const inside = key.pointer.slice(frame.pointer.length);
        this.page.edit(joined).then((written) => { if (written) this.selectNew(inside, there.time); });
        return null;
      }
      if (there) {
        this.page.say(frame.repeated || there.repeated
          ? "A keyframe of a block that repeats cannot join another keyframe. Nothing is written."
          : `This keyframe cannot join the one at ${seconds(time)}: both have a key of the same track, or their interpolation or weights differ, or the time of a block that repeats is relative to this keyframe. Nothing is written.`);
        return null;
      }
      const [from, to] = roomOfKey(state.keyframes, key.pointer);
      if (time >= from && time <= to) return [{ kind: "set", pointer: key.time_pointer, value: next }];
      this.page.say(`A keyframe stays between its neighbours: here from ${seconds(from)} to ${seconds(to)}. ` +
        "To move a key beyond them, remove it and add it at the other time.");
      return null;
    };
  }

  selected() {
    const { state, selection } = this.page;
    if (!selection) return null;
    if (selection.kind === "pattern") return selection;
    if (selection.kind === "phase") return state.phases.find((one) => one.pointer === selection.pointer);
    if (selection.kind === "disturbance")
      return state.disturbances.find((one) => one.pointer === selection.pointer);
    for (const track of state.tracks)
      for (const key of track.keys) if (key.pointer === selection.pointer) return { ...key, track, original: key };
    return null;
  }

  render() {
    const thing = this.selected(), box = byId("selected"), { selection, state } = this.page;
    this.wanted = stillWanted(this.wanted, selection, state.text);
    const active = box.contains(document.activeElement) ? document.activeElement : null;
    const typed = active?.matches("input") ? active.value : null;
    box.replaceChildren(...!thing ? [element("p", { class: "soft" },
      "Nothing is selected. Choose a key, a phase or a disturbance on the timeline, or the whole pattern.")]
      : [...this[selection.kind](thing, state), ...this.missing()]);
    if (active) this.restore(box, active.dataset.id, typed !== active.dataset.written ? typed : null);
    byId("add-key").hidden = !this.page.can("edit");
    this.offerTracks(state);
    this.moved();
  }

  /// Restores what was being typed when a new version arrived. If the field has disappeared, this
  /// box gets the focus.
  restore(box, id, typed) {
    const same = id && [...box.querySelectorAll("[data-id]")].find((one) => one.dataset.id === id);
    if (!same) return box.focus({ preventScroll: true });
    same.focus();
    if (typed !== null) same.value = typed;
  }

  /// Gives the focus to the first value, or to the first one below a pointer.
  focusValues(pointer = "") {
    const values = [...byId("selected").querySelectorAll("input, select")];
    (values.find((one) => one.dataset.id?.startsWith(pointer)) ?? byId("selected")).focus();
  }

  /// The typed text has been written, so the fields are cleared for the next one.
  emptied(ids) {
    const fields = ids.map((id) => [...byId("selected").querySelectorAll("input")].find((one) => one.dataset.id === id));
    for (const one of fields) if (one) one.value = "";
    fields[0]?.focus();
  }

  button(edits, words, then = () => {}, id = words) {
    return this.page.can("edit") ? element("button", { type: "button", "data-id": id,
      onclick: () => this.page.edit(edits()).then((done) => { if (done) then(); }) }, words) : null;
  }

  /// Removes a key, or says why it has to stay.
  remove(key) {
    const edits = removeKey(this.page.state, key);
    return edits ? this.page.edit(edits) : this.page.say(countedFrom);
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
      ...this.inputs(key.time_pointer, key.time_value, [key.time_pointer.split("/").at(-1)], {}, this.timeEdits(key, state)),
      ...this.inputs(key.pointer, key.value, path, choices),
      ...frame ? ["interpolation", "weights"].flatMap((more) => {
        const value = valueAt(this.page.document, `${frame.pointer}/${more}`);
        return value === undefined ? [] : this.inputs(`${frame.pointer}/${more}`, value, [more], this.choicesOf("keyframe"));
      }) : [],
      frame ? this.weights(frame.pointer + "/weights", valueAt(this.page.document, frame.pointer)?.weights, "Weight of a joint from here on", 10) : null,
      others.length ? element("p", { class: "soft" }, `This keyframe also has keys of: ${others.join(", ")}. All keys of a keyframe move together.`) : null,
      ...key.track.name === "zmp" && !named ? ["left", "center", "right"].map((place) =>
        this.button(() => [{ kind: "set", pointer: key.pointer, value: place }], zmpWords[place])) : [],
      key.track.name === "zmp" && named && this.page.can("edit") ? element("button", { type: "button", "data-id": "point",
        title: "Write the point [x, y] in place of the name", onclick: () => this.page.edit([{ kind: "set", pointer: key.pointer,
          value: valueFromRow("zmp", this.page.planRow(), this.page.plan.columns, state.angle_unit) }]) }, "Write the point as numbers") : null,
      ...isTarget(key.track) ? this.targetButtons(key) : [],
      frame && this.page.can("mirror") ? element("button", { type: "button", "data-id": "mirror", title: "Exchange left and right in this keyframe",
        onclick: () => this.page.mirror(frame.pointer) }, "Mirror this keyframe") : null,
      this.page.can("edit") ? element("button", { type: "button", "data-id": "Remove this key", onclick: () => this.remove(key.original) }, "Remove this key") : null].filter(Boolean);
  }

  /// The handle that a key of a hand or the gaze moves, if there is one.
  handleOf(track) {
    const link = track.name.replace(/ hand$|^link /, "");
    return this.page.state.handles.find((one) => track.kind === "gaze" ? one.gaze : one.link === link);
  }

  /// Buttons that release a target, place it where the hand is now, or give the direction in which
  /// the hand points.
  targetButtons(key) {
    const handle = this.handleOf(key.track), set = (value) => [{ kind: "set", pointer: key.pointer, value }];
    const place = () => this.page.handles.placeOf(handle, this.page.row()).toArray().map(millimetre);
    if (typeof key.value === "string")
      return handle ? [this.button(() => set(place()), "Hold the present place")] : [];
    const written = Array.isArray(key.value) ? key.value : key.value.position;
    const points = key.track.kind === "hand" && handle && !key.value.direction;
    return [this.button(() => set("free"), "Release it here"),
      points ? this.button(() => set({ ...Array.isArray(key.value) ? {} : key.value, position: written,
        direction: this.page.handles.directionOf(handle).toArray().map(millimetre) }), "Also hold its direction") : null];
  }

  phase(phase, state) {
    const index = state.phases.indexOf(phase);
    return [element("h3", {}, `Phase ${index + 1}, ${seconds(phase.from)} to ${seconds(phase.until)}`),
      ...this.inputs(phase.until_pointer, phase.until_value, [phase.until_pointer.split("/").at(-1)]),
      ...phase.support ? this.inputs(phase.pointer + "/support", phase.support, ["support"],
        { support: ["both", "left", "right", "none"] }, (next) => this.support(index, next)) : [],
      ...phase.swing ? this.inputs(phase.pointer + "/swing", phase.swing, ["swing"], { foot: ["left", "right"] }) : [],
      this.goal(phase, state),
      ...phase.support ? [] : this.inputs(phase.pointer + "/viip", valueAt(this.page.document, phase.pointer + "/viip") ?? {}, ["viip"],
        { release: ["ref_z", "spring"] }),
      ...this.swingButtons(phase),
      this.splitter = this.button(() => splitPhase(phase, this.page.time), "Cut at the cursor"),
      // In a block that repeats, all rounds of a phase are written in one place.
      phase.pointer === state.phases.at(-1).pointer && this.page.can("edit") ? element("button", { type: "button", "data-id": "append", onclick: async () => {
        if (await this.page.edit(appendPhase(state.phases))) this.page.select({ kind: "phase", pointer: this.page.state.phases.at(-1).pointer }, this.page.state.phases.at(-1).from);
      } }, "Add a phase after this one") : null,
      state.phases.length > 1 ? this.button(() => [{ kind: "remove", pointer: phase.pointer }], "Remove this phase") : null,
      this.repetition(phase, index)].filter(Boolean);
  }

  /// The choice between keys and a goal that the control law VIIP carries out.
  goal(phase, state) {
    if (phase.repeated || !this.page.can("edit")) return null;
    const now = goalOf(phase.support ? null : valueAt(this.page.document, phase.pointer + "/viip"));
    const select = element("select", {}, ...goals.map((one) => element("option", { value: one.name }, one.words)));
    select.value = this.wanted?.name ?? now;
    select.dataset.id = phase.pointer + " goal";
    select.addEventListener("change", () => {
      const within = keysWithin(phase, state.keyframes);
      if (select.value === now) return this.want(null);
      if (select.value !== "none" && within.length) return this.want({ pointer: phase.pointer, name: select.value, text: state.text });
      return this.page.edit(putGoal(phase, select.value, state.angle_unit)).then((done) => { if (!done) select.value = now; });
    });
    return element("div", {}, element("label", { class: "value" }, element("span", {}, "VIIP goal"), select, element("span", { class: "unit" })),
      this.goalWithoutKeys(phase, state));
  }

  /// Keeps a goal that the author has chosen for a phase with keys inside it; null leaves the keys.
  want(goal) {
    this.wanted = goal;
    this.render();
  }

  /// VIIP plans the whole phase, so a goal removes the keys inside it.
  goalWithoutKeys(phase, state) {
    const within = keysWithin(phase, state.keyframes), { wanted } = this;
    if (!wanted) return null;
    const say = (words, remove = null) => element("p", { role: "status" },
      `VIIP plans the whole phase, so no key may lie inside it. Here are keyframes at ${within.map((frame) => seconds(frame.time)).join(", ")}. ${words}`,
      remove, element("button", { type: "button", "data-id": phase.pointer + " keep the keyframes", onclick: () => this.want(null) },
        within.length > 1 ? "Keep the keyframes" : "Keep the keyframe"));
    if (within.some((frame) => frame.repeated)) return say("They belong to a block that repeats. Remove them in the text. ");
    const edits = putGoal(phase, wanted.name, state.angle_unit, state.keyframes);
    if (!edits) return say(countedFrom + " ");
    return say("", this.button(() => edits,
      `Remove ${within.length > 1 ? "these keyframes" : "this keyframe"}, and give the goal`, () => {}, phase.pointer + " goal without keys"));
  }

  /// Repeats this phase and the phases before it, with their keys.
  repetition(phase, index) {
    if (!this.page.can("edit")) return null;
    if (phase.repeated) return this.rounds(phase);
    const number = (value, most, words) => {
      const input = element("input", { type: "number", min: words === "rounds" ? "2" : "1", max: String(most), value: String(value), required: true, "aria-label": words });
      input.dataset.id = phase.pointer + " " + words;
      return input;
    };
    const phases = number(1, index + 1, "phases to repeat"), rounds = number(2, 1000, "rounds");
    return element("form", { class: "repeat", onsubmit: (event) => {
      event.preventDefault();
      this.repeat(repeatPhases(this.page.state, this.page.document, index + 1 - Number(phases.value), index, Number(rounds.value)));
    } }, "Repeat the last ", phases, " phases, up to this one, ", rounds, " times in all ", element("button", { type: "submit" }, "Repeat"));
  }

  repeat({ edits, refused, kept }) {
    if (refused) return this.page.say(refused + " Nothing was written.");
    if (!edits.length) return null;
    return this.page.edit(edits).then((done) => {
      if (done && kept) this.page.say(`${kept} within these phases stays in the first round.`);
    });
  }

  /// The number of rounds of the block around a phase.
  rounds(phase) {
    const now = roundsOf(this.page.state, this.page.document, phase);
    const input = element("input", { type: "number", min: "1", max: "1000", step: "1", value: String(now.rounds) });
    input.dataset.id = now.pointer + "/repeat";
    input.dataset.written = String(now.rounds);
    input.addEventListener("change", () => {
      const { edits, refused } = setRounds(this.page.state, this.page.document, phase, Number(input.value));
      if (refused) input.value = String(now.rounds);
      this.repeat({ edits, refused });
    });
    return element("label", { class: "value" }, element("span", {}, "rounds of this block"), input, element("span", { class: "unit" }));
  }

  /// Changes the support. A flight also adds the COG keys that it needs, or it is refused and the
  /// message says what is missing.
  support(index, next) {
    const { state, document, plan } = this.page;
    const cogAt = (time) => valueFromRow("cog", sampleAt(plan, time), plan.columns, state.angle_unit);
    const { edits, refused, brought, landing } = putSupport(state, document, index, next, cogAt);
    if (refused) this.page.say(refused + " Nothing was written.");
    else if (brought?.length) this.page.say(`The flight follows a parabola, so keys of the COG were written at ${brought.map(seconds).join(", ")}` +
      (landing ? ", and a phase on both feet after it." : "."));
    return refused ? null : edits;
  }

  /// If the robot stands on one foot, the other one may swing. Its landing place is then typed, or
  /// dragged in the picture.
  swingButtons(phase) {
    const pointer = phase.pointer + "/swing";
    if (phase.swing) return [this.button(() => [{ kind: "remove", pointer }], "Remove its swing")];
    const foot = { left: "right", right: "left" }[phase.support];
    return foot ? [this.button(() => addSwing(phase, foot), `Let the ${foot} foot swing`)] : [];
  }

  disturbance(one) {
    return [element("h3", {}, `Disturbance at ${seconds(one.from)}: ${one.type.replace("_", " ")}`),
      ...Object.entries(one.value || {}).filter(([name]) => name !== "type").flatMap(([name, value]) =>
        this.inputs(`${one.pointer}/${name}`, value, [name], this.choicesOfDisturbance(one),
          one.type === "floor" && name === "shape" ? (next) => putShape(one.pointer, one.value, next) : null)),
      one.type === "floor" ? this.shift(one.pointer, one.value) : null,
      this.button(() => [{ kind: "remove", pointer: one.pointer }], "Remove this disturbance")].filter(Boolean);
  }

  choicesOfDisturbance({ type }) {
    const { links, joints } = this.page.state, joint = joints.map((one) => one.name);
    return { frame: ["world", "link"], foot: ["left", "right"], joint, ...type === "payload" ? { on: links } : { on: ["cog", ...links] },
      shape: type === "floor" ? shapes : ["rectangle", "half_sine"] };
  }

  offerTracks(state) {
    const select = byId("key-track"), chosen = select.value;
    const targets = state.handles.filter((one) => one.link || one.gaze), feet = state.handles.filter((one) => one.foot);
    const known = [["zmp", "ZMP"], ["cog", "COG"], ["cog height", "COG height"], ["fz", "vertical force"], ["torso", "trunk"]];
    select.replaceChildren(...known.map(([value, label]) => element("option", { value }, label)),
      ...feet.length ? [element("optgroup", { label: "Feet" }, ...feet.map((one) => element("option", { value: "foot " + one.name }, one.label)))] : [],
      ...targets.length ? [element("optgroup", { label: "Hands and gaze" }, ...targets.map((one) =>
        element("option", { value: "target " + one.name }, one.label)))] : [],
      element("optgroup", { label: "Joints" }, ...state.joints.map((one) => element("option", { value: one.name }, one.name))));
    if (chosen) select.value = chosen;
  }

  /// Gives a free foot a key at its place, and keys at the beginning and end of its freedom, as a
  /// drag does.
  async addFootKey(handle) {
    await this.page.showPlan();
    const { state, time } = this.page, phase = state.phases.find((one) => time < one.until && !sameTime(time, one.until)) ?? state.phases.at(-1);
    if (!phase.support) return this.page.say(`At ${seconds(time)} a goal of VIIP leads the feet, so they have no keys there.`);
    if (phase.support === "both" || phase.support === handle.foot)
      return this.page.say(`At ${seconds(time)} the ${handle.label} carries the robot, so it has no key there. Choose a time at which it is in the air.`);
    if (state.phases.some(({ swing }) => swing?.foot === handle.foot))
      return this.page.say(`A swing leads the ${handle.label} in this pattern: type where it lands, or drag the foot while it swings.`);
    if (!this.page.can("pose.drag")) return this.copyFootKey(handle, time);
    const place = this.page.handles.placeOf(handle, this.page.planRow()).toArray();
    const { status, value } = await this.page.server.ask("POST", "pose", { time, drag: handle.name, from: place, to: place });
    if (status !== 200) return this.page.say(value.message || "The foot cannot have a key. Please reload the page.");
    if (!value.edits.length || await this.page.edit(value.edits)) this.selectNew("/feet/" + handle.foot, time);
  }

  /// If the robot cannot do what is written, the foot takes the place of its previous key.
  async copyFootKey(handle, time) {
    const { state, document } = this.page, keyOf = (frame) => valueAt(document, `${frame.pointer}/feet/${handle.foot}`);
    const before = state.keyframes.filter((frame) => frame.time < time && keyOf(frame) !== undefined).at(-1);
    if (!before) return this.page.say("The text of the pattern has an error; correct it first.");
    const edits = putPart(state.keyframes, time, "feet", handle.foot, keyOf(before));
    if (!edits.length) return this.page.say(noRoom);
    if (await this.page.edit(edits)) this.selectNew("/feet/" + handle.foot, time);
  }

  async addKey() {
    const foot = this.page.state.handles.find((one) => byId("key-track").value === "foot " + one.name);
    if (foot) return this.addFootKey(foot);
    // The place of a hand is its place on the robot in the picture.
    if (byId("key-track").value.startsWith("target ")) await this.page.showPlan();
    const { state } = this.page, track = byId("key-track").value, time = this.page.time, row = this.page.planRow();
    const handle = state.handles.find((one) => track === "target " + one.name);
    const joint = !handle && !["zmp", "cog", "cog height", "fz", "torso"].includes(track);
    const value = handle ? this.page.handles.placeOf(handle, row).toArray().map(millimetre)
      : valueFromRow(track === "cog height" ? "cog" : track, row, this.page.plan.columns, state.angle_unit);
    const edits = handle ? putTarget(state.keyframes, time, handle, value)
      : track === "cog height" ? putPart(state.keyframes, time, "cog", "height", value.height)
        : joint ? putPart(state.keyframes, time, "joints", track, value) : putKey(state.keyframes, time, track, value);
    if (!edits.length) return this.page.say(noRoom);
    const legs = joint ? legWords(state, track) : "";
    if (await this.page.edit(edits)) this.selectNew(handle ? handle.gaze ? "/gaze" : "/hands" + token(handle.link)
      : track === "cog height" ? "/cog" : joint ? "/joints" + token(track) : "/" + track, time);
    if (legs) this.page.say(legs);
  }

  /// Selects the key that has just been added, with the focus in its first value.
  selectNew(inside, time) {
    const frame = this.page.state.keyframes.find((one) => sameTime(one.time, time));
    if (!frame) return;
    const pointer = frame.pointer + inside;
    if (!this.page.state.tracks.some((track) => track.keys.some((one) => one.pointer === pointer))) return;
    this.page.select({ kind: "key", pointer }, frame.time);
    [...byId("selected").querySelectorAll("input, select")].find((one) => one.dataset.id?.startsWith(pointer))?.focus();
  }

  moved() {
    if (document.activeElement !== byId("key-time")) byId("key-time").value = String(roundedTime(this.page.time));
    const thing = this.page.selection?.kind === "phase" ? this.selected() : null;
    if (thing && this.splitter) this.splitter.hidden = !splitPhase(thing, this.page.time).length;
  }
}
