#!/usr/bin/env python3
"""What `check` calls consistent, what `repair` calls repaired and what `export` accepts is one set.

    one_set.py PROGRAM [--seeds FIRST:LAST] [--keep DIR] [--stand] [--robot SIDECAR=SCALE]

Each seed makes a pattern as an author writes it, with keys: a bundled pattern or one of `ayumi new`,
of hoap1 or humanoid30, with a fault of ten kinds, from slight to gross. Where the pattern is
consistent nevertheless, it gets another one, up to four. What must hold for the robot's own profile,
each time:
  - `check` says consistent if and only if `export` writes the table, in each of its formats;
  - where `check` says inconsistent, it says what to do, and its list of what `export` would refuse
    is not empty; where it says consistent, that list is empty;
  - what `repair` calls repaired is consistent, and `export` writes it;
  - `repair` never fails on a consistent pattern.
The exit code is 1 when something does not hold; the seed is printed. A table of the outcomes is
printed at the end.

With --stand, each motion that `repair` writes is simulated in open loop in every plant that the
program has. The table counts those that do not stand: "repaired, falls" of the repaired ones, and
"consistent, falls" of those that `repair` copied. A fall is not a failure, because a consistent
motion may need a control law: with --most-falls N, the exit code is also 1 when more than N repaired
motions fall. --robot adds a robot, such as one of which `ayumi init` wrote the sidecar; SCALE is its
size relative to HOAP-1.
"""
import argparse
import collections
import json
import os
import random
import re
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ROBOTS = ("hoap1", "humanoid30")
MOST_FAULTS = 4  # of one pattern
MOST_TRIES = 20  # of a motion that a robot can do
REFUSED = (2, 3)  # exit codes with which `new` refuses a motion: a value out of range, bad input
# One number for each robot, with which lengths and times of its motions grow.
SCALE = {"hoap1": 1.0, "humanoid30": 2.5}


def without_comments(text):
    return re.sub(r"^\s*//.*$", "", text, flags=re.M)


class Generator:
    """Patterns of motions without a fault."""

    def __init__(self, program, folder):
        self.program, self.folder, self.made = program, folder, {}

    def new(self, words):
        """A pattern of `ayumi new`, as an object."""
        key = " ".join(words)
        if key not in self.made:
            path = os.path.join(self.folder, "base.json")
            subprocess.run([self.program, "new", *words, "--allow-inconsistent", "-o", path,
                            "--force", "-q"], check=True, stdout=subprocess.DEVNULL,
                           stderr=subprocess.PIPE, text=True)
            with open(path) as file:
                self.made[key] = without_comments(file.read())
        return json.loads(self.made[key])

    def motion(self, dice, robot):
        scale = SCALE[robot]
        kind = dice.choice(["bundled", "walk", "walk", "side", "turn", "sway", "squat", "wave",
                            "kick", "bow", "march", "stand"])
        bundled = os.path.join(SOURCE, "patterns", robot + "_walk.json")
        if kind == "bundled" and os.path.exists(bundled):
            with open(bundled) as file:
                return kind, json.loads(without_comments(file.read()))
        words = {
            "walk": ["walk", "--steps", str(dice.randint(1, 4)), "--stride",
                     f"{dice.uniform(-0.02, 0.035) * scale:.4f}"],
            "side": ["walk", "--steps", "2", "--stride", "0", "--side",
                     f"{dice.uniform(0.005, 0.02) * scale:.4f}"],
            "turn": ["turn"],
            "march": ["march"],
            "bundled": ["walk"],
        }.get(kind, [kind])
        return kind, self.new([*words, "--robot", robot])

    def make(self, dice):
        robot = ROBOTS[dice.random() < 0.35] if len(ROBOTS) == 2 else dice.choice(ROBOTS)
        for _ in range(MOST_TRIES):
            try:
                motion, pattern = self.motion(dice, robot)
                break
            except subprocess.CalledProcessError as error:
                if error.returncode not in REFUSED:
                    raise  # a crash, for example
                refused = error.stderr
        else:
            sys.exit(f"`new` refuses {MOST_TRIES} motions of {robot} one after the other; the last "
                     f"one: {refused.strip()}")
        pattern.pop("scenario", None)
        pattern["robot"] = robot
        return robot, motion, pattern


def spoil(pattern, dice, scale):
    """Plants a fault, and returns its name. Some faults need a swing or several keys."""
    while True:
        fault, plant = dice.choice(FAULTS)
        if plant(pattern, dice, scale):
            return fault


def end_of(pattern):
    return sum(p.get("duration", 0) for p in pattern["phases"]) or pattern["phases"][-1]["until"]


def degrees(pattern, angle):
    """Degrees in the unit of the pattern."""
    return angle if pattern.get("units", {}).get("angle") == "deg" else angle * 3.14159265 / 180


def add_key(pattern, key):
    """Keys of one time are one keyframe."""
    keys = pattern.setdefault("keyframes", [])
    for other in keys:
        if "t" in other and abs(other["t"] - key["t"]) < 0.02:
            for name, value in key.items():
                if name != "t":
                    other[name] = {**other.get(name, {}), **value} if isinstance(
                        value, dict) and isinstance(other.get(name, {}), dict) else value
            return
    keys.append(key)
    if all("t" in k for k in keys):
        keys.sort(key=lambda k: k["t"])


def uses_times(pattern):
    return all("until" in p for p in pattern["phases"]) and all(
        "t" in k for k in pattern.get("keyframes", []))


def bump_of_joint(pattern, dice, joint, angle, width):
    if not uses_times(pattern):
        return False
    end = end_of(pattern)
    width = min(width, end / 3)
    begin = round(dice.uniform(0.1 * end, 0.9 * end - width), 3)
    home = HOME[pattern["robot"]].get(joint, 0)
    add_key(pattern, {"t": begin, "joints": {joint: degrees(pattern, home)}})
    add_key(pattern, {"t": round(begin + width / 2, 3),
                      "joints": {joint: degrees(pattern, home + angle)}})
    add_key(pattern, {"t": round(begin + width, 3), "joints": {joint: degrees(pattern, home)}})
    return True


ARM = re.compile("shoulder|elbow|arm|sfe|saa", re.I)  # SFE, SAA: shoulders of HOAP-2 and HOAP-3


def arm_joint(pattern, dice):
    return dice.choice([joint for joint in HOME[pattern["robot"]] if ARM.search(joint)])


def swings(pattern):
    return [p["swing"] for p in pattern["phases"] if isinstance(p.get("swing"), dict)]


def joint_beyond_its_range(pattern, dice, scale):
    return bump_of_joint(pattern, dice, arm_joint(pattern, dice),
                         dice.choice((-1, 1)) * dice.uniform(40, 140), dice.uniform(1.2, 2))


def joint_too_fast(pattern, dice, scale):
    return bump_of_joint(pattern, dice, arm_joint(pattern, dice),
                         dice.choice((-1, 1)) * dice.uniform(10, 60), dice.uniform(0.12, 0.5))


def foothold_displaced(pattern, dice, scale):
    landing = [s for s in swings(pattern) if isinstance(s.get("to"), list)]
    if not landing:
        return False
    to = dice.choice(landing)["to"]
    to[0] = round(to[0] + dice.uniform(-0.03, 0.03) * scale, 4)
    to[1] = round(to[1] + dice.uniform(-0.03, 0.03) * scale, 4)
    return True


def swing_too_high(pattern, dice, scale):
    if not swings(pattern):
        return False
    dice.choice(swings(pattern))["lift"] = round(
        dice.choice((dice.uniform(0.0, 0.003), dice.uniform(0.02, 0.06))) * scale, 4)
    return True


def phase_moved(pattern, dice, scale):
    if len(pattern["phases"]) < 2 or not uses_times(pattern):
        return False
    at = dice.randrange(len(pattern["phases"]) - 1)
    before = pattern["phases"][at - 1]["until"] if at > 0 else 0
    low, high = before + 0.05, pattern["phases"][at + 1]["until"] - 0.05
    if low >= high:
        return False
    until = pattern["phases"][at]["until"] + dice.uniform(-0.12, 0.12)
    pattern["phases"][at]["until"] = round(min(high, max(low, until)), 3)
    return True


def zmp_outside(pattern, dice, scale):
    keys = [k for k in pattern.get("keyframes", []) if "zmp" in k][1:-1]
    if keys:
        dice.choice(keys)["zmp"] = [round(dice.uniform(-0.06, 0.1) * scale, 4),
                                    round(dice.uniform(-0.09, 0.09) * scale, 4)]
        return True
    if not uses_times(pattern):
        return False
    end = end_of(pattern)
    for share, zmp in ((0.3, "center"), (0.5, [round(dice.uniform(-0.05, 0.08) * scale, 4),
                                               round(dice.uniform(-0.08, 0.08) * scale, 4)]),
                       (0.7, "center")):
        add_key(pattern, {"t": round(share * end, 3), "zmp": zmp})
    return True


def slippery_ground(pattern, dice, scale):
    pattern.setdefault("world", {})["friction"] = round(dice.uniform(0.02, 0.2), 3)
    return True


def too_little_time(pattern, dice, scale):
    if not uses_times(pattern):
        return False
    share = dice.uniform(0.45, 0.85) / scale**0.5
    for phase in pattern["phases"]:
        phase["until"] = round(phase["until"] * share, 4)
    for key in pattern.get("keyframes", []):
        key["t"] = round(key["t"] * share, 4)
    return True


def height_of_the_cog(pattern, dice, scale):
    height = COG_HEIGHT[pattern["robot"]]
    pattern.setdefault("defaults", {})["cog_height"] = round(
        height * dice.choice((dice.uniform(0.62, 0.9), dice.uniform(1.0, 1.05))), 4)
    return True


def trunk_leans(pattern, dice, scale):
    if not uses_times(pattern):
        return False
    end = end_of(pattern)
    begin = dice.uniform(0.1, 0.5) * end
    width = min(dice.uniform(0.3, 1.5), 0.8 * (end - begin))
    lean = {dice.choice(("roll", "pitch", "yaw")): degrees(pattern, dice.uniform(-40, 40))}
    for at, value in ((0, {}), (0.5, lean), (1, {})):
        add_key(pattern, {"t": round(begin + at * width, 3), "torso": {**value} or {"roll": 0}})
    return True


FAULTS = [("a joint beyond its range", joint_beyond_its_range),
          ("a joint too fast", joint_too_fast),
          ("a foothold displaced", foothold_displaced),
          ("a swing too low or too high", swing_too_high),
          ("a phase too short or too long", phase_moved),
          ("the ZMP elsewhere", zmp_outside),
          ("slippery ground", slippery_ground),
          ("too little time", too_little_time),
          ("another height of the COG", height_of_the_cog),
          ("the trunk leans", trunk_leans)]
HOME, COG_HEIGHT = {}, {}


def know(robot, program, folder):
    """Angles of the home posture [deg], and the height of its COG [m]."""
    sidecar = robot if robot.endswith(".json") else os.path.join(SOURCE, "robots", robot, "robot.json")
    with open(sidecar) as file:
        sidecar = json.loads(re.sub(r"//.*$", "", file.read(), flags=re.M))
    home = sidecar["postures_deg"]["home"]
    HOME[robot] = {joint: home.get(joint, 0)
                   for joint in [*home, *sidecar.get("joint_order", [])]}
    squat = os.path.join(folder, "squat.json")
    subprocess.run([program, "new", "squat", "--robot", robot, "-o", squat, "--force", "-q"],
                   check=True, stdout=subprocess.DEVNULL)
    with open(squat) as file:
        keys = json.loads(without_comments(file.read()))["keyframes"]
    COG_HEIGHT[robot] = max(key["cog"]["height"] for key in keys if "height" in key.get("cog", {}))


class Trial:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.wrong, self.falls = [], []

    def run(self, *words):
        done = subprocess.run([self.program, *words], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def must(self, holds, what, words=""):
        if not holds:
            self.wrong.append(what + (": " + words.strip()[:2000] if words else ""))
        return holds

    def check(self, name):
        """(whether it is consistent or None where it cannot be sampled, what was printed)"""
        code, out, err = self.run("check", name, "--json", "-q")
        if code == 3:
            return None, err
        if not self.must(code in (0, 1), f"check ended with {code}", err):
            return None, err
        verdict = json.loads(out)
        refuses = verdict["export_refuses"]
        if code == 0:
            self.must(not refuses, "check says consistent, and that export would refuse", str(refuses))
        else:
            self.must(refuses, "check says inconsistent, and nothing of export")
            # A broken limit comes with a hint for the author.
            self.must(any(f.get("hint") for f in verdict.get("findings", [])),
                      "check says inconsistent without a hint", out)
        return code == 0, out

    def exported(self, name, robot):
        """Whether `export` writes it, and what it says."""
        formats = ["hoap", "csv", "json"] if robot == "hoap1" else ["csv", "json"]
        written, said = [], ""
        for form in formats:
            profile = ["--profile", robot] if os.sep not in robot else []
            code, out, err = self.run("export", name, "--format", form, "-o", "table." + form,
                                      "--force", *profile)
            self.must(code in (0, 1), f"export --format {form} ended with {code}", err)
            written.append(code == 0)
            said += out + err
        self.must(len(set(written)) == 1, "export accepts in one format only", said)
        return written[0], said

    def stands(self, name, plant):
        """Whether the robot stands after the motion in open loop; None if there is no such plant."""
        code, out, err = self.run("simulate", name, "-o", "run_" + plant, "--controller", "none",
                                  "--scenario", "none", "--plant", plant, "--force", "--json", "-q")
        if code == 2 and plant == "mujoco":
            return None
        self.must(code in (0, 1), f"simulate --plant {plant} ended with {code}", err)
        return code == 0

    def repaired(self, name, output, words):
        code, out, err = self.run("repair", name, "-o", output, "--force", "--json", "-q", *words)
        self.must(code in (0, 4), f"repair ended with {code}", err + out)
        return code == 0, out + err


def judge(trial, robot, dice, repairs, plants):
    """The outcome of one pattern, by its name in the table; a consistent one may stay unrepaired."""
    good, printed = trial.check("p.json")
    if good is None:
        return "cannot be sampled"
    accepted, said = trial.exported("p.json", robot)
    trial.must(accepted == good, f"check says {good}, export {accepted}", said + printed)
    if good and not repairs:
        return "consistent"
    words = (["--baked"] if dice.random() < 0.2 else []) + (
        ["--safety", "0"] if dice.random() < 0.15 else []) + (
            ["--trust", dice.choice(("cog", "zmp"))] if dice.random() < 0.1 else [])
    repaired, words_of_repair = trial.repaired("p.json", "r.json", words)
    if good:
        trial.must(repaired, "repair fails on a consistent pattern", words_of_repair)
    if not repaired:
        return "not repaired"
    still, printed = trial.check("r.json")
    accepted, said = trial.exported("r.json", robot)
    trial.must(still, f"repaired ({words}), but not consistent", printed)
    trial.must(accepted, f"repaired ({words}), but refused", said)
    for plant in plants:
        if trial.stands("r.json", plant) is False:
            trial.falls.append(f"{plant} ({' '.join(words)})" if words else plant)
    return "consistent" if good else "repaired"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--seeds", default="1:200", metavar="FIRST:LAST")
    parser.add_argument("--keep", help="folder for the patterns of which something does not hold")
    parser.add_argument("--stand", action="store_true", help="simulate what is repaired")
    parser.add_argument("--most-falls", type=int, metavar="N",
                        help="repaired motions that may fall (with --stand); any number if not given")
    parser.add_argument("--robot", action="append", default=[], metavar="SIDECAR=SCALE")
    options = parser.parse_args()
    for robot in options.robot:
        name, scale = robot.rsplit("=", 1)
        SCALE[os.path.abspath(name)] = float(scale)
    global ROBOTS
    ROBOTS = tuple(SCALE)
    first, last = map(int, options.seeds.split(":"))
    program = os.path.abspath(options.program)
    outcomes, failed = collections.defaultdict(collections.Counter), 0
    with tempfile.TemporaryDirectory(prefix="ayumi_one_set_") as folder:
        for robot in ROBOTS:
            know(robot, program, folder)
        generator = Generator(program, folder)
        for seed in range(first, last + 1):
            dice = random.Random(seed)
            robot, motion, pattern = generator.make(dice)
            trial = Trial(program, folder)
            for fault_number in range(1, MOST_FAULTS + 1):
                before = json.dumps(pattern)
                fault = spoil(pattern, dice, SCALE[robot])
                with open(os.path.join(folder, "p.json"), "w") as file:
                    json.dump(pattern, file, indent=1)
                outcome = judge(trial, robot, dice, fault_number == MOST_FAULTS,
                                ["ayumi", "mujoco"] if options.stand else [])
                if outcome == "cannot be sampled" and fault_number < MOST_FAULTS:
                    pattern = json.loads(before)  # another fault in its place
                elif outcome != "consistent":
                    break
            outcomes[fault][outcome] += 1
            outcomes[fault][outcome + ", falls"] += bool(trial.falls)
            print(f"{seed}: {robot} {motion}, {fault}: {outcome}"
                  + (f"; falls in {', '.join(trial.falls)}" if trial.falls else ""), flush=True)
            for wrong in trial.wrong:
                print(f"{seed}: WRONG: {wrong}", flush=True)
            if trial.wrong or trial.falls:
                failed += bool(trial.wrong)
                if options.keep:
                    os.makedirs(options.keep, exist_ok=True)
                    for name in ("p.json", "r.json"):
                        path = os.path.join(folder, name)
                        if os.path.exists(path):
                            with open(path) as source, open(
                                    os.path.join(options.keep, f"{seed}_{name}"), "w") as copy:
                                copy.write(source.read())
            if os.path.exists(os.path.join(folder, "r.json")):
                os.remove(os.path.join(folder, "r.json"))
    kinds = ["cannot be sampled", "consistent", "not repaired", "repaired"] + (
        ["consistent, falls", "repaired, falls"] if options.stand else [])
    print("| fault | patterns | " + " | ".join(kinds) + " |")
    print("| --- |" + " --- |" * (len(kinds) + 1))
    total = collections.Counter()
    for fault, counts in sorted(outcomes.items()):
        total.update(counts)
        print(f"| {fault} | {sum(counts[kind] for kind in kinds[:4])} | "
              + " | ".join(str(counts[kind]) for kind in kinds) + " |")
    print(f"| all | {sum(total[kind] for kind in kinds[:4])} | "
          + " | ".join(str(total[kind]) for kind in kinds) + " |")
    if failed:
        print(f"{failed} patterns of which something does not hold")
    falls = total["repaired, falls"]
    too_many = options.most_falls is not None and falls > options.most_falls
    if too_many:
        print(f"{falls} repaired motions fall, more than {options.most_falls}")
    return 1 if failed or too_many else 0


if __name__ == "__main__":
    sys.exit(main())
