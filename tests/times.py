#!/usr/bin/env python3
"""Processor time of tests, each with all its child processes.

    tests/times.py [--build DIR] [--cases SECONDS] [REGEX...]

Runs the tests of CTest whose names match one of the expressions (all without one), one after the
other, and prints their times, the longest first. With --cases, also the wall time of every test case
of a program that takes so long. A test that fails is marked. Fixtures are not set up: run
install.stage first. All tests take half an hour on one processor. Linux only.
"""
import argparse
import ctypes
import json
import os
import re
import resource
import subprocess
import tempfile
import time

PR_SET_CHILD_SUBREAPER = 36  # of linux/prctl.h


def processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def wait_for_orphans():
    """Servers and browsers that a test has stopped without waiting for them come to this process."""
    try:
        for _ in range(100):  # ten seconds
            while os.waitpid(-1, os.WNOHANG) != (0, 0):
                pass
            time.sleep(0.1)
    except ChildProcessError:  # there are none
        pass


def cases_of(report, least):
    with open(report) as file:
        suites = json.load(file)["testsuites"]
    cases = [(float(case["time"].rstrip("s")), suite["name"] + "." + case["name"])
             for suite in suites for case in suite["testsuite"]]
    return [(seconds, name) for seconds, name in sorted(cases, reverse=True) if seconds >= least]


def measured(test, least):
    properties = {p["name"]: p["value"] for p in test.get("properties", [])}
    environment = dict(os.environ, **dict(e.split("=", 1) for e in properties.get("ENVIRONMENT", [])))
    words, cases = list(test["command"]), []
    with tempfile.TemporaryDirectory(prefix="ayumi_times_") as folder:
        report = os.path.join(folder, "report.json")
        if least is not None and words[0].endswith("_tests"):
            words.append("--gtest_output=json:" + report)
        before = processor_time()
        code = subprocess.run(words, env=environment, cwd=properties.get("WORKING_DIRECTORY"),
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
        wait_for_orphans()
        seconds = processor_time() - before
        if os.path.exists(report):
            cases = cases_of(report, least)
    return seconds, code, test["name"], cases


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", metavar="REGEX")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--cases", type=float, metavar="SECONDS")
    options = parser.parse_args()
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    listed = subprocess.run(["ctest", "--test-dir", options.build, "--show-only=json-v1"],
                            capture_output=True, check=True).stdout
    tests = [test for test in json.loads(listed)["tests"]
             if not options.names or any(re.search(name, test["name"]) for name in options.names)]
    rows = sorted((measured(test, options.cases) for test in tests), reverse=True)
    for seconds, code, name, cases in rows:
        print(f"{seconds:8.2f} s  {name}{'' if code == 0 else f'  (exit code {code})'}")
        for wall, case in cases:
            print(f"            {wall:8.2f} s wall  {case}")
    print(f"{sum(row[0] for row in rows):8.2f} s  of {len(rows)} tests")


if __name__ == "__main__":
    main()
