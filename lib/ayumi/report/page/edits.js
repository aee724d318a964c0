// What the author does, as edits of the pattern's text: lists of { kind, pointer, value }. The server
// writes them into the text and leaves everything else as it is.

import { token, valueAt } from "./fields.js";

/// Times are written to the millisecond.
export const roundedTime = (t) => Number(t.toFixed(3));

export const sameTime = (a, b) => Math.abs(a - b) < 5e-4;

/// A number where the words are one, else the words: an expression or a name.
export function written(words) {
  const text = words.trim();
  return text !== "" && Number.isFinite(Number(text)) ? Number(text) : text;
}

/// Members that say nothing when they are empty, or may not be empty.
const fleeting = ["weights", "repair", "world", "ground", "defaults", "controller", "uncertainty", "cog", "torso"];

/// Without the value at a pointer, and without what would be left empty around it. `document` is the pattern as written.
export function removeValue(document, pointer) {
  for (;;) {
    const around = pointer.slice(0, pointer.lastIndexOf("/")), value = valueAt(document, around);
    const alone = value && !Array.isArray(value) && Object.keys(value).length === 1;
    if (!alone || !fleeting.includes(around.split("/").at(-1))) return [{ kind: "remove", pointer }];
    pointer = around;
  }
}

/// A time in a block that repeats stands for several times, so it is the author's to change. To an expression the server adds.
export const canDrag = (value, thing = {}) => ["number", "string"].includes(typeof value) && !thing.repeated;

/// The value that makes the time of a key or the end of a phase `time`: some count from the one before.
const timeValue = (time, base) => roundedTime(time - (base || 0));

/// Times between which a keyframe may lie: its neighbours'.
export function roomOfKey(keyframes, pointer) {
  const i = keyframes.findIndex((frame) => pointer.startsWith(frame.pointer + "/"));
  return [i > 0 ? keyframes[i - 1].time + 0.001 : 0,
    i >= 0 && i + 1 < keyframes.length ? keyframes[i + 1].time - 0.001 : 3600];
}

export function roomOfPhase(phases, index) {
  return [phases[index].from + 0.001,
    index + 1 < phases.length ? phases[index + 1].until - 0.001 : 3600];
}

export function moveKey(key, time) {
  return canDrag(key.time_value, key) && !sameTime(key.time, time)
    ? [{ kind: "set", pointer: key.time_pointer, value: timeValue(time, key.time_base) }] : [];
}

/// The end of a phase, and with `along` the keyframes that stand at that end and may follow there.
export function movePhase(state, index, time, along) {
  const phase = state.phases[index];
  if (!canDrag(phase.until_value, phase) || sameTime(phase.until, time)) return [];
  const edits = [{ kind: "set", pointer: phase.until_pointer, value: timeValue(time, phase.until_base) }];
  if (!along) return edits;
  for (const [i, frame] of state.keyframes.entries()) {
    if (!sameTime(frame.time, phase.until) || !canDrag(frame.time_value, frame)) continue;
    const before = state.keyframes[i - 1], after = state.keyframes[i + 1];
    if ((before && before.time >= time) || (after && after.time <= time)) continue;
    edits.push({ kind: "set", pointer: frame.time_pointer, value: timeValue(time, frame.time_base) });
  }
  return edits;
}

/// `value` under `name` in the keyframe at this time; a new keyframe where there is none.
export function putKey(keyframes, time, name, value) {
  const there = keyframes.find((frame) => sameTime(frame.time, time));
  if (there) return [{ kind: "set", pointer: `${there.pointer}/${name}`, value }];
  const i = keyframes.findIndex((frame) => frame.time > time);
  const next = keyframes[i], before = keyframes[(i < 0 ? keyframes.length : i) - 1];
  const added = { kind: "insert", pointer: next ? outermost(next.pointer) : "/keyframes/-",
    value: { t: roundedTime(time), [name]: value } };
  if (!next) return [added];
  // A block that repeats has no room for a key of one of its rounds.
  if (next.repeated && (isRelative(next) || (before && outermost(before.pointer) === outermost(next.pointer))))
    return [];
  return [added, ...follow(next, roundedTime(time))];
}

/// One part of a track, as the angle of one joint, in the keyframe at this time, or in a new one.
export function putPart(keyframes, time, name, part, value) {
  const there = keyframes.find((frame) => sameTime(frame.time, time));
  return there ? [{ kind: "set", pointer: `${there.pointer}/${name}/${part}`, value }]
    : putKey(keyframes, time, name, { [part]: value });
}

/// A place of a hand or of the gaze in the keyframe at this time.
export function putTarget(keyframes, time, handle, place) {
  if (handle.gaze) return putKey(keyframes, time, "gaze", place);
  return putPart(keyframes, time, "hands", handle.link, place);
}

/// The item of the pattern's list that holds a keyframe: itself, or a block that repeats.
const outermost = (pointer) => pointer.split("/").slice(0, 3).join("/");

const isRelative = (frame) => frame.time_pointer.endsWith("/after");

/// A keyframe that counts from the one before it stays at its time when that one is at `base` now.
const follow = (frame, base) => frame && isRelative(frame) && canDrag(frame.time_value, frame)
  ? [{ kind: "set", pointer: frame.time_pointer, value: timeValue(frame.time, base) }] : [];

/// Why no keyframe goes that a block which repeats counts its time from.
export const countedFrom = "A block that repeats counts its time from there, and would move with it. Change it in the text.";

/// Without the keyframes with these pointers, each in all its rounds: what counts from one of them stays at
/// its time. null where it cannot, because it stands in a block that repeats.
function withoutFrames(keyframes, pointers) {
  const goes = (frame) => pointers.includes(frame.pointer);
  const edits = pointers.map((pointer) => ({ kind: "remove", pointer }));
  let base = 0, gap = false;
  for (const frame of keyframes) {
    if (!goes(frame)) {
      const kept = gap ? follow(frame, base) : [];
      if (gap && isRelative(frame) && !kept.length) return null;
      edits.push(...kept);
      base = frame.time;
    }
    gap = goes(frame);
  }
  return edits;
}

/// All of a keyframe in another one, which is at the time that was typed for it; null where both have
/// the same key, or one stands in a block that repeats or is what such a block counts from. `document` is the
/// pattern as written.
export function joinKeyframe(state, document, frame, there) {
  if (frame.repeated || there.repeated) return null;
  const from = valueAt(document, frame.pointer), to = valueAt(document, there.pointer);
  if (!from || !to) return null;
  // They hold for all values of a keyframe, so a key that brought its own would change the others.
  if (["interpolation", "weights"].some((name) => JSON.stringify(from[name]) !== JSON.stringify(to[name]))) return null;
  const edits = [];
  const isParts = (value) => value && typeof value === "object" && !Array.isArray(value);
  for (const [name, value] of Object.entries(from)) {
    if (["t", "after", "interpolation", "weights"].includes(name)) continue;
    if (to[name] === undefined) edits.push({ kind: "set", pointer: there.pointer + token(name), value });
    else if (isParts(value) && isParts(to[name]) && Object.keys(value).every((part) => to[name][part] === undefined))
      for (const [part, one] of Object.entries(value)) edits.push({ kind: "set", pointer: there.pointer + token(name) + token(part), value: one });
    else return null;
  }
  const without = withoutFrames(state.keyframes, [frame.pointer]);
  return without && [...edits, ...without];
}

/// A key without its keyframe's other tracks; a keyframe with nothing else goes as a whole. null where a
/// block that repeats would move with it.
export function removeKey(state, key) {
  const frame = state.keyframes.find((one) => key.pointer.startsWith(one.pointer + "/"));
  const others = state.tracks.flatMap((track) => track.keys).filter((one) => one !== key &&
    frame && one.pointer.startsWith(frame.pointer + "/"));
  if (frame && others.length === 0 && !frame.more) return withoutFrames(state.keyframes, [frame.pointer]);
  return [{ kind: "remove", pointer: key.pointer }];
}

/// What the motion has at a time (the trunk's attitude as roll, pitch and yaw about z, y, x), as the value of a key of that track.
export function valueFromRow(track, row, columns, angleUnit) {
  const metres = (name) => Number(row[columns[name]].toFixed(4));
  if (track === "zmp") return [metres("zmp.x"), metres("zmp.y")];
  if (track === "cog") return { x: metres("cog.x"), y: metres("cog.y"), height: metres("cog.z") };
  if (track === "fz") return Number(row[columns.fz].toFixed(1));
  const inUnit = (angle) => angleUnit === "deg" ? Number((angle * 180 / Math.PI).toFixed(2))
    : Number(angle.toFixed(4));
  if (track !== "torso") return inUnit(row[columns["q." + track]]);
  const [x, y, z, w] = ["x", "y", "z", "w"].map((name) => row[columns["base.q" + name]]);
  const turns = { roll: Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
    pitch: Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x)))),
    yaw: Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) };
  const kept = Object.entries(turns).map(([name, angle]) => [name, inUnit(angle)]).filter(([, angle]) => angle);
  return kept.length ? Object.fromEntries(kept) : { pitch: 0 };
}

/// A phase is cut in two at a time within it; a phase with a swing stays whole.
export function splitPhase(phase, time) {
  if (phase.swing || !phase.support || phase.repeated) return [];
  if (time <= phase.from + 5e-4 || time >= phase.until - 5e-4) return [];
  const rest = phase.until_pointer.endsWith("/duration")
    ? [{ kind: "set", pointer: phase.until_pointer, value: roundedTime(phase.until - time) }] : [];
  return [{ kind: "insert", pointer: phase.pointer, value: { until: roundedTime(time), support: phase.support } }, ...rest];
}

/// A swing that lands beside the other foot, with the lift that it has without one (docs/formats.md).
export function addSwing(phase, foot) {
  return [{ kind: "set", pointer: phase.pointer + "/swing", value: { foot, step: { forward: 0, side: 0, turn: 0 }, lift: 0.02 } }];
}

const gravity = 9.80665;
const tenths = (value) => Number(value.toFixed(4));

/// How long and how deep the COG moves on the ground before a flight of `length` s and after it: as
/// deep as the quintic from rest to the lift-off of the parabola needs to rise all the way, and at
/// most by a fifth of the height (about what legs that are nearly straight have).
function stoopOf(length, room, height) {
  const deepest = 0.2 * height;
  const time = Math.min(length, room / 4, -2 * length + Math.sqrt(4 * length ** 2 + 20 * deepest / gravity));
  return { time, depth: gravity * time * (4 * length + time) / 20 };
}

/// Another support of a phase, as { edits } or { refused: why }. A flight follows a parabola, so
/// "none" brings along the COG keys that are missing: at lift-off and touchdown, so low that the top of
/// the parabola has the present height, a stoop before and after, and a phase to land in. `cogAt(t)` is the present COG { x, y, height }.
export function putSupport(state, document, index, support, cogAt) {
  const phase = state.phases[index], own = { kind: "set", pointer: phase.pointer + "/support", value: support };
  if (support !== "none") return { edits: [own] };
  if (index === 0 || [-1, 1].some((way) => state.phases[index + way]?.support === "none"))
    return { refused: "A flight needs a phase on the ground before it and after it. Add one, or cut this phase first." };
  if (phase.swing) return { refused: "In a flight no foot swings. Remove the swing of this phase first." };
  const inBlock = { refused: "This flight needs keys of the COG height at lift-off and touchdown, but a block that repeats " +
    "has no room for new keys. Write them in the text." };
  if (phase.repeated) return inBlock;
  const last = index + 1 === state.phases.length, landing = last ? 1 : state.phases[index + 1].until - phase.until;
  const written = state.keyframes.map((frame) => ({ time: frame.time, cog: valueAt(document, frame.pointer)?.cog }));
  const keyed = (part) => written.filter(({ cog }) => cog?.[part] !== undefined);
  const values = new Map();
  const put = (time, part, value) => {
    // The edges of the flight count exactly, even where they are no full milliseconds.
    const t = time === phase.from || time === phase.until ? Number(time.toFixed(9)) : roundedTime(time);
    if (keyed(part).some((one) => sameTime(one.time, t))) return;
    values.set(t, { ...values.get(t), [part]: tenths(value) });
  };
  const length = phase.until - phase.from;
  const edgeHeight = (time) => {
    const there = keyed("height").some((one) => sameTime(one.time, time)), { height } = cogAt(time);
    return there ? height : height - Math.min(gravity * length ** 2 / 8, 0.1 * height);
  };
  for (const time of [phase.from, phase.until]) {
    put(time, "height", edgeHeight(time));
    for (const part of ["x", "y"]) if (keyed(part).length) put(time, part, cogAt(time)[part]);
  }
  for (const [edge, way, room] of [[phase.from, -1, phase.from - state.phases[index - 1].from], [phase.until, 1, landing]]) {
    const inside = (one) => (one.time - edge) * way > 5e-4 && (one.time - edge) * way < room + 5e-4;
    if (keyed("height").some(inside)) continue;
    const low = edgeHeight(edge), { time, depth } = stoopOf(length, room, low);
    put(edge + way * time, "height", low - depth - 5e-5);
    put(edge + 4 * way * time, "height", cogAt(edge).height);
  }
  const edits = [own];
  for (const time of [...values.keys()].sort((a, b) => a - b)) {
    const there = state.keyframes.find((frame) => sameTime(frame.time, time)), value = values.get(time);
    const added = there && written.find((one) => sameTime(one.time, time)).cog !== undefined
      ? Object.entries(value).map(([part, one]) => ({ kind: "set", pointer: `${there.pointer}/cog/${part}`, value: one }))
      : putKey(state.keyframes, time, "cog", value);
    if (!added.length) return inBlock;
    for (const one of added) if (one.kind === "insert") one.value.t = time;
    // Of two new keyframes before one that counts from the one before it, the later one counts.
    for (const one of added) {
      const same = edits.findIndex((other) => other.kind === "set" && other.pointer === one.pointer);
      if (same >= 0) edits.splice(same, 1);
      edits.push(one);
    }
  }
  if (last) edits.push({ kind: "insert", pointer: "/phases/-", value: { until: roundedTime(phase.until + landing), support: "both" } });
  return { edits, brought: [...values.keys()].sort((a, b) => a - b), landing: last };
}

/// What a phase of VIIP may be asked for, each with values to begin with (docs/formats.md).
export const goals = [
  { name: "none", words: "no goal: keys", value: null },
  { name: "step", words: "steps on the spot", value: () => ({ step: "in_place", steps: 4 }) },
  { name: "velocity", words: "steps at a velocity", value: () => ({ velocity: [0.05, 0], steps: 6 }) },
  { name: "turn", words: "steps that turn", value: (angle) => ({ turn: angle === "deg" ? 10 : 0.17, steps: 6 }) },
  { name: "cog", words: "the COG at a place", value: () => ({ cog: [0.01, 0, 0] }) },
  { name: "cog_velocity", words: "the COG at a velocity", value: () => ({ cog_velocity: [0.01, 0, 0] }) },
  { name: "jump", words: "jumps", value: () => ({ jump: { height: 0.03 } }) },
];

/// Which of the goals a phase has, by name.
export function goalOf(viip) {
  if (!viip) return "none";
  return goals.map((one) => one.name).find((name) => viip[name] !== undefined) ?? "velocity";
}

/// The keyframes inside a phase. VIIP allows none there.
export function keysWithin(phase, keyframes) {
  return keyframes.filter(({ time }) => time > phase.from + 5e-4 && time < phase.until - 5e-4);
}

/// A goal that waits for an answer about its keyframes, as long as the same phase of the same text is
/// selected; otherwise null.
export function stillWanted(wanted, selection, text) {
  return wanted && selection?.kind === "phase" && selection.pointer === wanted.pointer && text === wanted.text ? wanted : null;
}

/// Another goal of VIIP for a phase, without those of `keyframes` that lie inside it, or keys again. The
/// other values of the phase stay. null where a block that repeats would move with these keyframes.
export function putGoal(phase, name, angleUnit, keyframes = []) {
  const pointer = phase.pointer, goal = goals.find((one) => one.name === name);
  if (!goal.value)
    return phase.support ? [] : [{ kind: "remove", pointer: pointer + "/viip" }, { kind: "set", pointer: pointer + "/support", value: "both" }];
  const without = withoutFrames(keyframes, keysWithin(phase, keyframes).map((frame) => frame.pointer));
  return without && [...without,
    ...phase.swing ? [{ kind: "remove", pointer: pointer + "/swing" }] : [],
    ...phase.support ? [{ kind: "remove", pointer: pointer + "/support" }] : [],
    { kind: "set", pointer: pointer + "/viip", value: goal.value(angleUnit) }];
}

/// A time of each round: what is written, and the length of the rounds before.
const inRounds = (value, length, count) => `${value} + ${length}*\${${count}}`;

/// The keyframes that belong to a block from `from` to `until`: those up to its end, or, where each round
/// `begins` with one, those from its beginning on.
const inBlock = (from, until, begins) => ({ time }) => begins ? time > from - 5e-4 && time < until - 5e-4 : time > from + 5e-4 && time < until + 5e-4;

/// Those that are later than this block.
const afterBlock = (until, begins) => ({ time }) => time >= until + (begins ? -5e-4 : 5e-4);

/// All that comes after a phase comes later by `shift`: phases, keyframes (`isLater`), disturbances, and motions of
/// the floor. A keyframe that counts from the one before it follows that one, if it moves (`after`).
function moveLater(state, document, last, shift, after, isLater) {
  const edits = [], { until } = state.phases[last], set = (pointer, value) => edits.push({ kind: "set", pointer, value });
  const refused = { refused: "A later block that repeats has times of its own. Change them in the text." };
  for (const phase of state.phases.slice(last + 1)) {
    if (!phase.until_pointer.endsWith("/until")) continue;
    if (!canDrag(phase.until_value, phase)) return refused;
    set(phase.until_pointer, roundedTime(phase.until + shift));
  }
  for (const [i, frame] of state.keyframes.filter(isLater).entries()) {
    if (isRelative(frame) && (i > 0 || after)) continue;
    if (!canDrag(frame.time_value, frame)) return refused;
    set(frame.time_pointer, timeValue(frame.time + shift, frame.time_base));
  }
  for (const one of state.disturbances)
    if (one.from >= until - 5e-4 && canDrag(one.at_value)) set(one.at_pointer, roundedTime(one.from + shift));
  for (const [i, motion] of (document.world?.motion ?? []).entries()) {
    if (typeof motion.at !== "number") return { refused: "A motion of the floor has an expression as its time. Change the rounds in the text." };
    if (motion.at >= until - 5e-4) set(`/world/motion/${i}/at`, roundedTime(motion.at + shift));
  }
  return { edits };
}

/// Disturbances that stay in the first round of a block, in words; "" where there are none.
function disturbancesWithin(state, from, until) {
  const times = state.disturbances.filter((one) => one.from >= from - 5e-4 && one.from < until - 5e-4).map((one) => `${one.from.toFixed(3)} s`);
  return times.length ? `The disturbance at ${times.join(" and at ")}` : "";
}

/// The phases from `first` to `last` and their keyframes as blocks that repeat, `times` rounds in all;
/// what comes later comes later. { edits } or { refused: why }.
export function repeatPhases(state, document, first, last, times) {
  const phases = state.phases.slice(first, last + 1), from = phases[0].from, until = phases.at(-1).until;
  const length = Number((until - from).toFixed(6)), shift = (times - 1) * length;
  const walks = phases.some(({ swing }) => swing), valueOf = (frame) => valueAt(document, frame.pointer) ?? {};
  const isPlaced = ({ zmp, cog, feet, hands, gaze }) => (zmp && typeof zmp !== "string") || cog?.x !== undefined || cog?.y !== undefined || feet || hands || gaze;
  // Where the first round begins with a keyframe and ends without one, each round begins as the first one does.
  const frameAt = (time) => state.keyframes.find((frame) => !frame.repeated && sameTime(frame.time, time)), opening = frameAt(from);
  const begins = Boolean(opening) && !frameAt(until) && !(walks && isPlaced(valueOf(opening)));
  const frames = state.keyframes.filter(inBlock(from, until, begins));
  if (!(times >= 2 && Number.isInteger(times))) return { refused: "A block repeats at least two times." };
  if ([...phases, ...frames].some((one) => one.repeated)) return { refused: "A part of this is already in a block that repeats. Change the block in the text." };
  if (phases.some(({ swing }) => swing && !swing.step))
    return { refused: "A swing of these phases lands at a place in the world, so every round would land there. Write it as a step first." };
  const placed = frames.findIndex((frame) => isPlaced(valueOf(frame)));
  if (walks && placed >= 0)
    return { refused: `The keyframe at ${frames[placed].time.toFixed(3)} s names a place in the world, and the robot is elsewhere in each round. ` +
      "Write its ZMP as left, center or right, and leave out places of the COG, the feet, the hands and the gaze." };
  const names = document.parameters ?? {}, count = ["i", "round", "n", "rounds"].find((name) => names[name] === undefined);
  const edits = [], set = (pointer, value) => edits.push({ kind: "set", pointer, value });
  for (const phase of phases)
    if (phase.until_pointer.endsWith("/until")) set(phase.until_pointer, inRounds(phase.until_value, length, count));
  for (const [i, frame] of frames.entries()) {
    if (!isRelative(frame)) set(frame.time_pointer, inRounds(frame.time_value, length, count));
    else if (i === 0) {
      edits.push({ kind: "remove", pointer: frame.time_pointer });
      set(frame.pointer + "/t", inRounds(roundedTime(frame.time), length, count));
    }
  }
  const moved = moveLater(state, document, last, shift, frames.length > 0, afterBlock(until, begins));
  if (moved.refused) return moved;
  edits.push(...moved.edits);
  edits.push({ kind: "repeat", pointer: phases[0].pointer, value: { items: phases.length, repeat: times, count } });
  if (frames.length) edits.push({ kind: "repeat", pointer: frames[0].pointer, value: { items: frames.length, repeat: times, count } });
  return { edits, kept: disturbancesWithin(state, from, until) };
}

/// How often the block around a phase repeats: { pointer, rounds }.
export function roundsOf(state, document, phase) {
  return { pointer: phase.pointer.split("/").slice(0, -2).join("/"), rounds: state.phases.filter((one) => one.pointer === phase.pointer).length };
}

/// Another number of rounds of the block around a phase and of the keyframes that repeat with it; what
/// comes later moves. { edits } or { refused: why }.
export function setRounds(state, document, phase, rounds) {
  const { pointer, rounds: now } = roundsOf(state, document, phase);
  if (!(rounds >= 1 && Number.isInteger(rounds))) return { refused: "The number of rounds is a whole number above 0." };
  if (pointer !== outermost(pointer)) return { refused: "This block is inside another block that repeats. Change its rounds in the text." };
  const own = state.phases.filter((one) => one.pointer.startsWith(pointer + "/")), from = own[0].from, until = own.at(-1).until;
  const repeats = (block) => JSON.stringify(valueAt(document, block)?.repeat), isOwn = (frame) => frame.repeated && repeats(outermost(frame.pointer)) === repeats(pointer);
  // A key at the beginning may also be the last one of another block before.
  const inside = new Set(state.keyframes.filter((frame) => inBlock(from, until, false)(frame) && !sameTime(frame.time, until) && isOwn(frame)).map((frame) => outermost(frame.pointer)));
  const begins = state.keyframes.some((frame) => sameTime(frame.time, from) && inside.has(outermost(frame.pointer))), within = inBlock(from, until, begins);
  const frames = state.keyframes.filter(within), blocks = [...new Set(frames.map((frame) => outermost(frame.pointer)))];
  const other = state.keyframes.find((frame) => within(frame) ? !isOwn(frame)
    : blocks.includes(outermost(frame.pointer)));
  if (other) return { refused: `The keyframe at ${other.time.toFixed(3)} s does not repeat with these phases. Change the rounds in the text.` };
  if (rounds === now) return { edits: [] };
  const kept = disturbancesWithin(state, from + Math.min(rounds, now) * (until - from) / now, until);
  if (kept) return { refused: `${kept} is in a round that would be removed. Move or remove it first.` };
  const moved = moveLater(state, document, state.phases.indexOf(own.at(-1)), (rounds - now) * (until - from) / now, frames.length > 0, afterBlock(until, begins));
  if (moved.refused) return moved;
  return { edits: [...[pointer, ...blocks].map((block) => ({ kind: "set", pointer: block + "/repeat", value: rounds })), ...moved.edits] };
}

/// A phase behind the last one, as long as it takes to look at.
export function appendPhase(phases) {
  return [{ kind: "insert", pointer: "/phases/-",
    value: { until: roundedTime(phases.at(-1).until + 0.5), support: "both" } }];
}

export function addDisturbance({ type, at, duration, direction, size, on }) {
  const value = { type, at: roundedTime(at), duration, direction, [type]: size };
  if (on && on !== "cog") value.on = on;
  return [{ kind: "insert", pointer: "/scenario/-", value }];
}
