// node --test author_parts.mjs: the parts of the live page that need no browser.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { TimeAxis, snapped } from "../../lib/ayumi/report/page/time_axis.js";
import { footWay, largerPart, nearAxis } from "../../lib/ayumi/report/page/drag_parts.js";
import { arrowsOf, wordsOfPush } from "../../lib/ayumi/report/page/push_parts.js";
import * as parts from "../../lib/ayumi/report/page/parts.js";
import * as edits from "../../lib/ayumi/report/page/edits.js";
import { fieldsOf, missingFields, optionalField, optionsOf, parsePattern, valueAt } from "../../lib/ayumi/report/page/fields.js";
import { nameAmongOthers, unitOf } from "../../lib/ayumi/report/page/inspector.js";
import { isKnown, linePoints, partsOf } from "../../lib/ayumi/report/page/curves.js";
import { strain, colorOf, heightOf, worstIn } from "../../lib/ayumi/report/page/strip_colors.js";
import { sideBySide, nearDifferences } from "../../lib/ayumi/report/page/text_difference.js";

const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-9, `${a} is not ${b}`);

test("a place of the axis is the place of its time, at every zoom", () => {
  const axis = new TimeAxis(7);
  for (const factor of [1, 3, 10, 0.2]) {
    axis.zoom(factor, 2);
    for (const share of [0, 0.25, 1]) near(axis.shareOf(axis.timeOf(share)), share);
    assert.ok(axis.from >= 0 && axis.to <= 7 + 1e-9 && axis.to > axis.from);
  }
  axis.zoom(0.001, 2);
  assert.deepEqual([axis.from, axis.to], [0, 7]);
});

test("zooming keeps the time under the pointer where it is", () => {
  const axis = new TimeAxis(10), before = axis.shareOf(4);
  axis.zoom(4, 4);
  near(axis.shareOf(4), before);
  near(axis.to - axis.from, 2.5);
  axis.reveal(9);
  assert.ok(axis.from <= 9 && axis.to >= 9);
});

test("a longer motion is shown whole only where the whole was shown", () => {
  const whole = new TimeAxis(5), part = new TimeAxis(5);
  part.show(1, 2);
  whole.stretch(8);
  part.stretch(8);
  assert.deepEqual([whole.from, whole.to, part.from, part.to], [0, 8, 1, 2]);
  part.stretch(1.5);
  assert.deepEqual([part.from, part.to], [0.5, 1.5]);
});

test("ticks are round, inside, and not more than asked for", () => {
  for (const [from, to, most] of [[0, 7.1, 10], [1.234, 1.301, 6], [0, 3600, 12], [0, 0.05, 3]]) {
    const axis = new TimeAxis(3600);
    axis.show(from, to);
    const ticks = axis.ticks(most);
    assert.ok(ticks.length >= 1 && ticks.length <= most + 1, `${ticks.length} ticks`);
    for (const { time, text } of ticks) {
      assert.ok(time >= axis.from - 1e-6 && time <= axis.to + 1e-6);
      near(Number(text), Number(time.toFixed(9)));
    }
  }
});

test("a time snaps to the nearest candidate within the tolerance", () => {
  assert.equal(snapped(1.03, [1, 1.05, 2], 0.05), 1.05);
  assert.equal(snapped(1.2, [1, 1.05, 2], 0.05), 1.2);
});

const state = {
  keyframes: [0, 0.7, 1.1, 1.6].map((time, i) => ({ time, time_value: time, time_pointer: `/keyframes/${i}/t`, pointer: `/keyframes/${i}` })),
  phases: [{ from: 0, until: 1.1, until_value: 1.1, until_pointer: "/phases/0/until" },
    { from: 1.1, until: 1.6, until_value: "${t} + 1", until_pointer: "/phases/1/until" },
    { from: 1.6, until: 2, until_value: 2, until_pointer: "/phases/2/until" }],
  tracks: [{ name: "zmp", keys: [{ pointer: "/keyframes/1/zmp" }, { pointer: "/keyframes/2/zmp" }] },
    { name: "cog", keys: [{ pointer: "/keyframes/2/cog" }] }],
};

test("a phase's end takes the keys that stand at it along, as far as their order allows", () => {
  assert.deepEqual(edits.movePhase(state, 0, 1.25, true), [
    { kind: "set", pointer: "/phases/0/until", value: 1.25 }, { kind: "set", pointer: "/keyframes/2/t", value: 1.25 }]);
  assert.deepEqual(edits.movePhase(state, 0, 1.25, false).length, 1);
  assert.deepEqual(edits.movePhase(state, 0, 0.6, true).length, 1, "a key does not pass the one before it");
  assert.deepEqual(edits.movePhase(state, 1, 1.7, true), [
    { kind: "set", pointer: "/phases/1/until", value: 1.7 }, { kind: "set", pointer: "/keyframes/3/t", value: 1.7 }],
  "an expression moves, too; the server adds to it");
  assert.deepEqual(edits.movePhase(state, 0, 1.1002, true), [], "nothing is written for nothing");
});

test("a key stays between its neighbours", () => {
  const rooms = [edits.roomOfKey(state.keyframes, "/keyframes/1/zmp"),
    edits.roomOfKey(state.keyframes, "/keyframes/3/zmp"), edits.roomOfPhase(state.phases, 0)];
  [[0.001, 1.099], [1.101, 3600], [0.001, 1.599]].forEach((room, i) => room.forEach((t, k) => near(rooms[i][k], t)));
});

test("a value goes into the keyframe of its time, or into a new one in order", () => {
  assert.deepEqual(edits.putKey(state.keyframes, 1.1003, "zmp", "left"),
    [{ kind: "set", pointer: "/keyframes/2/zmp", value: "left" }]);
  assert.deepEqual(edits.putKey(state.keyframes, 1.30049, "zmp", "left"),
    [{ kind: "insert", pointer: "/keyframes/3", value: { t: 1.3, zmp: "left" } }]);
  assert.deepEqual(edits.putKey(state.keyframes, 5, "fz", 60)[0].pointer, "/keyframes/-");
});

test("a target goes into the hands of the keyframe of its time, or into a new keyframe", () => {
  const hand = { name: "left_hand", link: "left" };
  assert.deepEqual(edits.putTarget(state.keyframes, 1.1003, hand, [0.1, 0.2, 0.3]),
    [{ kind: "set", pointer: "/keyframes/2/hands/left", value: [0.1, 0.2, 0.3] }]);
  assert.deepEqual(edits.putTarget(state.keyframes, 1.3, hand, [0.1, 0.2, 0.3])[0].value,
    { t: 1.3, hands: { left: [0.1, 0.2, 0.3] } });
  assert.deepEqual(edits.putTarget(state.keyframes, 1.3, { name: "gaze", gaze: true }, [1, 0, 1])[0].value, { t: 1.3, gaze: [1, 0, 1] });
});

test("the COG height alone, and a swing", () => {
  assert.deepEqual(edits.putPart(state.keyframes, 1.1002, "cog", "height", 0.23),
    [{ kind: "set", pointer: "/keyframes/2/cog/height", value: 0.23 }]);
  assert.deepEqual(edits.putPart(state.keyframes, 1.3, "cog", "height", 0.23)[0].value, { t: 1.3, cog: { height: 0.23 } });
  assert.deepEqual(edits.addSwing({ pointer: "/phases/3" }, "left"), [
    { kind: "set", pointer: "/phases/3/swing", value: { foot: "left", step: { forward: 0, side: 0, turn: 0 }, lift: 0.02 } }]);
});

test("a removed key takes its keyframe only where nothing else is in it", () => {
  const [one, two] = state.tracks[0].keys;
  assert.deepEqual(edits.removeKey(state, one), [{ kind: "remove", pointer: "/keyframes/1" }]);
  assert.deepEqual(edits.removeKey(state, two), [{ kind: "remove", pointer: "/keyframes/2/zmp" }]);
});

test("times that count from the one before, and blocks that repeat", () => {
  const relative = { time: 1, time_value: 0.4, time_base: 0.6, time_pointer: "/keyframes/2/after", pointer: "/keyframes/2" };
  assert.deepEqual(edits.moveKey(relative, 1.1), [{ kind: "set", pointer: "/keyframes/2/after", value: 0.5 }]);
  assert.deepEqual(edits.moveKey({ ...relative, repeated: true }, 1.1), []);
  const first = { time: 0.6, time_value: 0.6, time_pointer: "/keyframes/1/t", pointer: "/keyframes/1" };
  assert.deepEqual(edits.putKey([first, relative], 0.7, "fz", 70), [
    { kind: "insert", pointer: "/keyframes/2", value: { t: 0.7, fz: 70 } },
    { kind: "set", pointer: "/keyframes/2/after", value: 0.3 }]);
  const inBlock = (i, time) => ({ time, time_value: time, repeated: true,
    time_pointer: `/keyframes/2/keyframes/${i}/t`, pointer: `/keyframes/2/keyframes/${i}` });
  assert.equal(edits.putKey([first, inBlock(0, 1)], 0.7, "fz", 70)[0].pointer, "/keyframes/2");
  assert.deepEqual(edits.putKey([first, inBlock(0, 1), inBlock(1, 2)], 1.5, "fz", 70), []);
  const state = { keyframes: [first, relative], tracks: [{ keys: [{ pointer: "/keyframes/1/fz" }] }] };
  assert.deepEqual(edits.removeKey(state, state.tracks[0].keys[0]), [
    { kind: "remove", pointer: "/keyframes/1" },
    { kind: "set", pointer: "/keyframes/2/after", value: 1 }]);
});

test("a phase is cut only within it, and never in its swing", () => {
  const phase = { from: 1, until: 2, support: "left", pointer: "/phases/4", until_pointer: "/phases/4/until" };
  assert.deepEqual(edits.splitPhase(phase, 1.2504),
    [{ kind: "insert", pointer: "/phases/4", value: { until: 1.25, support: "left" } }]);
  for (const [one, t] of [[phase, 1], [phase, 2], [{ ...phase, swing: {} }, 1.5], [{ ...phase, support: undefined }, 1.5]])
    assert.deepEqual(edits.splitPhase(one, t), []);
  // If the phase has a duration, this becomes the duration of the second part.
  assert.deepEqual(edits.splitPhase({ ...phase, until_pointer: "/phases/4/duration" }, 1.25)[1],
    { kind: "set", pointer: "/phases/4/duration", value: 0.75 });
  assert.deepEqual(edits.splitPhase({ ...phase, repeated: true }, 1.25), []);
  assert.deepEqual(edits.appendPhase([phase]), [{ kind: "insert", pointer: "/phases/-", value: { until: 2.5, support: "both" } }]);
});

test("a flight brings along the COG keys that it needs, or says what is missing", () => {
  const phases = [0, 1.3, 1.42].map((from, i) => ({ from, until: [1.3, 1.42, 2.5][i], support: "both", pointer: `/phases/${i}` }));
  const document = { keyframes: [{ t: 0, zmp: "center" }, { t: 1.3, cog: { x: 0.01 } }] };
  const keyframes = document.keyframes.map(({ t }, i) => ({ time: t, time_value: t, pointer: `/keyframes/${i}`, time_pointer: `/keyframes/${i}/t` }));
  const cogAt = () => ({ x: 0.01, y: 0, height: 0.24 });
  const { edits: list, brought, landing } = edits.putSupport({ phases, keyframes }, document, 1, "none", cogAt);
  assert.equal(landing, false);
  assert.deepEqual(brought, [0.82, 1.18, 1.3, 1.42, 1.54, 1.9]);
  assert.deepEqual(list[0], { kind: "set", pointer: "/phases/1/support", value: "none" });
  // The parabola rises by g T^2 / 8. Before it, the quintic takes the COG within T from rest to the
  // lift-off speed g T / 2. It only rises, and begins g T^2 / 4 below the lift-off.
  assert.deepEqual(list.slice(1, 4), [
    { kind: "insert", pointer: "/keyframes/1", value: { t: 0.82, cog: { height: 0.24 } } },
    { kind: "insert", pointer: "/keyframes/1", value: { t: 1.18, cog: { height: 0.187 } } },
    { kind: "set", pointer: "/keyframes/1/cog/height", value: 0.2223 }]);
  assert.deepEqual(list[4].value, { t: 1.42, cog: { height: 0.2223, x: 0.01 } }, "a coordinate with keys needs them, too");
  const state = { phases: phases.slice(0, 2), keyframes };
  assert.deepEqual(edits.putSupport(state, document, 1, "none", cogAt).edits.at(-1),
    { kind: "insert", pointer: "/phases/-", value: { until: 2.42, support: "both" } });
  for (const [index, wrong] of [[0, {}], [1, { swing: {} }], [1, { repeated: true }]])
    assert.match(edits.putSupport({ phases: phases.map((one, i) => i === index ? { ...one, ...wrong } : one), keyframes },
      document, index, "none", cogAt).refused, /[.]$/);
  assert.deepEqual(edits.putSupport({ phases, keyframes }, document, 1, "left", cogAt),
    { edits: [{ kind: "set", pointer: "/phases/1/support", value: "left" }] });
});

test("the trunk's attitude comes back from its quaternion", () => {
  const [roll, pitch, yaw] = [0.2, -0.3, 0.4];
  const half = (angle) => [Math.cos(angle / 2), Math.sin(angle / 2)];
  const [[cr, sr], [cp, sp], [cy, sy]] = [roll, pitch, yaw].map(half);
  const q = { x: sr * cp * cy - cr * sp * sy, y: cr * sp * cy + sr * cp * sy, z: cr * cp * sy - sr * sp * cy,
    w: cr * cp * cy + sr * sp * sy };
  const columns = { "base.qx": 0, "base.qy": 1, "base.qz": 2, "base.qw": 3 };
  assert.deepEqual(edits.valueFromRow("torso", [q.x, q.y, q.z, q.w], columns, "rad"), { roll, pitch, yaw });
  assert.deepEqual(edits.valueFromRow("torso", [0, 0, 0, 1], columns, "deg"), { pitch: 0 });
});

test("words that are numbers are written as numbers", () => {
  assert.deepEqual(["0.03", " 1e-2 ", "${a}*2", "left", "0x", ""].map(edits.written),
    [0.03, 0.01, "${a}*2", "left", "0x", ""]);
});

test("a key from the motion has the author's angle unit", () => {
  const columns = { "q.l_knee": 0, "zmp.x": 1, "zmp.y": 2 }, row = [Math.PI / 6, 0.01234567, -0.02];
  assert.equal(edits.valueFromRow("l_knee", row, columns, "deg"), 30);
  assert.equal(edits.valueFromRow("l_knee", row, columns, "rad"), 0.5236);
  assert.deepEqual(edits.valueFromRow("zmp", row, columns, "deg"), [0.0123, -0.02]);
});

test("strain grows towards the limit for margins and for shares", () => {
  const margin = { sense: "low", limit: 0, warn: 10, values: [20, 10, 5, -1, null] };
  const share = { sense: "high", limit: 100, warn: 70, values: [] };
  assert.deepEqual([10, 5, 0].map((v) => strain(margin, v)), [0, 0.5, 1]);
  assert.deepEqual([70, 85, 100].map((v) => strain(share, v)), [0, 0.5, 1]);
  assert.equal(strain(margin, null), null);
  assert.deepEqual(worstIn(margin, 0.01, 0, 0.03), { share: 0.5, index: 2 });
  assert.equal(worstIn(margin, 0.01, 0.04, 0.05), null);
  assert.deepEqual(worstIn(margin, 0.01, 0, Infinity).index, 3);
});

test("nothing has the colour of good that is not good", () => {
  const green = (share) => {
    const [r, g] = /rgb\((\d+),(\d+)/.exec(colorOf(share)).slice(1).map(Number);
    return g > 1.5 * r;
  };
  assert.ok(green(-1) && green(0));
  for (const share of [0.5, 0.8, 1, 1.01, 5]) assert.ok(!green(share), `at ${share}`);
  assert.ok(heightOf(1.01) > heightOf(1) && heightOf(1) > heightOf(0) && heightOf(null) === 0);
});

test("texts beside each other: every line once, equal lines as equal", () => {
  let seed = 7;
  const random = (n) => (seed = (seed * 16807) % 2147483647) % n;
  for (let round = 0; round < 50; ++round) {
    const left = Array.from({ length: random(12) }, () => "abc"[random(3)]);
    const right = left.flatMap((line) => random(4) ? [line] : random(2) ? [] : [line, "x"]);
    for (const most of [100, 0]) {
      const rows = sideBySide(left.join("\n"), right.join("\n"), most);
      assert.equal(rows.map((row) => row.left).filter((line) => line !== null).join("\n"), left.join("\n"));
      assert.equal(rows.map((row) => row.right).filter((line) => line !== null).join("\n"), right.join("\n"));
      for (const row of rows) if (row.same) assert.equal(row.left, row.right);
    }
  }
  const one = sideBySide("a\nb\nc\nd\ne\nf\ng\nh", "a\nb\nc\nd\ne\nf\ng\nH");
  assert.equal(one.filter((row) => !row.same).length, 1);
  assert.deepEqual(nearDifferences(one, 1)[0], { gap: 6 });
});

// ---- what may be written

const schema = JSON.parse(readFileSync(new URL("../../docs/schemas/pattern-1.schema.json", import.meta.url)));
const definition = (node) => node?.$ref ? definition(schema.$defs[node.$ref.split("/").at(-1)]) : node;

/// The part of the schema for a path. Where the schema has several alternatives (oneOf), takes the first one in which
/// the path exists.
function schemaAt(node, path) {
  if (!path.length) return definition(node);
  const now = definition(node);
  for (const way of [now, ...now.oneOf || []]) {
    const part = definition(way).properties?.[path[0]];
    if (part) return schemaAt(part, path.slice(1));
  }
  return null;
}

const roots = { pattern: schema, phase: schema.$defs.phase, keyframe: schema.$defs.keyframe, disturbance: schema.$defs.disturbance };
const whole = { phase: { swing: { step: {} }, viip: { jump: {}, velocity: [0, 0] } }, disturbance: { type: "impulse" } };

test("the page offers what the schema knows, with its choices", () => {
  const state = { postures: ["home"] };
  for (const [kind, fields] of Object.entries(fieldsOf))
    for (const { path, choices } of fields(whole[kind] || {}, state)) {
      const known = schemaAt(roots[kind], path);
      assert.ok(known, `${kind}: ${path.join(".")} is not in the schema`);
      const listed = known.enum || known.oneOf?.flatMap((one) => definition(one).enum || []);
      if (choices && listed?.length) assert.deepEqual([...choices].sort(), [...listed].sort(), path.join("."));
    }
});

// The members of a keyframe, a phase and a swing that the form does not offer have a control of
// their own: dragging, New key of, or a button.
test("the page leaves out no member of a phase, a swing or a keyframe without a control of its own", () => {
  const own = { phase: ["until", "duration", "support", "swing", "viip"],
    keyframe: ["t", "after", "joints", "feet", "hands", "gaze", "weights"] };
  for (const [kind, others] of Object.entries(own)) {
    const offered = fieldsOf[kind](whole[kind] || {}, { postures: [] }).map(({ path }) => path[0]);
    for (const name of Object.keys(roots[kind].properties))
      assert.ok(offered.includes(name) || others.includes(name), `${kind}: ${name}`);
  }
  const swing = fieldsOf.phase(whole.phase, {}).filter(({ path }) => path[0] === "swing").map(({ path }) => path[1]);
  for (const name of Object.keys(schema.$defs.swing.properties))
    assert.ok(swing.includes(name) || ["foot", "to"].includes(name), `swing: ${name}`);
});

test("a pattern with comments is read, and what is missing is known", () => {
  const text = '{ // "a": 1\n "phases": [{ "until": 1, "support": "left", /* } */ "swing": { "foot": "right", "step": { "forward": "${a} // b" } } }] }';
  const pattern = parsePattern(text);
  assert.equal(valueAt(pattern, "/phases/0/swing/step/forward"), "${a} // b");
  assert.deepEqual(missingFields("phase", "/phases/0", pattern.phases[0], {}).map(({ pointer }) => pointer),
    ["/phases/0/swing/lift", "/phases/0/swing/step/side", "/phases/0/swing/step/up", "/phases/0/swing/step/turn"]);
  assert.equal(parsePattern("{ phases: 1 }"), null);
  assert.equal(valueAt(null, "/phases"), undefined);
});

test("a keyframe joins another one unless both have the same key", () => {
  const pattern = { keyframes: [{ t: 1, joints: { a: 1 }, zmp: "left" }, { t: 2, joints: { b: 2 } }, { after: 1, zmp: "right" }] };
  const frames = pattern.keyframes.map((frame, i) => ({ pointer: `/keyframes/${i}`, time: i + 1, time_value: frame.t ?? frame.after,
    time_pointer: `/keyframes/${i}/${frame.t ? "t" : "after"}`, time_base: frame.t ? 0 : i }));
  const state = { keyframes: frames };
  assert.deepEqual(edits.joinKeyframe(state, pattern, frames[1], frames[0]), [
    { kind: "set", pointer: "/keyframes/0/joints/b", value: 2 }, { kind: "remove", pointer: "/keyframes/1" },
    { kind: "set", pointer: "/keyframes/2/after", value: 2 }]);
  assert.equal(edits.joinKeyframe(state, pattern, frames[2], frames[0]), null);
});

test("a drag of the COG or the trunk is level or upright, by its larger part", () => {
  const c = Math.cos(0.35), s = Math.sin(0.35), right = [0.6, 0.8, 0], up = [-0.8 * s, 0.6 * s, c];
  const inPicture = (x, y) => [0, 1, 2].map((i) => x * right[i] + y * up[i]);
  largerPart(inPicture(0.002, -0.03), right, up).forEach((value, i) => near(value, [0, 0, -0.03 / c][i]));
  largerPart(inPicture(0.03, 0.01), right, up).forEach((value, i) => near(value, [0.018, 0.024, 0][i]));
  // From above, both directions of the picture are level.
  largerPart([0.1, 0.2, 0.05], [1, 0, 0], [0, 0.8, 0.6 - 0.2]).forEach((value, i) => near(value, [0.1, (0.8 * 0.2 + 0.4 * 0.05) / 0.8, 0][i]));
});

test("a drag moves a foot over the ground, or with Shift up and down, from every side", () => {
  const c = Math.cos(0.35), s = Math.sin(0.35), right = [0.6, 0.8, 0], up = [-0.8 * s, 0.6 * s, c];
  const inPicture = (x, y) => [0, 1, 2].map((i) => x * right[i] + y * up[i]);
  const is = (way, wanted) => way.forEach((value, i) => near(value, wanted[i]));
  // The foot stays under the pointer: the part of its movement in the picture is that of the drag.
  const level = footWay(inPicture(0.02, 0.03), right, up, false);
  near(level[2], 0);
  near(level[0] * right[0] + level[1] * right[1], 0.02);
  near(level[0] * up[0] + level[1] * up[1], 0.03);
  is(footWay(inPicture(0.02, 0.03), right, up, true), [0, 0, 0.03 / c]);
  // From the side the ground is a line, and from above nothing moves up.
  is(footWay([0.02, 0, 0.03], [1, 0, 0], [0, 0, 1], false), [0.02, 0, 0]);
  is(footWay([0.02, 0, 0.03], [1, 0, 0], [0, 0, 1], true), [0, 0, 0.03]);
  is(footWay([0.02, 0.03, 0], [1, 0, 0], [0, 1, 0], false), [0.02, 0.03, 0]);
  is(footWay([0.02, 0.03, 0], [1, 0, 0], [0, 1, 0], true), [0, 0, 0]);
});

test("a view that is nearly along an axis drags exactly across it", () => {
  assert.deepEqual(nearAxis([0.1, -0.99, -0.1]).map((x) => x + 0), [0, -1, 0]);
  assert.deepEqual(nearAxis([0.6, 0.7, -0.3]), [0.6, 0.7, -0.3]);
});

test("a push has its direction in words, and an arrow where it acts on the COG", () => {
  const push = { type: "impulse", size: 2, unit: "N s", link: "cog", direction: [0, 2, 0], from: 1, until: 1.02, text: "" };
  assert.equal(wordsOfPush(push), "impulse of 2 N s on cog towards 90 degrees");
  assert.equal(wordsOfPush({ ...push, direction: [0, 0, -1] }), "impulse of 2 N s on cog downwards");
  assert.equal(wordsOfPush({ ...push, direction: undefined }), "impulse of 2 N s on cog");
  assert.equal(wordsOfPush({ type: "friction", text: "friction 0.3 at 1 s" }), "friction 0.3 at 1 s");
  assert.deepEqual(arrowsOf([push, { ...push, link: "head" }, { type: "friction" }]),
    [{ begin: 1, end: 1.02, from_cog: [0, 0, 0], direction: [0, 1, 0] }]);
});

test("a value that a keyframe may have says of what it is", () => {
  const names = fieldsOf.keyframe({}, { postures: [] }).map(({ path }) => nameAmongOthers(path));
  assert.deepEqual(names, ["interpolation", "posture", "ZMP", "COG forward", "COG left", "COG height", "vertical force", "trunk roll", "trunk pitch", "trunk yaw"]);
});

// Two phases on the right foot from 1 to 1.5 s, a last one, and keys; two keys have times relative to the key before
// them.
const walk = () => {
  const document = { parameters: { i: 3 }, phases: [{ until: 1, support: "both" },
    { until: 1.4, support: "right", swing: { foot: "left", step: {} } }, { duration: 0.1, support: "both" }, { until: "${a} + 2", support: "both" }],
  keyframes: [{ t: 0, zmp: "center" }, { t: 1, zmp: "right" }, { after: 0.4, zmp: "right" }, { t: 1.45, zmp: "left" }, { after: 1, zmp: "center" }] };
  const times = [0, 1, 1.4, 1.45, 2.45];
  const keyframes = document.keyframes.map((frame, i) => {
    const key = frame.t === undefined ? "after" : "t";
    return { time: times[i], time_value: frame[key], time_pointer: `/keyframes/${i}/${key}`, time_base: key === "t" ? 0 : times[i - 1], pointer: `/keyframes/${i}` };
  });
  const ends = [0, 1, 1.4, 1.5, 3.2];
  const phases = document.phases.map((phase, i) => {
    const key = phase.until === undefined ? "duration" : "until";
    return { from: ends[i], until: ends[i + 1], until_value: phase[key], until_pointer: `/phases/${i}/${key}`, pointer: `/phases/${i}`,
      support: phase.support, swing: phase.swing ?? null };
  });
  return { document, state: { keyframes, phases, disturbances: [] } };
};

test("phases and their keys become blocks that repeat, and what is later comes later", () => {
  const { document, state } = walk();
  const { edits: made, refused } = edits.repeatPhases(state, document, 1, 2, 3);
  assert.equal(refused, undefined);
  assert.deepEqual(made, [
    { kind: "set", pointer: "/phases/1/until", value: "1.4 + 0.5*${round}" },
    { kind: "set", pointer: "/keyframes/1/t", value: "1 + 0.5*${round}" },
    { kind: "set", pointer: "/keyframes/3/t", value: "1.45 + 0.5*${round}" },
    { kind: "set", pointer: "/phases/3/until", value: 4.2 },
    { kind: "repeat", pointer: "/phases/1", value: { items: 2, repeat: 3, count: "round" } },
    { kind: "repeat", pointer: "/keyframes/1", value: { items: 3, repeat: 3, count: "round" } }]);
});

test("where a round ends with a key, the one at its beginning stays outside", () => {
  const { document, state } = walk();
  document.keyframes[3].t = 1.5;
  Object.assign(state.keyframes[3], { time: 1.5, time_value: 1.5 });
  Object.assign(state.keyframes[4], { time: 2.5, time_base: 1.5 });
  const { edits: made } = edits.repeatPhases(state, document, 1, 2, 3);
  assert.deepEqual(made, [
    { kind: "set", pointer: "/phases/1/until", value: "1.4 + 0.5*${round}" },
    { kind: "remove", pointer: "/keyframes/2/after" },
    { kind: "set", pointer: "/keyframes/2/t", value: "1.4 + 0.5*${round}" },
    { kind: "set", pointer: "/keyframes/3/t", value: "1.5 + 0.5*${round}" },
    { kind: "set", pointer: "/phases/3/until", value: 4.2 },
    { kind: "repeat", pointer: "/phases/1", value: { items: 2, repeat: 3, count: "round" } },
    { kind: "repeat", pointer: "/keyframes/2", value: { items: 2, repeat: 3, count: "round" } }]);
});

test("a block whose rounds begin with a key gets another number of rounds, and a key at its end moves", () => {
  const { document, state } = rounds();
  const own = state.keyframes.filter((one) => one.repeated).map((one) => ({ ...one, time: one.time === 1.4 ? 1 : one.time }));
  state.keyframes = [state.keyframes[0], ...[0, 1, 2].map((round) => ({ ...own[0], time: 1 + 0.5 * round })), { time: 2.5, time_value: 2.5, time_base: 0, pointer: "/keyframes/3", time_pointer: "/keyframes/3/t" }];
  const { edits: made, refused } = edits.setRounds(state, document, state.phases[3], 5);
  assert.equal(refused, undefined);
  assert.deepEqual(made.filter(({ pointer }) => pointer.startsWith("/keyframes")), [
    { kind: "set", pointer: "/keyframes/2/repeat", value: 5 }, { kind: "set", pointer: "/keyframes/3/t", value: 3.5 }]);
});

test("disturbances after a block that repeats come later, and those within it stay in its first round", () => {
  const { document, state } = walk();
  document.world = { motion: [{ at: 0.5 }, { at: 2 }] };
  state.disturbances = [0.2, 1.2, 1.5, "${push}"].map((at, i) => ({ from: typeof at === "number" ? at : 3, at_value: at, at_pointer: `/scenario/${i}/at` }));
  const { edits: made, kept } = edits.repeatPhases(state, document, 1, 2, 3);
  assert.deepEqual(made.filter((one) => /scenario|world/.test(one.pointer)), [
    { kind: "set", pointer: "/scenario/2/at", value: 2.5 }, { kind: "set", pointer: "/scenario/3/at", value: 4 },
    { kind: "set", pointer: "/world/motion/1/at", value: 3 }]);
  assert.equal(kept, "The disturbance at 1.200 s");
});

// The walk with its second and third phase and their keys three times; each round lasts 0.5 s.
const rounds = () => {
  const { document, state } = walk();
  const phases = [0, 1, 2].flatMap((round) => state.phases.slice(1, 3).map((phase, i) => ({ ...phase, from: phase.from + 0.5 * round, until: phase.until + 0.5 * round,
    repeated: true, pointer: `/phases/1/phases/${i}`, until_pointer: `/phases/1/phases/${i}/until` })));
  const keys = [0, 1, 2].flatMap((round) => [1.4, 1.45].map((t, i) => ({ time: t + 0.5 * round, time_value: "...", repeated: true,
    pointer: `/keyframes/2/keyframes/${i}`, time_pointer: `/keyframes/2/keyframes/${i}/t` })));
  const last = { ...state.phases[3], from: 2.5, until: 4.2, until_value: 4.2, pointer: "/phases/2", until_pointer: "/phases/2/until" };
  const end = { time: 3.5, time_value: 3.5, time_base: 0, pointer: "/keyframes/3", time_pointer: "/keyframes/3/t" };
  return { document: { phases: [document.phases[0], { repeat: 3, count: "i", phases: [] }, document.phases[3]],
    keyframes: [{}, {}, { repeat: 3, count: "i", keyframes: [] }, {}] },
  state: { phases: [state.phases[0], ...phases, last], keyframes: [...state.keyframes.slice(0, 2), ...keys, end],
    disturbances: [{ from: 3, at_value: 3, at_pointer: "/scenario/0/at" }] } };
};

test("a block gets another number of rounds with its keys, and what is later moves", () => {
  const { document, state } = rounds();
  assert.deepEqual(edits.roundsOf(state, document, state.phases[3]), { pointer: "/phases/1", rounds: 3 });
  const { edits: made, refused } = edits.setRounds(state, document, state.phases[3], 5);
  assert.equal(refused, undefined);
  assert.deepEqual(made, [
    { kind: "set", pointer: "/phases/1/repeat", value: 5 }, { kind: "set", pointer: "/keyframes/2/repeat", value: 5 },
    { kind: "set", pointer: "/phases/2/until", value: 5.2 }, { kind: "set", pointer: "/keyframes/3/t", value: 4.5 },
    { kind: "set", pointer: "/scenario/0/at", value: 4 }]);
  assert.equal(edits.setRounds(state, document, state.phases[3], 1).edits.find((one) => one.pointer === "/keyframes/3/t").value, 2.5);
  assert.deepEqual(edits.setRounds(state, document, state.phases[3], 3).edits, []);
  assert.ok(edits.setRounds(state, document, state.phases[3], 0).refused);
  document.keyframes[2].repeat = 2;
  assert.ok(edits.setRounds(state, document, state.phases[3], 5).refused);
});

test("the last key of a block before is not the beginning of the next one", () => {
  const { document, state } = rounds();
  const from = state.phases[1].from;
  document.keyframes[1] = { repeat: 3, count: "i", keyframes: [] };
  const earlier = [from - 0.2, from - 0.1, from].map((time) => ({ time, time_value: "...", repeated: true, pointer: "/keyframes/1/keyframes/0", time_pointer: "/keyframes/1/keyframes/0/t" }));
  state.keyframes.splice(1, 1, ...earlier);
  const { edits: made, refused } = edits.setRounds(state, document, state.phases[3], 5);
  assert.equal(refused, undefined);
  assert.deepEqual(made.filter(({ pointer }) => pointer.endsWith("/repeat")).map(({ pointer }) => pointer), ["/phases/1/repeat", "/keyframes/2/repeat"]);
  const plain = walk();
  Object.assign(plain.state.keyframes[1], { repeated: true, pointer: "/keyframes/1/keyframes/0" });
  assert.equal(edits.repeatPhases(plain.state, plain.document, 1, 2, 3).refused, undefined);
});

test("the first key of a leg joint takes the legs from the solver, and the page says so", () => {
  const joints = [{ name: "l_knee", leg: true }, { name: "r_knee", leg: true }, { name: "l_elbow", leg: false }];
  const state = { joints, tracks: [{ name: "zmp", kind: "zmp", keys: [] }, { name: "joint l_elbow", kind: "joint", joint: "l_elbow", keys: [] }] };
  assert.match(edits.legWords(state, "l_knee"), /^l_knee is a joint of a leg.*no longer computed/);
  assert.equal(edits.legWords(state, "l_elbow"), "");
  const keyed = { joints, tracks: [...state.tracks, { name: "joint r_knee", kind: "joint", joint: "r_knee", keys: [] }] };
  assert.equal(edits.legWords(keyed, "l_knee"), "", "the legs follow their keys already");
});

test("a block that repeats is refused where every round would be at the same place", () => {
  const places = [(one) => { one.document.keyframes[2].zmp = [0, 0.04]; }, (one) => { one.document.keyframes[3].cog = { x: 0.1 }; },
    (one) => { one.state.phases[1].swing = { foot: "left", to: [0.1, 0.04] }; }, (one) => { one.state.phases[2].repeated = true; }];
  for (const change of places) {
    const one = walk();
    change(one);
    assert.ok(edits.repeatPhases(one.state, one.document, 1, 2, 3).refused);
  }
  const { document, state } = walk();
  assert.ok(edits.repeatPhases(state, document, 1, 2, 1).refused);
  // If the robot does not walk in the phases, their keys may have places in the world.
  state.phases[1].swing = null;
  document.keyframes[3].zmp = [0, 0.04];
  assert.ok(edits.repeatPhases(state, document, 1, 2, 3).edits);
});

test("a phase gets a goal of VIIP in place of its support and its swing, and back", () => {
  const schema = JSON.parse(readFileSync(new URL("../../docs/schemas/pattern-1.schema.json", import.meta.url)));
  const phase = { pointer: "/phases/1", support: "right", swing: { foot: "left", step: {} } };
  for (const { name, value } of edits.goals.slice(1)) {
    const [first, second, last] = edits.putGoal(phase, name, "deg");
    assert.deepEqual([first, second].map((one) => one.kind + one.pointer), ["remove/phases/1/swing", "remove/phases/1/support"]);
    assert.equal(last.pointer, "/phases/1/viip");
    for (const key of Object.keys(value("deg"))) assert.ok(schema.$defs.viip.properties[key], key);
    assert.equal(edits.goalOf(last.value), name);
  }
  assert.equal(edits.goalOf(null), "none");
  // The keys inside the phase are removed, each by its place in the text before the edit. The keys at both ends of the
  // phase stay.
  const frames = [1, 1.5, 2, 2.5].map((time, i) => ({ time, pointer: `/keyframes/${i}`, time_pointer: `/keyframes/${i}/t`, time_value: time }));
  assert.deepEqual(edits.keysWithin({ from: 1, until: 2.5 }, frames).map(({ time }) => time), [1.5, 2]);
  const away = edits.putGoal({ pointer: "/phases/1", support: "both", from: 1, until: 2.5 }, "jump", "deg", frames);
  assert.deepEqual(away.filter(({ pointer }) => pointer.startsWith("/keyframes")).map(({ kind, pointer }) => [kind, pointer]),
    [["remove", "/keyframes/1"], ["remove", "/keyframes/2"]]);
  assert.deepEqual(edits.putGoal({ pointer: "/phases/1", support: null }, "none", "deg").map((one) => one.pointer), ["/phases/1/viip", "/phases/1/support"]);
});

test("a goal waits for an answer while its phase is selected and the text is the same", () => {
  const wanted = { pointer: "/phases/1", name: "jump", text: "a" }, phase = { kind: "phase", pointer: "/phases/1" };
  assert.equal(edits.stillWanted(wanted, phase, "a"), wanted);
  for (const [selection, text] of [[phase, "b"], [{ kind: "phase", pointer: "/phases/2" }, "a"], [{ kind: "key", pointer: "/keyframes/1/zmp" }, "a"], [null, "a"]])
    assert.equal(edits.stillWanted(wanted, selection, text), null);
  assert.equal(edits.stillWanted(null, phase, "a"), null);
});

test("no keyframe goes that a block which repeats counts its time from", () => {
  const at = (pointer, time, more) => ({ pointer, time, time_pointer: pointer + "/t", time_value: time, time_base: 0, ...more });
  const counts = (pointer, time, time_base, repeated) => at(pointer, time, { time_pointer: pointer + "/after", time_value: time - time_base, time_base, repeated });
  const inBlock = [1.5, 2.1].map((base) => counts("/keyframes/2/keyframes/0", base + 0.6, base, true));
  const keyframes = [at("/keyframes/0", 0.5), at("/keyframes/1", 1.5), ...inBlock], phase = { pointer: "/phases/1", support: "both", from: 1, until: 2 };
  assert.equal(edits.putGoal(phase, "jump", "deg", keyframes), null);
  const tracks = [{ keys: [{ pointer: "/keyframes/1/fz" }, { pointer: "/keyframes/2/keyframes/0/fz" }] }];
  for (const key of tracks[0].keys) assert.equal(edits.removeKey({ keyframes: [...keyframes.slice(0, 2), ...inBlock], tracks }, key) === null, key === tracks[0].keys[0]);
  // A keyframe whose time is relative to the last round keeps its time.
  const later = counts("/keyframes/3", 3, 2.7, false);
  assert.deepEqual(edits.removeKey({ keyframes: [...keyframes, later], tracks }, tracks[0].keys[1]),
    [{ kind: "remove", pointer: "/keyframes/2/keyframes/0" }, { kind: "set", pointer: "/keyframes/3/after", value: 1.5 }]);
  assert.equal(edits.joinKeyframe({ keyframes }, { keyframes: [{ t: 0.5, fz: 1 }, { t: 1.5, zmp: "left" }] }, keyframes[1], keyframes[0]), null);
  // A later keyframe is no hindrance if it has a time of its own, or if it is outside of blocks.
  assert.ok(edits.putGoal(phase, "jump", "deg", [...keyframes.slice(0, 2), at("/keyframes/2/keyframes/0", 2.1, { repeated: true })]));
  assert.deepEqual(edits.putGoal(phase, "jump", "deg", [...keyframes.slice(0, 2), counts("/keyframes/2", 2.1, 1.5)])[1], { kind: "set", pointer: "/keyframes/2/after", value: 1.6 });
});

/// A value of the page has what the schema asks for, and nothing else; words among choices are known.
function fits(value, node) {
  const { properties, required = [], oneOf } = definition(node);
  for (const [name, one] of Object.entries(value)) {
    assert.ok(properties[name], name);
    const known = definition(properties[name]).enum;
    if (known) assert.ok(known.includes(one), `${name}: ${one}`);
  }
  for (const name of required) assert.ok(value[name] !== undefined, name);
  const own = value.type && oneOf?.find((way) => way.properties?.type?.const === value.type);
  for (const name of own?.required ?? []) assert.ok(value[name] !== undefined, `${value.type}: ${name}`);
  for (const name of Object.keys(own ? value : {})) assert.ok(own.propertyNames.enum.includes(name), `${value.type}: ${name}`);
  if (oneOf?.every((way) => Object.keys(way).join() === "required"))
    assert.equal(oneOf.filter((way) => way.required?.every((name) => value[name] !== undefined)).length, 1, JSON.stringify(value));
}

test("what the page adds to a pattern has what the schema asks for", () => {
  const { block, patch, field, motion, disturbance, quantity, uncertain_push: push } = schema.$defs;
  for (const [list, node] of [["blocks", block], ["patches", patch]]) {
    const { value, pointer } = parts.addToGround(list)[0];
    assert.equal(pointer, `/world/${list}/-`);
    fits(value, node);
  }
  fits(parts.addField()[0].value, field);
  for (const unit of ["deg", "rad"]) {
    fits(parts.addFloorMotion(1.23456, unit)[0].value, motion);
    fits(parts.addUncertainPush(unit)[0].value, push);
    for (const { what } of parts.quantities) fits(parts.addQuantity(what, unit)[0].value, quantity);
    const state = { angle_unit: unit, joints: [{ name: "l_knee" }], links: ["torso"] };
    for (const { type } of parts.disturbances) fits(parts.addOther(type, 1, state)[0].value, disturbance);
  }
  // The page offers all kinds that the schema has.
  assert.deepEqual(parts.quantities.map(({ what }) => what).sort(), [...quantity.properties.what.enum].sort());
  assert.deepEqual([...parts.disturbances.map(({ type }) => type), "impulse", "force", "torque"].sort(), [...disturbance.properties.type.enum].sort());
});

test("a new part of the ground lies where no other one is", () => {
  const block = parts.addToGround("blocks")[0].value, patch = parts.addToGround("patches", { blocks: [block] })[0].value;
  assert.deepEqual([block.x, patch.x], [[0.1, 0.3], [0.3, 0.5]]);
  const field = parts.addField({ blocks: [block], patches: [patch] })[0].value;
  assert.equal(field.origin[0], 0.5);
  assert.ok(field.heights[0].every((height) => height === 0) && field.heights.flat().some((height) => height > 0));
  assert.deepEqual(parts.addToGround("blocks", { field, blocks: [{ position: [1, 0], radius: 0.1 }] })[0].value.x, [1.1, 1.3]);
  assert.equal(parts.freeGround({ blocks: [{ x: ["${a}", "${b}"] }] }), 0.1);
});

test("a new part of the ground lies ahead of the soles", () => {
  const robot = parsePattern(readFileSync(new URL("../../robots/humanoid30/robot.json", import.meta.url), "utf8"));
  const corners = ["left", "right"].flatMap((side) => robot.soles[side].polygon);
  const toes = Math.max(...corners.map(([x]) => x));
  for (const at of [0, 1.23]) {
    const soles = corners.map(([x, y]) => [x + at, y, 0]), from = parts.freeGround(undefined, soles);
    assert.ok(from >= toes + at + 0.02 - 1e-9 && from < toes + at + 0.07, `${from}`);
    for (const list of ["blocks", "patches"]) assert.equal(parts.addToGround(list, {}, soles)[0].value.x[0], from);
    assert.equal(parts.addField({}, soles)[0].value.origin[0], from);
  }
  assert.equal(parts.freeGround({}, [[0.06, 0, 0]]), 0.1);
  assert.equal(parts.freeGround({ blocks: [{ x: [0.1, 0.3] }] }, corners), 0.3);
});

test("a field grows by a copy of its last nodes", () => {
  const field = { heights: [[1, 2], [3, 4]] };
  assert.deepEqual(parts.growField(field, "x"), [{ kind: "insert", pointer: "/world/field/heights/-", value: [3, 4] }]);
  assert.deepEqual(parts.growField(field, "y").map(({ pointer, value }) => [pointer, value]),
    [["/world/field/heights/0/-", 2], ["/world/field/heights/1/-", 4]]);
});

test("the first angle of a pattern brings its unit", () => {
  const trunk = { kind: "set", pointer: "/keyframes/0/torso/pitch", value: 0.1 }, height = { kind: "set", pointer: "/keyframes/0/cog/height", value: 0.2 };
  assert.deepEqual(parts.withUnits({}, [trunk], "rad"), [trunk, { kind: "set", pointer: "/units/angle", value: "rad" }]);
  assert.equal(parts.withUnits({}, parts.addFloorMotion(0, "rad"), "rad").length, 2);
  assert.equal(parts.withUnits({}, parts.addQuantity("slope", "rad"), "rad").length, 2);
  assert.equal(parts.withUnits({}, [height], "rad").length, 1);
  assert.equal(parts.withUnits({ units: { angle: "deg" } }, [trunk], "deg").length, 1);
  const document = { uncertainty: { quantities: [{ what: "backlash" }, { what: "mass" }] } };
  const brings = (pointer, value, kind = "set") => parts.withUnits(document, [{ kind, pointer, value }], "rad").length === 2;
  const angles = [["/postures/turn/l_knee", 1], ["/postures/phases", { l_knee: "${bent}" }], ["/start/left", [0, 0.1, 0, 0.2]], ["/start/left/rpy/2", 1],
    ["/phases/0/swing/to/3", 0.1], ["/phases/0/phases/1/swing", { foot: "left", to: { position: [0, 0, 0], rpy: [0, 0, 1] } }], ["/phases/1/swing/step/turn", 0],
    ["/phases/1/viip", { turn: 0.1, steps: 2 }], ["/keyframes/0/keyframes/1/joints/l_knee", 1], ["/keyframes/0/posture", { l_knee: 1 }],
    ["/keyframes/0/feet/left", [0, 0, 0, 1]], ["/world/ground/roll", 1], ["/scenario/0", { type: "sensor_bias", gyro: [0, 0, 1] }], ["/scenario/0/offset", 1],
    ["/uncertainty/quantities/0/uniform/1", 1], ["/uncertainty/pushes/0/direction", 1], ["/uncertainty/pushes/0/direction/choice/2", 1]];
  for (const [pointer, value] of angles) assert.ok(brings(pointer, value), pointer);
  const others = [["/scenario/0/direction", [0, 1, 0]], ["/scenario/0/direction/1", 1], ["/phases/0/swing/to", [0.1, 0, 0]], ["/phases/0/swing/to/2", 0.1],
    ["/start/right", { position: [0, 0, 0] }], ["/keyframes/0/feet/left", [0, 0.1]], ["/keyframes/0/posture", "home"], ["/defaults/posture", "turn"],
    ["/keyframes/0/weights/yaw", 10], ["/repair/weights", { pitch: 10 }], ["/parameters/turn", 1], ["/keyframes/0/hands/left", [0, 0, 0.2]], ["/name", "slope"],
    ["/uncertainty/quantities/1/uniform/1", 1], ["/uncertainty/quantities/0/source", "slope"], ["/uncertainty/pushes/0/direction/weights/0", 1]];
  for (const [pointer, value] of others) assert.ok(!brings(pointer, value), pointer);
  const push = edits.addDisturbance({ type: "impulse", at: 1, duration: 0.02, direction: [0, 1, 0], size: 2 });
  assert.equal(parts.withUnits({}, push, "rad").length, 1);
  assert.ok(!brings("/keyframes/0/torso/yaw", undefined, "remove") && !brings("/phases/0", { items: 2, repeat: 3, count: "turn" }, "repeat"));
  assert.equal(parts.withUnits({}, parts.addUncertainPush("rad"), "rad").length, 2);
});

test("each number of an uncertain quantity or push has its unit", () => {
  const units = { cog: "m", slope: "deg", bumps: "m", servo_friction: "N m", encoder_offset: "deg", servo_delay: "s", backlash: "deg", attitude_bias: "deg",
    gyro_bias: "deg/s", load_bias: "N", sensor_latency: "s", payload: "kg" };
  for (const { what, words } of parts.quantities) {
    const document = { uncertainty: { quantities: [{ what }] } }, unit = (...path) => unitOf(["uncertainty", "quantities", 0, ...path], "deg", document);
    for (const [name, i] of [["uniform", 0], ["normal", 1], ["truncated", 3], ["choice", 2]]) assert.equal(unit(name, i), units[what] ?? "", `${what} ${name}`);
    assert.ok(units[what] || /[(]factor[)]/.test(words) || what === "friction", `${what} has no unit`);
    for (const path of [["source"], ["weights", 0], ["correlation"], ["axis"], ["each"]]) assert.equal(unit(...path), "");
    assert.equal(unit("point", 2), "m");
  }
  const document = { uncertainty: { pushes: [{ unit: "B", time: "phases" }, { unit: "N s", time: { uniform: [1, 2] } }] } };
  const unit = (i, ...path) => unitOf(["uncertainty", "pushes", i, ...path], "rad", document);
  assert.deepEqual([unit(0, "direction"), unit(0, "direction", "choice", 1), unit(0, "direction", "uniform", 0), unit(0, "direction", "weights", 0), unit(0, "direction", "source")],
    ["rad", "rad", "rad", "", ""]);
  assert.deepEqual([unit(0, "size"), unit(1, "size", "normal", 0), unit(0, "time"), unit(1, "time", "uniform", 1), unit(0, "duration"), unit(0, "unit"), unit(0, "on")],
    ["B", "N s", "", "s", "s", "", ""]);
});

test("bias of a gyro is an angle in each second, and viscous friction counts in rad", () => {
  assert.deepEqual([unitOf(["gyro", 1], "deg"), unitOf(["viscous"], "deg"), unitOf(["viscous"], "rad"), unitOf(["offset"], "deg")], ["deg/s", "N m s/rad", "N m s/rad", "deg"]);
});

test("what may be missing can be chosen to be missing, and what is written is always shown", () => {
  const state = { joints: [{ name: "l_knee" }], links: ["torso"], postures: ["home"] };
  const offered = (value, name, choices) => optionsOf(choices, value[name], optionalField("disturbance", "/scenario/0", value, state, "/scenario/0/" + name));
  assert.deepEqual(offered({ type: "gain_loss", joint: "l_knee", share: 0.3 }, "joint", ["l_knee", "r_knee"]),
    [["", "(all joints)"], ["l_knee", "l_knee"], ["r_knee", "r_knee"]]);
  assert.deepEqual(offered({ type: "impulse", on: "torso" }, "on", ["cog", "torso"])[0], ["", "(cog)"]);
  assert.deepEqual(offered({ type: "payload", on: "torso" }, "on", ["torso"]), [["torso", "torso"]], "a payload needs its link");
  assert.deepEqual(offered({ type: "payload", on: "${link}" }, "on", ["torso"]), [["torso", "torso"], ["${link}", "${link}"]]);
  assert.deepEqual(optionsOf(["true", "false"], false), [["true", "true"], ["false", "false"]]);
});

test("a slope and a bias of the attitude have no axis z", () => {
  const axes = Object.fromEntries(parts.quantities.map(({ what, value }) => [what, value("deg").axis && parts.axesOf(what).join("")]).filter(([, one]) => one));
  assert.deepEqual(axes, { cog: "xyz", slope: "xy", attitude_bias: "xy", gyro_bias: "xyz" });
});

test("only a sine has a frequency", () => {
  const kinds = (motion, shape) => parts.putShape("/world/motion/0", motion, shape).map(({ kind, pointer }) => `${kind} ${pointer.split("/").at(-1)}`);
  assert.deepEqual(kinds({}, "sine"), ["set shape", "set frequency"]);
  assert.deepEqual(kinds({ frequency: 2 }, "ramp"), ["set shape", "remove frequency"]);
  assert.deepEqual(kinds({ frequency: 2 }, "sine"), ["set shape"]);
});

test("the last item of a list takes the list along", () => {
  const document = { world: { motion: [{}, {}], blocks: [{}] }, uncertainty: { quantities: [{}] } };
  const pointer = (path, i) => parts.removeItem(document, path, i)[0].pointer;
  assert.equal(pointer(["world", "motion"], 1), "/world/motion/1");
  assert.equal(pointer(["world", "blocks"], 0), "/world/blocks");
  assert.equal(pointer(["uncertainty", "quantities"], 0), "/uncertainty");
  assert.equal(parts.removeItem({ world: { blocks: [{}] } }, ["world", "blocks"], 0)[0].pointer, "/world");
});

test("what would be left empty goes along, unless it says something when it is empty", () => {
  const document = { repair: { weights: { l_knee: 10 } }, world: { ground: { roll: 1 }, friction: 0.5 }, parameters: { cog: 1 },
    keyframes: [{ t: 0, cog: { height: 0.2 }, weights: { l_knee: 10, r_knee: 10 } }], phases: [{ swing: { foot: "left", step: { forward: 0.1 } } }] };
  const gone = (pointer) => edits.removeValue(document, pointer).map((one) => one.pointer).join();
  assert.equal(gone("/repair/weights/l_knee"), "/repair");
  assert.equal(gone("/world/ground/roll"), "/world/ground");
  assert.equal(gone("/keyframes/0/cog/height"), "/keyframes/0/cog");
  for (const pointer of ["/keyframes/0/weights/l_knee", "/phases/0/swing/step/forward", "/world/friction", "/parameters/cog"]) assert.equal(gone(pointer), pointer);
});

test("a load is on the first link, and an offset is that of a joint that turns", () => {
  const state = { angle_unit: "deg", joints: [{ name: "slide", prismatic: true }, { name: "l_knee", prismatic: false }], links: ["torso", "head"] };
  assert.equal(parts.addOther("payload", 1, state)[0].value.on, "torso");
  assert.equal(parts.addOther("encoder_offset", 1, state)[0].value.joint, "l_knee");
  const { type, at, ...floor } = parts.addOther("floor", 1, state)[0].value, { at: time, ...motion } = parts.addFloorMotion(1, "deg")[0].value;
  assert.deepEqual([type, at, floor], ["floor", time, motion]);
});

test("in flight there is no ZMP, and its curve has a gap", () => {
  const columns = { t: 0, fz: 1, "zmp.y": 2, "cog.y": 3, left_planned: 4, right_planned: 5, "ref_zmp.y": 6 };
  const known = (name, fz, left) => isKnown(name, [1.5, fz, 0.01, 0, left, 0, 0.01], columns, 0.05);
  assert.equal(known("zmp.y", 1e-13, 0), false);
  assert.equal(known("cog.y", 0, 0), true);
  assert.equal(known("zmp.y", 80, 1), true);
  // The reference has a ZMP while a foot is planned to stand, whatever the force is.
  assert.equal(known("ref_zmp.y", 1e-13, 0), false);
  assert.equal(known("ref_zmp.y", 80, 0), false);
  assert.equal(known("ref_zmp.y", 0, 1), true);
  assert.deepEqual(partsOf([null, [0, 1], [1, 1], null, null, [2, 3], null]), [[[0, 1], [1, 1]], [[2, 3]]]);
  assert.equal(linePoints([[2, 3]]), "2.0,3.0 2.0,3.0");
  assert.equal(linePoints([[0, 1], [1, 1]]), "0.0,1.0 1.0,1.0");
});
