"""Runs an example in a scratch folder: example_test.py EXAMPLE FILE... ; the files must be written.
What the example ends with is the result, 77 where it says what it needs."""

import pathlib
import subprocess
import sys
import tempfile

example, *files = sys.argv[1:]
with tempfile.TemporaryDirectory() as folder:
    done = subprocess.run([sys.executable, example, folder], cwd=folder)
    if done.returncode:
        sys.exit(done.returncode)
    for file in files:
        if not (pathlib.Path(folder) / file).stat().st_size:
            sys.exit(f"{file} is empty")
