#!/usr/bin/env python3
"""Measures what happens at half and at twice the value of the constants that steer verdicts.

    docs/measurements/constants.py                       all constants, writes constants.md
    docs/measurements/constants.py repair limits/stance  constants with one of these words in their
                                                         name; the page keeps its other rows
    docs/measurements/constants.py --list                names of the constants, and those left out
    docs/measurements/constants.py --build               only builds the program
    docs/measurements/constants.py --page                only writes constants.md from what is measured

The source tree is copied to AYUMI_CONSTANTS (default: a folder in the temporary folder, kept for
the next call). There, each `constexpr` number of the files in SOURCES becomes a variable whose
factor is read from the environment variable AYUMI_SCALE, so that one program serves all trials.
A trial runs the same short cases with one constant at half or at twice its value, and what it
prints is compared with the run at factor 1. Results are kept beside the build, so the next call continues after
an interruption. Needs Python 3 and what a build needs.
"""

import datetime
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = pathlib.Path(__file__).resolve().parent / "constants.md"
WORK = pathlib.Path(os.environ.get("AYUMI_CONSTANTS",
                                   str(pathlib.Path(tempfile.gettempdir()) / "ayumi_constants")))
TREE = WORK / "tree"
LIBRARY = TREE / "lib/ayumi"
PROGRAM = TREE / "build/release/app/ayumi"

SOURCES = ["repair/policy.hpp", "limits", "check", "demand", "control", "sim", "study", "plan",
           "author/import/contact_detection.cpp", "identify/compare.cpp",
           "io/robot/first_sidecar.cpp"]

# Constants that the compiler has to know, or whose half and double have no meaning.
LEFT_OUT = {
    "kWhole": "the number 1, which means the full limit",
    "kFindingKindCount": "a count",
    "kRows": "the size of a matrix",
    "kReserved": "reserves memory and changes no result",
    "Keys": "an identifier",
    "Ids": "an identifier",
    "kTipsOfShape": "an identifier",
    "kDegreesPerRadian": "mathematics",
    "kInfinity": "mathematics",
    "kNone": "mathematics",
    "kLeastJerkPeak": "mathematics",
    "kTooFast": "an identifier",
    "kTooFar": "an identifier",
    "kLargestCount": "the size of a number in a file",
    "plant_mujoco": "belongs to MuJoCo's plant, which the cases do not use",
    "kLargestNumber": "refuses input and changes no result",
    "kMostSamples": "refuses input and changes no result",
    "kMostLogEvents": "refuses input and changes no result",
    "kMostLatency": "refuses input and changes no result",
    "first_sidecar.cpp:kLead": "refuses input and changes no result",
    "kHelium": "refuses input and changes no result",
    "kRadian": "mathematics",
    "kSwaySmooth": "used for legs without ankle roll, which no robot of the cases has",
    "kZmpStep": "used for legs without ankle roll, which no robot of the cases has",
    "kInsideShare": "used for legs without ankle roll, which no robot of the cases has",
    "kNotMeasured": "an identifier",
    "check/consistency.cpp:kBlockSamples": "divides work between threads and changes no result",
    "check/consistency.cpp:kBlocksAtOnce": "divides work between threads and changes no result",
    "first_sidecar": "a guess that `init` writes into the sidecar with a request to replace it",
    "differentiate": "the reach of a formula",
}

# Factors near 1, for which half and twice are taken of the distance from 1.
FROM_ONE = ["kFirstBackoff.limit_share", "kFirstBackoff.friction_cone", "kPaceStep",
            "kCoarsePaceStep", "kFasterStep", "kSlowerStep", "kBeyondStep", "kMeanSpeedSpare",
            "kSmallestFactor"]

SCALE_HEADER = r"""#pragma once
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace ayumi {
// AYUMI_SCALE is "name=factor".
inline double constant_factor(const char* name) {
  const char* text = std::getenv("AYUMI_SCALE");
  if (!text) return 1;
  const size_t length = std::strlen(name);
  if (std::strncmp(text, name, length) != 0 || text[length] != '=') return 1;
  return std::atof(text + length + 1);
}
template <typename T>
T scaled(const char* name, T value) {
  const double factor = constant_factor(name);
  return factor == 1 ? value : static_cast<T>(value * factor);
}
inline double scaled_from_one(const char* name, double value) {
  const double factor = constant_factor(name);
  return factor == 1 ? value : 1 + (value - 1) * factor;
}
template <typename T>
T scaled_count(const char* name, T value) {
  const double factor = constant_factor(name);
  if (factor == 1) return value;
  const long count = std::lround(static_cast<double>(value) * factor);
  return static_cast<T>(count < 1 ? 1 : count);
}
}  // namespace ayumi
"""


# ---- The program whose constants are variables ----


def split(text):
    """The parts of `text` between the commas that are outside all brackets."""
    parts, depth, last = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "({[") - (c in ")}]")
        if c == "," and depth == 0:
            parts.append(text[last:i])
            last = i + 1
    return [p.strip() for p in parts + [text[last:]]]


def left_out(name):
    return next((why for word, why in LEFT_OUT.items() if word in name), None)


def wrapped(name, kind, value):
    if any(name.endswith(n) for n in FROM_ONE):
        return f'::ayumi::scaled_from_one("{name}", {value})'
    function = "scaled" if kind == "double" else "scaled_count"
    return f'::ayumi::{function}<{kind}>("{name}", {value})'


DECLARATION = re.compile(
    r"^(?P<front>[ ]*(?:static |inline )*)constexpr (?P<kind>double|int|long|size_t|Backoff) "
    r"(?P<rest>k[A-Z][^;]*);", re.M)
BACKOFF = ["joint_position", "limit_share", "friction_cone", "zmp"]


def constants_of(path, text):
    """(match, name of the declaration's file and namespaces, declarators as (name, value))."""
    for match in DECLARATION.finditer(text):
        spaces = []
        for line in text[: match.start()].splitlines():
            opened = re.match(r"namespace ([\w:]+) \{", line)
            closed = re.match(r"\}  // namespace ([\w:]+)", line)
            if opened and not opened[1].startswith("ayumi"):
                spaces.append(opened[1])
            if closed and spaces and closed[1] == spaces[-1]:
                spaces.pop()
        front = str(path) + ":" + "".join(s + "::" for s in spaces)
        parts = [re.match(r"(\w+(?:\[\])?) = (.*)$", p, re.S) for p in split(match["rest"])]
        if all(parts):
            yield match, front, [(p[1], " ".join(p[2].split())) for p in parts]


def rewrite(path, text, found):
    def one(match, front, declarators):
        kind, made = match["kind"], []
        full_names = [front + name.replace("[]", "") for name, _ in declarators]
        reasons = [why for why in map(left_out, full_names) if why]
        if reasons:  # the whole declaration stays as it is
            found.extend((full, value, left_out(full) or reasons[0])
                         for full, (_, value) in zip(full_names, declarators))
            return match[0]
        for full, (name, value) in zip(full_names, declarators):
            if kind == "Backoff":
                values = []
                for field, v in zip(BACKOFF, split(value.strip("{}"))):
                    found.append((f"{full}.{field}", v, None))
                    values.append(wrapped(f"{full}.{field}", "double", v))
                value = "{" + ", ".join(values) + "}"
            elif name.endswith("[]"):
                found.append((full, value, None))
                value = "{" + ", ".join(wrapped(full, kind, v) for v in split(value.strip("{}"))) + "}"
            else:
                found.append((full, value, None))
                value = wrapped(full, kind, value)
            made.append(f"{name} = {value}")
        front_words = match["front"]
        if len(front_words) > 0 and not front_words.strip():
            front_words += "static "  # of a function: evaluated once
        if "static" in match["front"]:
            front_words += "inline "  # a member
        return f"{front_words}const {kind} {', '.join(made)};"

    pieces, last = [], 0
    for match, front, declarators in constants_of(path, text):
        pieces += [text[last : match.start()], one(match, front, declarators)]
        last = match.end()
    text = "".join(pieces + [text[last:]])
    # A value that is made of these constants is no constant expression either.
    text = text.replace("inline constexpr std::array<GroupPrice", "inline const std::array<GroupPrice")
    text = text.replace("constexpr const GroupPrice& of", "inline const GroupPrice& of")
    if "::ayumi::scaled" in text:
        text = '#include "ayumi/base/scaled_constant.hpp"\n' + text
    return text


def files_of(base):
    for source in SOURCES:
        place = base / source
        yield from [place] if place.is_file() else sorted(place.rglob("*.[ch]pp"))


def all_constants():
    found = []
    for path in files_of(ROOT / "lib/ayumi"):
        rewrite(path.relative_to(ROOT / "lib/ayumi"), path.read_text(), found)
    return found


def write_if_other(path, text):
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def build():
    TREE.mkdir(parents=True, exist_ok=True)
    for part in ("lib", "app", "robots", "patterns", "packaging"):
        shutil.rmtree(TREE / part, ignore_errors=True)
        shutil.copytree(ROOT / part, TREE / part, symlinks=True)  # keeps times of files
    for part in ("CMakeLists.txt", "CMakePresets.json"):
        shutil.copy2(ROOT / part, TREE / part)
    write_if_other(LIBRARY / "base/scaled_constant.hpp", SCALE_HEADER)
    for path in files_of(LIBRARY):
        text = path.read_text()
        new = rewrite(path.relative_to(LIBRARY), text, [])
        if new != text:
            times = (path.stat().st_atime, path.stat().st_mtime)
            path.write_text(new)
            os.utime(path, times)
    for path in sorted((LIBRARY / "repair").glob("*.cpp")):
        text = path.read_text()
        new = re.sub(r"constexpr ((?:double|int) \w+ = [^;]*policy::)", r"static const \1", text)
        if new != text:
            times = (path.stat().st_atime, path.stat().st_mtime)
            path.write_text(new)
            os.utime(path, times)
    commands = [["cmake", "--preset", "release", "-DAYUMI_BUILD_TESTS=OFF",
                 "-DAYUMI_WITH_REPLAY=OFF"],
                ["nice", "-n", "10", "cmake", "--build", "build/release", "--parallel", "1",
                 "--target", "ayumi"]]
    for command in commands:
        subprocess.run(command, cwd=TREE, check=True)


# ---- The cases ----

CASES = {}  # name: function that returns figures by name


def case(name):
    def register(function):
        CASES[name] = function
        return function

    return register


def program(*words, scale=None):
    """Standard output of the program; None where it ended by an error."""
    environment = {k: v for k, v in os.environ.items() if k != "AYUMI_SCALE"}
    if scale:
        environment["AYUMI_SCALE"] = scale
    try:
        done = subprocess.run(["nice", "-n", "10", str(PROGRAM), "--quiet", "--threads", "1"] +
                              [str(w) for w in words], capture_output=True, text=True, cwd=WORK,
                              env=environment, timeout=240)
    except subprocess.TimeoutExpired:
        return None
    return done.stdout if done.returncode in (0, 1, 4) else None


def read_jsonc(path):
    return json.loads(re.sub(r"^\s*//.*$", "", pathlib.Path(path).read_text(), flags=re.M))


def figures_of(text):
    if text is None:
        return {"outcome": "no result"}
    return json.loads(text)


def counts(words):
    return ", ".join(f"{words.count(w)} {w}" for w in sorted(set(words))) or "none"


def repair_case(name, pattern, *words):
    @case(name)
    def run(scale):
        r = figures_of(program("--json", "repair", pattern, "-o", "out.json", "--force", *words,
                               scale=scale))
        if "status" not in r:
            return r
        return {"outcome": r["status"], "change": r["weighted_change"]["change"],
                "missing safety": r["weighted_change"]["safety"],
                "iterations": r["iterations"], "ZMP margin": r["zmp_margin"]["after_m"],
                "foot moved": r["moved"]["foot"]["most_m"], "COG moved": r["moved"]["cog"]["most_m"],
                "joints moved": len(r["moved"]["joints"]),
                "reasons": counts(["reason"] * len(r.get("reasons", []))),
                "times as long": (r.get("slower") or {}).get("factor")}


def check_case(name, pattern, *words):
    @case(name)
    def run(scale):
        r = figures_of(program("--json", "check", pattern, *words, scale=scale))
        if "verdict" not in r:
            return r
        result = {"outcome": r["verdict"],
                  "findings": counts([f["severity"] + " " + f["kind"] for f in r["findings"]]),
                  "causes": counts([f["kind"] for f in r["findings"] if not f["follows_from"]])}
        for hint in r["findings"]:
            slower = re.search(r"stretch .* to ([\d.]+) times its length", hint["hint"])
            if slower:
                result["slower by"] = float(slower[1])
        result.update({k: v for k, v in r["summary"].items() if not k.startswith("max_zmp_res")})
        return result


def simulation_case(name, pattern, *words):
    @case(name)
    def run(scale):
        r = figures_of(program("--json", "simulate", pattern, *words, scale=scale))
        if "max_tilt_rad" not in r:
            return r
        keys = ["outcome", "fell_at_s", "max_tilt_rad", "final_cog_error_m", "final_speed_m_s",
                "zmp_tracking_rms_m", "flight_s", "apex_m", "steps", "max_joint_speed_ratio",
                "max_torque_ratio", "max_penetration_m", "max_foot_slip_m", "duration_s",
                "max_contact_residual_m_s"]
        result = {k: r.get(k) for k in keys}
        result["events"] = counts([e["kind"] for e in r["events"] if e["kind"] != "saturation"])
        result["log"] = r["log_hash"]
        return result


def bump(t, center, width):
    s = (t - center) / width
    return math.cos(math.pi * s) ** 4 if abs(s) < 0.5 else 0


def step(t, center, width):
    return 1 if abs(t - center) < width / 2 else 0


def plant_fault(source, name, moves, change=None, keep_commands=False, shape=bump, pace=1):
    """The motion of `source` at 500 Hz, or in `pace` of its time, with `moves` of columns (name,
    size, center, width), and without the commands of COG, ZMP and f_z unless they are kept."""
    lines = (WORK / f"{source}.csv").read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    columns = lines[head].split(",")
    kept = [i for i, c in enumerate(columns) if keep_commands or not re.match("cog|zmp|fz", c)]
    notes = [l.replace("dt: 0.001", f"dt: {0.002 * pace:g}").replace("rate_hz: 1000",
                                                                     f"rate_hz: {500 / pace:g}")
             for l in lines[:head]]
    rows = []
    for line in lines[head + 1 :: 2]:
        values = line.split(",")
        for column, size, center, width in moves:
            b = shape(float(values[0]), center, width)
            if b:
                i = columns.index(column)
                values[i] = repr(float(values[i]) + size * b)
        values[0] = f"{float(values[0]) * pace:g}"
        rows.append(",".join(values[i] for i in kept))
    (WORK / f"{name}.csv").write_text(
        "\n".join(notes + [",".join(columns[i] for i in kept)] + rows) + "\n")
    pattern = read_jsonc(WORK / f"{source}.json")
    pattern["table"] = f"{name}.csv"
    for phase in pattern["phases"]:
        phase["until"] *= pace
    if change:
        change(pattern)
    (WORK / f"{name}.json").write_text(json.dumps(pattern))


def with_scenario(source, name, scenario, change=None):
    pattern = read_jsonc(source)
    pattern.pop("$schema", None)
    pattern["scenario"] = scenario
    if change:
        change(pattern)
    (WORK / f"{name}.json").write_text(json.dumps(pattern))


def push(at, impulse, direction, **more):
    return {"type": "impulse", "at": at, "duration": 0.02, "on": "cog", "direction": direction,
            "impulse": impulse, **more}


def make_patterns():
    for name, words in [("walk", ["walk", "--steps", 2]), ("stand", ["stand", "--duration", 1.4]),
                        ("jump", ["jump"]), ("steps", ["viip", "--steps", 2]),
                        ("viip_walk", ["viip", "--steps", 4, "--velocity", "0.05,0.01", "--turn", 15])]:
        program("new", *words, "--robot", "hoap1", "-o", f"{name}.json", "--force")
    for name in ("walk", "stand", "jump"):
        program("edit", "bake", f"{name}.json", "-o", f"{name}_table.json", "--force")

    def friction(value):
        return lambda p: p["world"].update(friction=value)

    def leaves_early(p):
        p["phases"][2]["until"] -= 0.045

    def lands_early(p):
        p["phases"][3]["until"] -= 0.05

    knee, elbow = "theta.l_knee[rad]", "theta.l_elbow[rad]"
    arms = ["theta.l_shoulder_pitch[rad]", "theta.r_shoulder_pitch[rad]"]
    plant_fault("stand_table", "sway", [("base.y[m]", 0.012, 0.7, 0.3)])
    plant_fault("stand_table", "planned sway", [("base.y[m]", 0.012, 0.7, 0.3)], keep_commands=True)
    plant_fault("stand_table", "slip", [(knee, 0.1, 0.7, 0.3)])
    plant_fault("stand_table", "arm", [(elbow, -0.8, 0.7, 0.3)])
    plant_fault("stand_table", "grip", [(arms[0], 0.3, 0.7, 0.6)], friction(0.01))
    plant_fault("walk_table", "knee", [(knee, 0.4, 1.9, 0.25)])
    plant_fault("walk_table", "collision", [("theta.l_hip_roll[rad]", -0.12, 1.9, 0.3)])
    plant_fault("walk_table", "friction", [], friction(0.1))
    plant_fault("walk_table", "early", [], lands_early)
    plant_fault("walk_table", "cog", [("cog.y[m]", 0.006, 1.9, 0.4)], keep_commands=True)
    plant_fault("walk_table", "jolt", [(knee, 0.03, 1.9, 0.1)], shape=step)
    plant_fault("walk_table", "leaving", [], leaves_early)
    plant_fault("walk_table", "fast", [], pace=0.6)
    plant_fault("walk_table", "sinking", [("theta.l_knee[rad]", -0.05, 1.35, 0.3)])
    plant_fault("jump_table", "push-off", [("theta.l_ankle_pitch[rad]", 0.05, 1.44, 0.06)])
    plant_fault("jump_table", "flight", [(arms[0], 0.25, 1.52, 0.12)])
    angles = [l.split(",") for l in (WORK / "walk_table.csv").read_text().splitlines() if l[0] != "#"]
    kept = [i for i, c in enumerate(angles[0]) if c.startswith(("t[", "theta"))]
    (WORK / "angles.csv").write_text("\n".join(",".join(r[i] for i in kept) for r in angles) + "\n")

    with_scenario(WORK / "walk.json", "pushed_walk", [push(1.9, 1.8, [0, 1, 0])])
    with_scenario(WORK / "walk.json", "crossing_walk", [push(1.9, 1.8, [0, -1, 0])])
    with_scenario(WORK / "walk.json", "hurried_walk", [push(1.9, 3, [1, 0.2, 0])])
    with_scenario(WORK / "walk.json", "thrown_walk", [push(1.75, 2.6, [0.2, 1, 0])])
    with_scenario(WORK / "walk.json", "rough_walk", [
        {"type": "bump", "at": 1.2, "height": 0.002, "foot": "right", "position": [0.03, 0.01]},
        {"type": "floor", "at": 0.1, "duration": 0.8, "shape": "ramp", "pitch": 2}])
    with_scenario(WORK / "stand.json", "pushed_stand", [push(0.4, 2, [1, 0, 0])])
    with_scenario(WORK / "stand.json", "thrown_stand", [push(0.4, 4, [1, 0.3, 0])])
    with_scenario(WORK / "steps.json", "pushed_steps", [push(1.0, 1.4, [0, 1, 0])])
    with_scenario(WORK / "viip_walk.json", "pushed_viip_walk", [push(1.9, 1.4, [0, 1, 0])])
    with_scenario(ROOT / "patterns/hoap1_jump.json", "viip_jump", [])
    with_scenario(ROOT / "patterns/hoap1_hop3.json", "viip_hops", [])
    with_scenario(ROOT / "patterns/hoap1_viip_shift.json", "viip_shift", [])

    # A robot whose elbows rest at their limits.
    folder = WORK / "robots/resting"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT / "robots/hoap1", folder)
    urdf = folder / "robot.urdf"
    urdf.write_text(re.sub(r'(<joint name="[lr]_elbow".*?upper=")[^"]*', rf'\g<1>{math.radians(-25)!r}',
                           urdf.read_text(), flags=re.S))
    with_scenario(WORK / "knee.json", "knee, elbows at a limit", [],
                  lambda p: p.update(robot="resting"))

    # A jump from keys alone.
    heights = [(0, 0.582), (1.265, 0.528), (1.4, 0.57), (1.54, 0.57), (1.675, 0.528), (2.94, 0.582)]
    (WORK / "tall jump.json").write_text(json.dumps(
        {"format": "ayumi.pattern/1", "name": "jump", "robot": "humanoid30",
         "phases": [{"until": 1.4, "support": "both"}, {"until": 1.54, "support": "none"},
                    {"until": 2.94, "support": "both"}],
         "keyframes": [{"t": t, "cog": {"height": z}} for t, z in heights]}))

    # The recording of a run: load cells with zeros of -8 N and -2 N, 10 ms late.
    program("simulate", "walk.json", "-o", "walk_run", "--force")
    program("export", "walk_run", "--format", "csv-log", "-o", "walk_log.csv", "--force")
    log = [l.split(",") for l in (WORK / "walk_log.csv").read_text().splitlines() if l[0] != "#"]
    kept = [i for i, c in enumerate(log[0]) if c.startswith(("t[", "theta"))]
    (WORK / "measured_angles.csv").write_text("\n".join(",".join(r[i] for i in kept) for r in log) + "\n")
    left, right = (log[0].index(f"{side}.force.z[N]") for side in ("left", "right"))
    cells = [f"{after[0]},{float(r[left]) - 8:.3f},{float(r[right]) - 2:.3f}"
             for r, after in zip(log[1:], log[11:])]
    (WORK / "measured_loads.csv").write_text("\n".join(["t[s],fz.left[N],fz.right[N]"] + cells) + "\n")

    for name, goal in GOALS.items():
        with_scenario(WORK / "steps.json", name, [],
                      lambda p: p.update(phases=[{"until": 3, "viip": goal}]))

    def then_keys(p):
        p["phases"] = [{"until": 1.5, "viip": {"cog": [0.02, 0, 0]}}, {"until": 2.5, "support": "both"}]
        p["keyframes"] = [{"t": 1.5, "zmp": "center"}]

    with_scenario(WORK / "steps.json", "handover", [], then_keys)


GOALS = {"far goal": {"cog": [0.09, 0, 0]}, "low goal": {"cog": [0, 0, -0.2]},
         "fast goal": {"steps": 4, "velocity": [0.5, 0]},
         "turning goal": {"steps": 4, "velocity": [0.05, 0], "turn": 100}}
FAULTS = ["sway", "slip", "arm", "grip", "knee", "friction", "early", "cog", "flight", "jolt", "leaving", "fast",
          "sinking", "push-off"]
for fault in FAULTS:
    check_case("check " + fault, fault + ".json")
for fault in ("sway", "planned sway", "slip", "grip", "knee", "early", "flight", "collision"):
    repair_case("repair " + fault, fault + ".json")
repair_case("repair cog, trusted", "cog.json", "--trust", "cog")
repair_case("repair arm, foot locked", "arm.json", "--lock", "foot:left")
repair_case("repair arm, time locked", "arm.json", "--lock", "0.3..0.35")
repair_case("repair arm, locked", "arm.json", "--lock", "l_elbow")
ROBOTS = ["--robot-path", "robots"]
repair_case("repair jolt", "jolt.json")
repair_case("repair knee, elbows at a limit", "knee, elbows at a limit.json", *ROBOTS)
repair_case("tall jump", "tall jump.json", "--from-scratch")
for good in ("walk", "jump", "walk_table"):
    check_case("check " + good, good + ".json")
for run in ("walk", "pushed_walk", "rough_walk", "pushed_stand", "thrown_stand", "steps",
            "pushed_steps", "viip_walk", "pushed_viip_walk", "viip_shift", "viip_jump", "viip_hops",
            "handover"):
    simulation_case(run.replace("_", " "), run + ".json")
simulation_case("pushed walk, noise", "pushed_walk.json", "--noise")
for run in ("pushed", "crossing", "hurried", "thrown"):
    simulation_case(run + " walk, moved footholds", run + "_walk.json", "--gain", "step=1")


def goal_case(name):
    @case(name)
    def run(scale):
        # The reason names the goal's value and the largest possible one.
        found = figures_of(program("--json", "check", name + ".json", scale=scale))
        need = found.get("actuators", {}).get("need") or ""
        return {"outcome": f"{int(bool(need))} goals refused", "need": need}


for goal in GOALS:
    goal_case(goal)


@case("import")
def import_case(scale):
    r = figures_of(program("--json", "import", "angles.csv", "--robot", "hoap1", "-o", "imported.json",
                           "--force", scale=scale))
    contacts = r.pop("contacts", [])
    times = {f"contact {i + 1}": f"{c['foot']} {c['begin_s']:.3f}-{c['end_s']:.3f} s"
             for i, c in enumerate(contacts)}
    return {"outcome": f"{len(contacts)} contacts", **times}


@case("compare")
def compare_case(scale):
    r = figures_of(program("--json", "compare", "walk_run", "measured_angles.csv",
                           "measured_loads.csv", scale=scale))
    if "loads" not in r:
        return r
    result = {"outcome": f"{len(r['notes'])} notes", "landings apart": r["landings_unmatched"],
              "landings differ by": r["landing_max_s"]}
    for load in r["loads"]:
        result.update({f"{load['name']}, mean difference": load["mean"],
                       f"{load['name']}, late_s": load["lag_s"]})
    return result


def threshold_case(name, pattern, at, *words):
    @case(name)
    def run(scale):
        r = figures_of(program("--json", "push", pattern, "--times", at, "--directions", 1, "--replicas",
                               1, *words, scale=scale))
        if "thresholds" not in r:
            return r
        t = r["thresholds"][0]
        return {"outcome": "found", "largest push": t["impulse_Ns"],
                "open loop": t["open_loop_Ns"], "bound": t["bound_Ns"],
                "recovery": t["moderate"]["recovery_s"]}


threshold_case("largest push, standing", "stand.json", 0.4)
threshold_case("largest push, walking", "walk.json", 1.9, "--cap", 1.5)


@case("retime")
def retime_case(scale):
    text = program("edit", "retime", "walk.json", "--to-limits", "-o", "faster.json", "--force",
                   scale=scale) or ""
    took = re.search(r"takes ([\d.]+)", text)
    return {"outcome": text.split(",")[0].split(": ")[-1] or "no result",
            "share of the time": float(took[1]) if took else None}


@case("tune")
def tune_case(scale):
    r = figures_of(program("--json", "tune", "stand.json", "--tune", "ka,ks", "--gain", "ka=0.5",
                           "--rounds", 2, "--directions", 1, "--times", 0.4, scale=scale))
    if "after" not in r:
        return r
    return {"outcome": "tuned", "objective": r["after"]["objective"], **r["gains"],
            "choices": r["choices"]}


CHECKS = ["check " + c for c in ("sway", "arm", "grip", "knee", "early", "cog", "flight", "jump",
                                "jolt", "leaving", "fast", "sinking", "push-off")]
SIMULATIONS = [c for c in CASES if CASES[c].__qualname__.startswith("simulation_case")]
REPAIRS = ["repair sway", "repair knee", "repair early"]
PUSHES = ["largest push, standing", "largest push, walking"]
VIIP = ["steps", "pushed steps", "viip walk", "pushed viip walk"]
FOOTHOLDS = [w + " walk, moved footholds" for w in ("pushed", "crossing", "hurried", "thrown")]

# The first of these patterns that occurs in a constant's name says which cases can depend on the
# constant.
CASES_OF = [
    ("kFlightRamps", ["tall jump"]),
    ("kHeights", ["tall jump"]),
    ("repair.*kRestingSpeed", REPAIRS + ["repair knee, elbows at a limit"]),
    ("repair.*rough", ["repair jolt"]),
    ("repair.*kKink", REPAIRS + ["repair collision", "repair arm, locked", "repair jolt"]),
    ("repair.*flight|repair.*Flight", REPAIRS + ["repair flight"]),
    ("repair.*(riction|solver|tighten|rounds|Backoff|Active|Beside)", REPAIRS + ["repair grip"]),
    ("repair.*infeasible", ["repair arm, locked"]),
    ("repair.*prices", REPAIRS + ["repair arm, locked", "repair planned sway"]),
    ("dcm", ["repair planned sway"]),
    ("repair.*clearance", ["repair collision"]),
    ("kLocked", ["repair arm, foot locked", "repair arm, time locked"]),
    ("kInSlip|stance|guess", REPAIRS + ["repair slip"]),
    ("kTrusted", ["repair cog, trusted"]),
    ("repair", REPAIRS),
    ("limits", CHECKS + ["repair sway"]),
    ("check/(time_scaling|counterfactuals)", CHECKS + ["repair arm, locked"]),
    ("check", CHECKS),
    ("demand", CHECKS + ["repair early"]),
    ("plan/(flight|viip)", ["check jump", "viip jump", "handover", "steps"]),
    ("plan/", CHECKS + ["walk", "handover"]),
    ("laws/viip_jump", ["viip jump", "viip hops"]),
    ("laws/viip|footsteps", VIIP),
    ("viip_goals", VIIP + ["viip shift", "handover", *GOALS]),
    ("foothold_shift", FOOTHOLDS),
    ("command_plan", ["handover"] + FOOTHOLDS),
    ("laws/dtad|feedback", ["pushed walk", "rough walk", "pushed stand", "crossing walk, moved footholds",
                            "pushed walk, noise", "largest push, standing"]),
    ("control", [c for c in SIMULATIONS if c not in ("viip walk", "steps", "walk")]),
    ("sim/plant", ["walk", "rough walk", "thrown stand", "viip jump"]),
    ("sim/(sensors|tilt)", ["pushed walk, noise", "rough walk"]),
    ("sim", ["pushed walk", "rough walk", "thrown stand", "viip jump", "crossing walk, moved footholds"]),
    ("study/retime", ["retime"]),
    ("study/tune", ["tune"]),
    ("study/runs", ["largest push, standing"]),
    ("study", PUSHES),
    ("import", ["import"]),
    ("identify/compare", ["compare"]),
]


def cases_for(name):
    return next(cases for pattern, cases in CASES_OF if re.search(pattern, name))


# ---- Comparison ----

# Units by the end of a figure's name, with the smallest change that counts.
FLOORS = [("_m_s2", 1), ("_m_s", 2e-3), ("_rad_s2", 10), ("_rad", 2e-3), ("_m", 2e-4), ("_s", 0.005),
          ("_N", 0.2), ("_Nm", 0.02), ("ratio", 0.02), ("margin", 5e-4), ("moved", 2e-4),
          ("push", 0.02), ("iterations", 10), ("joints moved", 3), ("change", 1e-4),
          ("missing safety", 1e-3), ("share of the time", 0.002), ("mean difference", 0.05),
          ("differ by", 0.002)]
PART = 0.05  # a change of a figure by less than this part does not count


def shown(figure, value):
    if value is None:
        return "none"
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        return str(value)
    if re.search(r"_m$|margin|moved$", figure) and figure != "joints moved":
        return f"{1e3 * value:.3g} mm"
    unit = {"_m_s": " m/s", "_rad": " rad", "_s": " s", "_N": " N", "push": " N s"}
    end = next((u for e, u in unit.items() if figure.endswith(e)), "")
    return f"{value:.3g}{end}"


def words_of(figure):
    words = re.sub(r"_(m_s2|m_s|rad_s2|rad|m|s|N|Nm)$", "", figure).replace("_", " ")
    for short, long in (("max ", "largest "), ("min ", "smallest ")):
        if words.startswith(short):
            words = long + words[len(short):]
    return words.replace("zmp", "ZMP")


def differences(before, after):
    """(weight, case, changes of a figure in words), and whether anything changed."""
    found, any_change = [], False
    for name in after:
        if before[name] == after[name]:
            continue
        any_change = True
        for figure in {**before[name], **after[name]}:
            a, b = before[name].get(figure), after[name].get(figure)
            if a == b or figure in ("log", "text", "max_contact_residual_m_s"):
                continue
            if before[name]["outcome"] == after[name]["outcome"] == "fell" and figure != "fell_at_s":
                continue  # what a fallen robot does is chaotic
            numbers = all(isinstance(v, (int, float)) for v in (a, b))
            if numbers:
                floor = next((f for end, f in FLOORS if figure.endswith(end)), 0)
                if abs(a - b) <= floor or abs(a - b) <= PART * max(abs(a), abs(b)):
                    continue
                weight = abs(a - b) / max(abs(a), floor, 1e-12)
                weight = min(weight, 50) * (0.1 if figure in ("iterations", "joints moved") else 1)
            else:
                weight = {"outcome": 1000, "findings": 200, "causes": 100}.get(figure, 80)
            changes = (changed_counts(figure, a, b) if figure in COUNTED
                       else [f"{words_of(figure)} {shown(figure, a)} → {shown(figure, b)}"])
            found.append((weight, name, changes))
    return sorted(found, key=lambda f: -f[0]), any_change


# Lists of numbers and kinds, such as "2 error joint_speed, 1 warning servo_step".
COUNTED = {"findings": "{0} findings {1}", "causes": "causes {0}", "events": "{0} events"}
MOST_KINDS = 2  # of such a list that are shown
WIDEST_CELL = 72  # characters


def counted(text):
    """{"error joint_speed": 2} of such a list."""
    entries = [e.split(" ", 1) for e in (text or "none").split(", ") if e != "none"]
    return {kind: int(number) for number, kind in entries}


def changed_counts(figure, a, b):
    """The kinds of which there are more or fewer, in words."""
    before, after = counted(a), counted(b)
    changes = [f"{COUNTED[figure].format(*kind.split())} {before.get(kind, 0)} → {after.get(kind, 0)}"
               for kind in sorted({**before, **after}) if before.get(kind) != after.get(kind)]
    return changes


def first_of(words, most, noun):
    left = len(words) - most
    return words[:most] + ([counted_words(left, "more " + noun)] if left > 0 else [])


def counted_words(number, noun):
    return f"{number} {noun}{'s' if number > 1 else ''}"


def cell_of(parts, more):
    """Text of a cell: (case, changes of its figures) of the cases that are named, and how many more
    changed. Figures, then a case, and then kinds are left out until the cell is not too wide."""
    for cases, figures, kinds in ((2, 2, MOST_KINDS), (2, 1, MOST_KINDS), (1, 1, MOST_KINDS), (1, 1, 1)):
        texts = [f"{name}: {'; '.join(', '.join(first_of(f, kinds, 'kind')) for f in changes[:figures])}"
                 for name, changes in parts[:cases]]
        left = more + len(parts) - len(texts)
        if left:
            texts.append(counted_words(left, "more case"))
        text = ". ".join(texts)
        if len(text) <= WIDEST_CELL:
            break
    return text


def summary_of(before, after):
    found, any_change = differences(before, after)
    if not any_change:
        return "no case changes"
    if not found:
        return "below 5 %"
    by_case = {}
    for _, name, changes in found:
        by_case.setdefault(name, []).append(changes)
    parts = list(by_case.items())
    return cell_of(parts[:2], len(parts[2:]))


# ---- The page ----

START, END = "<!-- table: constants -->", "<!-- end -->"


def rows_of_page(text):
    """{name of a constant: its row} of the page."""
    rows, room = {}, ""
    for line in text.splitlines():
        if line.startswith("### "):
            room = line[4:]
        match = re.match(r"\| `([^`]+)`\*? \| ", line)
        if match:
            rows[f"{room}:{match[1]}"] = line
    return rows


def write_page(results, found, commit, whole=True):
    """Writes the rows that are measured. If not all constants were measured, the page keeps its
    other rows, and the new ones get an asterisk."""
    text = PAGE.read_text()
    before, rest = text.split(START, 1)
    table, after = rest.split(END, 1)
    kept = {} if whole else rows_of_page(table)
    if whole:
        note = f"Commit {commit}, {datetime.date.today()}: `docs/measurements/constants.py`"
    else:
        later = re.findall(r"\w+ on \d{4}-\d\d-\d\d", table.split("Rows with an asterisk")[-1])
        later += [one for one in [f"{commit} on {datetime.date.today()}"] if one not in later]
        note = (re.search(r"^Commit .*?constants.py`", table, re.M)[0] + ". Rows with an asterisk were"
                " measured later, with the names of the constants as arguments, at one of these commits:"
                f" {', '.join(later)}.")
    rooms = {}
    for name, value, why in found:
        if why:
            continue
        if name + "=0.5" in results and name + "=2" in results:
            cells = [summary_of({c: results["base"][c] for c in results[name + "=" + f]},
                                results[name + "=" + f]) for f in ("0.5", "2")]
            shown_value = value.replace("|", "\\|")
            mark = "" if whole else "*"
            line = f"| `{name.split(':', 1)[1]}`{mark} | {shown_value} | {cells[0]} | {cells[1]} |"
        elif name in kept:
            line = kept[name]
        else:
            continue
        rooms.setdefault(name.split(":")[0], []).append(line)
    lines = []
    for room, rows in rooms.items():
        lines += ["", f"### {room}", "", "| constant | value | at half | at twice |",
                  "| --- | --- | --- | --- |", *rows]
    lines += ["", "### Left out", "",
              "These constants were not measured. Each line states the reason before the names of the constants:", ""]
    for why in sorted({w for _, _, w in found if w}):
        names = [f"`{n.split('/')[-1]}`" for n, _, w in found if w == why]
        lines += textwrap.wrap(f"- {why}: {', '.join(names)}", 150, subsequent_indent="  ",
                               break_long_words=False, break_on_hyphens=False)
    PAGE.write_text(before + START + "\n" +
                    "\n".join(lines + ["", *textwrap.wrap(note, 150, break_long_words=False,
                                                         break_on_hyphens=False)]).lstrip("\n") + "\n" + END + after)


def head():
    return subprocess.run(["git", "rev-parse", "--short=7", "HEAD"], capture_output=True, text=True,
                          cwd=ROOT).stdout.strip()


def trial(names, scale):
    return {name: CASES[name](scale) for name in names}


def main(words):
    found = all_constants()
    if "--list" in words:
        for name, value, why in found:
            print(name, "=", value, f"(left out: {why})" if why else "")
        return
    if any(w.startswith("-") and w not in ("--build", "--page") for w in words):
        sys.exit(__doc__)
    file = WORK / "results.json"
    results = json.loads(file.read_text()) if file.exists() else {}
    if "--page" in words:
        return write_page(results, found, results["commit"])
    if results.get("commit") != head() or not PROGRAM.exists():
        build()
        results = {"commit": head()}
    if "--build" in words:
        return
    chosen = [n for n, _, why in found if not why and (not words or any(w in n for w in words))]
    missing = [c for c in CASES if c not in results.get("base", {})]
    if missing:
        make_patterns()
        results["base"] = {**results.get("base", {}), **trial(missing, None)}
    for number, name in enumerate(chosen, 1):
        for factor in ("0.5", "2"):
            scale = f"{name}={factor}"
            missing = [c for c in cases_for(name) if c not in results.get(scale, {})]
            if not missing:
                continue
            begin = time.time()
            results[scale] = {**results.get(scale, {}), **trial(missing, scale)}
            file.write_text(json.dumps(results))
            same = {c: results["base"][c] for c in results[scale]}
            print(f"{number}/{len(chosen)} {scale}, {time.time() - begin:.0f} s:",
                  summary_of(same, results[scale]), flush=True)
    write_page(results, found, results["commit"], whole=not words)


if __name__ == "__main__":
    main(sys.argv[1:])
