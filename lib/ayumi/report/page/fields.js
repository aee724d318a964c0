// All values that an author may give to the whole pattern, a phase, a keyframe or a disturbance
// (docs/formats.md), each with the value that applies if it is not written. The page offers the
// missing ones. A test compares this list with the schema of the pattern.

const interpolation = ["linear", "cubic", "minimum_jerk", "hold", "spline"];
const field = (path, otherwise) => ({ path, otherwise });
const turns = ["roll", "pitch", "yaw"];

/// Weights that are written can be removed.
const weighted = (path, written) => Object.keys(written ?? {}).map((joint) => ({ path: [...path, joint], otherwise: "1" }));

/// The fields of each kind of thing: { path, otherwise, choices }. `value` is the written value,
/// `state` is the page's state.
export const fieldsOf = {
  pattern: (value, state) => [
    { path: ["name"], otherwise: "none" },
    { path: ["profile"], otherwise: "the first profile of the robot", choices: state.profiles },
    { path: ["defaults", "cog_height"], otherwise: "as in the posture" },
    { path: ["defaults", "posture"], otherwise: "home", choices: state.postures },
    { path: ["defaults", "interpolation"], otherwise: "minimum_jerk", choices: interpolation },
    { path: ["defaults", "cog_model"], otherwise: "full", choices: ["full", "point_mass"] },
    { path: ["world", "friction"], otherwise: "0.8" },
    ...typeof value.world?.ground === "string" ? [] : ["roll", "pitch", "height"].map((name) =>
      ({ path: ["world", "ground", name], otherwise: "0" })),
    { path: ["controller", "type"], otherwise: "dtad", choices: ["none", "dtad", "viip", "preview",
      "foot-guided", "dcm-step", "dtad-literal", "viip-landings", "viip-nofeedback"] },
    { path: ["repair", "trust"], otherwise: "posture", choices: ["posture", "cog", "zmp"] },
    { path: ["repair", "margin"], otherwise: "the default of ayumi repair" },
    { path: ["repair", "safety"], otherwise: "the default of ayumi repair" },
    ...weighted(["repair", "weights"], value.repair?.weights),
  ],
  phase: (value) => [
    ...value.swing ? [field(["swing", "lift"], "0.02")] : [],
    ...value.swing?.step ? ["forward", "side", "up", "turn"].map((name) => ({ path: ["swing", "step", name], otherwise: "0" })) : [],
    ...value.viip?.jump ? [field(["viip", "jump", "height"], "0.03"), field(["viip", "jump", "stoop"], "0.03"),
      field(["viip", "jump", "forward"], "0"), { path: ["viip", "jump", "times"], otherwise: "1" },
      { path: ["viip", "jump", "release"], otherwise: "ref_z", choices: ["ref_z", "spring"] }] : [],
    ...value.viip?.velocity || value.viip?.turn !== undefined || value.viip?.step
      ? [{ path: ["viip", "steps"], otherwise: "as many steps as the phase has time for" }] : [],
    ...value.viip?.velocity ? [{ path: ["viip", "turn"], otherwise: "0" }] : [],
  ],
  keyframe: (value, state) => [
    { path: ["interpolation"], otherwise: "the interpolation of the pattern", choices: interpolation },
    ...typeof value.posture === "object" ? [] : [{ path: ["posture"], otherwise: "none", choices: state.postures }],
    { path: ["zmp"], otherwise: "no key", choices: ["left", "center", "right"] },
    ...["x", "y", "height"].map((name) => ({ path: ["cog", name], otherwise: "no key" })),
    { path: ["fz"], otherwise: "no key" },
    ...turns.map((name) => ({ path: ["torso", name], otherwise: value.torso ? "0" : "no key" })),
    ...weighted(["weights"], value.weights),
  ],
  disturbance: (value, state) => [
    { path: ["duration"], otherwise: ["impulse", "bump"].includes(value.type) ? "a short time" : "to the end" },
    ...["impulse", "force", "torque"].includes(value.type) ? [{ path: ["on"], otherwise: "cog", choices: state.links },
      { path: ["frame"], otherwise: "world", choices: ["world", "link"] }] : [],
    ...["floor", "sensor_bias"].includes(value.type) ? ["roll", "pitch"].map((name) => ({ path: [name], otherwise: "0" })) : [],
    ...value.type === "sensor_bias" ? [{ path: ["load"], otherwise: "0" }] : [],
    ...value.type === "bump" ? [{ path: ["radius"], otherwise: "0.01" }] : [],
    ...["encoder_offset", "joint_friction", "gain_loss"].includes(value.type)
      ? [{ path: ["joint"], otherwise: "all joints", choices: state.joints?.map((one) => one.name) }] : [],
  ],
};

/// The pattern in a text with comments; null if the text is not JSON.
export function parsePattern(text) {
  const plain = (text || "").replace(/"(?:\\.|[^"\\])*"|\/\/[^\n]*|\/\*[\s\S]*?\*\//g,
    (part) => part[0] === '"' ? part : " ");
  try {
    return JSON.parse(plain);
  } catch {
    return null;
  }
}

export const token = (name) => "/" + String(name).replaceAll("~", "~0").replaceAll("/", "~1");

export function valueAt(document, pointer) {
  return pointer.split("/").slice(1).reduce((value, part) =>
    value?.[part.replaceAll("~1", "/").replaceAll("~0", "~")], document ?? undefined);
}

const joined = (path) => path.map(token).join("");

const inside = (value, path) => path.reduce((part, name) => part?.[name], value);

/// The fields that are not written in `value`, with their pointers.
export function missingFields(kind, pointer, value, state) {
  return fieldsOf[kind](value, state).filter(({ path }) => inside(value, path) === undefined)
    .map((field) => ({ ...field, pointer: pointer + joined(field.path) }));
}

/// The optional field to which the value at a pointer belongs, and which can be removed.
export function optionalField(kind, pointer, value, state, at) {
  return fieldsOf[kind](value, state).find(({ path }) => pointer + joined(path) === at);
}

/// The choices of a select as [value, words]: the default if the value can be removed, the choices,
/// and the written value if it is none of them.
export function optionsOf(choices, written, field) {
  const names = choices.map(String), known = written === undefined || names.includes(String(written));
  return [...field ? [["", `(${field.otherwise})`]] : [], ...[...names, ...known ? [] : [String(written)]].map((one) => [one, one])];
}
