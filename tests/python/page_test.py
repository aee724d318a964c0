"""The Python code of docs/python.md runs from top to bottom, in a scratch folder, and what its comments
`# -> ...` say of the values is true."""

import os
import pathlib
import re
import tempfile
import unittest
import warnings

PAGE = pathlib.Path(os.environ["AYUMI_SOURCE_DIR"]) / "docs/python.md"


def blocks():
    """(first line, text) of every block of Python."""
    text = PAGE.read_text()
    for match in re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        yield text[:match.start()].count("\n") + 2, match[1]


class Page(unittest.TestCase):
    def test_it_runs(self):
        found = list(blocks())
        self.assertGreater(len(found), 4)
        names = {}
        with tempfile.TemporaryDirectory() as folder:
            before = os.getcwd()
            os.chdir(folder)
            warnings.simplefilter("ignore", RuntimeWarning)  # a plant in Python is slow
            try:
                for line, text in found:
                    code = compile("\n" * (line - 1) + text, str(PAGE), "exec")
                    exec(code, names)
                    for expression, said in re.findall(r"^(\S.*?) +# -> (.*)$", text, re.MULTILINE):
                        with self.subTest(line=line, expression=expression):
                            self.assertEqual(repr(eval(expression, names)), said)
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
