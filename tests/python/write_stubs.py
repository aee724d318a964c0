"""Writes the type stubs of the Python package from the docstrings of its module.

    PYTHONPATH=build/release/lib/python python3 tests/python/write_stubs.py > lib/python/ayumi/__init__.pyi

The first line of a docstring is the signature that the binding has, so the stubs cannot differ from
it. A test compares the file with what this program writes.
"""

import inspect
import re
import sys

HEAD = '''# Written by tests/python/write_stubs.py from the module; do not edit.
from os import PathLike
from pathlib import Path
from typing import Any, Callable, Optional, Union

import numpy
from numpy.typing import NDArray

__version__: str
__all__: list[str]
'''

TYPES = [
    (r"-> os\.PathLike", "-> Path"),
    (r"\bself: [\w.]+", "self"),
    (r"progress: object", "progress: Optional[Callable[[str, float, str], Any]]"),
    (r"targets: object", "targets: Optional[Callable[..., Any]]"),
    (r"plant: object", "plant: Union[str, Callable[..., Any]]"),
    (r"ayumi\.", ""),
    (r"os\.PathLike", "Union[str, PathLike[str]]"),
    (r"numpy\.ndarray\[(numpy\.\w+)(\[[^\]]*\](, flags\.\w+)?)?\]", r"NDArray[\1]"),
    (r"numpy\.ndarray\b", "NDArray[Any]"),
    (r"\bDict\b", "dict"), (r"\bList\b", "list"), (r"\bTuple\b", "tuple"),
    (r"Annotated\[(list\[\w+\]), FixedSize\(\d+\)\]", r"\1"),
    (r"\blist\[(\w+)\[\d+\]\]", r"list[\1]"),
    (r"\btuple\b(?!\[)", "tuple[Any, ...]"), (r"\b(list|dict)\b(?!\[)", r"\1[Any]"),
    (r"(\w+): (\w+) = None", r"\1: Optional[\2] = None"),
    (r"\bobject\b", "Any"), (r"\bhandle\b", "Any"),
    (r"<[^<>]*>", "..."), (r"array\([^()]*\)", "..."),
]


def in_stub(signature):
    """A signature as pybind11 writes it, in the words of a stub."""
    for pattern, word in TYPES:
        signature = re.sub(pattern, word, signature)
    return signature


def parts(docstring, name):
    """Signature and text of a docstring."""
    first, _, rest = (docstring or "").partition("\n")
    match = re.match(rf"(?:{name})?(\(.*\) -> .*)$", first)
    if not match:
        raise SystemExit(f"{name}: the docstring does not begin with a signature: {first!r}")
    return in_stub(match[1]), rest.strip()


def quoted(text, indent):
    if not text:
        return f"{indent}...\n"
    return f'{indent}"""{text}"""\n'


def function(name, thing, indent):
    signature, text = parts(thing.__doc__, name)
    return f"{indent}def {name}{signature}:\n{quoted(text, indent + '    ')}"


def klass(name, thing):
    bases = "" if thing.__bases__[0].__name__ == "pybind11_object" else f"({thing.__bases__[0].__name__})"
    lines = f"\nclass {name}{bases}:\n" + quoted(inspect.getdoc(thing), "    ")
    for key, member in vars(thing).items():
        if isinstance(member, property):
            _, returned = parts(member.fget.__doc__, "")[0].rsplit(" -> ", 1)
            lines += f"\n    @property\n    def {key}(self) -> {returned}:\n"
            lines += quoted(inspect.getdoc(member), "        ")
            if member.fset:
                lines += f"\n    @{key}.setter\n    def {key}(self, value: {returned}) -> None: ...\n"
        elif isinstance(member, str) and not key.startswith("__"):
            lines += f"\n    {key}: str\n"
        elif inspect.isroutine(member) and key in ("__init__", "__len__", "__getitem__", "__bool__"):
            if "(self: " in (member.__doc__ or ""):
                lines += "\n" + function(key, member, "    ")
        elif inspect.isroutine(member) and not key.startswith("_"):
            lines += "\n" + function(key, member, "    ")
    return lines


def stubs(module):
    text = HEAD
    for name in module.__all__:
        thing = getattr(module, name)
        text += klass(name, thing) if inspect.isclass(thing) else "\n" + function(name, thing, "")
    return text


if __name__ == "__main__":
    import ayumi

    sys.stdout.write(stubs(ayumi))
