// The replay of a report: the robot of the page's .glb moved through time, marks of the run's
// quantities, one time for the scene, the scrub bar and the cursors in the plots.

import {
  AmbientLight, AnimationMixer, BufferAttribute, BufferGeometry, CircleGeometry, Color,
  CylinderGeometry, DirectionalLight, DoubleSide, Group, HemisphereLight, Line, LineBasicMaterial,
  LineLoop, LineSegments, LoopOnce, Mesh, MeshBasicMaterial, MeshLambertMaterial, PCFShadowMap, PerspectiveCamera,
  PlaneGeometry, Quaternion, RingGeometry, Scene, ShadowMaterial, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { clampTime, convexHull, rowAt, sampleAt } from "./series.js";

const byId = (id) => document.getElementById(id);

function bytesOf(id) {
  const words = atob(byId(id).textContent.trim());
  const bytes = new Uint8Array(words.length);
  for (let i = 0; i < words.length; ++i) bytes[i] = words.charCodeAt(i);
  return bytes.buffer;
}

const config = JSON.parse(byId("replay-config").textContent);
const columns = Object.fromEntries(config.columns.map((name, i) => [name, i]));
const table = new Float32Array(bytesOf("replay-series"));
const width = config.columns.length;
const rows = table.length / width;
const series = { table, width, rows, columns };
const last = table[(rows - 1) * width];

const colors = { cog: 0xd9a312, zmp: 0xd6261f, reference: 0x0d4dbf, support: 0x1a73cc,
  force: 0x0d8c59, push: 0xc7409e, ghost: 0x2f7fd0 };

// ---- marks

function disc(inner, outer, color) {
  const shape = inner > 0 ? new RingGeometry(inner, outer, 40) : new CircleGeometry(outer, 40);
  const mark = new Mesh(shape, new MeshBasicMaterial({ color, side: DoubleSide, depthTest: false }));
  mark.renderOrder = 3;
  return mark;
}

/// Along its own y axis, from 0 to 1 when its length is 1.
function arrow(color) {
  const material = new MeshBasicMaterial({ color, depthTest: false, transparent: true });
  const shaft = new Mesh(new CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0), material);
  const head = new Mesh(new CylinderGeometry(0, 1, 1, 16).translate(0, -0.5, 0), material);
  const mark = new Group().add(shaft, head);
  for (const part of [shaft, head]) part.renderOrder = 4;
  return Object.assign(mark, { shaft, head });
}

/// Lines of a grid over -reach..reach, cut at every crossing: some renderers lose a line that
/// begins behind the eye, and then only its nearest piece goes.
function grid(reach, spacing, color) {
  const ends = [], count = Math.round(reach / spacing);
  const cuts = Array.from({ length: 2 * count + 1 }, (_, i) => (i - count) * spacing);
  for (const a of cuts)
    for (let i = 0; i + 1 < cuts.length; ++i)
      ends.push(a, cuts[i], 0, a, cuts[i + 1], 0, cuts[i], a, 0, cuts[i + 1], a, 0);
  return new LineSegments(new BufferGeometry().setAttribute("position",
    new BufferAttribute(new Float32Array(ends), 3)), new LineBasicMaterial({ color }));
}

function makeMarks(size) {
  const marks = {
    cog: new Group(), zmp: disc(0, 0.02 * size, colors.zmp),
    reference: disc(0.026 * size, 0.036 * size, colors.reference),
    support: new Group(), forces: [arrow(colors.force), arrow(colors.force)],
    push: arrow(colors.push),
  };
  const ball = new Mesh(new SphereGeometry(0.022 * size, 24, 16),
    new MeshLambertMaterial({ color: colors.cog, depthTest: false }));
  ball.renderOrder = 5;
  marks.ball = ball;
  marks.plumb = new Line(new BufferGeometry(),
    new LineBasicMaterial({ color: colors.cog, depthTest: false }));
  marks.plumb.renderOrder = 3;
  marks.cog.add(ball, marks.plumb);
  marks.outline = new LineLoop(new BufferGeometry(),
    new LineBasicMaterial({ color: colors.support }));
  marks.area = new Mesh(new BufferGeometry(), new MeshBasicMaterial({
    color: colors.support, transparent: true, opacity: 0.25, side: DoubleSide, depthWrite: false }));
  marks.support.add(marks.outline, marks.area);
  return marks;
}

const vector = (name, row) => new Vector3(
  row[columns[name + ".x"]], row[columns[name + ".y"]], row[columns[name + ".z"]]);

/// Frame of the floor: as it stands, or as a row says where it moves.
function floorAt(row) {
  const at = (name) => row[columns["floor." + name]];
  if (columns["floor.x"] === undefined)
    return { position: new Vector3(...config.floor.position),
      quaternion: new Quaternion(...config.floor.quaternion) };
  return { position: new Vector3(at("x"), at("y"), at("z")),
    quaternion: new Quaternion(at("qx"), at("qy"), at("qz"), at("qw")).normalize() };
}

/// The plane that marks lie on: the ground, or the level above it of the higher foot in contact.
function planeAt(row) {
  const floor = floorAt(row);
  const normal = new Vector3(0, 0, 1).applyQuaternion(floor.quaternion);
  const origin = floor.position.clone().addScaledVector(normal, config.ground_height);
  let level = 0;
  for (const side of ["left", "right"])
    if (vector(side + "_force", row).length() > 0.02 * row[columns.fz] && row[columns.fz] > 0)
      level = Math.max(level, normal.dot(vector(side + "_cop", row).sub(origin)));
  if (level > 5e-4) origin.addScaledVector(normal, level);
  return { normal, origin };
}

/// The point of the plane below p.
function onGround({ normal, origin }, p, lift) {
  const below = new Vector3(p.x, p.y, p.z - normal.dot(p.clone().sub(origin)) / normal.z);
  return below.addScaledVector(normal, lift);
}

function point(mark, from, force, scale) {
  const length = force.length() * scale;
  mark.visible = length > 1e-3;
  if (!mark.visible) return;
  const head = Math.min(0.4 * length, 0.055 * config.height), thin = 0.006 * config.height;
  mark.position.copy(from);
  mark.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), force.clone().normalize());
  mark.shaft.scale.set(thin, length - head, thin);
  mark.head.position.y = length;
  mark.head.scale.set(0.4 * head, head, 0.4 * head);
}

/// Names may be changed on loading; the number of the body is not.
function bodyOf(actor, number) {
  let found = null;
  actor.root.traverse((part) => { if (part.userData.body === number) found = part; });
  return found;
}

// ---- scene

class Replay {
  constructor(stage, gltf) {
    this.time = 0;
    this.playing = false;
    this.speed = 1;
    this.stage = stage;
    this.marks = makeMarks(config.height);
    this.buildScene(gltf);
    this.buildView();
  }

  buildScene(gltf) {
    this.scene = new Scene();
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const paint = () => { this.scene.background = new Color(dark.matches ? 0x23272d : 0xdfe4e9); };
    dark.addEventListener("change", () => { paint(); this.draw(); });
    paint();
    this.scene.add(new HemisphereLight(0xffffff, 0x99938c, 1.6), new AmbientLight(0xffffff, 0.5));
    this.sun = new DirectionalLight(0xffffff, 2.0);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    const reach = 1.2 * config.height;
    Object.assign(this.sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach,
      near: 0.1 * config.height, far: 6 * config.height });
    this.sun.shadow.normalBias = 0.004 * config.height;
    this.scene.add(this.sun, this.sun.target);
    this.scene.add(this.ground());
    this.actors = [];
    this.addActor(gltf.scene, gltf.animations[0], false);
    for (const clip of gltf.animations.slice(1)) this.addActor(gltf.scene.clone(true), clip, true);
    const m = this.marks;
    this.scene.add(m.cog, m.zmp, m.reference, m.support, m.push, ...m.forces);
  }

  /// Grid, what stands on it and what comes up from it, in the floor's frame.
  ground() {
    const ground = this.floor = new Group(), plane = new Group();
    this.grid = new Group().add(grid(3, 0.1, 0xb4bac2), grid(10, 1, 0x747b84));
    const floor = new Mesh(new PlaneGeometry(40, 40), new ShadowMaterial({ opacity: 0.3 }));
    floor.receiveShadow = true;
    this.grid.add(floor);
    plane.add(this.grid);
    plane.position.z = config.ground_height;
    ground.add(plane);
    const solid = (geometry, material) => {
      const mesh = new Mesh(geometry, new MeshLambertMaterial(material));
      mesh.receiveShadow = true;
      plane.add(mesh);
      return mesh;
    };
    const corners = new Float32Array(bytesOf("replay-scenery"));
    if (corners.length) {
      const pick = (from) => new BufferAttribute(Float32Array.from({ length: corners.length / 2 },
        (_, i) => corners[6 * Math.floor(i / 3) + from + i % 3]), 3);
      const color = pick(3);
      for (let i = 0; i < color.array.length; ++i) color.array[i] **= 2.2;
      const shape = new BufferGeometry().setAttribute("position", pick(0))
        .setAttribute("color", color);
      shape.computeVertexNormals();
      solid(shape, { vertexColors: true, side: DoubleSide }).position.z = -config.ground_height;
    }
    this.bumps = config.bumps.map((bump) => {
      const shape = new CylinderGeometry(bump.radius, bump.radius, bump.height, 8);
      shape.rotateX(Math.PI / 2).rotateZ(Math.PI / 8).translate(0, 0, bump.height / 2);
      const mesh = solid(shape, { color: 0xa89980 });
      mesh.position.set(...bump.center);
      return { mesh, ...bump };
    });
    return ground;
  }

  placeFloor(row) {
    const { position, quaternion } = floorAt(row);
    this.floor.position.copy(position);
    this.floor.quaternion.copy(quaternion);
    // The grid comes along in steps that do not show.
    const under = vector("cog", row).sub(position).applyQuaternion(quaternion.clone().invert());
    this.grid.position.set(Math.round(under.x), Math.round(under.y), 0);
    for (const { mesh, begin, end, rise } of this.bumps) {
      const share = Math.min(1, Math.max(0, (this.time - begin) / rise));
      mesh.visible = share > 0 && this.time < end;
      mesh.scale.z = Math.max(1e-3, share ** 3 * (10 - 15 * share + 6 * share ** 2));
    }
  }

  /// glTF's y becomes the world's z again.
  addActor(model, clip, ghost) {
    const actor = { name: clip.name, ghost, root: new Group(), duration: clip.duration };
    actor.root.rotation.x = Math.PI / 2;
    actor.root.add(model);
    model.traverse((part) => {
      if (!part.isMesh) return;
      part.castShadow = !ghost;
      if (ghost) part.material = new MeshLambertMaterial({ color: colors.ghost, transparent: true,
        opacity: 0.28, depthWrite: false });
    });
    actor.mixer = new AnimationMixer(model);
    actor.action = actor.mixer.clipAction(clip);
    actor.action.setLoop(LoopOnce);
    actor.action.clampWhenFinished = true;
    actor.action.play();
    actor.root.visible = !ghost;
    this.scene.add(actor.root);
    this.actors.push(actor);
  }

  buildView() {
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.camera = new PerspectiveCamera(28, 16 / 9, 0.01 * config.height, 100 * config.height);
    this.camera.up.set(0, 0, 1);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "application");
    canvas.setAttribute("aria-roledescription", "3-D replay");
    canvas.setAttribute("aria-label", config.label);
    this.stage.replaceChildren(canvas);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enableZoom = true;
    this.orbit.addEventListener("change", () => this.draw());
    this.look(config.view);
    const fit = () => {
      const wide = this.stage.clientWidth;
      this.renderer.setSize(wide, Math.round(wide * 9 / 16));
      this.draw();
    };
    new ResizeObserver(fit).observe(this.stage);
    fit();
  }

  look(view) {
    const [azimuth, elevation] = { front: [0, 8], side: [-90, 6], back: [180, 8], top: [-90, 80],
      iso: [-40, 20] }[view].map((degrees) => degrees * Math.PI / 180);
    const far = 2.9 * config.height;
    const row = sampleAt(series, this.time);
    this.orbit.target.copy(this.focus(row));
    this.camera.position.copy(this.orbit.target).add(new Vector3(
      far * Math.cos(elevation) * Math.cos(azimuth), far * Math.cos(elevation) * Math.sin(azimuth),
      far * Math.sin(elevation)));
    this.orbit.update();
  }

  focus(row) {
    return onGround(planeAt(row), vector("cog", row), 0.48 * config.height);
  }

  /// Everything at time t: robot, ghosts, marks, camera, plots, controls.
  show(t) {
    const before = this.focus(sampleAt(series, this.time));
    this.time = clampTime(series, t);
    const row = sampleAt(series, this.time);
    for (const actor of this.actors) {
      actor.action.enabled = true;
      actor.action.paused = false;
      actor.action.time = Math.min(this.time, actor.duration);
      actor.mixer.update(0);
    }
    const moved = this.focus(row).sub(before);
    this.orbit.target.add(moved);
    this.camera.position.add(moved);
    this.sun.target.position.copy(this.orbit.target);
    this.sun.position.copy(this.orbit.target).add(
      new Vector3(0.8, -0.9, 2.2).multiplyScalar(config.height));
    this.placeFloor(row);
    this.place(row);
    showValues(this.time, row);
    this.draw();
  }

  place(row) {
    const m = this.marks, size = config.height, cog = vector("cog", row);
    const plane = planeAt(row);
    for (const mark of [m.zmp, m.reference])
      mark.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), plane.normal);
    m.ball.position.copy(cog);
    m.plumb.geometry.setFromPoints([cog, onGround(plane, cog, 0.001 * size)]);
    m.zmp.position.copy(onGround(plane, vector("zmp", row), 0.004 * size));
    m.reference.position.copy(onGround(plane, vector("ref_zmp", row), 0.003 * size));
    ["left", "right"].forEach((side, i) => point(m.forces[i], vector(side + "_cop", row),
      vector(side + "_force", row), 0.5 * size / config.weight));
    this.placeSupport(row, plane);
    const push = config.pushes.find((p) => this.time >= p.begin - 1e-6 &&
      this.time < Math.max(p.end, p.begin + 0.6));
    m.push.visible = Boolean(push) && shown("push");
    if (push) {
      const tip = cog.clone().add(new Vector3(...push.from_cog));
      const along = new Vector3(...push.direction);
      point(m.push, tip.clone().addScaledVector(along, -0.5 * size), along, 0.5 * size);
      m.push.visible = shown("push");
    }
    for (const mark of m.forces) mark.visible = mark.visible && shown("forces");
    byId("push-now").textContent = push ? "push " + push.text : "";
  }

  placeSupport(row, plane) {
    const corners = [];
    this.actors[0].root.updateMatrixWorld(true);
    for (const sole of config.soles) {
      if (row[columns[sole.side + "_planned"]] < 0.5) continue;
      const body = bodyOf(this.actors[0], sole.body);
      for (const corner of sole.corners) {
        const p = onGround(plane, body.localToWorld(new Vector3(...corner)),
          0.002 * config.height);
        corners.push([p.x, p.y, p.z]);
      }
    }
    const hull = convexHull(corners), m = this.marks;
    m.support.visible = hull.length > 2 && shown("support");
    if (hull.length < 3) return;
    const flat = new Float32Array(hull.flat());
    m.outline.geometry.dispose();
    m.outline.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(flat, 3));
    m.area.geometry.dispose();
    m.area.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(flat, 3));
    const fan = [];
    for (let i = 1; i + 1 < hull.length; ++i) fan.push(0, i, i + 1);
    m.area.geometry.setIndex(fan);
  }

  switchMarks() {
    const m = this.marks;
    m.cog.visible = shown("cog");
    m.zmp.visible = shown("zmp");
    m.reference.visible = shown("ref-zmp");
    const ghost = byId("ghost") ? byId("ghost").value : "";
    for (const actor of this.actors) actor.root.visible = !actor.ghost || actor.name === ghost;
    this.show(this.time);
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
  }

  play(on) {
    if (on && this.time >= last - 1e-6) this.show(0);
    this.playing = on;
    byId("play").textContent = on ? "Pause" : "Play";
    let before = performance.now();
    const tick = (now) => {
      if (!this.playing) return;
      this.show(this.time + this.speed * Math.min(0.25, (now - before) / 1000));
      before = now;
      if (this.time >= last - 1e-6) this.play(false);
      else requestAnimationFrame(tick);
    };
    if (on) requestAnimationFrame(tick);
  }
}

// ---- page

const shown = (mark) => byId("mark-" + mark).checked;

function drawCursors() {
  return [...document.querySelectorAll("[data-time-axis]")].map((figure) => {
    const [left, right, from, to] = figure.dataset.timeAxis.split(" ").map(Number);
    const svg = figure.querySelector("svg");
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    line.setAttribute("class", "cursor");
    line.setAttribute("y1", "40");
    line.setAttribute("y2", String(svg.viewBox.baseVal.height - 28));
    svg.append(line);
    const xOf = (t) => left + (right - left) * (t - from) / (to - from);
    const timeOf = (event) => {
      const box = svg.getBoundingClientRect();
      const x = (event.clientX - box.left) / box.width * svg.viewBox.baseVal.width;
      return from + (to - from) * (x - left) / (right - left);
    };
    return { svg, line, xOf, timeOf };
  });
}

const cursors = drawCursors();
const millimetres = (value) => (1000 * value).toFixed(1);

function showValues(t, row) {
  for (const { line, xOf } of cursors) {
    line.setAttribute("x1", xOf(t).toFixed(2));
    line.setAttribute("x2", xOf(t).toFixed(2));
  }
  const scrub = byId("scrub");
  scrub.value = String(t);
  const feet = ["left", "right"].filter((side) => row[columns[side + "_planned"]] > 0.5);
  const support = feet.length === 2 ? "both feet" : feet.length ? feet[0] + " foot" : "flight";
  scrub.setAttribute("aria-valuetext", t.toFixed(2) + " seconds, " + support);
  byId("readout").textContent = "t " + t.toFixed(3) + " s · " + support + " · COG " +
    ["x", "y", "z"].map((axis) => millimetres(row[columns["cog." + axis]])).join(", ") +
    " mm · ZMP " + ["x", "y"].map((axis) => millimetres(row[columns["zmp." + axis]])).join(", ") +
    " mm · f_z " + row[columns.fz].toFixed(1) + " N";
}

function connect(replay) {
  byId("scrub").addEventListener("input", (event) => replay.show(Number(event.target.value)));
  byId("play").addEventListener("click", () => replay.play(!replay.playing));
  byId("speed").addEventListener("change", (event) => { replay.speed = Number(event.target.value); });
  byId("view").addEventListener("change", (event) => replay.look(event.target.value));
  if (byId("ghost")) byId("ghost").addEventListener("change", () => replay.switchMarks());
  for (const box of document.querySelectorAll("#controls input[type=checkbox]"))
    box.addEventListener("change", () => replay.switchMarks());
  for (const { svg, timeOf } of cursors) {
    const go = (event) => { if (event.buttons & 1) replay.show(timeOf(event)); };
    svg.addEventListener("pointerdown", go);
    svg.addEventListener("pointermove", go);
  }
  replay.renderer.domElement.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 0.1 : 1 / config.rate;
    const jump = { ArrowLeft: -step, ArrowRight: step }[event.key];
    if (event.key === " ") replay.play(!replay.playing);
    else if (event.key === "Home") replay.show(0);
    else if (event.key === "End") replay.show(last);
    else if (jump) replay.show(replay.time + jump);
    else return;
    event.preventDefault();
  });
}

function start(gltf) {
  const replay = new Replay(byId("stage"), gltf);
  connect(replay);
  byId("controls").hidden = false;
  replay.switchMarks();
  replay.show(config.start);
  document.documentElement.dataset.replay = "ready";
  window.ayumiReplay = {
    get time() { return replay.time; },
    show: (t) => replay.show(t),
    row: () => Object.fromEntries(config.columns.map((name, i) => [name,
      rowAt(series, replay.time)[i]])),
    floor: () => ({ height: replay.floor.position.z, turn: replay.floor.quaternion.toArray(),
      bumps: replay.bumps.filter((bump) => bump.mesh.visible).length }),
    position: (body) => {
      replay.actors[0].root.updateMatrixWorld(true);
      return bodyOf(replay.actors[0], body).getWorldPosition(new Vector3()).toArray();
    },
  };
}

function without(reason) {
  byId("replay-state").textContent = "The replay cannot run here (" + reason +
    "); the picture shows one instant.";
  document.documentElement.dataset.replay = "failed";
}

new GLTFLoader().parse(bytesOf("replay-model"), "", (gltf) => {
  try {
    start(gltf);
  } catch (error) {
    without(error.message);
  }
}, (error) => without(error.message || "the model cannot be read"));
