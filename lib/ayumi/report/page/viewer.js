// The robot in 3-D, moved through time, with marks of the motion's quantities: COG, ZMP, support
// polygon, foot forces, pushes. A page gives it a motion and decides which marks are shown. Both
// the report's replay and the authoring page use it.

import {
  AmbientLight, AnimationMixer, BufferAttribute, BufferGeometry, CircleGeometry, Color,
  CylinderGeometry, DirectionalLight, DoubleSide, Group, HemisphereLight, Line, LineBasicMaterial,
  LineLoop, LineSegments, LoopOnce, Mesh, MeshBasicMaterial, MeshLambertMaterial, PCFShadowMap, PerspectiveCamera,
  PlaneGeometry, Quaternion, RingGeometry, Scene, ShadowMaterial, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { clampTime, convexHull, sampleAt, hasReferenceZmp, hasZmp } from "./series.js";

const colors = { cog: 0xd9a312, zmp: 0xd6261f, reference: 0x0d4dbf, support: 0x1a73cc,
  force: 0x0d8c59, push: 0xc7409e };

// ---- marks

function disc(inner, outer, color) {
  const shape = inner > 0 ? new RingGeometry(inner, outer, 40) : new CircleGeometry(outer, 40);
  const mark = new Mesh(shape, new MeshBasicMaterial({ color, side: DoubleSide, depthTest: false }));
  mark.renderOrder = 3;
  return mark;
}

/// An arrow along its own y axis, from 0 to 1 when its length is 1.
function arrow(color) {
  const material = new MeshBasicMaterial({ color, depthTest: false, transparent: true });
  const shaft = new Mesh(new CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0), material);
  const head = new Mesh(new CylinderGeometry(0, 1, 1, 16).translate(0, -0.5, 0), material);
  const mark = new Group().add(shaft, head);
  for (const part of [shaft, head]) part.renderOrder = 4;
  return Object.assign(mark, { shaft, head });
}

/// The lines of a grid over -reach..reach, cut at every crossing. Some renderers lose a line that
/// begins behind the eye; then only the nearest piece is lost.
function grid(reach, spacing) {
  const ends = [], count = Math.round(reach / spacing);
  const cuts = Array.from({ length: 2 * count + 1 }, (_, i) => (i - count) * spacing);
  for (const a of cuts)
    for (let i = 0; i + 1 < cuts.length; ++i)
      ends.push(a, cuts[i], 0, a, cuts[i + 1], 0, cuts[i], a, 0, cuts[i + 1], a, 0);
  return new LineSegments(new BufferGeometry().setAttribute("position",
    new BufferAttribute(new Float32Array(ends), 3)), new LineBasicMaterial());
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

/// The point of the plane below p.
function onGround({ normal, origin }, p, lift) {
  const below = new Vector3(p.x, p.y, p.z - normal.dot(p.clone().sub(origin)) / normal.z);
  return below.addScaledVector(normal, lift);
}

/// Names may be changed on loading, but the number of the body is not.
export function bodyOf(actor, number) {
  let found = null;
  actor.root.traverse((part) => { if (part.userData.body === number) found = part; });
  return found;
}

// ---- scene

/// A motion is { config, series, scenery }: its description in the page's JSON, its rows
/// (series.js) and the triangles of the ground.
export class Viewer {
  /// `gltf` is the robot, with the colour for its ghosts. Its animations, if it has any, are the
  /// motion and its ghosts. `hooks` are functions: shown(mark) says whether a mark is drawn;
  /// moved(time, row, push) and played(on) inform the page.
  constructor(stage, motion, gltf, hooks) {
    this.time = 0;
    this.playing = false;
    this.speed = 1;
    this.stage = stage;
    this.hooks = hooks;
    this.take(motion);
    this.marks = makeMarks(this.config.height);
    this.buildScene(gltf);
    this.buildView();
  }

  take({ config, series, scenery }) {
    Object.assign(this, { config, series, scenery, columns: series.columns });
    this.last = series.table[(series.rows - 1) * series.width];
  }

  /// Shows another motion of the same robot in place of the present one.
  replace(motion) {
    this.take(motion);
    this.scene.remove(this.floor);
    this.floor.traverse((part) => {
      part.geometry?.dispose();
      part.material?.dispose();
    });
    this.scene.add(this.ground());
    this.paintGround();
    this.show(this.time);
  }

  vector(name, row) {
    return new Vector3(...["x", "y", "z"].map((axis) => row[this.columns[name + "." + axis]]));
  }

  buildScene(gltf) {
    this.scene = new Scene();
    const dark = matchMedia("(prefers-color-scheme: dark)");
    this.paintGround = () => {
      this.scene.background = new Color(dark.matches ? 0x23272d : 0xdfe4e9);
      const [fine, coarse] = this.grid.children;
      fine.material.color.set(dark.matches ? 0x3d444d : 0xb4bac2);
      coarse.material.color.set(dark.matches ? 0x626b76 : 0x747b84);
    };
    dark.addEventListener("change", () => { this.paintGround(); this.draw(); });
    this.scene.add(new HemisphereLight(0xffffff, 0x99938c, 1.6), new AmbientLight(0xffffff, 0.5));
    this.sun = new DirectionalLight(0xffffff, 2.0);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    const reach = 1.2 * this.config.height;
    Object.assign(this.sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach,
      near: 0.1 * this.config.height, far: 6 * this.config.height });
    this.sun.shadow.normalBias = 0.004 * this.config.height;
    this.scene.add(this.sun, this.sun.target);
    this.scene.add(this.ground());
    this.paintGround();
    this.actors = [];
    this.ghostColor = gltf.userData.ghost_color;
    if (gltf.animations.length > 0) this.addActor(gltf.scene, gltf.animations[0], false);
    for (const clip of gltf.animations.slice(1)) this.addActor(gltf.scene.clone(true), clip, true);
    const m = this.marks;
    this.scene.add(m.cog, m.zmp, m.reference, m.support, m.push, ...m.forces);
  }

  /// The grid, and everything that is on it or rises from it, in the floor's frame.
  ground() {
    const ground = this.floor = new Group(), plane = new Group();
    this.grid = new Group().add(grid(3, 0.1), grid(10, 1));
    const floor = new Mesh(new PlaneGeometry(40, 40), new ShadowMaterial({ opacity: 0.3 }));
    floor.receiveShadow = true;
    this.grid.add(floor);
    plane.add(this.grid);
    plane.position.z = this.config.ground_height;
    ground.add(plane);
    const solid = (geometry, material) => {
      const mesh = new Mesh(geometry, new MeshLambertMaterial(material));
      mesh.receiveShadow = true;
      plane.add(mesh);
      return mesh;
    };
    const corners = this.scenery;
    if (corners.length) {
      const pick = (from) => new BufferAttribute(Float32Array.from({ length: corners.length / 2 },
        (_, i) => corners[6 * Math.floor(i / 3) + from + i % 3]), 3);
      const color = pick(3);
      for (let i = 0; i < color.array.length; ++i) color.array[i] **= 2.2;
      const shape = new BufferGeometry().setAttribute("position", pick(0))
        .setAttribute("color", color);
      shape.computeVertexNormals();
      solid(shape, { vertexColors: true, side: DoubleSide }).position.z = -this.config.ground_height;
    }
    this.bumps = this.config.bumps.map((bump) => {
      const shape = new CylinderGeometry(bump.radius, bump.radius, bump.height, 8);
      shape.rotateX(Math.PI / 2).rotateZ(Math.PI / 8).translate(0, 0, bump.height / 2);
      const mesh = solid(shape, { color: 0xa89980 });
      mesh.position.set(...bump.center);
      return { mesh, ...bump };
    });
    return ground;
  }

  placeFloor(row) {
    const { position, quaternion } = this.floorAt(row);
    this.floor.position.copy(position);
    this.floor.quaternion.copy(quaternion);
    // The grid moves with the robot in steps that are not visible.
    const under = this.vector("cog", row).sub(position).applyQuaternion(quaternion.clone().invert());
    this.grid.position.set(Math.round(under.x), Math.round(under.y), 0);
    for (const { mesh, begin, end, rise } of this.bumps) {
      const share = Math.min(1, Math.max(0, (this.time - begin) / rise));
      mesh.visible = share > 0 && this.time < end;
      mesh.scale.z = Math.max(1e-3, share ** 3 * (10 - 15 * share + 6 * share ** 2));
    }
  }

  /// Adds the robot, moved by an animation of its glTF file.
  addActor(model, clip, ghost) {
    const mixer = new AnimationMixer(model), action = mixer.clipAction(clip);
    action.setLoop(LoopOnce);
    action.clampWhenFinished = true;
    action.play();
    this.addMoved(clip.name, model, ghost, (time) => {
      action.enabled = true;
      action.paused = false;
      action.time = Math.min(time, clip.duration);
      mixer.update(0);
    });
  }

  /// Adds the robot, moved by a function of time. glTF's y becomes the world's z again.
  addMoved(name, model, ghost, move) {
    const actor = { name, ghost, move, root: new Group() };
    actor.root.rotation.x = Math.PI / 2;
    actor.root.add(model);
    const depths = [];
    model.traverse((part) => {
      if (!part.isMesh) return;
      part.castShadow = !ghost;
      if (!ghost) return;
      // A ghost is drawn slightly behind its place, so that parts that coincide with it are visible
      // without flickering.
      const behind = { polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 400,
        transparent: true };
      part.material = new MeshLambertMaterial({ color: this.ghostColor, opacity: 0.4, ...behind });
      part.renderOrder = 2;
      // The depth of the ghost is drawn first, so that only its nearest surface is visible.
      const depth = new Mesh(part.geometry, new MeshBasicMaterial({ colorWrite: false, ...behind }));
      depth.renderOrder = 1;
      depths.push([part, depth]);
    });
    for (const [part, depth] of depths) part.add(depth);
    actor.root.visible = !ghost;
    this.scene.add(actor.root);
    this.actors.push(actor);
    return actor;
  }

  buildView() {
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.camera = new PerspectiveCamera(28, 16 / 9, 0.01 * this.config.height, 100 * this.config.height);
    this.camera.up.set(0, 0, 1);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "application");
    canvas.setAttribute("aria-roledescription", "3-D replay");
    canvas.setAttribute("aria-label", this.config.label);
    this.stage.replaceChildren(canvas);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enableZoom = true;
    this.orbit.addEventListener("change", () => this.draw());
    this.look(this.config.view);
    const fit = () => {
      const wide = this.stage.clientWidth;
      const high = this.hooks.fills ? this.stage.clientHeight : Math.round(wide * 9 / 16);
      if (!wide || !high) return;
      this.renderer.setSize(wide, high);
      this.camera.aspect = wide / high;
      this.camera.updateProjectionMatrix();
      this.draw();
    };
    new ResizeObserver(fit).observe(this.stage);
    fit();
  }

  /// The frame of the floor: its fixed frame, or the frame in a row if the floor moves.
  floorAt(row) {
    const at = (name) => row[this.columns["floor." + name]];
    if (this.columns["floor.x"] === undefined)
      return { position: new Vector3(...this.config.floor.position),
        quaternion: new Quaternion(...this.config.floor.quaternion) };
    return { position: new Vector3(at("x"), at("y"), at("z")),
      quaternion: new Quaternion(at("qx"), at("qy"), at("qz"), at("qw")).normalize() };
  }

  /// The plane on which marks are drawn: the ground, or the level above it of the higher foot in
  /// contact.
  planeAt(row) {
    const floor = this.floorAt(row);
    const normal = new Vector3(0, 0, 1).applyQuaternion(floor.quaternion);
    const origin = floor.position.clone().addScaledVector(normal, this.config.ground_height);
    let level = 0;
    for (const side of ["left", "right"])
      if (this.vector(side + "_force", row).length() > 0.02 * row[this.columns.fz] && row[this.columns.fz] > 0)
        level = Math.max(level, normal.dot(this.vector(side + "_cop", row).sub(origin)));
    if (level > 5e-4) origin.addScaledVector(normal, level);
    return { normal, origin };
  }

  point(mark, from, force, scale) {
    const length = force.length() * scale;
    mark.visible = length > 1e-3;
    if (!mark.visible) return;
    const head = Math.min(0.4 * length, 0.055 * this.config.height), thin = 0.006 * this.config.height;
    mark.position.copy(from);
    mark.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), force.clone().normalize());
    mark.shaft.scale.set(thin, length - head, thin);
    mark.head.position.y = length;
    mark.head.scale.set(0.4 * head, head, 0.4 * head);
  }

  look(view) {
    const [azimuth, elevation] = { front: [0, 8], side: [-90, 6], back: [180, 8], top: [-90, 80],
      iso: [-40, 20] }[view].map((degrees) => degrees * Math.PI / 180);
    const far = 2.9 * this.config.height;
    const row = sampleAt(this.series, this.time);
    this.orbit.target.copy(this.focus(row));
    this.camera.position.copy(this.orbit.target).add(new Vector3(
      far * Math.cos(elevation) * Math.cos(azimuth), far * Math.cos(elevation) * Math.sin(azimuth),
      far * Math.sin(elevation)));
    this.orbit.update();
  }

  focus(row) {
    return onGround(this.planeAt(row), this.vector("cog", row), 0.48 * this.config.height);
  }

  /// Shows everything at time t: robot, ghosts, marks, camera, plots, controls.
  show(t) {
    const before = this.focus(sampleAt(this.series, this.time));
    this.time = clampTime(this.series, t);
    const row = sampleAt(this.series, this.time);
    for (const actor of this.actors) actor.move(this.time);
    const moved = this.focus(row).sub(before);
    this.orbit.target.add(moved);
    this.camera.position.add(moved);
    this.sun.target.position.copy(this.orbit.target);
    this.sun.position.copy(this.orbit.target).add(
      new Vector3(0.8, -0.9, 2.2).multiplyScalar(this.config.height));
    this.placeFloor(row);
    this.place(row);
    const push = this.config.pushes.find((p) => this.time >= p.begin - 1e-6 &&
      this.time < Math.max(p.end, p.begin + 0.6));
    this.placePush(push, row);
    this.hooks.moved(this.time, row, push);
    this.draw();
  }

  place(row) {
    const m = this.marks, size = this.config.height, cog = this.vector("cog", row);
    const plane = this.planeAt(row);
    for (const mark of [m.zmp, m.reference])
      mark.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), plane.normal);
    m.ball.position.copy(cog);
    m.plumb.geometry.setFromPoints([cog, onGround(plane, cog, 0.001 * size)]);
    m.zmp.position.copy(onGround(plane, this.vector("zmp", row), 0.004 * size));
    m.reference.position.copy(onGround(plane, this.vector("ref_zmp", row), 0.003 * size));
    ["left", "right"].forEach((side, i) => this.point(m.forces[i], this.vector(side + "_cop", row),
      this.vector(side + "_force", row), 0.5 * size / this.config.weight));
    this.placeSupport(row, plane);
    for (const mark of m.forces) mark.visible = mark.visible && this.hooks.shown("forces");
    m.zmp.visible = hasZmp(row, this.columns, this.config.least_zmp_force) && this.hooks.shown("zmp");
    m.reference.visible = hasReferenceZmp(row, this.columns) && this.hooks.shown("ref-zmp");
  }

  placePush(push, row) {
    const mark = this.marks.push, size = this.config.height;
    mark.visible = Boolean(push) && this.hooks.shown("push");
    if (!mark.visible) return;
    const along = new Vector3(...push.direction);
    const tip = this.vector("cog", row).add(new Vector3(...push.from_cog));
    this.point(mark, tip.addScaledVector(along, -0.5 * size), along, 0.5 * size);
  }

  placeSupport(row, plane) {
    const corners = [];
    this.actors[0].root.updateMatrixWorld(true);
    for (const sole of this.config.soles) {
      if (row[this.columns[sole.side + "_planned"]] < 0.5) continue;
      const body = bodyOf(this.actors[0], sole.body);
      for (const corner of sole.corners) {
        const p = onGround(plane, body.localToWorld(new Vector3(...corner)),
          0.002 * this.config.height);
        corners.push([p.x, p.y, p.z]);
      }
    }
    const hull = convexHull(corners), m = this.marks;
    m.support.visible = hull.length > 2 && this.hooks.shown("support");
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

  /// Shows the marks that the page wants, and the ghosts with these names.
  switchMarks(ghosts) {
    const m = this.marks;
    m.cog.visible = this.hooks.shown("cog");
    for (const actor of this.actors) actor.root.visible = !actor.ghost || ghosts.includes(actor.name);
    this.show(this.time);
  }

  /// Draws one picture for all changes until the browser shows the next picture.
  draw() {
    this.frame ??= requestAnimationFrame(() => this.paint());
  }

  paint() {
    cancelAnimationFrame(this.frame);
    this.frame = null;
    this.renderer.render(this.scene, this.camera);
  }

  play(on) {
    if (on && this.time >= this.last - 1e-6) this.show(0);
    this.playing = on;
    this.hooks.played(on);
    let before = performance.now();
    const tick = (now) => {
      if (!this.playing) return;
      this.show(this.time + this.speed * Math.min(0.25, (now - before) / 1000));
      before = now;
      if (this.time >= this.last - 1e-6) this.play(false);
      else requestAnimationFrame(tick);
    };
    if (on) requestAnimationFrame(tick);
  }
}

