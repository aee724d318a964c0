// The author's changes as edits of the pattern's text: lists of { kind, pointer, value }. The
// server writes them into the text and leaves everything else as it is.

import { token, valueAt } from "./fields.js";

/// A time rounded to the millisecond, as times are written.
export const roundedTime = (t) => Number(t.toFixed(3));

export const sameTime = (a, b) => Math.abs(a - b) < 5e-4;

/// A number if the words are one; otherwise the words, which are an expression or a name.
export function written(words) {
  const text = words.trim();
  return text !== "" && Number.isFinite(Number(text)) ? Number(text) : text;
}

/// Members that have no meaning when they are empty, or must not be empty.
const fleeting = ["weights", "repair", "world", "ground", "defaults", "controller", "uncertainty", "cog", "torso"];

/// The edits that remove the value at a pointer, together with the members around it that would
/// become empty. `document` is the pattern as written.
export function removeValue(document, pointer) {
  for (;;) {
    const around = pointer.slice(0, pointer.lastIndexOf("/")), value = valueAt(document, around);
    const alone = value && !Array.isArray(value) && Object.keys(value).length === 1;
    if (!alone || !fleeting.includes(around.split("/").at(-1))) return [{ kind: "remove", pointer }];
    pointer = around;
  }
}

/// What the author should know of a joint of a leg before it gets a key; "" for other joints, and if
/// a leg joint already has a key.
export function legWords(state, name) {
  const isLeg = (joint) => state.joints.some((one) => one.name === joint && one.leg);
  if (!isLeg(name) || state.tracks.some((track) => isLeg(track.joint))) return "";
  return `${name} is a joint of a leg. As soon as one leg joint has a key, all leg joints follow only their keys, ` +
    "and the legs are no longer computed from the feet and the COG.";
}

/// Whether a time can be dragged. A time in a block that repeats stands for several times, so only
/// the author changes it in the text. The server can change an expression by adding a number.
export const canDrag = (value, thing = {}) => ["number", "string"].includes(typeof value) && !thing.repeated;

/// The value that is written so that a key or the end of a phase is at `time`; some times are
/// relative to the previous one.
const timeValue = (time, base) => roundedTime(time - (base || 0));

/// The times between which a keyframe may be moved: those of its neighbours.
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

/// Moves the end of a phase. With `along`, also moves the keyframes at that end that can follow it.
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

/// Puts `value` under `name` into the keyframe at this time, or into a new keyframe if there is
/// none.
export function putKey(keyframes, time, name, value) {
  const there = keyframes.find((frame) => sameTime(frame.time, time));
  if (there) return [{ kind: "set", pointer: `${there.pointer}/${name}`, value }];
  const i = keyframes.findIndex((frame) => frame.time > time);
  const next = keyframes[i], before = keyframes[(i < 0 ? keyframes.length : i) - 1];
  const added = { kind: "insert", pointer: next ? outermost(next.pointer) : "/keyframes/-",
    value: { t: roundedTime(time), [name]: value } };
  if (!next) return [added];
  // A block that repeats has no place for a key of only one of its rounds.
  if (next.repeated && (isRelative(next) || (before && outermost(before.pointer) === outermost(next.pointer))))
    return [];
  return [added, ...follow(next, roundedTime(time))];
}

/// Puts one part of a track, such as the angle of one joint, into the keyframe at this time, or
/// into a new one.
export function putPart(keyframes, time, name, part, value) {
  const there = keyframes.find((frame) => sameTime(frame.time, time));
  return there ? [{ kind: "set", pointer: `${there.pointer}/${name}/${part}`, value }]
    : putKey(keyframes, time, name, { [part]: value });
}

/// Puts a place of a hand or of the gaze into the keyframe at this time.
export function putTarget(keyframes, time, handle, place) {
  if (handle.gaze) return putKey(keyframes, time, "gaze", place);
  return putPart(keyframes, time, "hands", handle.link, place);
}

/// The item of the pattern's list that contains a keyframe: itself, or a block that repeats.
const outermost = (pointer) => pointer.split("/").slice(0, 3).join("/");

const isRelative = (frame) => frame.time_pointer.endsWith("/after");

/// Keeps the time of a keyframe with a relative time, if the previous keyframe is now at `base`.
const follow = (frame, base) => frame && isRelative(frame) && canDrag(frame.time_value, frame)
  ? [{ kind: "set", pointer: frame.time_pointer, value: timeValue(frame.time, base) }] : [];

/// The reason why a keyframe cannot be removed if a block that repeats counts its time from it.
export const countedFrom = "The time of a block that repeats is relative to this keyframe, so the block would move, too. Change the block in the text.";

/// The edits that remove the keyframes with these pointers, each in all its rounds. Keyframes whose
/// times are relative to one of them keep their time. Returns null if this is not possible because
/// such a keyframe is in a block that repeats.
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

/// The edits that move all keys of the keyframe `frame` into the keyframe `there`, which is at the
/// time that the author has typed. Returns null if both keyframes have the same key, if one of them
/// is in a block that repeats, or if the time of such a block is given relative to `frame`.
/// `document` is the pattern as written.
export function joinKeyframe(state, document, frame, there) {
  if (frame.repeated || there.repeated) return null;
  const from = valueAt(document, frame.pointer), to = valueAt(document, there.pointer);
  if (!from || !to) return null;
  // These members apply to all values of a keyframe, so those of the moved keyframe would change
  // the other values.
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

/// The edits that remove a key and keep the keyframe's other tracks. A keyframe that has nothing
/// else is removed as a whole. null if a block that repeats would move with it.
export function removeKey(state, key) {
  const frame = state.keyframes.find((one) => key.pointer.startsWith(one.pointer + "/"));
  const others = state.tracks.flatMap((track) => track.keys).filter((one) => one !== key &&
    frame && one.pointer.startsWith(frame.pointer + "/"));
  if (frame && others.length === 0 && !frame.more) return withoutFrames(state.keyframes, [frame.pointer]);
  return [{ kind: "remove", pointer: key.pointer }];
}

/// The value of the motion at a time, in the form of a key of this track. The trunk's attitude
/// becomes roll, pitch and yaw about z, y, x.
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

/// The edits that cut a phase in two at a time within it. A phase with a swing is not cut.
export function splitPhase(phase, time) {
  if (phase.swing || !phase.support || phase.repeated) return [];
  if (time <= phase.from + 5e-4 || time >= phase.until - 5e-4) return [];
  const rest = phase.until_pointer.endsWith("/duration")
    ? [{ kind: "set", pointer: phase.until_pointer, value: roundedTime(phase.until - time) }] : [];
  return [{ kind: "insert", pointer: phase.pointer, value: { until: roundedTime(time), support: phase.support } }, ...rest];
}

/// Adds a swing that lands beside the other foot, with the default lift (docs/formats.md).
export function addSwing(phase, foot) {
  return [{ kind: "set", pointer: phase.pointer + "/swing", value: { foot, step: { forward: 0, side: 0, turn: 0 }, lift: 0.02 } }];
}

const gravity = 9.80665;
const tenths = (value) => Number(value.toFixed(4));

/// The time and the depth of the stoop of the COG before a flight of `length` s and after it. With
/// this depth, the quintic from rest to the lift-off of the parabola rises all the time. The depth
/// is at most a fifth of the height, about as much as nearly straight legs allow.
function stoopOf(length, room, height) {
  const deepest = 0.2 * height;
  const time = Math.min(length, room / 4, -2 * length + Math.sqrt(4 * length ** 2 + 20 * deepest / gravity));
  return { time, depth: gravity * time * (4 * length + time) / 20 };
}

/// The edits that give a phase another support, as { edits } or { refused: why }. A flight follows
/// a parabola, so "none" also adds missing COG keys and phases: keys at lift-off and touchdown, so
/// low that the top of the parabola has the present height, a stoop before and after, and a phase
/// for the landing. `cogAt(t)` is the present COG { x, y, height }.
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
    // The times of the flight's ends are exact, even if they are not whole milliseconds.
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
    // If two new keyframes are inserted before a keyframe with a relative time, its time is
    // relative to the later one of the two.
    for (const one of added) {
      const same = edits.findIndex((other) => other.kind === "set" && other.pointer === one.pointer);
      if (same >= 0) edits.splice(same, 1);
      edits.push(one);
    }
  }
  if (last) edits.push({ kind: "insert", pointer: "/phases/-", value: { until: roundedTime(phase.until + landing), support: "both" } });
  return { edits, brought: [...values.keys()].sort((a, b) => a - b), landing: last };
}

/// The goals that a phase of VIIP may have, each with initial values (docs/formats.md).
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

/// The keyframes inside a phase. VIIP does not allow any there.
export function keysWithin(phase, keyframes) {
  return keyframes.filter(({ time }) => time > phase.from + 5e-4 && time < phase.until - 5e-4);
}

/// A goal that waits for the author's decision about its keyframes, as long as the same phase of
/// the same text is selected; otherwise null.
export function stillWanted(wanted, selection, text) {
  return wanted && selection?.kind === "phase" && selection.pointer === wanted.pointer && text === wanted.text ? wanted : null;
}

/// The edits that give a phase another goal of VIIP and remove those of `keyframes` that are inside
/// it. Without a goal, the edits make it a phase with keys again. The other values of the phase do
/// not change. Returns null if a block that repeats would move with these keyframes.
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

/// A time in each round as an expression: the written time plus the length of the previous rounds.
const inRounds = (value, length, count) => `${value} + ${length}*\${${count}}`;

/// The keyframes that belong to a block from `from` to `until`: if each round `begins` with a
/// keyframe, those from its beginning on, without the one at its end; otherwise those after its
/// beginning, with the one at its end.
const inBlock = (from, until, begins) => ({ time }) => begins ? time > from - 5e-4 && time < until - 5e-4 : time > from + 5e-4 && time < until + 5e-4;

/// The keyframes that are later than this block.
const afterBlock = (until, begins) => ({ time }) => time >= until + (begins ? -5e-4 : 5e-4);

/// Moves everything after a phase by `shift`: phases, keyframes (`isLater`), disturbances, and
/// motions of the floor. A keyframe whose time is relative to the previous keyframe moves with it;
/// `after` says whether the keyframe before the first later one moves.
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

/// In words, the disturbances that only act in the first round of a block; "" if there are none.
function disturbancesWithin(state, from, until) {
  const times = state.disturbances.filter((one) => one.from >= from - 5e-4 && one.from < until - 5e-4).map((one) => `${one.from.toFixed(3)} s`);
  return times.length ? `The disturbance at ${times.join(" and at ")}` : "";
}

/// Makes the phases from `first` to `last` and their keyframes blocks that repeat, with `times`
/// rounds in all; later parts move. Returns { edits } or { refused: why }.
export function repeatPhases(state, document, first, last, times) {
  const phases = state.phases.slice(first, last + 1), from = phases[0].from, until = phases.at(-1).until;
  const length = Number((until - from).toFixed(6)), shift = (times - 1) * length;
  const walks = phases.some(({ swing }) => swing), valueOf = (frame) => valueAt(document, frame.pointer) ?? {};
  const isPlaced = ({ zmp, cog, feet, hands, gaze }) => (zmp && typeof zmp !== "string") || cog?.x !== undefined || cog?.y !== undefined || feet || hands || gaze;
  // If the first round begins with a keyframe and ends without one, each round begins like the
  // first.
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

/// The number of rounds of the block around a phase: { pointer, rounds }.
export function roundsOf(state, document, phase) {
  return { pointer: phase.pointer.split("/").slice(0, -2).join("/"), rounds: state.phases.filter((one) => one.pointer === phase.pointer).length };
}

/// Changes the number of rounds of the block around a phase and of the keyframes that repeat with
/// it; later parts move. Returns { edits } or { refused: why }.
export function setRounds(state, document, phase, rounds) {
  const { pointer, rounds: now } = roundsOf(state, document, phase);
  if (!(rounds >= 1 && Number.isInteger(rounds))) return { refused: "The number of rounds is a whole number above 0." };
  if (pointer !== outermost(pointer)) return { refused: "This block is inside another block that repeats. Change its rounds in the text." };
  const own = state.phases.filter((one) => one.pointer.startsWith(pointer + "/")), from = own[0].from, until = own.at(-1).until;
  const repeats = (block) => JSON.stringify(valueAt(document, block)?.repeat), isOwn = (frame) => frame.repeated && repeats(outermost(frame.pointer)) === repeats(pointer);
  // A key at the beginning may also be the last key of an earlier block.
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

/// Adds a phase of 0.5 s after the last one.
export function appendPhase(phases) {
  return [{ kind: "insert", pointer: "/phases/-",
    value: { until: roundedTime(phases.at(-1).until + 0.5), support: "both" } }];
}

export function addDisturbance({ type, at, duration, direction, size, on }) {
  const value = { type, at: roundedTime(at), duration, direction, [type]: size };
  if (on && on !== "cog") value.on = on;
  return [{ kind: "insert", pointer: "/scenario/-", value }];
}
