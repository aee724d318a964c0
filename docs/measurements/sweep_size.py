#!/usr/bin/env python3
"""What a sweep of many cases needs: size of the results, time and memory of the commands.

sweep_size.py AYUMI CASES FOLDER: runs 40 cases of a study that has CASES cases, adds similar rows for
the other cases to the results, and prints what each command takes. It measures figures of
docs/slurm.md."""

import hashlib
import json
import os
import random
import sqlite3
import struct
import subprocess
import sys
import time


def measured(what, words, folder):
    """Runs a command, and prints its processor time [s] and its largest memory [MB]."""
    process = subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    assert status == 0, words
    print(f"{what}: {used.ru_utime + used.ru_stime:.2f} s of processor time, {used.ru_maxrss / 1024:.0f} MB")


def rows_like(rows, count):
    """Rows of the other cases, with numbers of the same length."""
    have = {row[0] for row in rows}
    random.seed(1)
    for number in range(count):
        if number not in have:
            row = [cell * (1 + 1e-3 * random.random()) if isinstance(cell, float) else cell
                   for cell in rows[number % len(rows)]]
            row[0] = number
            yield row


def hash_of(row):
    """The SHA-256 of a row as docs/formats.md defines it, as a number."""
    cells = b""
    for cell in row:
        if cell is None:
            cells += b"n"
        elif isinstance(cell, int):
            cells += b"i%d;" % cell
        elif isinstance(cell, float):
            cells += b"d" + struct.pack("<d", cell)
        else:
            cells += b"t%d;" % len(cell.encode()) + cell.encode()
    return int.from_bytes(hashlib.sha256(cells).digest(), "big")


def main():
    ayumi, count, folder = os.path.abspath(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    os.makedirs(folder)
    subprocess.run([ayumi, "new", "stand", "--duration", "0.3", "-o", "stand.json", "--quiet"],
                   cwd=folder, check=True, stdout=subprocess.DEVNULL)
    side = max(1, round(count ** 0.5))
    study = {"format": "ayumi.study/1", "name": "size", "sweep": {
        "settings": {"pattern": "stand.json", "disturbances": "push", "noise": True},
        "cases": {"seed": {"from": 1, "to": count // side, "count": count // side},
                  "value.impulse": {"from": 0.1, "to": 6, "count": side}},
        "disturbances": {"push": [{"type": "impulse", "at": 0.1, "duration": 0.02,
                                   "impulse": "${impulse}", "direction": [0, 1, 0]}]}}}
    with open(os.path.join(folder, "study.json"), "w") as file:
        json.dump(study, file)
    count = count // side * side
    sweep = [ayumi, "sweep", "study.json", "-o", "r.db", "--quiet"]
    measured("40 cases of %d" % count, sweep + ["--cases", "0-39"], folder)
    database = sqlite3.connect(os.path.join(folder, "r.db"))
    rows = database.execute("SELECT * FROM cases").fetchall()
    begin = time.process_time()
    (seal,), = database.execute("SELECT value FROM about WHERE key = 'rows_sha256'")
    total = int(seal, 16)

    def sealed_rows():
        nonlocal total
        for row in rows_like(rows, count):
            total += hash_of(row)
            yield row

    database.executemany("INSERT INTO cases VALUES (%s)" % ",".join("?" * len(rows[0])),
                         sealed_rows())
    database.execute("UPDATE about SET value = ? WHERE key = 'rows_sha256'", ("%064x" % (total % 2 ** 256),))
    database.commit()
    database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    database.close()
    print(f"filled in {time.process_time() - begin:.0f} s")
    print(f"size: {os.path.getsize(os.path.join(folder, 'r.db')) / count:.0f} bytes for a case")
    measured("status", [ayumi, "sweep", "status", "r.db", "--quiet"], folder)
    measured("CSV", sweep + ["--csv", "r.csv"], folder)
    print(f"size of the CSV: {os.path.getsize(os.path.join(folder, 'r.csv')) / count:.0f} bytes for a case")


if __name__ == "__main__":
    main()
