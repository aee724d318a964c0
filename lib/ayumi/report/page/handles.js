// Points in the picture that can be dragged: feet, hands, gaze, trunk and COG, and the targets of
// keys of hands and gaze. Pushes, which are drawn as arrows, can be dragged too. For a dragged point,
// the server answers with the posture that brings the point to its place.

import { BufferGeometry, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, OctahedronGeometry, Plane, Raycaster,
  SphereGeometry, Vector2, Vector3 } from "three";
import { byId, seconds } from "./dom.js";
import { footWay, largerPart, nearAxis } from "./drag_parts.js";
import { bodyOf } from "./viewer.js";

const reach = 14;  // [px] distance from a point within which the pointer takes it
const targetColor = 0x0a8f8f;

export class Handles {
  constructor(page) {
    this.page = page;
    this.marks = [];
    this.targets = [];
    this.raycaster = new Raycaster();
    const stage = page.viewer.stage;
    stage.addEventListener("pointerdown", (event) => this.down(event), true);
    stage.addEventListener("pointermove", (event) => {
      if (event.buttons) return;
      const mark = this.page.drawing ? null : this.near(event);
      stage.style.cursor = this.page.drawing ? "crosshair" : mark ? "grab" : "";
      const name = mark?.target ? `target of the ${mark.target.label} at ${seconds(mark.target.time)}` : mark?.handle.label;
      stage.title = !mark ? "" : this.isOneWay(mark.handle) && !mark.target ? `${name}: drag it sideways, or up and down`
        : `${name}: drag it${this.isFoot(mark.handle) && !mark.target ? " over the ground" : ""}, with Shift only up and down`;
    });
  }

  /// Takes over the points of this robot.
  take(handles) {
    const same = JSON.stringify(handles);
    if (same === this.taken) return;
    this.taken = same;
    const { viewer } = this.page, size = viewer.config.height;
    for (const mark of this.marks) viewer.scene.remove(mark.ball);
    this.marks = handles.map((handle) => {
      const ball = new Mesh(new SphereGeometry(0.016 * size, 16, 12),
        new MeshBasicMaterial({ color: 0xffffff, depthTest: false, transparent: true, opacity: 0.85 }));
      const rim = new Mesh(new SphereGeometry(0.022 * size, 16, 12),
        new MeshBasicMaterial({ color: 0x0b57a4, depthTest: false, transparent: true, opacity: 0.8 }));
      rim.renderOrder = 6;
      ball.renderOrder = 7;
      ball.add(rim);
      viewer.scene.add(ball);
      return { handle, ball };
    });
  }

  /// Shows the targets of the keys: an octahedron for each, and for the gaze also a line from the
  /// head.
  takeTargets(targets) {
    const { viewer } = this.page, size = viewer.config.height;
    for (const { ball, line } of this.targets) {
      viewer.scene.remove(ball, line);
      for (const gone of [ball, line]) {
        gone.geometry.dispose();
        gone.material.dispose();
      }
    }
    this.targets = targets.map((target) => {
      const paint = { color: targetColor, depthTest: false, transparent: true };
      const ball = new Mesh(new OctahedronGeometry(0.024 * size), new MeshBasicMaterial({ ...paint }));
      ball.position.set(...target.place);
      ball.renderOrder = 8;
      const line = new Line(new BufferGeometry().setFromPoints([ball.position, ball.position]), new LineBasicMaterial({ ...paint, opacity: 0.5 }));
      line.renderOrder = 5;
      viewer.scene.add(ball, line);
      return { target, ball, line, handle: this.page.state.handles.find((one) => one.name === target.handle) };
    });
  }

  /// The direction of a limb, from its joint to its end.
  directionOf(handle) {
    const body = bodyOf(this.page.viewer.actors[0], handle.body);
    return body.localToWorld(new Vector3(...handle.point)).sub(body.getWorldPosition(new Vector3())).normalize();
  }

  /// The place of a handle's point in a row of the motion.
  placeOf(handle, row) {
    const { viewer } = this.page;
    if (handle.body === undefined) return viewer.vector("cog", row);
    return bodyOf(viewer.actors[0], handle.body).localToWorld(new Vector3(...handle.point));
  }

  place(row) {
    const shown = byId("show-handles").checked && this.page.can("pose.drag") && !this.page.viewer.playing;
    for (const { handle, ball } of this.marks) {
      ball.visible = shown;
      if (shown) ball.position.copy(this.placeOf(handle, row));
    }
    const seen = byId("mark-targets").checked, { time, viewer } = this.page;
    for (const { target, ball, line, handle } of this.targets) {
      const leads = time >= target.time - 5e-4 && time < Math.max(target.until, target.time + 5e-4);
      ball.visible = seen;
      ball.material.opacity = leads ? 0.95 : 0.35;
      line.visible = seen && leads && Boolean(handle?.gaze);
      if (line.visible) line.geometry.setFromPoints([bodyOf(viewer.actors[0], handle.body).getWorldPosition(new Vector3()), ball.position]);
    }
  }

  pixels(event) {
    const box = this.page.viewer.renderer.domElement.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top, box.width, box.height];
  }

  near(event) {
    const [x, y, wide, high] = this.pixels(event);
    let best = null, least = reach;
    for (const mark of [...this.marks, ...this.page.can("pose.drag") ? this.targets : []]) {
      if (!mark.ball.visible) continue;
      const at = mark.ball.position.clone().project(this.page.viewer.camera);
      const far = Math.hypot((at.x + 1) / 2 * wide - x, (1 - at.y) / 2 * high - y);
      if (far < least) [best, least] = [mark, far];
    }
    return best;
  }

  /// The point at which the pointer's ray meets the plane; null if it does not.
  hit(event, plane) {
    const [x, y, wide, high] = this.pixels(event);
    this.raycaster.setFromCamera(new Vector2(2 * x / wide - 1, 1 - 2 * y / high), this.page.viewer.camera);
    return this.raycaster.ray.intersectPlane(plane, new Vector3());
  }

  down(event) {
    if (event.button !== 0) return;
    const mark = this.page.drawing ? null : this.near(event);
    if (!mark && !this.page.drawing) return;
    event.stopPropagation();
    event.preventDefault();
    const { viewer } = this.page, stage = viewer.stage;
    viewer.play(false);
    let drag = null, latest = null, ended = false;
    const begin = () => { drag = mark ? this.dragOf(mark, event) : this.arrowOf(event); };
    // A drag changes the pattern, so the pattern is shown first; then the drag continues from the
    // place of the point in the pattern.
    if (mark && !this.page.showsPlan())
      this.page.showPlan().then(() => {
        if (ended) return;
        begin();
        if (latest) drag?.move(latest);
      });
    else begin();
    stage.setPointerCapture(event.pointerId);
    const moved = (e) => {
      latest = e;
      drag?.move(e);
    };
    const finish = (write) => {
      ended = true;
      stage.removeEventListener("pointermove", moved);
      stage.removeEventListener("pointerup", up);
      stage.removeEventListener("pointercancel", cancel);
      removeEventListener("keydown", escape, true);
      drag?.end(write);
    };
    const up = () => finish(true), cancel = () => finish(false);
    const escape = (e) => { if (e.key === "Escape") finish(false); };
    stage.addEventListener("pointermove", moved);
    stage.addEventListener("pointerup", up);
    stage.addEventListener("pointercancel", cancel);
    addEventListener("keydown", escape, true);
  }

  /// For the COG and the trunk, a drag sideways and a drag up or down change different things.
  isOneWay(handle) {
    return handle?.name === "cog" || handle?.name === "trunk";
  }

  isFoot(handle) {
    return Boolean(handle?.foot);
  }

  /// The drag is in the plane that faces the eye, that of a foot over the ground; with Shift, it is
  /// only vertical.
  dragOf({ handle, target, ball }, event) {
    const { camera } = this.page.viewer, oneWay = !target && this.isOneWay(handle), foot = !target && this.isFoot(handle);
    const right = new Vector3(), up = new Vector3(), facing = new Vector3();
    camera.updateMatrixWorld();
    camera.matrixWorld.extractBasis(right, up, facing);
    if (!oneWay && !foot) facing.set(...nearAxis(facing.toArray()));
    const plane = new Plane().setFromNormalAndCoplanarPoint(facing, ball.position);
    const begin = ball.position.clone(), first = this.hit(event, plane);
    if (!first) return null;
    let changed = false;
    if (target) this.page.show(target.time);
    const what = target ? { target: target.pointer } : { drag: handle.name, from: begin.toArray() };
    return {
      move: (e) => {
        const at = this.hit(e, plane);
        if (!at) return;
        const way = at.sub(first);
        if (oneWay && !e.shiftKey) way.set(...largerPart(way.toArray(), right.toArray(), up.toArray()));
        if (foot) way.set(...footWay(way.toArray(), right.toArray(), up.toArray(), e.shiftKey));
        const to = begin.clone().add(way);
        if (e.shiftKey) to.set(begin.x, begin.y, to.z);
        changed = changed || to.distanceTo(begin) > 5e-4;
        if (target) ball.position.copy(to);
        if (changed) this.page.pose.ask({ ...what, to: to.toArray() });
      },
      end: async (write) => {
        await (write && changed ? this.page.pose.write() : this.page.pose.drop());
        if (target) this.takeTargets(this.page.state.targets);
        this.place(this.page.row());
      },
    };
  }

  /// An arrow from the COG in a level plane: the direction and the size of a push.
  arrowOf(event) {
    const { viewer } = this.page, cog = viewer.vector("cog", this.page.row());
    const plane = new Plane().setFromNormalAndCoplanarPoint(new Vector3(0, 0, 1), cog);
    if (!this.hit(event, plane)) return null;
    let way = new Vector3();
    return {
      move: (e) => {
        const at = this.hit(e, plane);
        if (!at) return;
        way = at.sub(cog);
        way.clampLength(0, 2 * viewer.config.height);
        viewer.point(viewer.marks.push, cog, way, 1);
        viewer.draw();
        this.page.pushes.drawn(way, false);
      },
      end: (write) => {
        this.page.pushes.drawn(way, write && way.length() > 0.02 * viewer.config.height);
        viewer.show(this.page.time);
      },
    };
  }
}
