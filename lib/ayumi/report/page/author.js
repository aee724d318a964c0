// The live page of `ayumi author`: it shows the pattern that the server reads, and sends the
// author's changes to it. The picture, the timeline, the strip and the curves share one time and
// one window of time.

import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { Vector3 } from "three";
import { chooseVersion } from "./conflict.js";
import { Curves } from "./curves.js";
import { byId, element, fixed, refill, seconds } from "./dom.js";
import { parsePattern } from "./fields.js";
import { Handles } from "./handles.js";
import { Inspector } from "./inspector.js";
import { Jobs } from "./jobs.js";
import { linked } from "./places.js";
import { withUnits } from "./parts.js";
import { Pose } from "./pose.js";
import { Postures } from "./postures.js";
import { arrowsOf } from "./push_parts.js";
import { Pushes } from "./pushes.js";
import { Rig } from "./rig.js";
import { sampleAt, hasZmp } from "./series.js";
import { Server } from "./server.js";
import { Strip } from "./strip.js";
import { TimeAxis } from "./time_axis.js";
import { Timeline } from "./timeline.js";
import { Viewer, bodyOf } from "./viewer.js";

const motionWords = { plan: "the pattern", ghost: "last consistent", repair: "repaired",
  open_loop: "run in open loop", closed_loop: "run with the control law" };
const tabs = ["answers", "edit", "pose", "postures", "pushes", "text"];

/// Values of a state for members that the server does not send.
const nothing = { features: [], motions: ["plan"], findings: [], groups: [], phases: [], tracks: [], keyframes: [],
  disturbances: [], joints: [], handles: [], targets: [], postures: [], own_postures: [], strips: {},
  result: null, error: null, stale: false };

class Page {
  constructor() {
    this.state = null;
    this.selection = null;
    this.finding = null;
    this.drawing = false;
    this.previewed = null;
    this.axis = new TimeAxis();
    this.writing = Promise.resolve();
    this.server = new Server({ state: (version) => this.hears(version), job: (news) => this.news(news),
      lost: () => { byId("lost").hidden = false; },
      found: () => { byId("lost").hidden = true; this.load(); } });
    this.timeline = new Timeline(this);
    this.lanes = new Strip(this);
    this.curves = new Curves(this);
    this.inspector = new Inspector(this);
    this.pose = new Pose(this);
    this.postures = new Postures(this);
    this.pushes = new Pushes(this);
    this.jobs = new Jobs(this);
    this.connect();
    this.server.listen();
  }

  get time() {
    return this.viewer ? this.viewer.time : 0;
  }

  can(feature) {
    return this.state.features.includes(feature);
  }

  // ---- what the server knows

  /// Loads the state after a message of the server. The page already knows the changes that it has
  /// made itself.
  hears(version) {
    if (this.loading || !(this.state?.version >= version)) this.load();
  }

  /// Loads the latest state. While one is being loaded, at most one more is requested.
  load() {
    this.again = Boolean(this.loading);
    if (!this.loading)
      this.loading = (async () => {
        do {
          this.again = false;
          try {
            await this.take(await this.server.state());
          } catch (error) {
            this.say("The state cannot be shown: " + error.message);
          }
        } while (this.again);
        this.loading = null;
      })();
    return this.loading;
  }

  async take(latest) {
    const state = { ...nothing, ...latest };
    if (this.state) this.follow(this.state, state);
    this.state = state;
    this.document = parsePattern(state.text);
    document.title = `${state.file} – Ayumi author`;
    byId("file").textContent = state.file;
    this.showError(state);
    if (state.replay) {
      this.columns = Object.fromEntries(state.replay.columns.map((name, i) => [name, i]));
      this.chooseMotions(state);
      await this.fetchMotions();
      if (!this.viewer) await this.build();
      else this.viewer.replace(this.whole());
      this.axis.stretch(Math.max(state.duration, this.viewer.last, state.error ? state.phases.at(-1)?.until ?? 0 : 0));
      byId("scrub").max = String(this.viewer.last);
      this.handles.take(state.handles);
      this.handles.takeTargets(state.targets);
      this.previewed = null;
      if (this.finding && !state.findings.some((one) => one.message === this.finding.message)) this.leaveFinding();
      this.render();
      if (this.pose.asked) this.pose.ask({ ...this.pose.asked });
    } else this.renderText();
    document.documentElement.dataset.author = state.replay ? "ready" : "error";
    document.documentElement.dataset.version = String(state.version);
  }

  /// Keeps the same thing selected if things before it were added or removed.
  follow(before, now) {
    const list = { phase: "phases", disturbance: "disturbances" }[this.selection?.kind];
    if (list) {
      const thing = before[list].find((one) => one.pointer === this.selection.pointer);
      // Several disturbances may begin at the same time. The selection stays on the same one of
      // them.
      const at = (all) => all.filter((one) => thing && Math.abs(one.from - thing.from) < 5e-4);
      const there = at(now[list]);
      const same = now[list].length !== before[list].length && (there[at(before[list]).indexOf(thing)] ?? there.at(-1));
      if (same) this.selection = { kind: this.selection.kind, pointer: same.pointer };
    }
    if (this.selection?.kind !== "key") return;
    for (const track of before.tracks) {
      const key = track.keys.find((one) => one.pointer === this.selection.pointer);
      const same = key && now.tracks.find((one) => one.name === track.name)?.keys
        .find((one) => Math.abs(one.time - key.time) < 5e-4);
      if (same) this.selection = { kind: "key", pointer: same.pointer };
    }
  }

  whole() {
    return { config: { ...this.state.replay, view: byId("look").value, pushes: arrowsOf(this.state.disturbances) }, series: this.motion,
      scenery: this.scenery };
  }

  /// Chooses the shown motion and the ghost among the motions that exist now.
  chooseMotions(state) {
    const there = state.motions;
    const fill = (select, names, wanted) => {
      const known = select.options.length > 0;
      select.replaceChildren(...names.map(([value, words]) => element("option", { value }, words)));
      select.value = known && names.some(([value]) => value === wanted) ? wanted : names[0][0];
    };
    const named = there.map((name) => [name, motionWords[name] || name]);
    fill(byId("which"), named, byId("which").value);
    fill(byId("ghost"), [["auto", "automatic"], ["", "none"], ...named], byId("ghost").value);
  }

  ghostName() {
    const chosen = byId("ghost").value, { state } = this, shown = byId("which").value;
    const there = state.motions;
    if (chosen !== "auto") return chosen === shown ? "" : chosen;
    if (state.stale) return "";
    if (shown === "plan" && there.includes("repair")) return "repair";
    if (shown === "plan" && !state.consistent && there.includes("ghost")) return "ghost";
    return shown === "plan" ? "" : "plan";
  }

  async series(which) {
    const bytes = await this.server.bytes(`series?version=${this.state.version}&which=${which}`);
    if (!bytes) return null;
    const table = new Float32Array(bytes), width = this.state.replay.columns.length;
    return { table, width, rows: table.length / width, columns: this.columns };
  }

  async fetchMotions() {
    const ghost = this.ghostName(), shown = byId("which").value;
    const [motion, other, scenery, plan] = await Promise.all([this.series(shown),
      ghost ? this.series(ghost) : null, this.server.bytes(`scenery?version=${this.state.version}`),
      shown === "plan" ? null : this.series("plan")]);
    if (!motion) throw new Error("the motion is missing");
    this.motion = motion;
    this.plan = plan || motion;
    this.ghostMotion = other;
    this.scenery = new Float32Array(scenery || 0);
  }

  async build() {
    const bytes = await this.server.bytes("model.glb");
    const gltf = await new GLTFLoader().parseAsync(bytes, "");
    const model = gltf.scene, other = gltf.scene.clone(true);
    const hooks = { fills: true, shown: (mark) => byId("mark-" + mark).checked,
      moved: (time, row, push) => this.moved(time, row, push),
      played: (on) => { byId("play").textContent = on ? "Pause" : "Play"; } };
    this.viewer = new Viewer(byId("stage"), this.whole(), { ...gltf, animations: [] }, hooks);
    this.viewer.renderer.domElement.setAttribute("aria-label",
      "The robot in 3-D. Drag turns the view, the wheel changes the distance.");
    this.rig = new Rig(model, this.state.replay);
    this.ghostRig = new Rig(other, this.state.replay);
    this.viewer.addMoved("shown", model, false, (t) => this.rig.place(this.previewed || sampleAt(this.motion, t)));
    this.viewer.addMoved("ghost", other, true, (t) => {
      if (this.ghostMotion) this.ghostRig.place(sampleAt(this.ghostMotion, t));
    });
    this.handles = new Handles(this);
  }

  // ---- what is shown

  row() {
    return this.previewed || sampleAt(this.motion, this.time);
  }

  /// The row of the pattern at a time, whatever is shown. New keys and edits change the pattern.
  planRow(t = this.time) {
    return this.showsPlan() && this.previewed ? this.previewed : sampleAt(this.plan, t);
  }

  /// The corners of the soles at the start of the pattern, in the world.
  solesAtStart() {
    const [actor] = this.viewer.actors;
    this.rig.place(sampleAt(this.plan, 0));
    actor.root.updateMatrixWorld(true);
    const corners = this.state.replay.soles.flatMap((sole) => {
      const body = bodyOf(actor, sole.body);
      return sole.corners.map((corner) => body.localToWorld(new Vector3(...corner)).toArray());
    });
    this.rig.place(this.row());
    return corners;
  }

  showsPlan() {
    return byId("which").value === "plan";
  }

  /// Shows the pattern, because a change of the posture changes the pattern. Returns true if it was
  /// not shown before.
  async showPlan() {
    if (this.showsPlan()) return false;
    byId("which").value = "plan";
    await this.changeMotions();
    this.say("The pattern is shown now, because this changes the pattern.");
    return true;
  }

  /// The lanes of the strip for the shown motion: the pattern, a repaired motion, or a run.
  strip() {
    const { strips } = this.state, own = strips[byId("which").value];
    return { ...own ?? strips.plan ?? { lanes: [], dt: 0.01 }, own: Boolean(own) };
  }

  show(t) {
    if (!this.viewer) return;
    if (this.pose.asked && Math.abs(t - this.time) > 1e-6) {
      this.say(`The change of the posture at ${seconds(this.time)} was not written.`);
      this.pose.forget();
      this.previewed = null;
    }
    this.viewer.show(t);
    if (this.time < this.axis.from || this.time > this.axis.to) {
      this.axis.reveal(this.time);
      this.renderTime();
    }
  }

  /// Shows another posture than that of the motion at this time, or the motion's posture again.
  preview(row) {
    if (!this.viewer) return;
    this.previewed = row;
    this.viewer.actors[0].move(this.time);
    this.viewer.place(this.row());
    this.handles.place(this.row());
    if (!row) this.pose.moved(this.row());
    this.viewer.draw();
  }

  moved(time, row) {
    if (!this.handles) return;
    this.paint();
    this.handles.place(row);
    byId("scrub").value = String(time);
    const feet = ["left", "right"].filter((side) => row[this.columns[side + "_planned"]] > 0.5);
    const support = feet.length === 2 ? "both feet" : feet.length ? feet[0] + " foot" : "flight";
    byId("scrub").setAttribute("aria-valuetext", `${time.toFixed(2)} seconds, ${support}`);
    const mm = (name) => fixed(1000 * row[this.columns[name]], 1);
    byId("readout").textContent = `t ${time.toFixed(3)} s · ${support} · COG ${["x", "y", "z"].map((a) => mm("cog." + a)).join(", ")} mm · ` +
      `ZMP ${hasZmp(row, this.columns, this.viewer.config.least_zmp_force) ? ["x", "y"].map((a) => mm("zmp." + a)).join(", ") + " mm" : "none"} · f_z ${row[this.columns.fz].toFixed(1)} N`;
    if (this.viewer.playing) this.previewed = null;
    this.moveCursor();
    this.lanes.moved(time);
    this.curves.moved(time);
    this.pose.moved(row);
    this.inspector.moved();
    this.postures.moved();
    this.pushes.moved();
  }

  moveCursor() {
    const share = this.axis.shareOf(this.time), cursor = byId("cursor");
    cursor.hidden = share < -1e-9 || share > 1 + 1e-9;
    cursor.style.setProperty("--share", share.toFixed(6));
    cursor.style.setProperty("--tall", "0px");
    cursor.style.setProperty("--tall", byId("time").scrollHeight + "px");
  }

  /// Paints limbs red if the selected finding names them, and everything else grey if the motion is
  /// old.
  paint() {
    const now = this.finding && this.time >= this.finding.begin - 0.05 && this.time <= this.finding.end + 0.05
      ? this.finding : null;
    this.rig.paint(now ? this.bodiesOf(now) : [], this.state.stale);
    const wrong = now && this.isOfSole(now);
    this.viewer.marks.outline.material.color.set(wrong ? 0xd6261f : 0x1a73cc);
    this.viewer.marks.area.material.color.set(wrong ? 0xd6261f : 0x1a73cc);
  }

  isOfSole(finding) {
    return Boolean(finding.side) || /support|zmp|dcm|foot|sole|yaw|friction|slip/.test(finding.kind);
  }

  bodiesOf(finding) {
    const { joints, bodies, soles } = this.state.replay, index = joints.indexOf(finding.joint);
    const found = [...finding.bodies || []];
    if (index >= 0) found.push(bodies.findIndex((body) => body.joint === index));
    if (!found.length && finding.side) found.push(soles.find((sole) => sole.side === finding.side)?.body);
    return found.filter((body) => body >= 0);
  }

  showFinding(finding) {
    this.finding = finding;
    this.viewer.play(false);
    if (finding.joint) this.curves.bring("q." + finding.joint);
    this.show(finding.at);
    this.bring(finding);
    this.openTab("answers");
    this.renderFindings();
    this.say(`${finding.message} at ${seconds(finding.at)}`);
  }

  /// Moves the camera near to the place of a finding without changing its side; soles are viewed
  /// from higher up.
  bring(finding) {
    const { viewer } = this, size = viewer.config.height, bodies = this.bodiesOf(finding), center = new Vector3();
    for (const body of bodies) center.add(bodyOf(viewer.actors[0], body).getWorldPosition(new Vector3()));
    if (bodies.length) center.divideScalar(bodies.length);
    else if (this.isOfSole(finding)) center.copy(viewer.vector("zmp", this.row()));
    else return;
    const way = viewer.camera.position.clone().sub(viewer.orbit.target);
    this.wayBefore ??= way.clone();
    way.normalize();
    if (!bodies.length || finding.side) way.z = 0.9;
    viewer.orbit.target.copy(center);
    viewer.camera.position.copy(center).addScaledVector(way.normalize(), 1.9 * size);
    viewer.orbit.update();
    viewer.draw();
  }

  /// Ends the view of a finding: the camera moves back to its previous place.
  leaveFinding() {
    const { viewer } = this;
    this.finding = null;
    if (!this.wayBefore) return;
    viewer.orbit.target.copy(viewer.focus(this.row()));
    viewer.camera.position.copy(viewer.orbit.target).add(this.wayBefore);
    this.wayBefore = null;
    viewer.orbit.update();
    this.renderFindings();
  }

  isSelected(thing) {
    return this.selection?.kind === thing.kind && this.selection.pointer === thing.pointer;
  }

  /// The server knows which joint is the mirror image of which.
  async mirror(pointer) {
    const { status, value } = await this.server.ask("POST", "mirror", { pointer });
    if (status !== 200) return this.say(value.message || "The keyframe cannot be mirrored.");
    if (!value.edits.length) return this.say("The keyframe is its own mirror image.");
    return value.text ? this.write(value.text, value.hash) : this.edit(value.edits);
  }

  select(thing, time) {
    this.selection = thing;
    this.leaveFinding();
    if (time !== undefined) this.show(time);
    this.openTab("edit");
    this.timeline.render();
    this.inspector.render();
  }

  render() {
    const { state, viewer } = this, { findings } = state;
    const errors = findings.filter((one) => one.severity === "error").length;
    const verdict = byId("verdict");
    verdict.className = state.error ? "bad" : state.consistent ? "good" : "bad";
    verdict.textContent = state.error ? this.noMotion() : state.consistent ? "consistent"
      : state.consistent === undefined ? "" : errors === 1 ? "1 error" : `${errors} errors`;
    for (const [id, count] of [["undo", state.undo], ["redo", state.redo]]) {
      byId(id).parentElement.hidden = !this.can("undo");
      byId(id).disabled = !count;
    }
    byId("time").classList.toggle("stale", state.stale);
    byId("keys-along").parentElement.hidden = !this.can("edit");
    byId("show-handles").parentElement.hidden = !this.can("pose.drag");
    byId("mark-targets").parentElement.hidden = !state.targets.length;
    byId("to-pose").hidden = !this.can("pose.joints") && !this.can("pose.drag");
    byId("to-postures").hidden = !this.can("posture") && !state.postures.length;
    this.renderFindings();
    this.renderText();
    this.renderTime();
    this.inspector.render();
    this.postures.render();
    this.pushes.render();
    this.jobs.render();
    viewer.switchMarks(this.ghostMotion ? ["ghost"] : []);
    this.pose.render();
  }

  renderTime() {
    if (!this.state.replay) return;  // there is no motion yet
    this.timeline.render();
    this.lanes.render();
    this.curves.render();
    this.moveCursor();
  }

  renderFindings() {
    const { findings, error } = this.state;
    byId("to-answers").textContent = findings.length ? `Answers (${this.groups().length})` : "Answers";
    const old = error && findings.length ? [element("p", { class: "soft" },
      `These findings are about the old motion, because the changed pattern ${this.noMotion()}.`)] : [];
    refill(byId("findings"), findings.length ? [...old, ...this.groups().map((group) => this.answer(group))]
      : [element("p", { class: error ? "soft" : "good" }, error ? `The pattern ${this.noMotion()}, so there are no findings.`
        : this.state.consistent ? "Nothing is wrong: the motion is consistent." : "")]);
  }

  /// The findings by cause, as `ayumi check` groups them.
  groups() {
    const { findings, groups } = this.state;
    return groups.length ? groups : findings.map((one, i) => ({ worst: i, members: [i], places: one.where, consequences: [] }));
  }

  answer({ worst, members, places, consequences }) {
    const { findings } = this.state, one = findings[worst];
    const times = members.length > 1 ? `${members.length} times, worst at ${seconds(one.at)}` : `at ${seconds(one.at)}`;
    return element("button", { type: "button", class: "answer " + one.severity, "data-id": "answer " + worst,
      "aria-pressed": String(members.some((i) => findings[i] === this.finding)), onclick: () => this.showFinding(one) },
    element("span", {}, element("strong", {}, { error: "Error", warning: "Warning", info: "Info" }[one.severity]), " " + times),
    element("span", {}, one.message),
    places !== one.where && members.length > 1 ? element("span", {}, `The same finding at: ${places}`) : null,
    one.hint ? element("span", { class: "soft" }, one.hint) : null,
    consequences.length ? element("span", { class: "soft" }, `Consequences: ${consequences.join("; ")}`) : null);
  }

  renderText() {
    if (byId("tab-text").hidden) return;
    const { text, error } = this.state;
    byId("text").replaceChildren(...(text || "").split("\n").map((line, i) =>
      element("span", { class: error && i + 1 === error.line ? "wrong" : null }, line || " ")));
    byId("text").querySelector(".wrong")?.scrollIntoView({ block: "center" });
  }

  showError({ error, stale, replay, features }) {
    byId("error").hidden = !error;
    byId("error-place").textContent = error ? error.line ? `Line ${error.line}:` : "Error:" : "";
    byId("error-words").replaceChildren(...error ? linked(this, error.message + (stale && replay
      ? (/[.!?]$/.test(error.message) ? "" : ".") + " The picture shows the old motion in grey." +
        (features.includes("edit") ? "" : " The pattern can be changed here again when the file can be read; Undo takes changes back.") : "")) : []);
    byId("error-go").hidden = !error?.line;
    if (error && !replay) byId("verdict").textContent = this.noMotion();
  }

  /// Why the text has no motion: it is not a pattern, or the robot cannot do what it says.
  noMotion() {
    return this.can("edit") ? "gives no motion" : "cannot be read";
  }

  openTab(name) {
    if (byId("to-" + name).getAttribute("aria-selected") === "true") return;
    for (const one of tabs) {
      const on = one === name;
      byId("to-" + one).setAttribute("aria-selected", String(on));
      byId("to-" + one).tabIndex = on ? 0 : -1;
      byId("tab-" + one).hidden = !on;
    }
    if (name === "text") this.renderText();
    if (name === "pose" && this.viewer) this.pose.moved(this.row());
  }

  say(words) {
    clearTimeout(this.saying);
    byId("said").textContent = words;
    this.saying = setTimeout(() => { byId("said").textContent = ""; }, 6000);
  }

  // ---- actions of the author

  /// Sends edits. Returns true if they are in the file. Edits are sent one after the other, each
  /// for the text after the previous one.
  edit(edits) {
    const all = withUnits(this.document, edits, this.state.angle_unit);
    return this.post("edit", (hash) => ({ hash, edits: all }), all.some((one) => one.kind !== "set"));
  }

  /// Replaces the text; `base` is the hash of the version from which it was made, if not the last.
  write(text, base) {
    return this.post("edit", (hash) => ({ hash: base ?? hash, text }), true);
  }

  post(path, bodyWith, moves) {
    const seen = this.state.version;
    const turn = this.writing.then(async () => {
      // An edit that adds or removes an element changes the places of later elements.
      if (this.movedSince > seen) {
        this.say("The file has just changed; please do this again.");
        return false;
      }
      let { status, value } = await this.server.ask("POST", path, bodyWith(this.state.hash));
      if (status === 409) {
        if (await chooseVersion(value) === "mine")
          ({ status, value } = await this.server.ask("POST", "edit", { hash: value.theirs_hash, text: value.mine }));
        else {
          await this.load();
          return false;
        }
      }
      if (status !== 200) this.refusal = value.message || `The server refuses this change (${status}). Please reload the page.`;
      if (status !== 200) this.say(this.refusal);
      else if (byId("said").textContent === this.refusal) this.say("");  // it was about another change
      await this.load();
      if (status === 200 && moves) this.movedSince = this.state.version;
      if (status !== 200) this.timeline.render();
      return status === 200;
    }).catch((error) => {
      this.say("The server does not answer: " + error.message);
      return false;
    });
    this.writing = turn;
    return turn;
  }

  history(path) {
    if (this.can("undo") && this.state[path]) this.post(path, (hash) => ({ hash }), true);
  }

  putPosture(name, time) {
    return this.postures.put(name, time);
  }

  async news(job) {
    this.jobs.news(job);
    if (!job.done) return;
    await this.load();
    if (job.error) return;
    this.openTab("answers");
    byId("tab-answers").scrollTop = 0;
    if (job.kind !== "simulate") return;
    const run = ["closed_loop", "open_loop"].find((name) => this.state.motions.includes(name));
    if (run) {
      byId("which").value = run;
      await this.changeMotions();
    }
  }

  async changeMotions() {
    await this.fetchMotions();
    this.viewer.replace(this.whole());
    byId("scrub").max = String(this.viewer.last);
    this.axis.stretch(Math.max(this.state.duration, this.viewer.last));
    this.render();
  }

  nextFinding(way) {
    const all = [...this.state.findings].sort((a, b) => a.at - b.at);
    if (!all.length) return;
    const i = all.findIndex((one) => one === this.finding);
    this.showFinding(all[i < 0 ? (way > 0 ? 0 : all.length - 1) : (i + way + all.length) % all.length]);
  }

  zoom(factor, about = this.time) {
    this.axis.zoom(factor, about);
    this.renderTime();
  }

  connect() {
    const on = (id, event, f) => byId(id).addEventListener(event, f);
    on("play", "click", () => this.viewer?.play(!this.viewer.playing));
    on("scrub", "input", (event) => this.show(Number(event.target.value)));
    on("speed", "change", (event) => { this.viewer.speed = Number(event.target.value); });
    on("look", "change", (event) => {
      this.wayBefore = null;
      this.viewer.look(event.target.value);
    });
    on("which", "change", () => this.changeMotions());
    on("ghost", "change", () => this.changeMotions());
    for (const box of document.querySelectorAll("#marks input"))
      box.addEventListener("change", () => this.viewer.switchMarks(this.ghostMotion ? ["ghost"] : []));
    on("undo", "click", () => this.history("undo"));
    on("redo", "click", () => this.history("redo"));
    on("zoom-in", "click", () => this.zoom(2));
    on("zoom-out", "click", () => this.zoom(0.5));
    on("zoom-all", "click", () => { this.axis.show(0, this.axis.duration); this.renderTime(); });
    on("help-button", "click", () => byId("help").showModal());
    on("error-go", "click", () => { this.openTab("text"); this.renderText(); byId("tab-text").focus(); });
    this.connectTabs();
    this.connectTimeline();
    addEventListener("keydown", (event) => this.pressed(event));
    new ResizeObserver(() => { if (this.viewer) this.renderTime(); }).observe(byId("time"));
  }

  connectTabs() {
    for (const name of tabs) byId("to-" + name).addEventListener("click", () => this.openTab(name));
    document.querySelector("[role=tablist]").addEventListener("keydown", (event) => {
      const shown = tabs.filter((name) => !byId("to-" + name).hidden);
      const i = shown.findIndex((name) => byId("to-" + name) === document.activeElement);
      const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!way || i < 0) return;
      event.preventDefault();
      const next = shown[(i + way + shown.length) % shown.length];
      this.openTab(next);
      byId("to-" + next).focus();
    });
  }

  /// A press beside the keys sets the time. The wheel zooms with Ctrl and moves the window with
  /// Shift.
  connectTimeline() {
    const time = byId("time"), plotOf = (event) => event.target.closest?.(".plot");
    const timeAt = (event, plot) => {
      const box = plot.getBoundingClientRect();
      const t = this.axis.timeOf(Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
      return event.shiftKey || event.ctrlKey ? t : Math.min(this.axis.to, this.timeline.pointed(t, (this.axis.to - this.axis.from) / box.width));
    };
    let plot = null;
    time.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || event.target.closest("button, select, input, label")) return;
      plot = plotOf(event);
      if (!plot) return;
      time.setPointerCapture(event.pointerId);
      this.show(timeAt(event, plot));
    });
    time.addEventListener("pointermove", (event) => { if (plot) this.show(timeAt(event, plot)); });
    for (const name of ["pointerup", "pointercancel"]) time.addEventListener(name, () => { plot = null; });
    time.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.shiftKey) return;
      event.preventDefault();
      const span = this.axis.to - this.axis.from;
      if (event.ctrlKey) this.axis.zoom(event.deltaY < 0 ? 1.25 : 0.8, timeAt(event, byId("ruler")));
      else {
        const shift = Math.sign(event.deltaY || event.deltaX) * 0.1 * span;
        this.axis.show(this.axis.from + shift, this.axis.to + shift);
      }
      this.renderTime();
    }, { passive: false });
  }

  pressed(event) {
    const at = event.target, typing = at.matches?.("input:not([type=checkbox]):not([type=range]), select, textarea");
    if (!this.viewer || document.querySelector("dialog[open]")) return;
    const step = event.shiftKey ? 0.1 : 1 / this.viewer.config.rate, key = event.key;
    // What was being typed is discarded.
    if (key === "Escape" && byId("selected").contains(at)) {
      if (at.dataset.written !== undefined) at.value = at.dataset.written;
      this.timeline.focusSelected();
    }
    if ((event.ctrlKey || event.metaKey) && key.toLowerCase() === "z" && !typing) this.history(event.shiftKey ? "redo" : "undo");
    else if (event.ctrlKey && key.toLowerCase() === "y" && !typing) this.history("redo");
    else if (event.ctrlKey || event.metaKey || event.altKey || typing) return;
    else if (key === "Escape") {
      this.leaveFinding();
      if (this.drawing) this.pushes.draw(false);
      this.pose.drop();
      this.show(this.time);
    } else if (key === " " && !at.matches?.("button, summary, input")) this.viewer.play(!this.viewer.playing);
    else if (key === "," || key === "<" || key === ";") this.show(this.time - step);
    else if (key === "." || key === ">" || key === ":") this.show(this.time + step);
    else if (key === "Home") this.show(0);
    else if (key === "End") this.show(this.viewer.last);
    else if (key.toLowerCase() === "n") this.nextFinding(event.shiftKey ? -1 : 1);
    else return;
    event.preventDefault();
  }
}

const page = new Page();

// Access for tests of the page.
window.ayumiAuthor = {
  page,
  position: (body) => {
    page.viewer.actors[0].root.updateMatrixWorld(true);
    return bodyOf(page.viewer.actors[0], body).getWorldPosition(new Vector3()).toArray();
  },
  pixelOf: (name) => {
    const { viewer, handles } = page;
    viewer.paint();
    const mark = handles.marks.find((one) => one.handle.name === name);
    const at = mark.ball.position.clone().project(viewer.camera);
    const box = viewer.renderer.domElement.getBoundingClientRect();
    return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height];
  },
  pixelOfTarget: (i) => {
    const { viewer, handles } = page, at = handles.targets[i].ball.position.clone();
    viewer.paint();
    at.project(viewer.camera);
    const box = viewer.renderer.domElement.getBoundingClientRect();
    return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height];
  },
  wrongBodies: () => page.rig.meshes.filter(({ mesh, material }) => mesh.material !== material &&
    !page.state.stale).map(({ body }) => body),
};
