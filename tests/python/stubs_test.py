"""The type stubs are those of the module, and everything has a docstring."""

import ast
import builtins
import importlib.util
import inspect
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import ayumi
import write_stubs

SOURCE = pathlib.Path(os.environ["AYUMI_SOURCE_DIR"]) / "lib/python"


class Stubs(unittest.TestCase):
    def test_the_file_is_what_the_module_says(self):
        self.maxDiff = 4000
        self.assertEqual((SOURCE / "ayumi/__init__.pyi").read_text(), write_stubs.stubs(ayumi),
                         "run tests/python/write_stubs.py")

    def test_they_are_python_and_name_everything(self):
        tree = ast.parse(write_stubs.stubs(ayumi))
        named = {node.name for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(named, set(ayumi.__all__))
        known = named | {"Any", "Callable", "Optional", "Union", "PathLike", "Path", "numpy", "NDArray", "property",
                         *dir(builtins)}
        used = set()
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                for type_ in [node.returns, *(a.annotation for a in node.args.args)]:
                    used |= {n.id for n in ast.walk(type_) if isinstance(n, ast.Name)} if type_ else set()
        self.assertEqual(used - known, set(), "types that the stubs do not define")

    def test_types_are_complete(self):
        """`mypy --strict` requires the types inside of lists, and no None for another type."""
        for node in ast.walk(ast.parse(write_stubs.stubs(ayumi))):
            if isinstance(node, ast.Subscript) and getattr(node.value, "id", "") not in ("NDArray", "Callable"):
                for inner in node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]:
                    self.assertFalse(isinstance(inner, ast.Constant) and isinstance(inner.value, int),
                                     f"line {node.lineno}: a number in a type")
            if not isinstance(node, ast.FunctionDef):
                continue
            for type_ in [node.returns, *(a.annotation for a in node.args.args + node.args.kwonlyargs)]:
                self.assertNotIn(getattr(type_, "id", ""), ("list", "dict", "tuple", "NDArray"), node.name)
            defaults = list(zip(reversed(node.args.args), reversed(node.args.defaults)))
            for argument, value in defaults + list(zip(node.args.kwonlyargs, node.args.kw_defaults)):
                if isinstance(value, ast.Constant) and value.value is None:
                    self.assertEqual(argument.annotation.value.id, "Optional", f"{node.name}: {argument.arg}")

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_a_type_checker_accepts_them(self):
        with tempfile.TemporaryDirectory() as folder:
            checked = subprocess.run(
                [sys.executable, "-m", "mypy", "--strict", "--cache-dir", folder, SOURCE / "ayumi/__init__.pyi"],
                capture_output=True, text=True, cwd=folder)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_everything_is_described(self):
        for name in ayumi.__all__:
            thing = getattr(ayumi, name)
            self.assertTrue(inspect.getdoc(thing), name)
            if not inspect.isclass(thing):
                self.assertIn("\n\n", thing.__doc__, f"{name} has a signature alone")
                continue
            for key, member in vars(thing).items():
                if isinstance(member, property):
                    self.assertTrue(member.__doc__, f"{name}.{key}")


if __name__ == "__main__":
    unittest.main()
