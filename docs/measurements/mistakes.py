#!/usr/bin/env python3
"""Mistakes of authors, planted into sound patterns, and whether the first message names them.

measure.py makes the tables of mistakes.md from it. As a program, it prints what `check` says:

    docs/measurements/mistakes.py                           all mistakes on all robots
    docs/measurements/mistakes.py --robot hoap1 --only payload

The robots that are not bundled come from AYUMI_DATA (default: ../shared/data) through `ayumi init`;
a robot whose file is absent is left out. AYUMI names the program.
"""

import argparse
import copy
import dataclasses
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import typing

ROOT = pathlib.Path(__file__).resolve().parents[2]
AYUMI = os.environ.get("AYUMI", str(ROOT / "build/release/app/ayumi"))
DATA = pathlib.Path(os.environ.get("AYUMI_DATA", ROOT.parent / "shared/data"))
BARE = {
    "hoap3": "hoap3/hoap3_description/urdf/hoap3.urdf",
    "darwin": "darwin_op/urdf/darwin.urdf",
    "mighty": "roki/mighty.ztk",
}
KNEES = {"hoap1": "l_knee", "humanoid30": "l_knee", "hoap3": "L_LFE_L_KN_joint",
         "darwin": "j_tibia_l", "mighty": "left_knee_flexion"}
HANDS = {"hoap1": "r_forearm", "humanoid30": "r_hand", "hoap3": "R_EB", "darwin": "MP_ARM_LOW_R",
         "mighty": "right_elbow_flexion"}
# Processor time after which a check counts as having no answer [s]. Chosen: several times what a
# person waits for.
LONGEST = 40


@dataclasses.dataclass
class Mistake:
    name: str
    kind: str  # of the pattern: walk, kick, bow, wave, squat, jump
    plant: typing.Callable  # changes the pattern; returns False where it cannot be planted
    names: str  # a regular expression that the first message matches if it names the mistake
    robots: tuple = ()  # the only ones, where not all


# ---- Planting. A walk swings in its phases 1, 3, 5 ...; phase 3 stands on the right foot.


def swing(pattern, phase):
    return pattern["phases"][phase]["swing"]


def angles(pattern, factor):
    """Multiplies the angles of all keys."""
    def scaled(values):
        return {k: scaled(v) if isinstance(v, dict) else v * factor for k, v in values.items()}

    for key in pattern["keyframes"]:
        for track in ("joints", "posture", "torso"):
            if isinstance(key.get(track), dict):
                key[track] = scaled(key[track])


def angle_key(pattern):
    """The first key with a joint angle beyond 20 deg, and the angles of this key."""
    for key in pattern["keyframes"]:
        joints = key.get("joints") or key.get("posture")
        if isinstance(joints, dict) and max(map(abs, joints.values()), default=0) > 20:
            return key, joints
    return None, None


def degrees_as_radians(pattern, robot):
    pattern["units"] = {"angle": "rad"}


def radians_as_degrees(pattern, robot):
    angles(pattern, math.pi / 180)


def leg_joint(pattern, robot):
    pattern["keyframes"][3]["joints"] = {robot["knee"]: 20}


def foot_up(pattern, robot):
    """The foot keys are higher than in the generated kick, and the pattern states no COG height."""
    pattern["defaults"].pop("cog_height", None)
    for key in pattern["keyframes"]:
        for foot in key.get("feet", {}).values():
            if len(foot) > 2 and foot[2] > 0:
                foot[2] = max(foot[2], 0.03)


def straight_knees(pattern, robot):
    for k in (2, 3):
        pattern["keyframes"][k]["cog"]["height"] = 0.262


def long_segment(pattern, robot):
    pattern["keyframes"][1]["t"] = 1.1


def sides_of_phase(pattern, robot):
    pattern["phases"][3]["support"] = "left"
    swing(pattern, 3)["foot"] = "right"


def milliseconds(pattern, robot):
    for phase in pattern["phases"]:
        phase["until"] *= 1000
    for key in pattern["keyframes"]:
        key["t"] *= 1000


def far_foothold(pattern, robot):
    swing(pattern, 3)["to"][0] = 0.9


def exchanged_footholds(pattern, robot):
    a, b = swing(pattern, 3), swing(pattern, 5)
    a["to"], b["to"] = b["to"], a["to"]


def missing_swing(pattern, robot):
    del pattern["phases"][3]["swing"]


def high_cog(pattern, robot):
    heights = [k for k in pattern["keyframes"] if "cog" in k]
    if heights:
        heights[1]["cog"]["height"] *= 10
    else:
        pattern["defaults"]["cog_height"] = 2.05


def wrong_zmp(pattern, robot):
    begin, end = pattern["phases"][2]["until"], pattern["phases"][3]["until"]
    for key in pattern["keyframes"]:
        if begin - 1e-9 <= key["t"] <= begin + 1e-9:
            key["zmp"] = "left"


def payload(mass):
    def plant(pattern, robot):
        pattern.setdefault("scenario", []).append(
            {"type": "payload", "at": 0, "on": robot["hand"], "mass": mass})
        pattern["scenario"] = pattern["scenario"][-1:]

    return plant


def other_side(pattern, robot):
    swing(pattern, 3)["to"][1] *= -1


def height_in_mm(pattern, robot):
    pattern["defaults"]["cog_height"] = round(950 * robot["height"])


def foothold_in_mm(pattern, robot):
    swing(pattern, 3)["to"] = [1000 * x for x in swing(pattern, 3)["to"]]


def friction(value):
    def plant(pattern, robot):
        pattern["world"]["friction"] = value

    return plant


def sign_of_joint(pattern, robot):
    key, joints = angle_key(pattern)
    if not key:
        return False
    name = max(joints, key=lambda j: abs(joints[j]))
    joints[name] *= -2


def tilt(degrees):
    def plant(pattern, robot):
        for key in pattern["keyframes"]:
            if key.get("torso", {}).get("pitch"):
                key["torso"]["pitch"] = degrees

    return plant


def deep_squat(pattern, robot):
    least = min(k["cog"]["height"] for k in pattern["keyframes"] if "cog" in k)
    for key in pattern["keyframes"]:
        if key.get("cog", {}).get("height") == least:
            key["cog"]["height"] = round(0.45 * robot["height"], 3)


def short_phase(pattern, robot):
    pattern["phases"][3]["until"] = round(pattern["phases"][2]["until"] + 0.05, 3)


def high_lift(pattern, robot):
    swing(pattern, 3)["lift"] = 0.9


def no_double_support(pattern, robot):
    del pattern["phases"][4]


def jumping_key(pattern, robot):
    key, _ = angle_key(pattern)
    key["interpolation"] = "hold"


def key_of_stance(pattern, robot):
    feet = [k["feet"] for k in pattern["keyframes"] if "feet" in k]
    feet[-2]["left"] = feet[-2].pop("right")


def kick_in_ground(pattern, robot):
    feet = [k["feet"] for k in pattern["keyframes"] if "feet" in k]
    feet[-2]["right"][2] *= -1


def foothold_in_air(pattern, robot):
    swing(pattern, 3)["to"] = swing(pattern, 3)["to"][:2] + [round(0.2 * robot["height"], 3)]


# Mistakes that were seen in trials, and others that were known when the search was written.
KNOWN = [
    Mistake("degrees declared as radians (arm)", "wave", degrees_as_radians,
            r"^/units.*\"angle\": \"deg\""),
    Mistake("degrees declared as radians (trunk)", "bow", degrees_as_radians,
            r"^/units.*\"angle\": \"deg\""),
    Mistake("radians declared as degrees", "wave", radians_as_degrees,
            r"^/units.*\"angle\": \"rad\""),
    Mistake("a leg joint with a key", "walk", leg_joint, r"^/keyframes/3.*joint of a leg"),
    Mistake("a foot key 30 mm up, without a COG height", "kick", foot_up,
            r"(?s)^/keyframes/\d+: the right foot is lifted by \d+ mm( \(it is also lifted in [^)]*\))?\. The COG rises|"
            r"^/defaults/cog_height.*nearly straight"),
    Mistake("knees nearly straight at lift-off", "jump", straight_knees,
            r"^/keyframes/[23]: the COG height is 0.262 m", ("hoap1",)),
    Mistake("too much time between the COG key of the stoop and the lift-off", "jump", long_segment,
            r"^/keyframes/1: t is 1.1 s.*segment", ("hoap1",)),
    Mistake("left and right exchanged in a phase", "walk", sides_of_phase,
            r"^/phases/3: .*support.*left.*exchanged"),
    Mistake("a foothold on the other side", "walk", other_side,
            r"^/phases/3.*left foot.*exchanged"),
    Mistake("times in ms", "walk", milliseconds, r" ms"),
    Mistake("a foothold of 0.9 m", "walk", far_foothold, r"^/phases/3.*(x is 0.9 m|foot lands 0.8\d* m from)"),
    Mistake("footholds exchanged", "walk", exchanged_footholds,
            r"^/phases/3.*/phases/5 were perhaps exchanged"),
    Mistake("a missing swing", "walk", missing_swing, r"^/phases/3.*swing of the \w+ foot is missing"),
    Mistake("COG height of 2.05 m", "walk", high_cog, r"^/defaults/cog_height.*2.05 m"),
    Mistake("COG height ten times too large", "squat", high_cog,
            r"^/keyframes/\d+.*the COG height is [1-9]\.?\d* m"),
    Mistake("COG height in mm", "walk", height_in_mm, r"^/defaults/cog_height.* mm"),
    Mistake("ZMP key under the wrong foot", "walk", wrong_zmp,
            r"^/phases/3: the robot stands on the right foot.*ZMP under the left|"
            r"^/keyframes/\d+.*wrong foot"),
    Mistake("payload of 3 kg", "wave", payload(3), r"^/scenario/0.*payload.*3 kg"),
    Mistake("a foothold in mm", "walk", foothold_in_mm, r"^/phases/3.*( mm|Check the unit)"),
    Mistake("ground of friction 0.02", "walk", friction(0.02), r"^/world/friction.*0.02"),
    Mistake("trunk 80 degrees ahead", "bow", tilt(80), r"^/keyframes/\d.*trunk is 80 deg"),
    Mistake("a squat too deep", "squat", deep_squat, r"^/keyframes/\d.*COG height is"),
    Mistake("a phase that ends too early", "walk", short_phase, r"^/phases/3.*phase ends at"),
    Mistake("a lift of 0.9 m", "walk", high_lift, r"^/phases/3.*lift.*0.9 m"),
    Mistake("a missing double support", "walk", no_double_support,
            r"^/phases/4.*\"both\" is missing"),
    Mistake("a key of the foot that stands", "kick", key_of_stance,
            r"^/keyframes/\d.*left foot, which carries"),
    Mistake("a foot key below the ground", "kick", kick_in_ground,
            r"^/keyframes/\d.*right foot's z is -"),
]


# ---- New ones: written for this page, before they were tried with the program.


def durations_as_times(pattern, robot):
    before = 0
    for phase in pattern["phases"]:
        phase["until"], before = round(phase["until"] - before, 3), phase["until"]


def twice_as_fast(pattern, robot):
    for phase in pattern["phases"]:
        phase["until"] = round(0.3 * phase["until"], 4)
    for key in pattern["keyframes"]:
        key["t"] = round(0.3 * key["t"], 4)


def keys_not_moved(pattern, robot):
    """The phases become longer, and the keys keep their times."""
    for phase in pattern["phases"]:
        phase["until"] = round(1.5 * phase["until"], 3)


def zmp_keys_exchanged(pattern, robot):
    for key in pattern["keyframes"]:
        key["zmp"] = {"left": "right", "right": "left"}.get(key["zmp"], key["zmp"])


def zmp_in_the_middle(pattern, robot):
    for key in pattern["keyframes"]:
        if "zmp" in key:
            key["zmp"] = "center"


def zmp_in_mm(pattern, robot):
    key = next(k for k in pattern["keyframes"] if k.get("zmp") not in (None, "center"))
    key["zmp"] = [round(1000 * robot["forward"], 1), round(900 * abs(swing(pattern, 1)["to"][1]), 1)]


def unknown_joint(pattern, robot):
    key, joints = angle_key(pattern)
    name = next(iter(joints))
    joints[name[:-1] + "x"] = joints.pop(name)


def joints_of_hoap1(pattern, robot):
    key, joints = angle_key(pattern)
    if "r_elbow" in joints:
        return False
    joints["r_elbow"] = -40


def trunk_rolls(pattern, robot):
    for key in pattern["keyframes"]:
        if "pitch" in key.get("torso", {}):
            key["torso"] = {"roll": 2 * key["torso"]["pitch"]}


def trunk_backwards(pattern, robot):
    tilt(-60)(pattern, robot)


def cog_to_the_other_side(pattern, robot):
    pattern["keyframes"][1].setdefault("cog", {})["y"] = round(-0.5 * robot["height"], 3)


def force_in_kg(pattern, robot):
    pattern["keyframes"][1]["fz"] = round(robot["mass"], 2)


def force_of_two_weights(pattern, robot):
    pattern["keyframes"][1]["fz"] = round(20 * robot["mass"], 1)


def one_foothold_turned(pattern, robot):
    to = swing(pattern, 3)["to"]
    swing(pattern, 3)["to"] = (to + [0])[:3] + [90]


def foot_on_foot(pattern, robot):
    swing(pattern, 3)["to"] = list(swing(pattern, 1)["to"])


def foothold_not_ahead(pattern, robot):
    """A digit is missing: 0.06 became 0.6."""
    swing(pattern, 5)["to"][0] = round(10 * swing(pattern, 5)["to"][0], 4)


def key_time_digit(pattern, robot):
    keys = pattern["keyframes"]
    key = [i for i, k in enumerate(keys) if "joints" in k or "posture" in k][1]
    keys[key]["t"] = round(keys[key - 1]["t"] + 0.03, 3)


def quick_bow(pattern, robot):
    keys = pattern["keyframes"]
    i = next(i for i, k in enumerate(keys) if k.get("torso", {}).get("pitch"))
    keys[i]["t"] = round(keys[i - 1]["t"] + 0.06, 3)


def quick_kick(pattern, robot):
    keys = pattern["keyframes"]
    i = [i for i, k in enumerate(keys) if "feet" in k][-2]
    keys[i]["t"] = round(keys[i - 1]["t"] + 0.03, 3)


def kick_too_far(pattern, robot):
    feet = [k["feet"] for k in pattern["keyframes"] if "feet" in k]
    feet[-2]["right"][0] = round(1.2 * robot["height"], 3)


def kick_to_the_left(pattern, robot):
    feet = [k["feet"] for k in pattern["keyframes"] if "feet" in k]
    feet[-2]["right"][1] *= -1


def kick_lands_elsewhere(pattern, robot):
    feet = [k["feet"] for k in pattern["keyframes"] if "feet" in k]
    feet[-1]["right"] = feet[-1]["right"][:2] + [0.02]


def weight_not_shifted(pattern, robot):
    for key in pattern["keyframes"]:
        if key.get("zmp") not in (None, "center"):
            key["zmp"] = "center"


def low_default(pattern, robot):
    pattern["defaults"]["cog_height"] = round(0.4 * robot["height"], 3)


def key_after_the_end(pattern, robot):
    pattern["keyframes"][-1]["t"] = round(10 * pattern["keyframes"][-1]["t"], 2)


def ends_on_one_foot(pattern, robot):
    pattern["phases"][-1]["support"] = "left"


def payload_in_grams(pattern, robot):
    payload(200)(pattern, robot)


def payload_on_nothing(pattern, robot):
    payload(0.1)(pattern, {"hand": robot["hand"] + "_tip"})


def all_friction(pattern, robot):
    """A percentage."""
    pattern["world"]["friction"] = 0.008


NEW = [
    Mistake("durations in place of times", "walk", durations_as_times, r"(?i)duration"),
    Mistake("all times at 0.3 of their values", "walk", twice_as_fast, r"^/phases.*multiplied by"),
    Mistake("phases 1.5 times as long, keys unchanged", "walk", keys_not_moved,
            r"keyframes.*(do not fit|phases)"),
    Mistake("left and right exchanged in all ZMP keys", "walk", zmp_keys_exchanged,
            r"exchanged in all ZMP keys"),
    Mistake("all ZMP keys in the middle", "walk", zmp_in_the_middle,
            r"ZMP at \"center\""),
    Mistake("a ZMP point in mm", "walk", zmp_in_mm, r"^/keyframes/\d.*ZMP.* mm"),
    Mistake("a joint name with a wrong letter", "wave", unknown_joint,
            r"/keyframes/\d.*(joint|unknown).*did you mean"),
    Mistake("a joint of another robot", "wave", joints_of_hoap1, r"/keyframes/\d.*r_elbow"),
    Mistake("roll in place of pitch, 60 degrees", "bow", trunk_rolls, r"roll of the trunk"),
    Mistake("trunk 60 degrees back", "bow", trunk_backwards,
            r"^/keyframes/\d: the pitch of the trunk is -60 deg"),
    Mistake("a COG beside the feet", "squat", cog_to_the_other_side, r"^/keyframes/1.*COG's y"),
    Mistake("f_z in kg", "squat", force_in_kg, r"^/keyframes/1: f_z is .*kg"),
    Mistake("f_z of twice the robot's weight", "squat", force_of_two_weights, r"^/keyframes/1: f_z is"),
    Mistake("a foothold turned by 90 degrees", "walk", one_foothold_turned,
            r"^/phases/3.*yaw is 90 deg"),
    Mistake("a foothold on the other foot", "walk", foot_on_foot,
            r"^/phases/3.*(lands on|y is -|other side)"),
    Mistake("a foothold ten times too far", "walk", foothold_not_ahead,
            r"^/phases/5.*right foot(.s x is| lands)"),
    Mistake("a foothold in the air", "walk", foothold_in_air, r"^/phases/3.*left foot's z is"),
    Mistake("an arm angle of the wrong sign, doubled", "wave", sign_of_joint, r"^/keyframes/\d.* is "),
    Mistake("a key that jumps", "wave", jumping_key, r"^/keyframes/\d.*\"hold\""),
    Mistake("an arm key 30 ms after the one before", "wave", key_time_digit,
            r"^/keyframes/\d: t is"),
    Mistake("a bow within 60 ms", "bow", quick_bow, r"^/keyframes/\d: t is"),
    Mistake("a kick within 30 ms", "kick", quick_kick, r"^/keyframes/\d: t is"),
    Mistake("a kick farther than the leg", "kick", kick_too_far,
            r"^/keyframes/\d.*right foot's x is"),
    Mistake("a kick to the wrong side", "kick", kick_to_the_left,
            r"^/keyframes/\d.*right foot's y is"),
    Mistake("the foot stays 20 mm up", "kick", kick_lands_elsewhere,
            r"^/keyframes/\d.*right foot's z is 0.02"),
    Mistake("the weight is not shifted", "kick", weight_not_shifted,
            r"stands on the left foot.*ZMP at \"center\""),
    Mistake("a COG at 0.4 of its height", "walk", low_default, r"^/defaults/cog_height.* is "),
    Mistake("a key after the end", "squat", key_after_the_end, r"^/keyframes/\d+: t is [2-9]|/keyframes/\d.*(end|after|last)"),
    Mistake("no double support at the end", "walk", ends_on_one_foot,
            r"^/phases/\d+: .*left.*(both|foot alone|ZMP)"),
    Mistake("a payload in g", "wave", payload_in_grams, r"^/scenario/0.*payload.*200 kg"),
    Mistake("a payload on an unknown link", "wave", payload_on_nothing, r"scenario/0.*link"),
    Mistake("friction of 0.008", "walk", all_friction, r"^/world/friction.*0.008"),
]


# ---- The program


def ayumi(*words):
    return subprocess.run([AYUMI, "--quiet"] + [str(w) for w in words], capture_output=True,
                          text=True)


def read(path):
    return json.loads(re.sub(r"^\s*//.*$", "", pathlib.Path(path).read_text(), flags=re.M))


BUNDLED = {
    ("hoap1", "walk"): "patterns/hoap1_walk.json",
    ("humanoid30", "walk"): "patterns/humanoid30_walk.json",
    ("hoap1", "kick"): "examples/motions/kick.json",
    ("hoap1", "bow"): "examples/motions/bow.json",
    ("hoap1", "wave"): "examples/motions/wave.json",
}


class Robots:
    """Robots with their sound patterns, in a folder of their own."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.robots, self.patterns = {}, {}

    def known(self, name):
        if name not in self.robots:
            self.robots[name] = self.make(name)
        return self.robots[name]

    def make(self, name):
        where = name
        if name in BARE:
            if not (DATA / BARE[name]).exists():
                return None
            where = self.folder / name
            done = ayumi("init", DATA / BARE[name], "-o", where)
            if done.returncode:
                sys.exit(done.stderr)
        facts = json.loads(ayumi("inspect", where, "--json").stdout)
        return {"where": str(where), "forward": facts["cog_m"][0],
                "height": facts["cog_m"][2], "mass": facts["mass_kg"],
                "knee": KNEES[name], "hand": HANDS[name]}

    def pattern(self, name, kind):
        if (name, kind) not in self.patterns:
            self.patterns[name, kind] = self.write(name, kind)
        return copy.deepcopy(self.patterns[name, kind])

    def write(self, name, kind):
        """A sound pattern, or nothing where the robot has none of this kind."""
        robot = self.known(name)
        if (name, kind) in BUNDLED:
            pattern = read(ROOT / BUNDLED[name, kind])
        else:
            file = self.folder / f"{name}_{kind}.json"
            more = {"walk": ["--steps", 4], "jump": ["--profile", "hoap1-strong"]}.get(kind, [])
            if ayumi("new", kind, "--robot", robot["where"], *more, "-o", file).returncode:
                return None
            pattern = read(file)
        pattern["robot"] = robot["where"]
        pattern.pop("scenario", None)
        pattern.setdefault("defaults", {})
        pattern.setdefault("world", {})
        return pattern if self.message(pattern)[0] == "consistent" else None

    def message(self, pattern):
        """What `check` says first: the verdict, and the words after it."""
        file = self.folder / "planted.json"
        file.write_text(json.dumps(pattern))
        command = f"ulimit -t {LONGEST}; exec '{AYUMI}' --quiet --threads 1 check '{file}' --json"
        done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
        if done.returncode < 0 or done.returncode > 3:
            return "no answer", ""
        said = json.loads(done.stdout)
        if "error" in said:
            words = said["error"] if isinstance(said["error"], str) else said["error"]["message"]
            words = words.replace(str(file) + ": ", "")
            if words.startswith("likely cause: "):
                words = re.split(r"\. Or /|\. In addition, /|\. First error: ", words[len("likely cause: "):])[0]
            return "unreadable", words
        causes = said["likely_mistakes"]
        if causes:
            return said["verdict"], causes[0]
        errors = [f for f in said["findings"] if f["severity"] == "error"]
        return said["verdict"], f"{errors[0]['kind']} {errors[0]['where']}" if errors else ""


def outcome(robots, name, mistake):
    """(named, not named, consistent, no answer or -, the first message)"""
    robot = robots.known(name)
    if robot is None or (mistake.robots and name not in mistake.robots):
        return "–", ""
    pattern = robots.pattern(name, mistake.kind)
    if pattern is None or mistake.plant(pattern, robot) is False:
        return "–", ""
    verdict, words = robots.message(pattern)
    if verdict == "consistent" and not words:
        return "consistent", ""
    if verdict == "no answer":
        return "no answer", ""
    return ("named" if re.search(mistake.names, words) else "not named"), words


ROBOTS = ["hoap1", "humanoid30"] + list(BARE)


def outcomes(mistakes, names=None, report=None):
    """[(mistake, {robot: (outcome, words)})]"""
    found = []
    with tempfile.TemporaryDirectory(prefix="ayumi_mistakes_") as folder:
        robots = Robots(folder)
        for mistake in mistakes:
            cells = {}
            for name in names or ROBOTS:
                cells[name] = outcome(robots, name, mistake)
                if report:
                    report(mistake, name, *cells[name])
            found.append((mistake, cells))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robot", action="append", choices=ROBOTS)
    parser.add_argument("--only", default="", help="mistakes whose name has these words")
    parser.add_argument("--set", choices=("known", "new"), action="append")
    options = parser.parse_args()
    chosen = options.set or ["known", "new"]
    mistakes = (KNOWN if "known" in chosen else []) + (NEW if "new" in chosen else [])
    outcomes([m for m in mistakes if options.only in m.name], options.robot,
             lambda mistake, robot, result, words: print(
                 f"{result:10} {robot:10} {mistake.name}: {words[:400]}", flush=True))


if __name__ == "__main__":
    main()
