"""Compares a .npz of `ayumi export` with the .csv of the same log: read_npz.py X.npz X.csv"""
import csv
import json
import sys

import numpy

archive = numpy.load(sys.argv[1], allow_pickle=False)
with open(sys.argv[2], newline="") as file:
    rows = list(csv.reader(file))
values = numpy.array(rows[1:], dtype=float)
about = json.loads(str(archive["about"]))
arrays = about["arrays"]

assert set(archive.files) == set(arrays) | {"joints", "about"}, archive.files
assert [c for a in arrays.values() for c in a["columns"]] == rows[0]
for name, array in arrays.items():
    assert archive[name].dtype == numpy.float64, name
    assert list(archive[name].shape) == array["shape"], name
together = numpy.concatenate([archive[n].reshape(len(values), -1) for n in arrays], axis=1)
assert together.shape == values.shape
assert numpy.array_equal(together, values, equal_nan=True), "not the same numbers"
joints = [c.split(".", 1)[1].split("[")[0] for c in arrays["theta"]["columns"]]
assert list(archive["joints"]) == joints, archive["joints"]
print(len(arrays), "arrays agree")
