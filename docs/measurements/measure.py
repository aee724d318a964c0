#!/usr/bin/env python3
"""Measures the tables of docs/measurements again and writes them into the pages.

    docs/measurements/measure.py                  all tables
    docs/measurements/measure.py latency          all tables of latency.md
    docs/measurements/measure.py latency/standing walking/tracking
    docs/measurements/measure.py --list

A page holds each table between `<!-- table: NAME -->` and `<!-- end -->`; what stands there is
replaced, followed by the commit, the date and the command. AYUMI names the program (default:
build/release/app/ayumi). The commit is the one checked out where the program is, so the program has
to be built from it. AYUMI_THREADS is the number of threads (default 1; results do not depend on it).
Needs Python 3 and nothing else.
"""

import csv
import datetime
import functools
import json
import math
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from random import Random

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = pathlib.Path(__file__).resolve().parent
AYUMI = os.environ.get("AYUMI", str(ROOT / "build/release/app/ayumi"))
THREADS = os.environ.get("AYUMI_THREADS", "1")
WORK = pathlib.Path(tempfile.mkdtemp(prefix="ayumi_measure_"))
TABLES = {}



def table(name):
    """Registers a function that returns the lines of a table."""

    def register(function):
        TABLES[name] = function
        return function

    return register


# ---- The program ----


def ayumi(*words, robots=None):
    """Standard output of a command; exit codes above 1 end the measurement."""
    front = [AYUMI, "--quiet", "--threads", THREADS]
    if robots:
        front += ["--robot-path", str(robots)]
    done = subprocess.run(front + [str(w) for w in words], capture_output=True, text=True, cwd=ROOT)
    if done.returncode > 1 and not (words[0] == "repair" and done.returncode == 4):
        sys.exit(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def as_json(*words, robots=None):
    return json.loads(ayumi(*words, "--json", robots=robots))


def read_jsonc(path):
    text = pathlib.Path(path).read_text()
    return json.loads(re.sub(r"^\s*//.*$", "", text, flags=re.M))


def write_pattern(pattern, name="pattern"):
    path = WORK / f"{name}.json"
    pattern = {k: v for k, v in pattern.items() if k != "$schema"}
    path.write_text(json.dumps(pattern))
    return path


def bundled(name):
    return read_jsonc(ROOT / "patterns" / f"{name}.json")


def robot_copy(name, change):
    """A folder with the robot `name` and its sidecar changed by `change`; for --robot-path."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=WORK))
    shutil.copytree(ROOT / "robots" / name, folder / name)
    sidecar = folder / name / "robot.json"
    robot = read_jsonc(sidecar)
    change(robot)
    sidecar.write_text(json.dumps(robot))
    return folder


class Log:
    """Columns of a run's log by name, from `ayumi export --format csv-log`."""

    def __init__(self, run):
        table = pathlib.Path(tempfile.mkdtemp(dir=WORK)) / "log.csv"
        ayumi("export", run, "--format", "csv-log", "-o", table)
        with open(table, newline="") as file:
            rows = csv.reader(line for line in file if not line.startswith("#"))
            names = [name.split("[")[0] for name in next(rows)]
            columns = list(zip(*rows))
        self.columns = {}
        for name, column in zip(names, columns):
            try:
                self.columns[name] = [float(value) for value in column]
            except ValueError:
                pass  # words: support, phase, disturbance
        time = self.columns["t"]
        self.dt = (time[-1] - time[0]) / (len(time) - 1)

    def vector(self, name, axes="xy"):
        return list(zip(*(self.columns[f"{name}.{a}"] for a in axes)))


def simulate(pattern, *words, robots=None, log=False):
    """Figures of a run, and its log if asked for."""
    if not log:
        return as_json("simulate", pattern, *words, robots=robots)
    out = pathlib.Path(tempfile.mkdtemp(dir=WORK)) / "run"
    figures = as_json("simulate", pattern, "-o", out, *words, robots=robots)
    return figures, Log(out)


def rms(pairs_a, pairs_b):
    squares = [sum((x - y) ** 2 for x, y in zip(a, b)) for a, b in zip(pairs_a, pairs_b)]
    return math.sqrt(sum(squares) / len(squares)), math.sqrt(max(squares))


# ---- Words ----


def mm(value, digits=1):
    return f"{1e3 * value:.{digits}f}"


def row(*cells):
    return "| " + " | ".join(str(c) for c in cells) + " |"


def head(*cells):
    return [row(*cells), row(*["---"] * len(cells))]


def verdict(figures):
    return figures["outcome"]


# ---- Patterns ----


WALK = "patterns/hoap1_walk.json"
LARGE_WALK = "patterns/humanoid30_walk.json"


def late(milliseconds):
    return [{"type": "latency", "at": 0, "latency": milliseconds / 1000}] if milliseconds else []


def stand(robot, controller, impulse, milliseconds, profile=None):
    """Three seconds on both feet, pushed to the left after one."""
    made = WORK / "stand.json"
    ayumi("new", "stand", "--robot", robot, "--duration", 3, "-o", made, "--force")
    pattern = read_jsonc(made)
    if controller == "viip":
        pattern["phases"] = [{"until": 3, "viip": {"cog": [0, 0, 0]}}]
        pattern.pop("keyframes", None)
    pattern["controller"] = {"type": controller}
    pattern["scenario"] = late(milliseconds) + [
        {"type": "impulse", "at": 1, "duration": 0.02, "on": "cog", "direction": [0, 1, 0],
         "impulse": impulse}]
    return write_pattern(pattern, "stand_late")


LATENCIES = (0, 4, 8, 10, 12, 14)


def late_cell(figures):
    if figures["outcome"] == "fell":
        return "falls"
    moves = "" if figures["outcome"] == "stands" else ", unsettled"
    return mm(figures["zmp_tracking_rms_m"]) + moves


@table("latency/standing")
def latency_standing():
    lines = head("robot, law", *[f"{ms} ms" for ms in LATENCIES])
    for name, robot, controller, impulse, words in [
        ("HOAP-1, DTAD", "hoap1", "dtad", 0.3, []),
        ("previous row, with `damp=0`", "hoap1", "dtad", 0.3, gain("damp=0")),
        ("HOAP-1 on soft servos (`hoap1-soft`), DTAD", "hoap1", "dtad", 0.3,
         ["--profile", "hoap1-soft"]),
        ("HOAP-1, VIIP", "hoap1", "viip", 0.3, []),
        ("previous row, with `damp=0`", "hoap1", "viip", 0.3, gain("damp=0")),
        ("`humanoid30`, DTAD, 2.4 N s", "humanoid30", "dtad", 2.4, []),
        ("previous row, with `damp=0`", "humanoid30", "dtad", 2.4, gain("damp=0")),
        ("`humanoid30`, VIIP, 2.4 N s", "humanoid30", "viip", 2.4, []),
    ]:
        lines.append(row(name, *[
            late_cell(simulate(stand(robot, controller, impulse, ms), "--allow-unstable", *words))
            for ms in LATENCIES]))
    return lines


@table("latency/walking")
def latency_walking():
    lines = head("pattern, law", *[f"{ms} ms" for ms in LATENCIES])
    for name, source, world, robots, words in [
        ("`hoap1_walk`, DTAD", "hoap1_walk", {}, None, []),
        ("previous row, with `damp=0`", "hoap1_walk", {}, None, gain("damp=0")),
        ("`hoap1_walk`, DTAD, on ground that rises by 3°", "hoap1_walk", {"ground": {"pitch": -3}}, None,
         []),
        ("`hoap1_walk`, DTAD, on soles of 60 kN/m", "hoap1_walk", {}, softer_soles(6e4), []),
        ("`hoap1_viip_step` without its push, VIIP", "hoap1_viip_step", {}, None, []),
        ("previous row, with `damp=0`", "hoap1_viip_step", {}, None, gain("damp=0")),
        ("`humanoid30_walk` without its push, DTAD", "humanoid30_walk", {}, None, []),
    ]:
        cells = []
        for ms in LATENCIES:
            pattern = bundled(source)
            pattern["scenario"] = late(ms)
            pattern.setdefault("world", {}).update(world)
            cells.append(late_cell(simulate(write_pattern(pattern), "--allow-unstable", *words,
                                            robots=robots)))
        lines.append(row(name, *cells))
    return lines


# ---- Walking ----


@table("walking/tracking")
def tracking():
    lines = head("plant", "law", "COG, rms", "COG, largest", "ZMP, rms", "landings")
    for plant in ("ayumi", "mujoco"):
        for law, words in (("open loop", ["--controller", "none"]), ("DTAD", []),
                           ("DTAD, `--noise`", ["--noise"])):
            figures, log = simulate(WALK, "--scenario", "none", "--profile", "hoap1", "--plant",
                                    plant, *words, log=True)
            cog, worst = rms(log.vector("cog", "xyz"), log.vector("cmd.cog", "xyz"))
            zmp, _ = rms(log.vector("zmp"), log.vector("cmd.zmp"))
            landings = sum(e["kind"] == "touchdown" for e in figures["events"])
            lines.append(row(plant, law, f"{mm(cog, 2)} mm", f"{mm(worst, 2)} mm",
                             f"{mm(zmp)} mm", landings))
    return lines


# ---- Pushes ----


NOMINAL = ["--replicas", 0]
FOUR = NOMINAL + ["--directions", 4]


@functools.lru_cache(maxsize=None)
def push_study(pattern, *words, robots=None):
    """Thresholds of `ayumi push`."""
    return as_json("push", pattern, *words, robots=robots)["thresholds"]


def cases(study, standing, controller=None):
    chosen = [c for c in study if (c["phase"] == "standing") == standing]
    return [c for c in chosen if c["controller"] == (controller or chosen[0]["controller"])]


def pair(values, digits=2):
    """Worst and mean."""
    return f"{min(values):.{digits}f} / {sum(values) / len(values):.{digits}f}"


def in_bounds(chosen, key="impulse_Ns"):
    return pair([c[key] / c["bound_Ns"] for c in chosen])


def in_newton_seconds(chosen, key="impulse_Ns"):
    return pair([c[key] for c in chosen], 2 if chosen[0]["bound_Ns"] < 10 else 1)


def push_row(name, study, key="impulse_Ns", controller=None):
    walking, still = cases(study, False, controller), cases(study, True, controller)
    return row(name, in_bounds(walking, key), in_newton_seconds(walking, key),
               in_bounds(still, key), in_newton_seconds(still, key))


@table("pushes/laws")
def pushes_laws():
    lines = head("robot, law", "walking [B]", "walking [N s]", "standing [B]", "standing [N s]")
    both = ("--controller", "dtad", "--controller", "dtad-literal")
    for robot, pattern in (("HOAP-1", WALK), ("`humanoid30`", LARGE_WALK)):
        study = push_study(pattern, *both)
        lines.append(push_row(f"{robot}, DTAD", study))
        lines.append(push_row(f"{robot}, DTAD, `--noise`", push_study(pattern, "--noise")))
        lines.append(push_row(f"{robot}, open loop", study, "open_loop_Ns"))
        lines.append(push_row(f"{robot}, literal law", study, controller="dtad-literal"))
    strong = push_study(WALK, "--profile", "hoap1-strong")
    lines.append(push_row("HOAP-1 with `hoap1-strong`, DTAD", strong))
    lines.append(push_row("HOAP-1 with `hoap1-strong`, open loop", strong, "open_loop_Ns"))
    return lines


@table("pushes/directions")
def pushes_directions():
    study = cases(push_study(WALK, "--controller", "dtad", "--controller", "dtad-literal"), False)
    still = cases(push_study(WALK, "--controller", "dtad", "--controller", "dtad-literal"), True)
    directions = sorted({c["direction_rad"] for c in study})
    lines = head("phase", *[f"{math.degrees(d):.0f}°" for d in directions])
    for phase in dict.fromkeys(c["phase"] for c in still + study):
        for name, key in (("DTAD", "impulse_Ns"), ("open loop", "open_loop_Ns")):
            line = [c for c in still + study if c["phase"] == phase]
            lines.append(row(f"{phase}, {name}", *[f"{c[key] / c['bound_Ns']:.2f}" for c in line]))
    return lines


@table("pushes/moderate")
def pushes_moderate():
    study = push_study(WALK, "--controller", "dtad", "--controller", "dtad-literal")
    lines = head("phase, law", "falls", "stance foot tilted, longest", "back after, longest",
                 "trunk tilt, largest")
    chosen = cases(study, True) + cases(study, False)
    for phase in dict.fromkeys(c["phase"] for c in chosen):
        for name, key in (("DTAD", "moderate"), ("open loop", "open_loop_moderate")):
            figures = [c[key] for c in chosen if c["phase"] == phase]
            upright = [f for f in figures if f["survives"]]
            lines.append(row(f"{phase}, {name}", f"{len(figures) - len(upright)} of {len(figures)}",
                             f"{1e3 * max(f['foot_tilt_s'] for f in upright):.0f} ms",
                             f"{1e3 * max(f['recovery_s'] for f in upright):.0f} ms",
                             f"{math.degrees(max(f['trunk_tilt_rad'] for f in upright)):.1f}°"))
    return lines


@table("pushes/walks")
def pushes_walks():
    lines = head("walk", "steps as planned [B]", "`step=1` [B]", "cases lower with `step=1`",
                 "of these cases, lower by more than 0.06 B")
    count = [0, 0, 0]
    for name, robot, words in [
        ("forward, as `hoap1_walk`", "hoap1", []),
        ("turning 8° a step", "hoap1", ["--turn", 8]),
        ("turning −15° a step", "hoap1", ["--turn", -15]),
        ("to the left, 30 mm per pair", "hoap1", ["--stride", 0, "--side", 0.03]),
        ("to the right, 30 mm per pair", "hoap1", ["--stride", 0, "--side", -0.03]),
        ("backwards", "hoap1", ["--stride", -0.03]),
        ("steps of 45 mm in 0.48 s", "hoap1", ["--stride", 0.045, "--period", 0.48]),
        ("high steps of 20 mm in 0.7 s", "hoap1",
         ["--stride", 0.02, "--period", 0.7, "--lift", 0.025]),
        ("`humanoid30`, forward", "humanoid30", []),
        ("`humanoid30`, turning 8° a step", "humanoid30", ["--turn", 8]),
    ]:
        made = WORK / f"walk_{len(lines)}.json"
        ayumi("new", "walk", "--robot", robot, *words, "--allow-inconsistent", "-o", made, "--force")
        profile = (*FOUR, *(("--profile", "hoap1-strong") if robot == "hoap1" else ()))
        fixed = push_study(made, *profile)
        moved = push_study(made, *profile, "--gain", "step=1")
        drop = [(f["impulse_Ns"] - m["impulse_Ns"]) / f["bound_Ns"] for m, f in zip(moved, fixed)]
        cells = [sum(d > 1e-9 for d in drop), sum(d > 0.061 for d in drop), len(drop)]
        count = [a + b for a, b in zip(count, cells)]
        lines.append(row(name, in_bounds(cases(fixed, False)), in_bounds(cases(moved, False)),
                         f"{cells[0]} of {cells[2]}", cells[1]))
    lines.append(row("all", "", "", f"{count[0]} of {count[2]}", count[1]))
    return lines


@table("pushes/plants")
def pushes_plants():
    lines = head("profile, plant", "DTAD, walking [B]", "DTAD, standing [B]",
                 "open loop, walking [B]", "open loop, standing [B]",
                 "cases lower than in open loop")
    for profile in ("hoap1", "hoap1-strong"):
        for plant in ("ayumi", "mujoco"):
            study = push_study(WALK, *FOUR, "--profile", profile, "--plant", plant)
            walking, still = cases(study, False), cases(study, True)
            lower = sum(c["impulse_Ns"] < c["open_loop_Ns"] - 1e-9 for c in study)
            lines.append(row(f"`{profile}`, {plant}", in_bounds(walking), in_bounds(still),
                             in_bounds(walking, "open_loop_Ns"), in_bounds(still, "open_loop_Ns"),
                             f"{lower} of {len(study)}"))
    return lines


def stepping(robot, profile):
    """Twelve steps in place by VIIP, as `hoap1_viip_step` without its push."""
    pattern = bundled("hoap1_viip_step")
    pattern["scenario"] = []
    pattern["robot"] = robot
    pattern["profile"] = profile
    if robot != "hoap1":
        pattern["phases"][1]["until"] = 10
        pattern.pop("defaults")
    return write_pattern(pattern, f"stepping_{robot}_{profile}")


@table("pushes/viip")
def pushes_viip():
    lines = head("robot", "VIIP [B]", "VIIP [N s]", "landings alone [B]", "no feedback [B]")
    for name, robot, profile, words in [
        ("HOAP-1, `hoap1-strong`", "hoap1", "hoap1-strong", ()),
        ("previous row, with `--noise`", "hoap1", "hoap1-strong", ("--noise",)),
        ("`humanoid30`", "humanoid30", "humanoid30", ()),
    ]:
        study = push_study(stepping(robot, profile), *FOUR, *words, "--controller", "viip",
                           "--controller", "viip-landings")
        viip = cases(study, False, "viip")
        lines.append(row(name, in_bounds(viip), in_newton_seconds(viip),
                         in_bounds(cases(study, False, "viip-landings")),
                         in_bounds(viip, "open_loop_Ns")))
    return lines


# ---- Baselines ----


BASELINES = ("preview", "foot-guided", "dcm-step")
LAWS_TO_COMPARE = ("dtad", "dtad, `step=1`") + BASELINES


def sway(robot):
    made = WORK / f"sway_{robot}.json"
    ayumi("new", "sway", "--robot", robot, "-o", made, "--force")
    return made


@functools.lru_cache(maxsize=None)
def pushes_of_laws(pattern, *words):
    """Thresholds by the laws of LAWS_TO_COMPARE."""
    compared = [w for law in ("dtad",) + BASELINES for w in ("--controller", law)]
    study = push_study(pattern, *FOUR, *words, *compared)
    by_law = {law: [c for c in study if c["controller"] == law] for law in ("dtad",) + BASELINES}
    by_law["dtad, `step=1`"] = push_study(pattern, *FOUR, *words, "--controller", "dtad",
                                          "--gain", "step=1")
    return by_law


def six_patterns(*words):
    """(name, cases by law) of six patterns."""
    for robot, walk, name in (("hoap1", WALK, "HOAP-1"),
                              ("humanoid30", LARGE_WALK, "`humanoid30`")):
        laws = pushes_of_laws(walk, *words)
        for what, standing in (("walk", False), ("standing", True)):
            yield f"{name}, {what}", {law: cases(c, standing) for law, c in laws.items()}
        laws = pushes_of_laws(sway(robot), *words)
        yield f"{name}, sway", {law: cases(c, False) for law, c in laws.items()}


@table("baselines/pushes")
def baselines_pushes():
    lines = head("pattern", "law", "J/B", "J/m [m/s]", "J/(m √(g z))", "lower than DTAD")
    for name, by_law in six_patterns():
        dtad = by_law["dtad"]
        for law in LAWS_TO_COMPARE:
            chosen = by_law[law]
            lower = sum(c["impulse_Ns"] < d["impulse_Ns"] - 1e-9 for c, d in zip(chosen, dtad))
            lines.append(row(name, law, in_bounds(chosen),
                             pair([c["J_per_m_m_per_s"] for c in chosen]),
                             pair([c["J_per_m_sqrt_gz"] for c in chosen], 3),
                             "" if law == "dtad" else f"{lower} of {len(chosen)}"))
    return lines


@table("baselines/unpushed")
def baselines_unpushed():
    lines = head("pattern", "law", "verdict", "COG error at the end", "ZMP error, rms",
                 "COG error at the end, `--noise`", "ZMP error, rms, `--noise`")
    for name, pattern in (("HOAP-1, walk", WALK), ("`humanoid30`, walk", LARGE_WALK)):
        for law, words in [("dtad", ()), ("dtad, `step=1`", ("--gain", "step=1"))] + [
                (law, ("--controller", law)) for law in BASELINES]:
            clean, noisy = (simulate(pattern, "--scenario", "none", *words, *more)
                            for more in ((), ("--noise",)))
            lines.append(row(name, law, verdict(clean), f"{mm(clean['final_cog_error_m'], 2)} mm",
                             f"{mm(clean['zmp_tracking_rms_m'])} mm",
                             f"{mm(noisy['final_cog_error_m'], 2)} mm",
                             f"{mm(noisy['zmp_tracking_rms_m'])} mm"))
    return lines


# ---- Terms and gains of DTAD ----


def zmp_error(*words):
    """Distance of the measured ZMP from ref ZMP in the unpushed walk, rms."""
    figures = simulate(WALK, "--scenario", "none", "--allow-unstable", *words)
    return "falls" if figures["outcome"] == "fell" else f"{mm(figures['zmp_tracking_rms_m'])}"


def gain(text):
    return [w for g in text.split() for w in ("--gain", g)]


LAWS = [
    ("DTAD", []),
    ("`ka=0 conform=0`: no short-term feedback", gain("ka=0 conform=0")),
    ("`damp=0`: rocking is not damped", gain("damp=0")),
    ("`long=0`: no long-term feedback", gain("long=0")),
    ("`washout=0`: a constant ZMP offset is never accepted", gain("washout=0")),
    ("`ankle=0`: ankles do not turn a tipped foot back", gain("ankle=0")),
    ("`conform=0`: ankles do not yield on bumps", gain("conform=0")),
    ("`momentum=0`: trunk and arms do not turn", gain("momentum=0")),
    ("`as_printed=1`: printed sign of D", gain("as_printed=1")),
    ("`step=1`: footholds move", gain("step=1")),
]


@table("law/terms")
def law_terms():
    lines = head("law", "walking [B]", "standing [B]", "ZMP error [mm]")
    for name, words in LAWS:
        study = push_study(WALK, *FOUR, *words)
        walking, still = cases(study, False), cases(study, True)
        if not words:
            lines.append(row("open loop", in_bounds(walking, "open_loop_Ns"),
                             in_bounds(still, "open_loop_Ns"), zmp_error("--controller", "none")))
        lines.append(row(name, in_bounds(walking), in_bounds(still), zmp_error(*words)))
    study = push_study(WALK, *FOUR, "--controller", "dtad-literal")
    lines.append(row("literal law", in_bounds(cases(study, False)), in_bounds(cases(study, True)),
                     zmp_error("--controller", "dtad-literal")))
    return lines


@table("law/gains")
def law_gains():
    lines = head("gains", "walking [B]", "standing [B]", "ZMP error [mm]",
                 "ZMP error, `--noise` [mm]")
    for words in ["", "ka=0.5", "ka=2", "ks=0.9 kd=0.9", "ks=3.6 kd=3.6", "ka=2.5 ks=2 kd=2",
                  "damp=4", "damp=16", "q=0.125", "q=0.5", "tau_z=0.005", "tau_z=0.02",
                  "ankle=0.25", "ankle=1",
                  "momentum=1", "momentum=3", "momentum=12"]:
        study = push_study(WALK, *FOUR, "--allow-unstable", *gain(words))
        lines.append(row(f"`{words}`" if words else "defaults", in_bounds(cases(study, False)),
                         in_bounds(cases(study, True)), zmp_error(*gain(words)),
                         zmp_error(*gain(words), "--noise")))
    return lines


@table("law/q")
def law_q():
    lines = head("pattern", "q = 0.25", "q = 0.6", "q = 1")
    for name, noise in (("", ()), (", `--noise`", ("--noise",))):
        walks, stands, sways = [], [], []
        for q in (0.25, 0.6, 1):
            study = push_study(LARGE_WALK, *FOUR, *noise, *gain(f"q={q}"))
            walks.append(in_bounds(cases(study, False)))
            stands.append(in_bounds(cases(study, True)))
            study = push_study(sway("humanoid30"), *FOUR, *noise, *gain(f"q={q}"))
            sways.append(in_bounds(cases(study, False)))
        for what, cells in (("walk", walks), ("standing", stands), ("sway", sways)):
            lines.append(row(f"{what}{name}: worst and mean push [B]", *cells))
    for name, words in (("", ()), (", `--noise`", ("--noise",))):
        lines.append(row(f"walk without a push{name}: ZMP error [mm]", *[
            mm(simulate(LARGE_WALK, "--scenario", "none", *words,
                        *gain(f"q={q}"))["zmp_tracking_rms_m"]) for q in (0.25, 0.6, 1)]))
    return lines


# ---- Conditions that the plan does not know ----


def walk_under(**world):
    """The walk without its push, in another world."""
    pattern = bundled("hoap1_walk")
    pattern["world"].update(world)
    pattern["scenario"] = []
    return write_pattern(pattern, f"under_{len(list(WORK.glob('under_*')))}")


def softer_soles(stiffness):
    def change(robot):
        for sole in robot["soles"].values():
            sole["stiffness"] = stiffness
    return robot_copy("hoap1", change)


def servos_of(kp, kd):
    def change(robot):
        robot["servos"][0].update(kp=kp, kd=kd)
        robot["servos"][1].update(kp=kp / 2, kd=kd / 2)
    return robot_copy("hoap1", change)


@table("conditions/changes")
def conditions_changes():
    lines = head("condition", "unpushed, DTAD and open loop", "DTAD [N s]", "open loop [N s]")
    for name, pattern, robots in [
        ("as planned", walk_under(), None),
        ("ground rises by 3°", walk_under(ground={"pitch": -3}), None),
        ("ground falls by 3°", walk_under(ground={"pitch": 3}), None),
        ("ground falls to the right by 3°", walk_under(ground={"roll": 3}), None),
        ("friction 0.15", walk_under(friction=0.15), None),
        ("soles of 60 kN/m", walk_under(), softer_soles(6e4)),
        ("`kp` 200, `kd` 4", walk_under(), servos_of(200, 4)),
    ]:
        alone = [simulate(pattern, *words, robots=robots)["outcome"]
                 for words in ([], ["--controller", "none"])]
        study = cases(push_study(pattern, *FOUR, robots=robots), False)
        lines.append(row(name, ", ".join(alone), in_newton_seconds(study),
                         in_newton_seconds(study, "open_loop_Ns")))
    return lines


DISC_SEEDS = 24


def disc_walk(seed):
    """One to three discs, 3 mm high, at random places under the sole of every foothold."""
    random = Random(seed)
    feet = [phase["swing"]["to"] for phase in bundled("hoap1_walk")["phases"] if "swing" in phase]
    discs = [{"position": [x + random.uniform(-0.042, 0.056), y + random.uniform(-0.0315, 0.0315)],
              "radius": random.uniform(0.005, 0.02), "height": 0.003}
             for x, y in feet for _ in range(1 + int(3 * random.random()))]
    return walk_under(blocks=discs)


@table("conditions/discs")
def conditions_discs():
    lines = head("law", "falls", "largest trunk tilt, mean", "largest trunk tilt, worst")
    walks = [disc_walk(seed) for seed in range(DISC_SEEDS)]
    for name, words in [("open loop", ["--controller", "none"]),
                        ("DTAD, `conform=0`", gain("conform=0")),
                        ("DTAD, `conform=0.5`, the default", []),
                        ("DTAD, `conform=1`", gain("conform=1"))]:
        runs = [simulate(walk, *words) for walk in walks]
        tilts = [math.degrees(f["max_tilt_rad"]) for f in runs if f["outcome"] != "fell"]
        lines.append(row(name, f"{len(runs) - len(tilts)} of {len(runs)}",
                         f"{sum(tilts) / len(tilts):.1f}°" if tilts else "",
                         f"{max(tilts):.1f}°" if tilts else ""))
    return lines


# ---- VIIP ----


def viip_pattern(robot, goal, until, profile=None, height=None):
    pattern = {"format": "ayumi.pattern/1", "name": "goal", "robot": robot,
               "units": {"angle": "deg"},
               "phases": [{"until": 0.5, "viip": {"cog": [0, 0, 0]}},
                          {"until": until, "viip": goal}],
               "controller": {"type": "viip"}}
    if profile:
        pattern["profile"] = profile
    if height:
        pattern["defaults"] = {"cog_height": height}
    return write_pattern(pattern, "goal")


def settled(robot, way, within, *words):
    """Time until the COG stays near its goal, and the distance of the ZMP from ref ZMP."""
    figures, log = simulate(viip_pattern(robot, {"cog": way}, 3), *words, log=True)
    if figures["outcome"] != "stands":
        return figures["outcome"]
    cog = log.vector("cog", "xyz")
    first = round(0.5 / log.dt)
    goal = [c + d for c, d in zip(cog[first], way)]
    far = [k for k, c in enumerate(cog) if k > first and math.dist(c, goal) > within]
    return f"{(far[-1] - first) * log.dt:.2f} s, {mm(figures['zmp_tracking_rms_m'])} mm"


@table("viip/displacements")
def viip_displacements():
    lines = head("goal", "Ayumi", "`--noise`", "MuJoCo")
    for robot, way, within in [
        ("hoap1", [0.02, 0, 0], 0.002), ("hoap1", [0.04, 0, 0], 0.002),
        ("hoap1", [0, 0.05, 0], 0.002), ("hoap1", [0, 0, -0.015], 0.002),
        ("hoap1", [0.025, 0.025, -0.015], 0.002),
        ("humanoid30", [0.1, 0, 0], 0.005), ("humanoid30", [0, 0.125, 0], 0.005),
    ]:
        name = f"{ROBOT_NAMES[robot]}, {', '.join(f'{1e3 * w:.0f}' for w in way)} mm"
        lines.append(row(name, *[settled(robot, way, within, *words)
                                 for words in ([], ["--noise"], ["--plant", "mujoco"])]))
    return lines


ROBOT_NAMES = {"hoap1": "HOAP-1", "humanoid30": "`humanoid30`"}


def speed_error(robot, velocity, *words):
    """Mean speed from the third landing to the eleventh, against the wanted one."""
    until = 20 if robot == "humanoid30" else 11
    pattern = viip_pattern(robot, {"steps": 14, "velocity": velocity}, until,
                           "hoap1-strong" if robot == "hoap1" else None,
                           0.225 if robot == "hoap1" else None)
    figures, log = simulate(pattern, *words, log=True)
    if figures["outcome"] != "stands":
        return figures["outcome"]
    landings = [e["t_s"] for e in figures["events"] if e["kind"] == "touchdown"]
    begin, end = (round(landings[k] / log.dt) for k in (2, 10))
    along = 0 if velocity[0] else 1
    cog = log.vector("cog")
    speed = (cog[end][along] - cog[begin][along]) / ((end - begin) * log.dt)
    return f"{100 * (speed / velocity[along] - 1):+.1f} %"


@table("viip/walking")
def viip_walking():
    lines = head("goal", "Ayumi", "`--noise`", "MuJoCo")
    for robot, velocity in [("hoap1", [0.05, 0]), ("hoap1", [0.1, 0]), ("hoap1", [0.2, 0]),
                            ("hoap1", [-0.1, 0]), ("hoap1", [0, 0.05]),
                            ("humanoid30", [0.15, 0]), ("humanoid30", [0.3, 0])]:
        lines.append(row(f"{ROBOT_NAMES[robot]}, ({velocity[0]:g}, {velocity[1]:g}) m/s",
                         *[speed_error(robot, velocity, *words)
                           for words in ([], ["--noise"], ["--plant", "mujoco"])]))
    return lines


JUMPING_MASS = 6.5  # of HOAP-1 [kg]


def jump(height, stoop, release, *words):
    """Errors of the apex and of the stoop at the landing; peak force over that of (27)."""
    pattern = bundled("hoap1_jump")
    pattern["phases"][1]["viip"]["jump"] = {"height": height, "stoop": stoop, "release": release}
    figures, log = simulate(write_pattern(pattern, "jump"), *words, log=True)
    if figures["outcome"] != "stands":
        return figures["outcome"]
    planned = height if release == "ref_z" else height + stoop**2 / (4 * height)
    z = log.columns["cog.z"]
    top = max(range(len(z)), key=lambda k: z[k])
    landing = min(round(e["t_s"] / log.dt) for e in figures["events"]
                  if e["kind"] == "touchdown" and e["t_s"] / log.dt > top)
    sunk = z[landing] - min(z[landing:])
    speed = min(log.columns["dcog.z"][top:landing])
    spring = JUMPING_MASS * (speed**2 / stoop + 9.80665)
    return (f"{100 * (figures['apex_m'] / planned - 1):+.1f} %, {100 * (sunk / stoop - 1):+.0f} %, "
            f"{max(log.columns['fz'][top:]) / spring:.1f}")


@table("viip/jumps")
def viip_jumps():
    lines = head("z_H, z_d, release", "Ayumi", "`--noise`", "MuJoCo")
    for height, stoop, release in [(20, 30, "ref_z"), (30, 35, "ref_z"), (40, 35, "ref_z"),
                                   (50, 40, "ref_z"), (30, 30, "spring"), (40, 35, "spring"),
                                   (50, 40, "spring")]:
        lines.append(row(f"{height} mm, {stoop} mm, `{release}`",
                         *[jump(height / 1e3, stoop / 1e3, release, *words)
                           for words in ([], ["--noise"], ["--plant", "mujoco"])]))
    return lines


# ---- Repair ----


def hill(t, center, width):
    """A smooth bump: 1 at `center`, and 0 at distances of half of `width` or more."""
    s = (t - center) / width
    return math.cos(math.pi * s) ** 4 if abs(s) < 0.5 else 0


def faulty(name, change):
    """`hoap1_walk` as a dense table without its push, and `change` plants a fault in it."""
    folder = WORK / name
    folder.mkdir(exist_ok=True)
    path = folder / "walk.json"
    source = bundled("hoap1_walk")
    source["scenario"] = []
    ayumi("edit", "bake", write_pattern(source, "plain"), "-o", path, "--force")
    pattern = read_jsonc(path)
    lines = (folder / "walk.csv").read_text().splitlines()
    first = next(k for k, line in enumerate(lines) if line.startswith("t[s]"))
    columns = lines[first].split(",")
    rows = [[float(v) for v in line.split(",")] for line in lines[first + 1 :]]
    change(pattern, columns, rows)
    if name == "squeezed":
        lines = [line for line in lines if not line.startswith(("# dt", "# rate_hz"))]
        first = next(k for k, line in enumerate(lines) if line.startswith("t[s]"))
    text = lines[: first + 1] + [",".join(repr(v) for v in r) for r in rows]
    (folder / "walk.csv").write_text("\n".join(text) + "\n")
    path.write_text(json.dumps(pattern))
    return path


def thrown(degrees, center, width, *joints):
    """Adds a smooth bump to the angle of the first joint, and the opposite bump to the other joints."""

    def change(pattern, columns, rows):
        for k, joint in enumerate(joints):
            column = columns.index(f"theta.{joint}[rad]")
            size = math.radians(degrees) * (-1 if k else 1)
            for r in rows:
                r[column] += size * hill(r[0], center, width)
    return change


def early_contact(pattern, columns, rows):
    pattern["phases"][7]["until"] -= 0.06


def squeezed(pattern, columns, rows):
    for r in rows:
        r[0] *= 0.65
    for phase in pattern["phases"]:
        phase["until"] *= 0.65


def slippery(pattern, columns, rows):
    pattern["world"]["friction"] = 0.10


def moved_cog(pattern, columns, rows):
    column = columns.index("cog.y[m]")
    for r in rows:
        r[column] += 0.015 * hill(r[0], 3, 0.6)


FAULTS = [
    ("knee thrown by 80°", "knee", thrown(80, 2.44, 0.4, "r_knee"), []),
    ("elbow beyond its limit", "elbow", thrown(40, 3, 0.8, "l_elbow"), []),
    ("arm through the trunk", "arm", thrown(-35, 3, 0.8, "l_shoulder_roll"), []),
    ("stance foot displaced by 5 mm", "slip",
     thrown(1.4, 2.3, 0.3, "l_hip_pitch", "l_ankle_pitch"), []),
    ("contact 60 ms too early", "contact", early_contact, []),
    ("whole motion played in 0.65 of its time", "squeezed", squeezed, []),
    ("ground of friction 0.10", "friction", slippery, []),
    ("COG moved by 15 mm, `--trust cog`", "cog", moved_cog, ["--trust", "cog"]),
]


def processor_time(work):
    begin = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = work()
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    return result, end.ru_utime - begin.ru_utime


@functools.lru_cache(maxsize=None)
def repaired_faults():
    results = []
    for name, key, change, words in FAULTS:
        path = faulty(key, change)
        mended = WORK / key / "repaired.json"
        _, check = processor_time(lambda: as_json("check", path))
        figures, time_taken = processor_time(
            lambda: as_json("repair", path, "-o", mended, "--force", *words))
        results.append((name, path, mended, figures, time_taken / check))
    return results


@table("repair/outcome")
def repair_outcome():
    lines = head("fault", "outcome", "joint moved most", "change", "safety", "iterations",
                 "time / check")
    for name, _, _, figures, ratio in repaired_faults():
        change, moved = figures["weighted_change"], figures["moved"]
        lines.append(row(name, figures["status"].replace("_", " "),
                         f"`{moved['where']}`, {math.degrees(moved['max_joint_rad']):.1f}°",
                         f"{change['change']:.4f}", f"{change['safety']:.4f}",
                         figures["iterations"], f"{ratio:.0f}"))
    return lines


# ---- Mistakes of authors ----


def mistakes_table(planted):
    """Whether the first message names each mistake, on each robot."""
    import mistakes

    mistakes.AYUMI = AYUMI
    found = mistakes.outcomes(planted)
    lines = head("mistake", "pattern", *[f"`{name}`" for name in mistakes.ROBOTS])
    words = {"named": "yes", "not named": "**no**"}
    for mistake, cells in found:
        lines.append(row(mistake.name, mistake.kind,
                         *[words.get(cells[name][0], cells[name][0]) for name in mistakes.ROBOTS]))
    counts = []
    for name in mistakes.ROBOTS:
        results = [cells[name][0] for _, cells in found]
        asked = sum(r in ("named", "not named", "no answer") for r in results)
        counts.append(f"{results.count('named')} of {asked}")
    lines.append(row("named", "", *counts))
    return lines


@table("mistakes/known")
def mistakes_known():
    import mistakes

    return mistakes_table(mistakes.KNOWN)


@table("mistakes/new")
def mistakes_new():
    import mistakes

    return mistakes_table(mistakes.NEW)


def commit():
    folder = pathlib.Path(AYUMI).resolve().parent
    return subprocess.run(["git", "rev-parse", "--short=7", "HEAD"], capture_output=True, text=True,
                          cwd=folder).stdout.strip()


def write_page(name, lines):
    page = PAGES / (name.split("/")[0] + ".md")
    start, end = f"<!-- table: {name} -->", "<!-- end -->"
    text = page.read_text()
    if start not in text:
        sys.exit(f"{page} has no line {start}")
    before, rest = text.split(start, 1)
    _, after = rest.split(end, 1)
    note = f"Commit {commit()}, {datetime.date.today()}: `docs/measurements/measure.py {name}`"
    page.write_text(before + start + "\n" + "\n".join(lines + ["", note]) + "\n" + end + after)


def main(words):
    if words == ["--list"]:
        print("\n".join(TABLES))
        return
    if any(w.startswith("-") for w in words):
        sys.exit(__doc__)
    chosen = [n for n in TABLES if not words or n in words or n.split("/")[0] in words]
    if not chosen:
        sys.exit(f"no such table; known: {', '.join(TABLES)}")
    for name in chosen:
        begin = time.time()
        lines = TABLES[name]()
        print(f"{name}, {time.time() - begin:.0f} s", *lines, sep="\n", flush=True)
        if not os.environ.get("AYUMI_MEASURE_ONLY"):
            write_page(name, lines)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    finally:
        shutil.rmtree(WORK, ignore_errors=True)
