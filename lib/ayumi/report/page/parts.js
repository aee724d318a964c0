// Parts of a pattern that the page makes with sensible initial values: parts of the ground, motions
// of the floor, disturbances other than pushes, weights of joints, and uncertain quantities
// (docs/formats.md).

import { removeValue, roundedTime } from "./edits.js";

const inUnit = (degrees, unit) => unit === "deg" ? degrees : Number((degrees * Math.PI / 180).toFixed(4));

/// The x at which the ground is free [m]: ahead of everything on it, and of the soles, whose
/// corners at the start are `soles`. Expressions are ignored.
export function freeGround(world = {}, soles = []) {
  const number = (value) => Number.isFinite(value) ? value : -Infinity;
  const ends = [...world.blocks ?? [], ...world.patches ?? []].map((one) =>
    one.position ? number(one.position[0]) + number(one.radius) : number(one.x?.[1]));
  if (world.field) ends.push(number(world.field.origin?.[0]) + number(world.field.spacing) * (world.field.heights.length - 1));
  // The position is a multiple of 50 mm, at least 20 mm in front of the toes.
  const toes = soles.map(([x]) => 0.05 * Math.ceil((x + 0.02) / 0.05 - 1e-6));
  return Number(Math.max(0.1, ...toes, ...ends).toFixed(4));
}

/// Adds a block or a patch of the ground, ahead of the robot and of everything on the ground.
export function addToGround(list, world, soles) {
  const from = freeGround(world, soles);
  const value = { x: [from, Number((from + 0.2).toFixed(4))], y: [-0.2, 0.2], ...list === "blocks" ? { height: 0.005 } : { friction: 0.4 } };
  return [{ kind: "insert", pointer: `/world/${list}/-`, value }];
}

/// Adds a field of low waves that is level at its edges.
export function addField(world, soles) {
  const nodes = 7, wave = (i, j) => Number((0.002 * Math.sin(Math.PI * i / (nodes - 1)) * Math.abs(Math.sin(Math.PI * j / 3))).toFixed(4));
  const heights = Array.from({ length: nodes }, (_, i) => Array.from({ length: nodes }, (_, j) => wave(i, j)));
  return [{ kind: "set", pointer: "/world/field", value: { origin: [freeGround(world, soles), -0.15], spacing: 0.05, heights } }];
}

/// Adds one more row ahead (along x) or one more column to the left (along y) of a field, with the
/// heights of the last one.
export function growField(field, along) {
  if (along === "x") return [{ kind: "insert", pointer: "/world/field/heights/-", value: field.heights.at(-1) }];
  return field.heights.map((row, i) => ({ kind: "insert", pointer: `/world/field/heights/${i}/-`, value: row.at(-1) }));
}

/// A tilt of the whole floor and back.
const tilt = (unit) => ({ shape: "half_sine", duration: 1, pitch: inUnit(2, unit) });

export function addFloorMotion(time, unit) {
  return [{ kind: "insert", pointer: "/world/motion/-", value: { at: roundedTime(time), ...tilt(unit) } }];
}

/// Changes the shape of a motion; only a sine has a frequency.
export function putShape(pointer, motion, shape) {
  const set = { kind: "set", pointer: pointer + "/shape", value: shape };
  if (shape === "sine" && motion.frequency === undefined) return [set, { kind: "set", pointer: pointer + "/frequency", value: 1 }];
  if (shape !== "sine" && motion.frequency !== undefined) return [set, { kind: "remove", pointer: pointer + "/frequency" }];
  return [set];
}

export const shapes = ["ramp", "half_sine", "sine"];

/// The first joint that turns, because an offset of a sliding joint would be a length.
const turning = (joints) => joints.find((one) => !one.prismatic) ?? joints[0];

/// Disturbances other than pushes, each with what it has besides its time.
export const disturbances = [
  { type: "payload", words: "a payload on a link", value: (state) => ({ on: state.links?.[0] ?? "", mass: 0.1 }) },
  { type: "floor", words: "a motion of the floor", value: (state) => tilt(state.angle_unit) },
  { type: "friction", words: "another friction of the ground", value: () => ({ friction: 0.3, duration: 1 }) },
  { type: "bump", words: "a bump under a foot", value: () => ({ foot: "left", height: 0.003 }) },
  { type: "latency", words: "later sensors", value: () => ({ latency: 0.005, duration: 1 }) },
  { type: "sensor_bias", words: "an error of the attitude sensor", value: (state) => ({ pitch: inUnit(1, state.angle_unit) }) },
  { type: "encoder_offset", words: "an offset of an encoder", value: (state) => ({ joint: turning(state.joints).name, offset: inUnit(1, state.angle_unit) }) },
  { type: "joint_friction", words: "friction of a joint", value: (state) => ({ joint: state.joints[0].name, coulomb: 0.2, viscous: 0.05 }) },
  { type: "gain_loss", words: "a weak servo", value: (state) => ({ joint: state.joints[0].name, share: 0.3 }) },
];

export function addOther(type, time, state) {
  const one = disturbances.find((each) => each.type === type);
  return [{ kind: "insert", pointer: "/scenario/-", value: { type, at: roundedTime(time), ...one.value(state) } }];
}

const around = (share) => ({ uniform: [Number((1 - share).toFixed(4)), 1 + share] });
const within = (most) => ({ uniform: [-most, most] });
const upTo = (most) => ({ uniform: [0, most] });

/// The names of distributions for people.
export const distributions = ["uniform", "normal", "truncated", "choice"];

/// The quantities that may be uncertain, each with an initial range and the unit of its values
/// ("angle" is that of the pattern); factors and coefficients have no unit.
export const quantities = [
  { what: "mass", words: "masses of the links (factor)", value: () => ({ each: true, ...around(0.05) }) },
  { what: "inertia", words: "inertias of the links (factor)", value: () => ({ each: true, ...around(0.1) }) },
  { what: "cog", words: "centre of mass of the trunk", unit: "m", value: () => ({ on: "trunk", axis: "x", ...within(0.003) }) },
  { what: "friction", words: "friction of the ground", value: () => ({ uniform: [0.5, 0.9] }) },
  { what: "slope", words: "slope of the ground", unit: "angle", value: (unit) => ({ axis: "y", ...within(inUnit(1, unit)) }) },
  { what: "bumps", words: "hollows of the ground", unit: "m", value: () => upTo(0.001) },
  { what: "sole_stiffness", words: "stiffness of the soles (factor)", value: () => around(0.3) },
  { what: "sole_damping", words: "damping of the soles (factor)", value: () => around(0.3) },
  { what: "servo_kp", words: "stiffness of the servos (factor)", value: () => around(0.1) },
  { what: "servo_kd", words: "damping of the servos (factor)", value: () => around(0.1) },
  { what: "servo_friction", words: "friction of the servos", unit: "N m", value: () => upTo(0.05) },
  { what: "encoder_offset", words: "offsets of the encoders", unit: "angle", value: (unit) => ({ each: true, ...within(inUnit(0.2, unit)) }) },
  { what: "servo_delay", words: "delay of the servos", unit: "s", value: () => upTo(0.002) },
  { what: "backlash", words: "backlash of the gears", unit: "angle", value: (unit) => upTo(inUnit(0.2, unit)) },
  { what: "sensor_noise", words: "noise of the sensors (factor)", value: () => ({ uniform: [1, 2] }) },
  { what: "attitude_bias", words: "error of the attitude sensor", unit: "angle", value: (unit) => ({ axis: "y", ...within(inUnit(0.3, unit)) }) },
  { what: "gyro_bias", words: "error of the gyro", unit: "angle/s", value: (unit) => ({ axis: "y", ...within(inUnit(0.3, unit)) }) },
  { what: "load_bias", words: "error of the load cells", unit: "N", value: () => within(0.5) },
  { what: "sensor_latency", words: "latency of the sensors", unit: "s", value: () => ({ uniform: [0.002, 0.006] }) },
  { what: "payload", words: "load on the trunk", unit: "kg", value: () => ({ on: "trunk", ...upTo(0.2) }) },
];

/// The axes that an uncertain quantity may have (docs/formats.md).
export const axesOf = (what) => ["slope", "attitude_bias"].includes(what) ? ["x", "y"] : ["x", "y", "z"];

const assumed = "assumed: the initial range of the page";

export function addQuantity(what, unit) {
  const one = quantities.find((each) => each.what === what);
  return [{ kind: "insert", pointer: "/uncertainty/quantities/-", value: { what, ...one.value(unit), source: assumed } }];
}

/// Adds a push from four sides in a phase of the walk, with half of the impulse that the robot can
/// capture.
export function addUncertainPush(unit) {
  const choice = [0, 90, 180, 270].map((degrees) => inUnit(degrees, unit));
  return [{ kind: "insert", pointer: "/uncertainty/pushes/-",
    value: { unit: "B", size: 0.5, direction: { choice, source: assumed }, time: "phases", duration: 0.02 } }];
}

/// The edits that remove an item of a list. A list that would become empty is removed as a whole,
/// together with members that contain nothing else.
export function removeItem(document, path, index) {
  const [part, list] = path;
  if (document[part][list].length > 1) return [{ kind: "remove", pointer: `/${part}/${list}/${index}` }];
  return removeValue(document, `/${part}/${list}`);
}

/// The paths to the angles of a pattern, without the items of lists. In a list, the last number of
/// a foothold [x, y, z, yaw] is an angle.
const angleWays = [
  /^postures\/[^/]+\/[^/]+$/,
  /^start\/(left|right)\/(3|rpy\/\d)$/,
  /^(phases\/)+swing\/(step\/turn|to\/3|to\/rpy\/\d)$/,
  /^(phases\/)+viip\/turn$/,
  /^(keyframes\/)+((joints|posture)\/[^/]+|torso\/(roll|pitch|yaw)|feet\/(left|right)\/(3|rpy\/\d))$/,
  /^world\/(ground|motion)\/(roll|pitch)$/,
  /^scenario\/(roll|pitch|offset|gyro\/\d)$/,
  /^uncertainty\/pushes\/direction(\/(uniform|normal|truncated|choice)\/\d+)?$/,
];
const lists = /^(phases|keyframes|motion|scenario|quantities|pushes)$/;

/// Whether a value at a place of the pattern is an angle. `what` is the kind of the uncertain
/// quantity that contains it.
function isAngle(path, what) {
  if (path[0] === "uncertainty" && path[1] === "quantities")
    return /^angle/.test(quantities.find((one) => one.what === what)?.unit) && distributions.includes(path[3]);
  return angleWays.some((way) => way.test(path.filter((name, i) => !(lists.test(path[i - 1]) && /^(\d+|-)$/.test(name))).join("/")));
}

/// The edits. If a pattern without a unit of angles gets its first angle, they also write the unit
/// of the page.
export function withUnits(document, edits, unit) {
  if (!document || document.units?.angle !== undefined) return edits;
  const holdsAngle = (value, path, what) => value && typeof value === "object"
    ? Object.entries(value).some(([name, part]) => holdsAngle(part, [...path, name], value.what ?? what)) : isAngle(path, what);
  const angular = edits.some(({ kind, pointer, value }) => {
    const path = pointer.split("/").slice(1);
    const what = path[0] === "uncertainty" ? document.uncertainty?.[path[1]]?.[path[2]]?.what : undefined;
    return (kind === "set" || kind === "insert") && holdsAngle(value, path, what);
  });
  return angular ? [...edits, { kind: "set", pointer: "/units/angle", value: unit }] : edits;
}
