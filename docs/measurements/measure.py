#!/usr/bin/env python3
"""Measures the tables of docs/measurements again and writes them into the pages.

    docs/measurements/measure.py                  all tables
    docs/measurements/measure.py latency          all tables of latency.md
    docs/measurements/measure.py latency/standing walking/tracking
    docs/measurements/measure.py --list

A page holds each table between `<!-- table: NAME -->` and `<!-- end -->`; what stands there is
replaced, headed by the commit, the date and the command. AYUMI names the program (default:
build/release/app/ayumi, which has to be built from the commit that is checked out), AYUMI_THREADS
the number of threads (default 1; results do not depend on it). Needs Python 3 and nothing else.
"""

import array
import datetime
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = pathlib.Path(__file__).resolve().parent
AYUMI = os.environ.get("AYUMI", str(ROOT / "build/release/app/ayumi"))
THREADS = os.environ.get("AYUMI_THREADS", "1")
WORK = pathlib.Path(tempfile.mkdtemp(prefix="ayumi_measure_"))
TABLES = {}

OLD_GAINS = ["--gain", "ka=2.5", "--gain", "ks=2", "--gain", "kd=2"]


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
    """A folder with the robot `name` whose sidecar went through `change`; for --robot-path."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=WORK))
    shutil.copytree(ROOT / "robots" / name, folder / name)
    sidecar = folder / name / "robot.json"
    robot = read_jsonc(sidecar)
    change(robot)
    sidecar.write_text(json.dumps(robot))
    return folder


class Log:
    """Columns of a log file by name, as docs/formats.md describes it."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        (length,) = struct.unpack_from("<I", data, 12)
        self.header = json.loads(data[16 : 16 + length])
        values = array.array("d")
        values.frombytes(data[16 + length :])
        names = [c if isinstance(c, str) else c["name"] for c in self.header["columns"]]
        names = [n.split("[")[0] for n in names]
        self.columns = {n: values[i :: len(names)] for i, n in enumerate(names)}
        self.rows = len(values) // len(names)
        self.dt = self.header["dt"]

    def vector(self, name, axes="xy"):
        return list(zip(*(self.columns[f"{name}.{a}"] for a in axes)))


def simulate(pattern, *words, robots=None, log=False):
    """Figures of a run, and its log if asked for."""
    if not log:
        return as_json("simulate", pattern, *words, robots=robots)
    out = pathlib.Path(tempfile.mkdtemp(dir=WORK)) / "run"
    figures = as_json("simulate", pattern, "-o", out, *words, robots=robots)
    (file,) = out.glob("log_*.bin*")
    return figures, Log(file)


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


LATENCIES = (0, 2, 4, 6, 8, 10)


@table("latency/standing")
def latency_standing():
    lines = head("robot, law", *[f"{ms} ms" for ms in LATENCIES])
    for name, robot, controller, impulse, words in [
        ("HOAP-1, DTAD", "hoap1", "dtad", 0.3, []),
        ("the same with `ka=2.5 ks=2 kd=2`, the defaults up to version 0.1", "hoap1", "dtad", 0.3,
         OLD_GAINS),
        ("HOAP-1, DTAD, `tau_z=0.066`", "hoap1", "dtad", 0.3, ["--gain", "tau_z=0.066"]),
        ("HOAP-1, VIIP", "hoap1", "viip", 0.3, []),
        ("the same with `tau_z=0.066`, the default up to version 0.1", "hoap1", "viip", 0.3,
         ["--gain", "tau_z=0.066"]),
        ("`humanoid30`, DTAD, 2.4 N s", "humanoid30", "dtad", 2.4, []),
        ("the same with `ka=2.5 ks=2 kd=2`", "humanoid30", "dtad", 2.4, OLD_GAINS),
    ]:
        cells = []
        for ms in LATENCIES:
            figures = simulate(stand(robot, controller, impulse, ms), "--allow-unstable", *words)
            cells.append(f"{mm(figures['zmp_tracking_rms_m'])}, {mm(figures['max_foot_slip_m'])}")
        lines.append(row(name, *cells))
    return lines


@table("latency/walking")
def latency_walking():
    lines = head("pattern, law", *[f"{ms} ms" for ms in LATENCIES])
    for name, source, words in [
        ("`hoap1_walk`, DTAD", "hoap1_walk", []),
        ("the same with `ka=2.5 ks=2 kd=2`", "hoap1_walk", OLD_GAINS),
        ("`hoap1_viip_step`, VIIP", "hoap1_viip_step", []),
        ("the same with `tau_z=0.066`", "hoap1_viip_step", ["--gain", "tau_z=0.066"]),
    ]:
        cells = []
        for ms in LATENCIES:
            pattern = bundled(source)
            pattern["scenario"] = late(ms)
            figures = simulate(write_pattern(pattern), "--allow-unstable", *words)
            cells.append("falls" if figures["outcome"] == "fell" else
                         f"{mm(figures['zmp_tracking_rms_m'])}, {mm(figures['max_foot_slip_m'])}")
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


def commit():
    def git(*words):
        return subprocess.run(["git", *words], capture_output=True, text=True, cwd=ROOT).stdout.strip()

    return git("rev-parse", "--short=7", "HEAD")


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
