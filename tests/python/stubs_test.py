"""The type stubs are those of the module, and everything has a docstring."""

import ast
import builtins
import inspect
import os
import pathlib
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
        known = named | {"Any", "Callable", "Optional", "Union", "PathLike", "Path", "numpy", "property",
                         *dir(builtins)}
        used = set()
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                for type_ in [node.returns, *(a.annotation for a in node.args.args)]:
                    used |= {n.id for n in ast.walk(type_) if isinstance(n, ast.Name)} if type_ else set()
        self.assertEqual(used - known, set(), "types that the stubs do not define")

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
