#!/usr/bin/env python3
"""Plants small faults in the sources of check, control and plan, and says whether tests notice them.

    tests/mutation.py [--count N] [--seed S] [--rooms check,control,plan] [--build build/release]

Each fault is one change of one place: another comparison, + for -, * for /, && for ||, min for max, a
condition turned round, a number that is twice or half as large or one more. The seed chooses the
places. A fault is planted in this working tree, what it needs is built, and the tests that cover the
room run until one of them fails. Then the source is put back, also after Ctrl-C. (After kill -9,
`git checkout lib` puts it back; so the script begins only where git sees no change in lib.) A fault
that does not compile is not counted, and another one takes its place.

300 faults (the default) take about six hours on one processor (estimated): a fault costs the compilation of one
unit, the linking of the test programs, and their running time. A sample is enough for an estimate;
the script prints how many faults it has planted, and the interval in which the share of noticed
faults lies with 95 % probability. It needs python3 and a build folder. The faults that no test has
noticed are listed at the end with file and line: each needs a test, or a reason why it changes
nothing.
"""
import argparse
import math
import os
import random
import re
import subprocess
import sys
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# The test programs that cover a room (a folder of lib/ayumi). Those that are most likely to notice
# a fault come first.
TESTS = {
    "check": ["check_tests", "limits_tests"],
    "control": ["control_tests", "sim_tests"],
    "plan": ["plan_tests", "check_tests"],
}
PLUS, MINUS = r"(?<= )\+(?= )", r"(?<= )-(?= )"
# Text in the source, and the text that is planted instead of it.
CHANGES = [
    (r"(?<= )<(?= )", "<="), (r"(?<= )<=(?= )", "<"),
    (r"(?<= )>(?= )", ">="), (r"(?<= )>=(?= )", ">"),
    (r"(?<= )==(?= )", "!="), (r"(?<= )!=(?= )", "=="),
    (PLUS, "-"), (MINUS, "+"),
    (r"(?<= )\*(?= )", "/"), (r"(?<= )/(?= )", "*"),
    (r"(?<= )\+=(?= )", "-="), (r"(?<= )-=(?= )", "+="),
    (r"(?<= )&&(?= )", "||"), (r"(?<= )\|\|(?= )", "&&"),
    (r"\bstd::min\(", "std::max("), (r"\bstd::max\(", "std::min("),
    (r"\btrue\b", "false"), (r"\bfalse\b", "true"),
    (r"(?<=[ (])!(?=[a-z])", ""),
    (r"(?<![\w.])\d+\.\d+(?:e-?\d+)?\b(?!\w)", lambda text: f"({text} * 2)"),
    (r"(?<![\w.])\d+\.\d+(?:e-?\d+)?\b(?!\w)", lambda text: f"({text} / 2)"),
    (r"(?<![\w.<\[])[0-9]\b(?![\w.>\]])", lambda text: f"({text} + 1)"),
]


def is_code(line):
    text = line.strip()
    return bool(text) and not text.startswith(("//", "#", "template", "static_assert", "using",
                                               "require("))


def places_in(path):
    """(line number, begin, end, planted text) of every fault that can be planted in a source."""
    with open(path) as file:
        lines = file.read().split("\n")
    for number, line in enumerate(lines):
        if not is_code(line):
            continue
        code = line.split("//")[0]
        # Text between quotes is a message.
        code = re.sub(r'"(?:[^"\\]|\\.)*"', lambda found: '"' * len(found.group()), code)
        turned = re.search(r"\bif \(((?:[^()]|\((?:[^()]|\([^()]*\))*\))*)\)", code)
        if turned and ";" not in turned.group(1):
            yield number, turned.start(1), turned.end(1), f"!({line[turned.start(1):turned.end(1)]})"
        for pattern, planted in CHANGES:
            if '"' in code and pattern in (PLUS, MINUS):
                continue  # texts are joined by + as well
            for found in re.finditer(pattern, code):
                text = planted(found.group()) if callable(planted) else planted
                yield number, found.start(), found.end(), text


def all_places(rooms):
    places = []
    for room in rooms:
        for folder, _, names in sorted(os.walk(os.path.join(SOURCE, "lib", "ayumi", room))):
            for name in sorted(names):
                if name.endswith(".cpp"):
                    path = os.path.join(folder, name)
                    places += [(room, path, *place) for place in places_in(path)]
    return places


def run(words, limit=None):
    """Exit code; None where it took longer than `limit` seconds."""
    try:
        return subprocess.run(words, cwd=SOURCE, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, timeout=limit, check=False).returncode
    except subprocess.TimeoutExpired:
        return None


class Tests:
    def __init__(self, build):
        self.build, self.takes = build, {}

    def compiles(self, programs):
        return run(["cmake", "--build", self.build, "--parallel", "1", "--target"] + programs) == 0

    def fails(self, program):
        """Whether a test fails, crashes, or takes ten times as long as without a fault."""
        words = [os.path.join(self.build, "tests", program), "--gtest_brief=1", "--gtest_fail_fast"]
        limit = 30 + 10 * self.takes[program] if program in self.takes else None
        begin = time.monotonic()
        code = run(words, limit)
        self.takes.setdefault(program, time.monotonic() - begin)
        return code != 0


def interval(noticed, count):
    """Wilson's interval of 95 % for a share."""
    z = 1.96
    share, square = noticed / count, z * z / count
    middle = (share + square / 2) / (1 + square)
    half = z * math.sqrt(share * (1 - share) / count + square / (4 * count)) / (1 + square)
    return middle - half, middle + half


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rooms", default="check,control,plan")
    parser.add_argument("--build", default=os.path.join(SOURCE, "build", "release"))
    options = parser.parse_args()
    rooms = options.rooms.split(",")
    if run(["git", "diff", "--quiet", "HEAD", "--", "lib"]) != 0:
        sys.exit("lib has changes that are not committed; commit them first")
    tests = Tests(os.path.abspath(options.build))
    programs = sorted({program for room in rooms for program in TESTS[room]})
    if not tests.compiles(programs):
        sys.exit("the sources do not build")
    for program in programs:
        if tests.fails(program):
            sys.exit(f"{program} fails without any fault")
    places = all_places(rooms)
    random.Random(options.seed).shuffle(places)
    noticed, unnoticed, broken = 0, [], 0
    for room, path, number, begin, end, planted in places:
        if noticed + len(unnoticed) == options.count:
            break
        with open(path) as file:
            original = file.read()
        lines = original.split("\n")
        line = lines[number]
        lines[number] = line[:begin] + planted + line[end:]
        what = (f"{os.path.relpath(path, SOURCE)}:{number + 1}: {line[begin:end]!r} -> {planted!r}: "
                f"{line.strip()}")
        try:
            with open(path, "w") as file:
                file.write("\n".join(lines))
            if not tests.compiles(TESTS[room]):
                broken += 1
                continue
            by = next((program for program in TESTS[room] if tests.fails(program)), None)
        finally:
            with open(path, "w") as file:
                file.write(original)
        if by:
            noticed += 1
        else:
            unnoticed.append(what)
        print(f"{'noticed by ' + by if by else 'NOT NOTICED'}: {what}", flush=True)
    count = noticed + len(unnoticed)
    if not count:
        sys.exit("no fault was planted")
    low, high = interval(noticed, count)
    print(f"\n{count} faults of {len(places)} possible ones, seed {options.seed}: tests notice "
          f"{noticed} ({100 * noticed / count:.0f} %; between {100 * low:.0f} and "
          f"{100 * high:.0f} % with 95 % probability); {broken} more did not compile")
    for what in unnoticed:
        print(f"not noticed: {what}")


if __name__ == "__main__":
    main()
