// The replay of a report: the viewer with the data of the page. The scene, the scrub bar and the
// cursors in the plots share one time.

import { Vector3 } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { fixed } from "./dom.js";
import { rowAt, hasZmp } from "./series.js";
import { Viewer, bodyOf } from "./viewer.js";

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
const series = { table, width, rows: table.length / width, columns };
const scenery = new Float32Array(bytesOf("replay-scenery"));

// ---- page

const shown = (mark) => byId("mark-" + mark).checked;

function drawCursors() {
  return [...document.querySelectorAll("[data-time-axis]")].map((figure) => {
    const [left, right, from, to, top] = figure.dataset.timeAxis.split(" ").map(Number);
    const svg = figure.querySelector("svg");
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    line.setAttribute("class", "cursor");
    line.setAttribute("y1", String(top));
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
/// A number with three digits, or a whole number if it is larger.
const digits = (value) => fixed(value, Math.abs(value) < 9.995 ? 2 : Math.abs(value) < 99.95 ? 1 : 0);
const millimetres = (value) => digits(1000 * value);
const place = (name, row, axes) => axes.map((axis) => millimetres(row[columns[name + "." + axis]]))
  .join(", ") + " mm";

function showValues(t, row, push) {
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
    place("cog", row, ["x", "y", "z"]) + " · ZMP " +
    (hasZmp(row, columns, config.least_zmp_force) ? place("zmp", row, ["x", "y"]) : "none") +
    " · f_z " + digits(row[columns.fz]) + " N";
  byId("push-now").textContent = push ? "push " + push.text : "";
}

function connect(replay) {
  byId("scrub").addEventListener("input", (event) => replay.show(Number(event.target.value)));
  byId("play").addEventListener("click", () => replay.play(!replay.playing));
  byId("speed").addEventListener("change", (event) => { replay.speed = Number(event.target.value); });
  byId("view").addEventListener("change", (event) => replay.look(event.target.value));
  const switchMarks = () => replay.switchMarks([byId("ghost")?.value]);
  byId("ghost")?.addEventListener("change", switchMarks);
  for (const box of document.querySelectorAll("#controls input[type=checkbox]"))
    box.addEventListener("change", switchMarks);
  switchMarks();
  for (const { svg, timeOf } of cursors) {
    const go = (event) => { if (event.buttons & 1) replay.show(timeOf(event)); };
    svg.addEventListener("pointerdown", go);
    svg.addEventListener("pointermove", go);
  }
  document.addEventListener("click", (event) => {
    const link = event.target.closest("[data-time]");
    if (!link) return;
    event.preventDefault();
    replay.play(false);
    replay.show(Number(link.dataset.time));
    byId("stage").scrollIntoView({ block: "nearest" });
  });
  replay.renderer.domElement.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 0.1 : 1 / config.rate;
    const jump = { ArrowLeft: -step, ArrowRight: step }[event.key];
    if (event.key === " ") replay.play(!replay.playing);
    else if (event.key === "Home") replay.show(0);
    else if (event.key === "End") replay.show(replay.last);
    else if (jump) replay.show(replay.time + jump);
    else return;
    event.preventDefault();
  });
}

function start(gltf) {
  const replay = new Viewer(byId("stage"), { config, series, scenery }, gltf, { shown,
    moved: showValues, played: (on) => { byId("play").textContent = on ? "Pause" : "Play"; } });
  connect(replay);
  byId("controls").hidden = false;
  replay.show(config.start);
  document.documentElement.dataset.replay = "ready";
  window.ayumiReplay = {
    get time() { return replay.time; },
    show: (t) => {
      replay.show(t);
      replay.paint();
    },
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
    "). The picture shows one instant of the run.";
  document.documentElement.dataset.replay = "failed";
}

new GLTFLoader().parse(bytesOf("replay-model"), "", (gltf) => {
  try {
    start(gltf);
  } catch (error) {
    without(error.message);
  }
}, (error) => without(error.message || "the model cannot be read"));
