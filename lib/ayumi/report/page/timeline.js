// Phases, keys, disturbances and findings over time. Keys, ends of phases and disturbances are moved
// by dragging, or with Ctrl and the arrow keys.

import { byId, element, refill, seconds } from "./dom.js";
import { canDrag, moveKey, movePhase, roomOfKey, roomOfPhase, roundedTime } from "./edits.js";
import { snapped } from "./time_axis.js";

const supportWords = { both: "both", left: "left", right: "right", none: "flight" };
const trackWords = { zmp: "ZMP", cog: "COG", fz: "Vertical force", torso: "Trunk",
  trunk: "Trunk", posture: "Posture", weights: "Weights" };

/// The smallest round step that is at least as long as a pixel of the timeline [s].
export const roundStep = (perPixel) => [0.001, 0.01, 0.1].find((step) => step >= perPixel) ?? 1;

/// The reason why a thing cannot be moved. `time` is what a drag would change: "the time of this key".
const reasonAgainst = (time, repeated) => repeated
  ? `This is in a block that repeats, so ${time} stands for several times. Change it in the text.`
  : `Here ${time} is not written as a number or an expression. Change it in the text.`;

/// The number of pixels from which on a movement is a drag and not a click.
const leastDrag = 4;

export const nameOfTrack = (track) => trackWords[track.name] ||
  (track.kind === "joint" ? track.joint : track.name[0].toUpperCase() + track.name.slice(1));

export function valueWords(value) {
  if (typeof value === "string") return value;
  if (Array.isArray(value)) return value.map(valueWords).join(", ");
  if (value && typeof value === "object")
    return Object.entries(value).map(([name, v]) => `${name} ${valueWords(v)}`).join(", ");
  return String(value);
}

export class Timeline {
  constructor(page) {
    this.page = page;
    this.dragged = null;
  }

  lane(name, contents, kind) {
    this.walkable(contents);
    const plot = element("div", { class: "plot" }, ...contents);
    return element("div", { class: "lane " + kind, role: "group", "aria-label": name },
      element("div", { class: "label", title: name }, name), plot);
  }

  render() {
    if (this.dragged) {
      this.late = true;
      return;
    }
    const { state } = this.page;
    this.renderRuler();
    refill(byId("lane-phases"), [this.phases(state)]);
    const tracks = state.tracks.map((track) => this.track(track));
    refill(byId("lane-tracks"), tracks);
    const rest = [];
    if (state.disturbances.length) rest.push(this.disturbances(state));
    rest.push(this.findings(state));
    refill(byId("lane-events"), rest);
    this.stopAt(this.things().find((part) => part === document.activeElement) ||
      this.things().find((part) => part.getAttribute("aria-pressed") === "true") ||
      this.things().find((part) => part.dataset.id === this.stop) || this.things()[0]);
  }

  renderRuler() {
    const { axis } = this.page, ruler = byId("ruler");
    const wide = ruler.clientWidth || 600;
    ruler.replaceChildren(...axis.ticks(wide / 70).map(({ time, text }) => element("span",
      { style: `left:${(100 * axis.shareOf(time)).toFixed(3)}%` }, text)));
  }

  place(from, to) {
    const { axis } = this.page, begin = 100 * axis.shareOf(from);
    if (to === undefined) return `left:${begin.toFixed(3)}%`;
    const left = Math.max(0, begin), right = Math.min(100, 100 * axis.shareOf(to));
    return `left:${left.toFixed(3)}%;width:${Math.max(0, right - left).toFixed(3)}%`;
  }

  /// The number of pixels that a duration takes.
  wide(duration) {
    return duration / (this.page.axis.to - this.page.axis.from) * (byId("ruler").clientWidth || 600);
  }

  visible(from, to) {
    return to >= this.page.axis.from - 1e-9 && from <= this.page.axis.to + 1e-9;
  }

  phases(state) {
    const parts = [];
    state.phases.forEach((phase, i) => {
      if (!this.visible(phase.from, phase.until)) return;
      const words = phase.viip || !phase.support ? "VIIP" : supportWords[phase.support] || phase.support;
      const thing = { kind: "phase", pointer: phase.pointer };
      parts.push(element("button", { type: "button", class: "phase " + (phase.support || "viip"),
        style: this.place(phase.from, phase.until), "data-id": phase.pointer,
        title: `${words}, ${seconds(phase.from)} to ${seconds(phase.until)}`,
        "aria-label": `Phase ${i + 1}: ${words}, ${seconds(phase.from)} to ${seconds(phase.until)}`,
        "aria-pressed": String(this.page.isSelected(thing)),
        onclick: () => this.page.select(thing, phase.from) },
      this.wide(phase.until - phase.from) > 7.5 * words.length ? element("span", {}, words) : null));
      if (!this.page.can("edit") || !this.visible(phase.until, phase.until)) return;
      const movable = canDrag(phase.until_value, phase), why = reasonAgainst("the end of this phase", phase.repeated);
      const grip = element("button", { type: "button", class: "grip", style: this.place(phase.until),
        "data-id": phase.until_pointer, title: `End of phase ${i + 1}: ${movable ? "drag, or Ctrl and arrow keys" : why}`,
        "aria-label": `End of phase ${i + 1} at ${seconds(phase.until)}`,
        onclick: () => this.page.select(thing, phase.until) });
      if (movable)
        this.movable(grip, { time: phase.until, room: roomOfPhase(state.phases, i), words: "phase",
          edits: (t) => movePhase(this.page.state, i, t, byId("keys-along").checked) });
      else this.fixed(grip, why);
      parts.push(grip);
    });
    return this.lane("Phases", parts, "phases");
  }

  track(track) {
    const parts = [], name = nameOfTrack(track);
    for (const key of track.keys) {
      if (!this.visible(key.time, key.time)) continue;
      const thing = { kind: "key", pointer: key.pointer };
      const mark = element("button", { type: "button", class: "key", style: this.place(key.time),
        "data-id": key.pointer, "data-time": key.time_pointer,
        title: `${name} ${valueWords(key.value)} at ${seconds(key.time)}` +
          (typeof key.time_value === "string" ? ` (written as ${key.time_value})` : ""),
        "aria-label": `${name} key at ${seconds(key.time)}: ${valueWords(key.value)}`,
        "aria-pressed": String(this.page.isSelected(thing)),
        onclick: () => this.page.select(thing, key.time) });
      this.dropPosture(mark, key);
      if (this.page.can("edit") && canDrag(key.time_value, key))
        this.movable(mark, { time: key.time, room: roomOfKey(this.page.state.keyframes, key.pointer),
          words: "key", edits: (t) => moveKey(key, t),
          together: `[data-time="${key.time_pointer}"]` });
      else if (this.page.can("edit")) this.fixed(mark, reasonAgainst("the time of this key", key.repeated));
      if (this.page.can("edit"))
        mark.addEventListener("keydown", (event) => {
          if (event.key !== "Delete") return;
          event.preventDefault();
          this.page.inspector.remove(key);
        });
      parts.push(mark);
    }
    return this.lane(name, parts, "track");
  }

  /// Gives the focus to the selected thing of the timeline.
  focusSelected() {
    byId("time").querySelector(".plot > [aria-pressed=true]")?.focus();
  }

  /// All things of all lanes, from the top.
  things() {
    return ["lane-phases", "lane-tracks", "lane-events"].flatMap((id) => [...byId(id).querySelectorAll(".plot > button")]);
  }

  /// The Tab key stops at one thing of the timeline.
  stopAt(thing) {
    if (!thing) return;
    for (const part of this.things()) part.tabIndex = part === thing ? 0 : -1;
    this.stop = thing.dataset.id;
  }

  /// The thing of the next lane above (-1) or below (1) that is nearest to a place.
  beside(part, way, place) {
    const plots = [...new Set(this.things().map((one) => one.parentElement))];
    const away = (one) => Math.max(0, one.offsetLeft - place, place - one.offsetLeft - one.offsetWidth);
    return [...plots[plots.indexOf(part.parentElement) + way]?.children ?? []]
      .reduce((best, one) => !best || away(one) < away(best) ? one : best, null);
  }

  /// The arrow keys go from one thing to the next in its lane and to the lanes above and below, and
  /// Enter goes to the values of the selected thing.
  walkable(parts) {
    for (const part of parts) {
      part.tabIndex = -1;
      part.addEventListener("focus", () => {
        this.stopAt(part);
        this.column = null;
      });
      part.addEventListener("keydown", (event) => {
        if (event.key === "Enter" && part.hasAttribute("aria-pressed") && !event.ctrlKey) {
          event.preventDefault();
          part.click();
          this.page.inspector.focusValues();
          return;
        }
        if (event.ctrlKey || !/^Arrow/.test(event.key)) return;
        event.preventDefault();
        // Several steps up or down keep the horizontal place at which the first of them began.
        const way = { ArrowUp: -1, ArrowDown: 1 }[event.key], column = this.column ?? part.offsetLeft + part.offsetWidth / 2;
        const next = way ? this.beside(part, way, column)
          : event.key === "ArrowRight" ? part.nextElementSibling : part.previousElementSibling;
        if (!next) return;
        next.focus();
        if (next.classList.contains("key")) next.click();
        if (way) this.column = column;
      });
    }
  }

  /// If a posture is dropped on a key, it becomes the posture of its keyframe.
  dropPosture(mark, key) {
    mark.addEventListener("dragover", (event) => {
      if (!event.dataTransfer.types.includes("text/ayumi-posture")) return;
      event.preventDefault();
      mark.classList.add("over");
    });
    mark.addEventListener("dragleave", () => mark.classList.remove("over"));
    mark.addEventListener("drop", (event) => {
      event.preventDefault();
      this.page.putPosture(event.dataTransfer.getData("text/ayumi-posture"), key.time);
    });
  }

  disturbances(state) {
    const parts = [];
    for (const one of state.disturbances) {
      const until = Math.max(one.until ?? one.from, one.from);
      if (!this.visible(one.from, until)) continue;
      const thing = { kind: "disturbance", pointer: one.pointer };
      const mark = element("button", { type: "button", class: "disturbance",
        style: this.place(one.from, Math.min(until, state.duration)), "data-id": one.pointer,
        title: `${one.type}: ${one.text}, from ${seconds(one.from)}`,
        "aria-label": `Disturbance ${one.type}, ${one.text}, at ${seconds(one.from)}`,
        "aria-pressed": String(this.page.isSelected(thing)),
        onclick: () => this.page.select(thing, one.from) }, element("span", {}, one.text));
      if (this.page.can("edit"))
        mark.addEventListener("keydown", (event) => {
          if (event.key !== "Delete") return;
          event.preventDefault();
          this.page.edit([{ kind: "remove", pointer: one.pointer }]);
        });
      if (this.page.can("edit") && one.at_pointer && canDrag(one.at_value))
        this.movable(mark, { time: one.from, room: [0, 3600], words: "disturbance",
          edits: (t) => [{ kind: "set", pointer: one.at_pointer, value: roundedTime(t) }] });
      parts.push(mark);
    }
    return this.lane("Disturbances", parts, "events");
  }

  findings(state) {
    const parts = [];
    // Errors are drawn last, above the warnings and notes of the same time.
    const rank = { info: 0, warning: 1, error: 2 };
    const order = state.findings.map((finding, i) => [finding, i]).sort(([a], [b]) => rank[a.severity] - rank[b.severity]);
    order.forEach(([finding, i]) => {
      if (!this.visible(finding.begin, finding.end)) return;
      parts.push(element("button", { type: "button", class: "finding " + finding.severity,
        style: this.place(finding.begin, finding.end), "data-id": "finding " + i,
        title: finding.message, "aria-label": `${finding.severity}: ${finding.message}`,
        onclick: () => this.page.showFinding(finding) }));
    });
    for (const mark of state.result?.marks || [])
      if (this.visible(mark.time, mark.time))
        parts.push(element("button", { type: "button", class: "mark", style: this.place(mark.time),
          title: `${mark.text}, ${seconds(mark.time)}`,
          "aria-label": `Result: ${mark.text}, ${seconds(mark.time)}`,
          onclick: () => this.page.show(mark.time) }));
    return this.lane("Findings", parts, "events");
  }

  /// Says why a thing does not move if the author tries to move it.
  fixed(mark, why) {
    mark.addEventListener("pointerdown", (down) => {
      if (down.button !== 0) return;
      mark.setPointerCapture(down.pointerId);
      const moved = (event) => {
        if (Math.abs(event.clientX - down.clientX) < leastDrag) return;
        mark.removeEventListener("pointermove", moved);
        this.page.say(why);
      };
      mark.addEventListener("pointermove", moved);
      mark.addEventListener("lostpointercapture", () => mark.removeEventListener("pointermove", moved), { once: true });
    });
    mark.addEventListener("keydown", (event) => {
      if (!event.ctrlKey || !/^Arrow(Left|Right)$/.test(event.key)) return;
      event.preventDefault();
      this.page.say(why);
    });
  }

  /// Makes a thing movable by dragging, or by Ctrl and the arrow keys (with Shift by 1 ms). A move
  /// by keys is written after a short pause.
  movable(mark, { time, room, edits, together }) {
    let shown = time, timer = 0;
    const { version } = this.page.state;
    const clamp = (t) => Math.min(room[1], Math.max(room[0], t));
    const move = (t) => {
      shown = roundedTime(clamp(t));
      const shift = together ? byId("lane-tracks").querySelectorAll(together) : [mark];
      for (const one of shift) one.style.left = `${100 * this.page.axis.shareOf(shown)}%`;
      byId("time-tip").textContent = seconds(shown);
      byId("said").textContent = seconds(shown);
    };
    const end = (write) => {
      this.dragged = null;
      byId("time-tip").hidden = true;
      mark.classList.remove("dragged");
      // The file has changed, so that what is dragged may be another thing now.
      const changed = this.page.state.version !== version;
      if (write && changed) this.page.say("The file changed while you dragged, so nothing was written. Please drag again.");
      const list = write && !changed ? edits(shown) : [];
      if (list.length) this.page.edit(list);
      else this.render();
      if (this.late) {
        this.late = false;
        this.render();
      }
    };
    mark.classList.add("movable");
    mark.addEventListener("pointerdown", (down) => {
      if (down.button !== 0) return;
      const plot = mark.parentElement.getBoundingClientRect(), begin = down.clientX;
      const others = this.times().filter((t) => Math.abs(t - time) > 5e-4);
      let begun = false;
      mark.setPointerCapture(down.pointerId);
      const moved = (event) => {
        if (!begun && Math.abs(event.clientX - begin) < leastDrag) return;
        if (!begun) {
          begun = true;
          this.dragged = mark;
          mark.classList.add("dragged");
          byId("time-tip").hidden = false;
        }
        const perPixel = (this.page.axis.to - this.page.axis.from) / plot.width;
        const wanted = time + (event.clientX - begin) * perPixel;
        move(event.shiftKey ? wanted : snapped(wanted, others, 6 * perPixel));
        byId("time-tip").style.left = `${event.clientX}px`;
        byId("time-tip").style.top = `${event.clientY - 34}px`;
      };
      const stop = (write) => {
        mark.removeEventListener("pointermove", moved);
        mark.removeEventListener("pointerup", up);
        mark.removeEventListener("pointercancel", cancel);
        mark.removeEventListener("lostpointercapture", cancel);
        removeEventListener("keydown", escape, true);
        if (!begun) return;
        // The click that ends a drag does not select anything.
        const swallow = (event) => event.stopImmediatePropagation();
        mark.addEventListener("click", swallow, { capture: true, once: true });
        setTimeout(() => mark.removeEventListener("click", swallow, true));
        end(write);
      };
      const up = () => stop(true), cancel = () => stop(false);
      const escape = (event) => { if (event.key === "Escape") stop(false); };
      mark.addEventListener("pointermove", moved);
      mark.addEventListener("pointerup", up);
      mark.addEventListener("pointercancel", cancel);
      mark.addEventListener("lostpointercapture", cancel);
      addEventListener("keydown", escape, true);
    });
    mark.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      // Takes back a move that is not written yet, and nothing before it.
      const back = event.key === "Escape" || (event.ctrlKey && !event.shiftKey && event.key.toLowerCase() === "z");
      if (back && timer) {
        clearTimeout(timer);
        timer = 0;
        event.preventDefault();
        event.stopPropagation();
        end(false);
      }
      if (!way || !event.ctrlKey) return;
      event.preventDefault();
      this.dragged = mark;
      clearTimeout(timer);
      move(shown + way * (event.shiftKey ? 0.001 : 0.01));
      timer = setTimeout(() => { timer = 0; end(true); }, 500);
    });
  }

  /// The time at which the author points: that of a nearby key or end of a phase, otherwise a round
  /// time.
  pointed(t, perPixel) {
    const { state } = this.page, step = roundStep(perPixel);
    const near = snapped(t, [...state.phases.map((phase) => phase.until), ...state.keyframes.map((frame) => frame.time)], 4 * perPixel);
    return near !== t ? near : roundedTime(Math.round(t / step) * step);
  }

  /// Times to which a dragged thing snaps.
  times() {
    const { state, time } = this.page;
    return [time, ...state.phases.map((phase) => phase.until),
      ...state.keyframes.map((frame) => frame.time)];
  }
}
