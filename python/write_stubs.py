# SPDX-License-Identifier: BSD-3-Clause
"""write_stubs.py PACKAGE_DIR: _fresco.pyi of the module in it. The rest of the package, and with it numpy, is not imported."""
import importlib
import pathlib
import sys
import types

folder = pathlib.Path(sys.argv[1])
bare = types.ModuleType("fresco")
bare.__path__ = [str(folder)]
sys.modules["fresco"] = bare
sys.modules.setdefault("numpy", types.ModuleType("numpy"))  # named, not used: a machine that builds may have none
(folder / "_fresco.pyi").write_text(importlib.import_module("fresco._fresco")._stubs(), encoding="utf8")
