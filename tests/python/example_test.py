"""Runs an example in a scratch folder: example_test.py EXAMPLE FILE... ; the files must be written.
The exit code is that of the example: 77 if the example says that something is missing."""

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
