#!/usr/bin/env python3
"""Plants small faults in the sources of check, control and plan, and says whether tests notice them.

    tests/mutation.py [--count N] [--seed S] [--rooms check,control,plan] [--build build/mutation]
                      [--minutes M]

Each fault is one change of one place: another comparison, + for -, * for /, && for ||, min for
max, a condition turned round, a number that is twice or half as large or one more. The seed
chooses the places. All faults are planted at once: each line keeps its own text beside the
changed text, and the environment variable AYUMI_FAULT chooses the fault that acts. So everything
is compiled only once. Then each test runs once without a fault, and it is recorded which faults
it reaches. Each fault is tried with the tests that reach it, those of its room and the quickest
first, until one of them fails; no more than `--most-seconds` are spent on it. The jobs of
`ayumi selftest` are such tests, too. Everything is compiled with the assertions of Eigen and of the
standard library, so that a step beyond the end of an array is noticed. Then the sources
are put back, also after Ctrl-C. (After kill -9, `git checkout lib` puts them back; so the script
begins only where git sees no change in lib.)

Only lines are changed that contain a whole statement or a whole condition. A fault that does not
compile is left out. With `--minutes`, the script tries as many of the faults as fit into this
time. It prints the share of noticed faults, and the interval in which it lies with 95 %
probability. It needs python3, CMake and Ninja, and configures a build folder of its own. The faults that no test has noticed are listed
at the end with file and line: each needs a test, or a reason why it changes nothing.
"""
import argparse
import collections
import concurrent.futures
import math
import os
import random
import re
import resource
import subprocess
import sys
import tempfile
import threading
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# The test programs that cover the rooms (folders of lib/ayumi).
PROGRAMS = ["check_tests", "limits_tests", "control_tests", "sim_tests", "plan_tests",
            "scenarios_tests"]
# The program whose `selftest` compares results bit for bit.
SELFTEST = "ayumi"
# Largest processor time of a test that is run [s].
LONGEST_TEST = 60.0
JOBS = min(2, os.cpu_count() or 1)
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
BALANCED = r"(?:[^()]|\((?:[^()]|\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\))*\))*"
TYPE = r"(?!(?:return|auto|using|else|case|throw|delete|goto|new)\b)[A-Za-z_][\w:]*(?:<[\w:, ]+>)?"
# Each form of a line: the text before, the part that is changed, and the text behind.
CONDITION = re.compile(rf"^(\s*(?:\}} )?(?:else )?(?:if|while) \()({BALANCED})(\).*)$")
LOOP = re.compile(rf"^(\s*for \([^;]*; )({BALANCED})(; {BALANCED}\).*)$")
RETURN = re.compile(rf"^(\s*(?:\}} )?(?:else )?(?:if \({BALANCED}\) )?return )([^{{;]+)(;)$")
VALUE = re.compile(rf"^(\s*)((?:(?:static|constexpr|const) )*)({TYPE})( \w+ = )([^{{;]+);$")
STATEMENT = re.compile(
    rf"^(\s*)((?!(?:return|if|for|while|else|case|const|static|using|throw)\b)"
    rf"[\w.\->\[\]()*:]+ [-+*/]?= [^{{;]+|[\w.\->:]+\({BALANCED}\));$")
BEGINS_STATEMENT = re.compile(r"(^$|[;{}:)]|\belse)$")

HEADER = """#pragma once
#include <cstdio>
#include <cstdlib>
namespace ayumi_faults {
inline const int chosen = [] {
  const char* text = std::getenv("AYUMI_FAULT");
  return text ? std::atoi(text) : -1;
}();
inline unsigned char reached[%d];
struct Record {
  ~Record() {
    const char* name = std::getenv("AYUMI_FAULTS_REACHED");
    std::FILE* file = name ? std::fopen(name, "wb") : nullptr;
    if (!file) return;
    std::fwrite(reached, 1, sizeof reached, file);
    std::fclose(file);
  }
};
inline Record record;
}  // namespace ayumi_faults
inline bool ayumi_fault(int number) {
  if (ayumi_faults::reached[number] == 0) ayumi_faults::reached[number] = 1;
  return number == ayumi_faults::chosen;
}
"""

Fault = collections.namedtuple("Fault", "room path number begin end planted")


def code_of(line):
    """The line without its comment, and with blanked texts: those between quotes are messages."""
    code = re.sub(r'"(?:[^"\\]|\\.)*"', lambda found: '"' * len(found.group()), line)
    return code.split("//")[0].rstrip()


def is_code(line):
    text = line.strip()
    return bool(text) and not text.startswith(("//", "#", "template", "static_assert", "using",
                                               "require("))


def changes_of(line):
    """(begin, end, planted text) of every change that can be planted in a line."""
    code = code_of(line)
    turned = re.search(rf"\b(?:if|while) \(({BALANCED})\)", code)
    if turned and ";" not in turned.group(1):
        yield turned.start(1), turned.end(1), f"!({line[turned.start(1):turned.end(1)]})"
    for pattern, planted in CHANGES:
        if '"' in code and pattern in (PLUS, MINUS):
            continue  # texts are joined by + as well
        for found in re.finditer(pattern, code):
            text = planted(found.group()) if callable(planted) else planted
            if not re.match(r"\(0\.0* [*/]", text):  # twice 0 is 0
                yield found.start(), found.end(), text


def switched(line, before, fault, index):
    """The line with both texts, of which the fault chooses one; None where it has another form."""
    code = code_of(line)
    line = line[:len(code)]
    choice = f"ayumi_fault({index})"

    def both(begin, end):
        if not begin <= fault.begin <= fault.end <= end:
            return None
        return line[begin:fault.begin] + fault.planted + line[fault.end:end], line[begin:end]

    for form in (CONDITION, LOOP):
        found = form.match(code)
        if found and " = " not in found.group(2) and ";" not in found.group(2):
            texts = both(found.start(2), found.end(2))
            if texts:
                return (line[:found.start(2)] + f"{choice} ? bool({texts[0]}) : bool({texts[1]})" +
                        line[found.end(2):])
    found = RETURN.match(code)
    if found:
        texts = both(found.start(2), found.end(2))
        if texts:
            return line[:found.start(2)] + f"{choice} ? ({texts[0]}) : ({texts[1]});"
    found = VALUE.match(code)
    if found:
        texts = both(found.start(5), found.end(5))
        if texts:
            kind = found.group(3)
            words = found.group(2).replace("constexpr", "const")
            return (found.group(1) + words + kind + found.group(4) +
                    f"{choice} ? {kind}({texts[0]}) : {kind}({texts[1]});")
    found = STATEMENT.match(code)
    if found and BEGINS_STATEMENT.search(before):
        texts = both(found.start(2), found.end(2))
        if texts:
            return f"{found.group(1)}{{ if ({choice}) {{ {texts[0]}; }} else {{ {texts[1]}; }} }}"
    return None


def all_faults(rooms):
    """Every fault that can be planted, one list for each line that has some."""
    lines_of = []
    for room in rooms:
        for folder, _, names in sorted(os.walk(os.path.join(SOURCE, "lib", "ayumi", room))):
            for name in sorted(names):
                if not name.endswith(".cpp"):
                    continue
                path = os.path.join(folder, name)
                with open(path) as file:
                    lines = file.read().split("\n")
                for number, line in enumerate(lines):
                    before = code_of(lines[number - 1]) if number else ""
                    if not is_code(line):
                        continue
                    faults = [Fault(room, path, number, *change) for change in changes_of(line)]
                    faults = [fault for fault in faults if switched(line, before, fault, 0)]
                    if faults:
                        lines_of.append(faults)
    return lines_of


def words_of(fault):
    with open(fault.path) as file:
        line = file.read().split("\n")[fault.number]
    return (f"{os.path.relpath(fault.path, SOURCE)}:{fault.number + 1}: "
            f"{line[fault.begin:fault.end]!r} -> {fault.planted!r}: {line.strip()}")


class Planted:
    """The sources with all faults, from __enter__ to __exit__."""

    def __init__(self, faults, build):
        self.faults, self.originals, self.build = dict(enumerate(faults)), {}, build
        for path in {fault.path for fault in faults}:
            with open(path) as file:
                self.originals[path] = file.read()
        self.header = os.path.join(build, "ayumi_faults.hpp")
        with open(self.header, "w") as file:
            file.write(HEADER % len(faults))

    def __enter__(self):
        self.write(self.originals)
        return self

    def __exit__(self, *_):
        for path, text in self.originals.items():
            with open(path, "w") as file:
                file.write(text)
        os.remove(self.header)

    def write(self, paths):
        for path in paths:
            lines = self.originals[path].split("\n")
            planted = list(lines)
            for index, fault in self.faults.items():
                if fault.path == path:
                    before = code_of(lines[fault.number - 1]) if fault.number else ""
                    planted[fault.number] = switched(lines[fault.number], before, fault, index)
            # The numbers of the lines stay.
            with open(path, "w") as file:
                file.write(f'#include "{self.header}"\n#line 1 "{path}"\n' + "\n".join(planted))

    def compile(self):
        """Compiles, and leaves out the faults that do not compile. Returns their number."""
        words = ["cmake", "--build", self.build, "--parallel", str(JOBS),
                 "--target", *PROGRAMS, SELFTEST, "--", "-k0"]
        left_out = 0
        while True:
            result = subprocess.run(words, cwd=SOURCE, stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, text=True, check=False)
            if result.returncode == 0:
                return left_out
            named = {(found.group(1), int(found.group(2)) - 1) for found in re.finditer(
                r"^(?:In file included from )?([^\s:]+\.cpp):(\d+)[:,]", result.stdout, re.M)}
            wrong = [index for index, fault in self.faults.items()
                     if (fault.path, fault.number) in named]
            if not wrong:
                sys.exit("the sources do not compile:\n" + result.stdout[-3000:])
            paths = {self.faults[index].path for index in wrong}
            for index in wrong:
                del self.faults[index]
            left_out += len(wrong)
            self.write(paths)


class Test:
    def __init__(self, program, name):
        self.program, self.name = program, name
        self.seconds, self.reached = 0.0, frozenset()


def run(build, tests, limit, **environment):
    """Exit code of tests of one program, and their processor time.

    They are stopped after `limit` seconds of processor time, and after twenty times as long if
    they only wait. Then the exit code is a negative number.
    """
    names = [test.name for test in tests]
    if tests[0].program == SELFTEST:
        words = [os.path.join(build, "app", SELFTEST), "selftest", *names, "--threads", "1"]
    else:
        words = [os.path.join(build, "tests", tests[0].program), "--gtest_brief=1",
                 "--gtest_fail_fast", "--gtest_filter=" + ":".join(names)]
    seconds = math.ceil(limit)
    process = subprocess.Popen(
        words, cwd=SOURCE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        env=os.environ | environment)
    resource.prlimit(process.pid, resource.RLIMIT_CPU, (seconds, seconds))
    waits = threading.Timer(20 * limit, process.kill)
    waits.start()
    _, status, usage = os.wait4(process.pid, 0)
    waits.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_utime + usage.ru_stime


def trace(build, test, count):
    """Runs a test without a fault. Returns it with the faults that it reaches, or None."""
    with tempfile.TemporaryDirectory() as folder:
        record = os.path.join(folder, "reached")
        code, test.seconds = run(build, [test], LONGEST_TEST, AYUMI_FAULTS_REACHED=record)
        if code != 0:
            print(f"not used: {test.program} {test.name}", flush=True)
            return None
        with open(record, "rb") as file:
            reached = file.read()
    test.reached = frozenset(i for i in range(count) if reached[i])
    return test


def all_tests(build):
    with open(os.path.join(SOURCE, "app", "commands", "selftest.cpp")) as file:
        jobs = re.findall(r'^    \{"(\w+)", "', file.read(), re.M)
    tests = [Test(SELFTEST, job) for job in jobs]
    for program in PROGRAMS:
        listed = subprocess.run([os.path.join(build, "tests", program), "--gtest_list_tests"],
                                cwd=SOURCE, capture_output=True, text=True, check=True).stdout
        for line in listed.split("\n")[1:]:
            name = line.split("#")[0].rstrip()
            if not name.startswith(" "):
                suite = name
            else:
                tests.append(Test(program, suite + name.strip()))
    return tests


def noticed_by(build, index, tests, most_seconds):
    """The tests of which one notices a fault; an empty text if none does."""
    spent, least = 0.0, 2.0
    left = list(tests)
    while left and spent < most_seconds:
        batch = [left.pop(0)]
        while (left and left[0].program == batch[0].program
               and sum(test.seconds for test in batch) + left[0].seconds < least):
            batch.append(left.pop(0))
        least *= 2
        limit = 10 + 10 * sum(test.seconds for test in batch)
        code, seconds = run(build, batch, limit, AYUMI_FAULT=str(index))
        if code != 0:
            return batch[0].program + " " + ":".join(test.name for test in batch)[:60]
        spent += seconds
    return ""


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
    parser.add_argument("--build", default=os.path.join(SOURCE, "build", "mutation"))
    parser.add_argument("--minutes", type=float, default=math.inf)
    parser.add_argument("--most-seconds", type=float, default=60)
    options = parser.parse_args()
    until = time.monotonic() + 60 * options.minutes
    build = os.path.abspath(options.build)
    if subprocess.run(["git", "diff", "--quiet", "HEAD", "--", "lib"], cwd=SOURCE,
                      check=False).returncode != 0:
        sys.exit("lib has changes that are not committed; commit them first")
    chance = random.Random(options.seed)
    lines = all_faults(options.rooms.split(","))
    possible = sum(len(faults) for faults in lines)
    # A line with many places has more faults, but one fault at a time.
    chance.shuffle(lines)
    faults = [chance.choice(line) for line in lines[:options.count]]
    words = [words_of(fault) for fault in faults]
    noticed, unnoticed = 0, []
    mark = os.path.join(build, "made_by_mutation")
    if os.path.exists(build) and not os.path.exists(mark):
        sys.exit(f"{build} belongs to another build; name another folder with --build")
    os.makedirs(build, exist_ok=True)
    with open(mark, "w"):
        pass
    subprocess.run(["cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -D_GLIBCXX_ASSERTIONS",
                    "-DAYUMI_BUILD_TESTS=ON"],
                   stdout=subprocess.DEVNULL, check=True)
    with Planted(faults, build) as planted:
        left_out = planted.compile()
        with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
            traced = pool.map(lambda test: trace(build, test, len(faults)), all_tests(build))
            tests = sorted(filter(None, traced), key=lambda test: test.seconds)
        print(f"{len(planted.faults)} faults compile, {len(tests)} tests take "
              f"{sum(test.seconds for test in tests):.0f} s", flush=True)
        # A constant is reached when the program starts, so other faults of its file say which tests
        # use it.
        always = frozenset.intersection(*(test.reached for test in tests))

        def attempt(index):
            fault = planted.faults[index]
            if time.monotonic() > until:
                return None
            same = {index} if index not in always else {
                other for other, there in planted.faults.items()
                if there.path == fault.path and other not in always} or {index}
            reaching = [test for test in tests if test.reached & same]
            reaching.sort(key=lambda test: test.program != SELFTEST
                          and not test.program.startswith(fault.room))
            by = noticed_by(build, index, reaching, options.most_seconds)
            how = "no test reaches it" if not reaching else f"{len(reaching)} tests reach it"
            print(f"noticed by {by}: {words[index]}" if by else
                  f"NOT NOTICED ({how}): {words[index]}", flush=True)
            return by, f"({how}) {words[index]}"

        with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
            for result in filter(None, pool.map(attempt, list(planted.faults))):
                noticed += bool(result[0])
                unnoticed += [] if result[0] else [result[1]]
    count = noticed + len(unnoticed)
    if not count:
        sys.exit("no fault was planted")
    low, high = interval(noticed, count)
    print(f"\n{count} faults of {possible} possible ones, seed {options.seed}: tests notice "
          f"{noticed} ({100 * noticed / count:.0f} %; between {100 * low:.0f} and "
          f"{100 * high:.0f} % with 95 % probability); {left_out} more did not compile")
    for text in unnoticed:
        print(f"not noticed: {text}")


if __name__ == "__main__":
    main()
