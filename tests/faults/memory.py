#!/usr/bin/env python3
"""memory.py AYUMI: how much memory and processor time two motions of different length take.

Prints for check, simulate, simulate -o and run --no-pictures the growth of the peak memory for each servo period, and
the processor time of both lengths. It ends with 1 if the memory grows faster than the bounds say. It takes about 20 s
of processor time. The times are printed only: other work on the machine disturbs them.
"""
import os
import subprocess
import sys
import tempfile

# Cycles of 2 s each. Both motions have more than one block of a log (32768 periods), because the memory of the first
# block is there from the beginning.
SHORT, LONG = 18, 28
PERIODS = (LONG - SHORT) * 2000

# Bytes for each servo period of HOAP-1. The command series, which is the motion itself, takes 1.1 kB, and the table of
# a run 0.4 kB. Measured between sways of 40 and 80 s: check 1.6 kB, simulate and simulate -o 1.5 kB. The rest of each
# bound is for the steps in which lists grow and for the text of a table that is being written. Before logs were written
# block by block, check took 2.4 kB, simulate 8 kB, simulate -o 13 kB and run 16 kB.
BOUNDS = {"check": 2000, "simulate": 2500, "simulate -o": 3500, "run": 4500}


def used(command):
    """Peak memory [bytes] and processor time [s] of a command."""
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as child:
        errors = child.stderr.read()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:  # a run that ends early would need little memory
        sys.exit(f"{' '.join(command)}: exit code {child.returncode}: {errors.decode()}")
    return usage.ru_maxrss * 1024, usage.ru_utime + usage.ru_stime


def main():
    ayumi = sys.argv[1]
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        patterns = []
        for cycles in (SHORT, LONG):
            patterns.append(os.path.join(folder, f"sway{cycles}.json"))
            used([ayumi, "new", "sway", "--cycles", str(cycles), "-o", patterns[-1]])
        for name, bound in BOUNDS.items():
            figures = []
            for pattern in patterns:
                command = [ayumi, name.split()[0], pattern]
                if name in ("simulate -o", "run"):
                    command += ["-o", os.path.join(folder, "out"), "--force"]
                figures.append(used(command + (["--no-pictures"] if name == "run" else [])))
            (few, short_time), (many, long_time) = figures
            growth = (many - few) / PERIODS
            verdict = "ok" if growth <= bound else "TOO MUCH"
            failed = failed or growth > bound
            print(f"{name}: {growth:.0f} bytes for each servo period (bound {bound}): {verdict}; "
                  f"{short_time:.2f} s and {long_time:.2f} s of processor time", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
