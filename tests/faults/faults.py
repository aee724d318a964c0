#!/usr/bin/env python3
"""Faults of the machine: calls that fail, a disk that is full, and signals at random moments.

    faults.py PROGRAM LIBRARY [--kind calls|disk|signals|all] [--count N] [--seed S] [--only NAMES]
              [--steps N]

PROGRAM is ayumi and LIBRARY the library of failing_calls.c. Each trial works in a folder of its own.
Signals stop commands that work on the bundled walk, or on a walk of so many steps.
What holds after each of them:
  - the program has ended by itself or by our signal: never by SIGSEGV, SIGABRT and the like;
  - exit code 0 or 1 means that every output exists and is complete; another code comes with a
    message;
  - every file with the name of an output is complete: a file that existed before is unchanged or
    replaced, and a run folder that has a run.json passes its own hashes;
  - the same command, started again without a fault, does its work. push, certify and sweep continue
    with the results that exist, and give the results of a command that nothing has stopped;
  - the pattern that a live page edits is one of the texts that the page has sent.
The exit code is 1 when something does not hold, and the trial is printed so that it can be repeated.
"""
import argparse
import hashlib
import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WALK = os.path.join(SOURCE, "patterns", "hoap1_walk.json")
STAND = """{"format": "ayumi.pattern/1", "name": "stand", "robot": "hoap1", "units": {"angle": "deg"},
"defaults": {"posture": "home"}, "phases": [{"duration": 0.3, "support": "both"}],
"keyframes": [{"t": 0}, {"t": 0.3, "joints": {"l_elbow": -20}}]}
"""
STUDY = """{"format": "ayumi.study/1", "sweep": {
"settings": {"pattern": "stand.json", "disturbances": "push"},
"cases": {"latin_hypercube": {"samples": 40, "ranges": {"value.impulse": [0.1, 12]}}},
"disturbances": {"push": [{"type": "impulse", "at": 0.1, "duration": 0.02, "impulse": "${impulse}",
"direction": [0, 1, 0]}]}}}
"""
TOO_LONG = 300  # [s] for one command; a loaded machine is slow
STOPS_WITHIN = 1.0  # [s] from Ctrl-C to the end, on a quiet machine


class Trial:
    """A command in a folder of its own, and what must hold after it."""

    def __init__(self, program, words, outputs, before=(), goes_on=False):
        self.program, self.words, self.outputs, self.goes_on = program, words, outputs, goes_on
        self.folder = tempfile.mkdtemp(prefix="ayumi_faults_")
        with open(os.path.join(self.folder, "stand.json"), "w") as file:
            file.write(STAND)
        with open(os.path.join(self.folder, "study.json"), "w") as file:
            file.write(STUDY)
        for name in before:
            with open(os.path.join(self.folder, name), "w") as file:
                file.write("before\n")

    def start(self, **environment):
        return subprocess.Popen(
            [self.program] + self.words, cwd=self.folder, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            # The calls that fail are counted, and do not depend on a cache of meshes.
            env={**os.environ, "XDG_CACHE_HOME": "off", **environment})

    def complaints(self, process, out, err, signals=()):
        """The broken expectations, as a list of sentences."""
        code, wrong = process.returncode, []
        if code < 0 and -code not in signals:
            wrong.append(f"ended by signal {-code}: {err[-300:]!r}")
        elif code > 1 and not err.strip():
            wrong.append(f"exit code {code} without a message")
        elif code == 5:
            wrong.append(f"an internal error: {err[-300:]!r}")
        if code == STOPPED:
            left = [name for _, folders, files in os.walk(self.folder) for name in folders + files
                    if name.startswith(".ayumi_") or f".part{process.pid}" in name]
            wrong += [f"{name} was left behind" for name in left]
        done = code in (0, 1)
        for name in self.outputs:
            wrong += self.complaints_about(name, done)
        return wrong

    def complaints_about(self, name, done):
        path = os.path.join(self.folder, name)
        if not os.path.exists(path):
            return [f"{name} is missing after success"] if done else []
        if os.path.isdir(path):
            return complaints_about_run(path, done)
        if name.endswith(".db"):
            return complaints_about_database(path)
        with open(path, "rb") as file:
            text = file.read()
        if text == b"before\n":
            return [f"{name} is unchanged after success"] if done else []
        if name.endswith(".json") and text.count(b"{") != text.count(b"}"):
            return [f"{name} is not whole"]  # a pattern may have comments, which a JSON parser refuses
        if not text.endswith(b"\n"):
            return [f"{name} is cut off"]
        return []

    def works_now(self):
        """The same command without a fault."""
        words = self.words
        if not self.goes_on and "--force" not in words:
            words = words + ["--force"]
        again = subprocess.run([self.program] + words, cwd=self.folder, capture_output=True,
                               timeout=TOO_LONG)
        if again.returncode not in (0, 1):
            return [f"started again: exit code {again.returncode}: {again.stderr[-300:]!r}"]
        wrong = []
        for name in self.outputs:
            wrong += self.complaints_about(name, True)
        return wrong

    def results(self):
        """The results of a command that continues earlier work, however often it was stopped."""
        path = os.path.join(self.folder, self.outputs[0])
        if path.endswith(".db"):
            with sqlite3.connect(path) as database:
                return sorted(map(repr, database.execute("SELECT * FROM cases")))
        with open(path) as file:
            return json.load(file)

    def end(self):
        shutil.rmtree(self.folder, ignore_errors=True)


def complaints_about_run(folder, done):
    """A folder with a run.json is a complete run, and its files have the hashes that run.json states."""
    path = os.path.join(folder, "run.json")
    if not os.path.exists(path):
        return [f"{folder}: no run.json after success"] if done else []
    try:
        with open(path) as file:
            run = json.load(file)
    except ValueError as error:
        return [f"{path} is not whole: {error}"]
    wrong = []
    for name, recorded in run["files"].items():
        try:
            with open(os.path.join(folder, name), "rb") as file:
                found = hashlib.sha256(file.read()).hexdigest()
        except OSError as error:
            found = str(error)
        if found != recorded:
            wrong.append(f"{name} of a run with run.json: {found}")
    return wrong


def complaints_about_database(path):
    try:
        with sqlite3.connect(path) as database:
            said = database.execute("PRAGMA integrity_check").fetchall()
    except sqlite3.Error as error:
        return [f"{path} cannot be read: {error}"]
    return [] if said == [("ok",)] else [f"{path} is damaged: {said}"]


class Editor(Trial):
    """`author`, with a page that changes the pattern again and again."""

    def __init__(self, program):
        super().__init__(program, ["author", "stand.json", "--json"], [])
        self.texts, self.thread = [STAND], None

    def start(self, **environment):
        process = super().start(**environment)
        self.thread = threading.Thread(target=self.edit, args=(process,), daemon=True)
        self.thread.start()
        return process

    def edit(self, process):
        ask = urllib.request.build_opener(urllib.request.ProxyHandler({})).open
        try:
            address = json.loads(process.stdout.readline())["address"]
            for angle in range(1000000):
                with ask(address + "state", timeout=5) as answer:
                    seen = json.load(answer)["hash"]
                text = STAND.replace("-20", str(-20 - angle % 10)) + " " * (angle % 3000)
                self.texts.append(text)
                body = json.dumps({"hash": seen, "text": text}).encode()
                ask(address + "edit", body, timeout=5).close()
        except (OSError, ValueError, KeyError):
            pass  # the server has ended

    def complaints(self, process, out, err, signals=()):
        self.thread.join(10)
        wrong = super().complaints(process, out, err, signals)
        with open(os.path.join(self.folder, "stand.json")) as file:
            if file.read() not in self.texts:
                wrong.append("stand.json is none of the texts that the page has sent")
        return wrong


def commands(program, pattern):
    """The commands that are tried: a function that makes a fresh trial of each."""
    return {
        "check": lambda: Trial(program, ["check", pattern, "--json", "--threads", "2"], []),
        "repair": lambda: Trial(program, ["repair", pattern, "-o", "fixed.json", "--force"],
                                ["fixed.json"], ["fixed.json"]),
        "simulate": lambda: Trial(program, ["simulate", pattern, "-o", "run"], ["run"]),
        "run": lambda: Trial(program, ["run", pattern, "-o", "run", "--no-pictures"], ["run"]),
        "export": lambda: Trial(program, ["export", pattern, "--format", "csv", "-o", "table.csv",
                                          "--force"], ["table.csv"], ["table.csv"]),
    }


def slow_commands(program, walk):
    """The commands that run long enough to be stopped at a random moment."""
    return {
        **commands(program, walk),
        "pictures": lambda: Trial(program, ["run", walk, "-o", "run"], ["run"]),
        "push": lambda: Trial(program, ["push", walk, "-o", "push.json", "--directions", "2"],
                              ["push.json"], goes_on=True),
        # 59 runs are enough for a certificate of 5 %.
        "certify": lambda: Trial(program, ["certify", walk, "-o", "cases.json", "--failure", "0.05"],
                                 ["cases.json"], goes_on=True),
        "sweep": lambda: Trial(program, ["sweep", "study.json", "-o", "results.db"],
                               ["results.db"], goes_on=True),
        "author": lambda: Editor(program),
    }


# Exit code after Ctrl-C or SIGTERM.
STOPPED = 130


class Report:
    def __init__(self):
        self.trials, self.failures, self.slowest = 0, 0, 0.0

    def add(self, what, wrong):
        self.trials += 1
        if wrong:
            self.failures += 1
            print(f"FAILED {what}")
            for sentence in wrong:
                print(f"    {sentence}")
            sys.stdout.flush()


def finished(process):
    try:
        return process.communicate(timeout=TOO_LONG)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return b"", b"hangs"


def one_fault(make, library, fault, report, name, again):
    trial = make()
    process = trial.start(LD_PRELOAD=library, AYUMI_FAULT=fault)
    out, err = finished(process)
    wrong = ["it hangs"] if err == b"hangs" else trial.complaints(process, out, err)
    if again and not wrong:
        wrong = trial.works_now()
    report.add(f"{name} {fault}", wrong)
    trial.end()


def counts_of(make, library):
    trial = make()
    file = os.path.join(trial.folder, "counts")
    finished(trial.start(LD_PRELOAD=library, AYUMI_FAULT_COUNT=file))
    with open(file) as lines:
        counts = {kind: int(n) for kind, n in (line.split() for line in lines)}
    size = sum(os.path.getsize(os.path.join(root, name)) for root, _, names in
               os.walk(trial.folder) for name in names) + 4096
    trial.end()
    return counts, size


def try_calls(program, library, count, rng, report):
    """Every n-th call fails, or `count` random ones of a kind where there are more."""
    for name, make in commands(program, "stand.json").items():
        counts, _ = counts_of(make, library)
        for kind, calls in counts.items():
            chosen = (range(1, calls + 1) if calls <= count
                      else sorted(rng.sample(range(1, calls + 1), count)))
            for n in chosen:
                suffix = "+" if rng.random() < 0.3 else ""
                one_fault(make, library, f"{kind}:{n}{suffix}", report, name, kind != "alloc")


def try_disk(program, library, count, rng, report):
    """The disk is full after every number of bytes, or after `count` random ones."""
    for name, make in commands(program, "stand.json").items():
        _, size = counts_of(make, library)
        chosen = range(size) if size <= count else sorted(rng.sample(range(size), count))
        for n in chosen:
            one_fault(make, library, f"bytes:{n}", report, name, n % 10 == 0)


def try_signals(program, walk, count, rng, report, only):
    """SIGKILL and Ctrl-C at random moments of long commands."""
    makers = slow_commands(program, walk)
    if only:
        makers = {name: make for name, make in makers.items() if name in only}
    lasts, results = {}, {}
    for trial_number in range(count):
        name = sorted(makers)[trial_number % len(makers)]
        if name not in lasts:
            trial = makers[name]()
            begin = time.monotonic()
            process = trial.start()
            if name == "author":
                time.sleep(2)
                process.terminate()
            finished(process)
            lasts[name] = time.monotonic() - begin
            if trial.goes_on:
                results[name] = trial.results()
            trial.end()
        kind = rng.choice([signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
        trial, moment = makers[name](), rng.uniform(0, lasts[name])
        process = trial.start()
        time.sleep(moment)
        process.send_signal(kind)
        begin = time.monotonic()
        out, err = finished(process)
        took = time.monotonic() - begin
        if kind != signal.SIGKILL:
            report.slowest = max(report.slowest, took)
        # Before the program has set its handlers, a signal ends it like every other program.
        wrong = trial.complaints(process, out, err, signals=(kind,))
        if kind != signal.SIGKILL and took > STOPS_WITHIN * ALLOWANCE:
            wrong.append(f"it took {took:.2f} s to stop")
        # This is only done every fifth time, because it takes as long as all the rest. Each round
        # tests another command.
        again = (trial_number + trial_number // len(makers)) % 5 == 0
        if not wrong and name != "author" and again:
            wrong = trial.works_now()
            if not wrong and trial.goes_on and trial.results() != results[name]:
                wrong = ["the results differ from those of a command that nothing has stopped"]
        report.add(f"{name} {kind.name} at {moment:.3f} s", wrong)
        trial.end()


# Factor by which Ctrl-C may take longer than on a quiet machine if other work shares the
# processors.
ALLOWANCE = float(os.environ.get("AYUMI_FAULTS_ALLOWANCE", "1"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("library")
    parser.add_argument("--kind", choices=["calls", "disk", "signals", "all"], default="all")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="commands that signals stop, with commas")
    parser.add_argument("--steps", type=int, help="a walk of so many steps in place of the bundled one")
    options = parser.parse_args()
    program, library = os.path.abspath(options.program), os.path.abspath(options.library)
    rng, report = random.Random(options.seed), Report()
    if options.kind in ("calls", "all"):
        try_calls(program, library, options.count, rng, report)
    if options.kind in ("disk", "all"):
        try_disk(program, library, options.count, rng, report)
    if options.kind in ("signals", "all"):
        only = [name for name in options.only.split(",") if name]
        with tempfile.TemporaryDirectory(prefix="ayumi_faults_walk_") as folder:
            walk = WALK
            if options.steps is not None:
                walk = os.path.join(folder, "walk.json")
                subprocess.run([program, "new", "walk", "--steps", str(options.steps), "-o", walk,
                                "-q"], check=True, stdout=subprocess.DEVNULL)
                with open(walk) as file:
                    head, _, tail = file.read().rpartition("}")
                with open(walk, "w") as file:
                    file.write(head + ', "scenario": [{"type": "impulse", "at": 1.5, "duration": 0.02, '
                               '"on": "cog", "direction": [0, 1, 0], "impulse": 0.3}]}' + tail)
            try_signals(program, walk, options.count, rng, report, only)
    print(f"{report.trials} trials, {report.failures} failed; seed {options.seed}; "
          f"the slowest stop took {report.slowest:.2f} s")
    sys.exit(1 if report.failures else 0)


if __name__ == "__main__":
    main()
