// node author_fixture.mjs AYUMI PATTERN FOLDER PAGE.html ROBOT.urdf: a server of the live page's contract, for
// trials of the page alone. Findings, motion and model are made by the program AYUMI. The lanes of the
// strip, the results of jobs and the inverse kinematics only have the form of the real ones. It writes
// a pattern anew as a whole, without its comments.

import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { createServer } from "node:http";
import { readFileSync, renameSync, writeFileSync, watch } from "node:fs";
import { join } from "node:path";

const [ayumi, pattern, folder, page, urdfFile] = process.argv.slice(2);
const rate = 50;
const features = ["edit", "undo", "pose.joints", "pose.drag", "posture", "job.check", "job.repair",
  "job.simulate", "job.push", "job.export"];

function program(args) {
  try {
    return execFileSync(ayumi, args, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] }).toString();
  } catch (error) {
    return String(error.stdout) || JSON.stringify({ error: String(error.stderr) });
  }
}

// ---- the robot: its picture from a report, its joints from its URDF

const robotName = JSON.parse(readFileSync(join(folder, pattern), "utf8").replace(/^\s*\/\/.*$/gm, "")).robot;
program(["new", "stand", "--robot", robotName, "--duration", "0.1", "-o", "fixture_stand.json", "--force"]);
program(["run", "fixture_stand.json", "-o", "fixture_run", "--force"]);
const report = readFileSync(join(folder, "fixture_run/report.html"), "utf8");
const embedded = (id) => new RegExp(`id="${id}"[^>]*>(.*?)</script>`, "s").exec(report)[1].trim();
const model = Buffer.from(embedded("replay-model"), "base64");
const config = JSON.parse(embedded("replay-config"));
const nodes = JSON.parse(model.subarray(20, 20 + model.readUInt32LE(12)).toString()).nodes;
const urdf = readFileSync(urdfFile, "utf8");
const joints = [...urdf.matchAll(/<joint name="([^"]+)" type="revolute">([\s\S]*?)<\/joint>/g)].map(([, name, text]) => {
  const of = (tag, attribute) => new RegExp(`<${tag}[^>]* ?${attribute}="([^"]+)"`).exec(text)?.[1];
  const three = (words) => (words || "0 0 0").split(" ").map(Number);
  return { name, child: of("child", "link"), axis: three(of("axis", "xyz")),
    position: three(of("origin", "xyz")), rpy: three(of("origin", "rpy")),
    low: Number(of("limit", "lower")), high: Number(of("limit", "upper")) };
});
const quaternion = ([r, p, y]) => {
  const [a, b, c, d, e, f] = [Math.cos(r / 2), Math.sin(r / 2), Math.cos(p / 2), Math.sin(p / 2), Math.cos(y / 2), Math.sin(y / 2)];
  return [b * c * e - a * d * f, a * d * e + b * c * f, a * c * f - b * d * e, a * c * e + b * d * f];
};
const names = joints.map((j) => j.name);
const bodies = nodes.filter((n) => n.extras?.body !== undefined).sort((a, b) => a.extras.body - b.extras.body).map((node) => {
  const j = joints.find((one) => one.child === node.name);
  return j ? { joint: names.indexOf(j.name), ratio: 1, offset: 0, axis: j.axis, prismatic: false,
    position: j.position, quaternion: quaternion(j.rpy) }
    : { joint: -1, ratio: 1, offset: 0, axis: [0, 0, 1], prismatic: false, position: [0, 0, 0], quaternion: [0, 0, 0, 1] };
});
const body = (name) => nodes.find((n) => n.name === name)?.extras.body ?? -1;
const handles = [{ name: "left_foot", label: "left foot", body: body("l_foot"), point: [0, 0, -0.037] },
  { name: "right_foot", label: "right foot", body: body("r_foot"), point: [0, 0, -0.037] },
  { name: "left_hand", label: "left hand", body: body("l_forearm"), point: [0.02, 0, -0.1] },
  { name: "right_hand", label: "right hand", body: body("r_forearm"), point: [0.02, 0, -0.1] },
  { name: "trunk", label: "trunk", body: 0, point: [0, 0, 0.12] }, { name: "cog", label: "COG" }];

// ---- the motion

const columns = [...config.columns, "base.x", "base.y", "base.z", "base.qx", "base.qy", "base.qz", "base.qw",
  ...names.map((name) => "q." + name)];
let version = 0, text, hash, data, error = null, findings = [], table = null, ghost = null, consistent = false, stale = false;
let repaired = null, run = null, result = null;
const undo = [], redo = [], listeners = new Set();

function sampled(file) {
  program(["export", file, "--format", "csv", "--ramp", "0", "--hold", "0", "--servo", "ideal", "--rate", String(rate),
    "--force-unsafe", "--force", "-o", "fixture.csv"]);
  let lines;
  for (const name of ["fixture.csv", "fixture.UNSAFE.csv"])
    try { lines = readFileSync(join(folder, name), "utf8").split("\n").filter((l) => l && l[0] !== "#");
      execFileSync("rm", [join(folder, name)]); break; } catch { /* the other name */ }
  const head = lines.shift().split(",").map((h) => h.replace(/\[.*/, ""));
  const rows = lines.map((line) => line.split(",").map(Number));
  const floats = new Float32Array(rows.length * columns.length);
  rows.forEach((row, i) => {
    const from = Object.fromEntries(head.map((h, k) => [h, row[k]]));
    const feet = [from["contact.left"], from["contact.right"]];
    const value = (name) => {
      if (name.startsWith("q.")) return from["theta." + name.slice(2)];
      if (name.startsWith("ref_")) return from[name.slice(4)];
      if (name === "left_planned") return feet[0];
      if (name === "right_planned") return feet[1];
      if (name.endsWith("_force.z")) return feet[name.startsWith("left") ? 0 : 1] * from.fz / (feet[0] + feet[1]);
      if (name.endsWith("_cop.y")) return (name.startsWith("left") ? 1 : -1) * 0.039;
      if (name.endsWith("_cop.x")) return from["cog.x"];
      return from[name] ?? 0;
    };
    columns.forEach((name, k) => { floats[i * columns.length + k] = value(name); });
  });
  return floats;
}

function read() {
  const now = readFileSync(join(folder, pattern), "utf8");
  if (now === text) return;
  text = now;
  hash = createHash("sha256").update(text).digest("hex");
  ++version;
  error = null;
  try {
    data = JSON.parse(text);
  } catch (problem) {
    const at = Number(/position (\d+)/.exec(problem.message)?.[1] || 0);
    error = { message: problem.message, line: text.slice(0, at).split("\n").length, pointer: "" };
  }
  if (!error) {
    const said = JSON.parse(program(["check", pattern, "--json"]) || "{}");
    if (said.findings) {
      if (consistent && table) ghost = table;
      findings = said.findings.map((f) => ({ kind: f.kind, severity: f.severity, where: f.where,
        begin: f.begin_s, end: f.end_s, at: f.at_s, message: f.kind.replaceAll("_", " ") + ": " + f.where + ", " + f.worst.toPrecision(3) + " " + f.unit,
        hint: f.hint, bodies: joints.some((j) => j.name === f.where) ? [body(joints.find((j) => j.name === f.where).child)] : [],
        side: null, joint: names.includes(f.where) ? f.where : null, pointer: null }));
      consistent = said.verdict === "consistent";
      table = sampled(pattern);
      repaired = run = null;
      result = null;
    } else error = { message: said.error || "the pattern cannot be sampled", line: 1, pointer: "/phases/7" };
  }
  stale = Boolean(error);
  tell("state", { version });
}

function tell(event, value) {
  for (const answer of listeners) answer.write(`event: ${event}\ndata: ${JSON.stringify(value)}\n\n`);
}

const kindOf = (name) => ({ torso: "trunk" })[name] || name;
function tracks() {
  const found = new Map();
  data.keyframes.forEach((frame, i) => {
    const add = (name, kind, pointer, value) => {
      if (!found.has(name)) found.set(name, { name, kind, joint: kind === "joint" ? name.slice(6) : undefined, keys: [] });
      found.get(name).keys.push({ time: frame.t, time_value: frame.t, time_pointer: `/keyframes/${i}/t`, pointer, value });
    };
    for (const name of ["zmp", "cog", "fz", "torso", "posture"])
      if (frame[name] !== undefined) add(name, kindOf(name), `/keyframes/${i}/${name}`, frame[name]);
    for (const [name, value] of Object.entries(frame.joints || {})) add("joint " + name, "joint", `/keyframes/${i}/joints/${name}`, value);
    for (const [name, value] of Object.entries(frame.feet || {})) add(name + " foot", "foot", `/keyframes/${i}/feet/${name}`, value);
  });
  return [...found.values()];
}

function strip() {
  const width = columns.length, rows = table.length / width;
  const list = (f) => Array.from({ length: rows }, (_, i) => f(table.subarray(i * width, (i + 1) * width), i));
  const at = (row, name) => row[columns.indexOf(name)];
  const speed = list((row, i) => {
    if (!i) return [0, names[0]];
    const shares = names.map((name) => Math.abs(at(row, "q." + name) - table[(i - 1) * width + columns.indexOf("q." + name)]) * rate / 4.76 * 100);
    const k = shares.indexOf(Math.max(...shares));
    return [shares[k], names[k]];
  });
  return [
    { name: "ZMP margin", unit: "mm", sense: "low", limit: 0, warn: 15, digits: 1, worst: null, values: list((r) => 31 - 250 * Math.abs(at(r, "zmp.y") - 0.02 * Math.sign(at(r, "zmp.y")))) },
    { name: "Reserve of f_z", unit: "N", sense: "low", limit: 0, warn: 15, digits: 1, worst: null, values: list((r) => at(r, "fz") || null) },
    { name: "Joint speed", unit: "%", sense: "high", limit: 100, warn: 70, digits: 0, worst: speed.map((s) => s[1]), values: speed.map((s) => s[0]) },
  ];
}

function state() {
  const duration = data.phases.at(-1).until;
  let from = 0;
  const phases = data.phases.map((phase, i) => {
    const one = { from, until: phase.until, support: phase.support, pointer: `/phases/${i}`, until_pointer: `/phases/${i}/until`,
      until_value: phase.until, swing: phase.swing || null };
    from = phase.until;
    return one;
  });
  const sizes = { impulse: "N s", force: "N", torque: "N m" };
  return { version, file: pattern, text, hash, error, stale, robot: robotName, duration, dt: 0.001, features,
    angle_unit: data.units?.angle || "rad", consistent, findings, phases, tracks: tracks(),
    keyframes: data.keyframes.map((f, i) => ({ time: f.t, time_value: f.t, pointer: `/keyframes/${i}` })),
    disturbances: (data.scenario || []).map((d, i) => ({ type: d.type, from: d.at, until: d.at + (d.duration || 0), pointer: `/scenario/${i}`,
      at_pointer: `/scenario/${i}/at`, at_value: d.at, duration: d.duration, size: d[d.type], unit: sizes[d.type], direction: d.direction,
      link: d.on || "cog", text: `${d[d.type]} ${sizes[d.type]} on ${d.on || "cog"}`, value: d })),
    joints: joints.map(({ name, low, high }) => ({ name, low, high, prismatic: false })),
    handles: handles.filter((one) => one.body !== -1),
    postures: ["home", "zero", ...Object.keys(data.postures || {})], own_postures: Object.keys(data.postures || {}),
    motions: ["plan", ...ghost ? ["ghost"] : [], ...repaired ? ["repair"] : [], ...run ? ["closed_loop"] : []],
    replay: { ...config, columns, rate, bodies, joints: names, pushes: [], start: 0 },
    strip: strip(), strip_dt: 1 / rate, result, undo: undo.length, redo: redo.length };
}

// ---- edits of the whole text

function edited(edits) {
  const whole = structuredClone(data);
  const index = (p) => Number(/\/(\d+)$/.exec(p)?.[1] ?? -1);
  const last = [...edits].sort((a, b) => (a.kind === "set" ? 0 : 1) - (b.kind === "set" ? 0 : 1) || index(b.pointer) - index(a.pointer));
  for (const { kind, pointer, value } of last) {
    const parts = pointer.split("/").slice(1), leaf = parts.pop();
    let at = whole;
    parts.forEach((part, i) => { at = at[part] ??= (i === parts.length - 1 && leaf === "-" ? [] : {}); });
    if (kind === "set") at[leaf] = value;
    else if (kind === "remove") Array.isArray(at) ? at.splice(Number(leaf), 1) : delete at[leaf];
    else leaf === "-" ? at.push(value) : at.splice(Number(leaf), 0, value);
  }
  return JSON.stringify(whole, null, 1).replace(/\n\s{3,}/g, " ").replace(/\n {2}\]/g, "]");
}

function save(now, from, to) {
  if (from) from.push(text);
  writeFileSync(join(folder, pattern + ".new"), now);
  renameSync(join(folder, pattern + ".new"), join(folder, pattern));
  read();
  return [200, { version }];
}

function bodyOf(request) {
  return new Promise((resolve) => {
    const parts = [];
    request.on("data", (part) => parts.push(part));
    request.on("end", () => resolve(JSON.parse(Buffer.concat(parts).toString() || "{}")));
  });
}

function pose({ time, joints: wanted, drag, to }) {
  const width = columns.length, i = Math.min(table.length / width - 1, Math.round(time * rate));
  const row = [...table.subarray(i * width, (i + 1) * width)];
  for (const [name, value] of Object.entries(wanted || {})) row[columns.indexOf("q." + name)] = value;
  let edits = [];
  const near = data.keyframes.findIndex((f) => Math.abs(f.t - time) < 5e-4);
  const place = near >= 0 ? near : data.keyframes.findIndex((f) => f.t > time);
  const write = (part, value) => near >= 0 ? [{ kind: "set", pointer: `/keyframes/${near}/${part}`, value }]
    : [{ kind: "insert", pointer: `/keyframes/${place < 0 ? "-" : place}`, value: { t: Number(time.toFixed(3)), [part]: value } }];
  if (wanted) edits = write("joints", Object.fromEntries(Object.entries(wanted).map(([n, v]) => [n, Number((v * 180 / Math.PI).toFixed(2))])));
  if (drag === "cog") {
    ["x", "y", "z"].forEach((axis, k) => { row[columns.indexOf("base." + axis)] += to[k] - row[columns.indexOf("cog." + axis)]; row[columns.indexOf("cog." + axis)] = to[k]; });
    edits = write("cog", { x: Number(to[0].toFixed(4)), y: Number(to[1].toFixed(4)) });
  }
  return { row, edits, message: drag && drag !== "cog" ? "this trial server does not move the " + drag.replace("_", " ") : null };
}

let job = 0;
const running = new Map();
function startJob(kind, options) {
  const id = String(++job);
  let progress = 0;
  const timer = setInterval(() => {
    progress += 0.25;
    if (progress >= 1) {
      clearInterval(timer);
      running.delete(id);
      if (kind === "repair") repaired = table.map((v, i) => i % columns.length === columns.indexOf("base.y") ? v + 0.02 : v);
      if (kind === "simulate") run = table.subarray(0, Math.floor(table.length / columns.length / 2) * columns.length);
      result = { kind, text: kind === "repair" ? text.replace(/"name": "[^"]*"/, '"name": "repaired"') : undefined, verdict: kind === "simulate" ? "The robot stands." : "Done.", good: true, lines: ["law: " + (options.law || "none")], marks: [{ time: 3, text: "push" }], files: [] };
      ++version;
      tell("job", { id, kind, progress: 1, text: "", done: true, error: null });
      tell("state", { version });
    } else tell("job", { id, kind, progress, text: "working", done: false, error: null });
  }, 300);
  running.set(id, { timer, kind });
  return id;
}

const server = createServer(async (request, response) => {
  const path = new URL(request.url, "http://x").pathname.replace(/^\/t\//, ""), query = new URL(request.url, "http://x").searchParams;
  const json = (status, value) => { response.writeHead(status, { "Content-Type": "application/json" }); response.end(JSON.stringify(value)); };
  const bytes = (value) => { response.writeHead(200); response.end(Buffer.from(value.buffer, value.byteOffset, value.byteLength)); };
  if (request.method === "GET") {
    if (path === "") { response.writeHead(200, { "Content-Type": "text/html" }); return response.end(readFileSync(page)); }
    if (path === "state") return json(200, state());
    if (path === "model.glb") return bytes(model);
    if (path === "scenery") return bytes(Buffer.from(embedded("replay-scenery"), "base64"));
    if (path === "series") {
      const which = { plan: table, ghost, repair: repaired, closed_loop: run }[query.get("which")];
      return which ? bytes(which) : json(404, {});
    }
    if (path === "events") {
      response.writeHead(200, { "Content-Type": "text/event-stream", "Cache-Control": "no-cache" });
      response.write(": hello\n\n");
      listeners.add(response);
      return request.on("close", () => listeners.delete(response));
    }
    return json(404, {});
  }
  if (request.method === "DELETE") {
    const id = path.split("/")[1];
    clearInterval(running.get(id)?.timer);
    tell("job", { id, kind: running.get(id)?.kind, progress: 0, text: "", done: true, error: "cancelled" });
    return json(200, {});
  }
  const asked = await bodyOf(request);
  if (path === "pose") return json(200, pose(asked));
  if (path === "posture") return json(200, { edits: [{ kind: "set", pointer: "/postures/" + asked.name, value: { l_knee: 30 } }] });
  if (path === "job") return json(200, { id: startJob(asked.kind, asked.options || {}) });
  read();
  if (asked.hash !== hash) return json(409, { theirs: text, theirs_hash: hash, mine: asked.edits ? edited(asked.edits) : text });
  if (path === "edit") {
    redo.length = 0;
    return json(...save(asked.text ?? edited(asked.edits), undo));
  }
  const [from, to] = path === "undo" ? [undo, redo] : [redo, undo];
  if (!from.length) return json(422, { message: "there is nothing to " + path });
  to.push(text);
  return json(...save(from.pop()));
});

writeFileSync(join(folder, pattern), JSON.stringify(JSON.parse(readFileSync(join(folder, pattern), "utf8").replace(/^\s*\/\/.*$/gm, "")), null, 1).replace(/\n\s{3,}/g, " ").replace(/\n {2}\]/g, "]"));
read();
watch(join(folder), () => { try { read(); } catch { /* half a file */ } });
server.listen(Number(process.env.PORT || 0), "127.0.0.1", () => console.log(`http://127.0.0.1:${server.address().port}/t/`));
