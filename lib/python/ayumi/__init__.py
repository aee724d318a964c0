"""Offline authoring and stabilization of humanoid motion patterns.

    import ayumi

    task = ayumi.load_task("patterns/hoap1_walk.json")
    verdict = ayumi.check(task)
    log = ayumi.simulate(task)
    log["zmp"], log.units("zmp")

The page docs/python.md describes the module. A log, a series and a table have arrays by name, as
numpy views with the units beside them. Every function raises ayumi.Error for bad input; a negative
verdict is a result.
"""

from . import _native
from ._native import *  # noqa: F401,F403
from ._native import __version__  # noqa: F401

_native._set_module_file(_native.__file__)

__all__ = sorted(name for name in vars(_native) if not name.startswith("_"))
