# SPDX-License-Identifier: BSD-3-Clause
"""What the compiled part builds on: errors, and the base of the classes that hold values."""
from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable
from typing import Any, ClassVar


class Error(RuntimeError):
    """It could not be done; the message says why."""


class Cancelled(Error):
    """`progress` returned False."""


class FileError(Error, OSError):
    """A file or folder is missing, damaged or cannot be written; the message names it."""


def unexpected(owner: str, name: str, known: Iterable[str]) -> TypeError:
    """The error for a keyword that `owner` does not take."""
    near = difflib.get_close_matches(name, list(known), 1, 0.5)
    return TypeError(f"{owner}() has no argument '{name}'" + (f"; did you mean '{near[0]}'?" if near else ""))


class Record:
    """A few named values. What is assigned is checked; arrays are kept as they are, not copied."""

    __slots__: Any = ()
    _checks: ClassVar[dict[str, Callable[[Any], Any]]] = {}
    _defaults: ClassVar[Callable[[], dict[str, Any]]] = dict

    def __init__(self, *values: Any, **named: Any) -> None:
        cls = type(self)
        for name, value in cls._defaults().items():
            object.__setattr__(self, name, value)
        if len(values) > len(self._checks):
            raise TypeError(f"{cls.__name__}() takes at most {len(self._checks)} values, not {len(values)}")
        for name, value in zip(self._checks, values):
            if name in named:
                raise TypeError(f"{cls.__name__}() got '{name}' twice")
            setattr(self, name, value)
        for name, value in named.items():
            if name not in self._checks:
                raise unexpected(cls.__name__, name, self._checks)
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        check = self._checks.get(name)
        if check is None:
            raise AttributeError(f"{type(self).__name__} has no '{name}'; it has {', '.join(self._checks)}")
        object.__setattr__(self, name, check(value))

    def __repr__(self) -> str:
        shown = {name: getattr(self, name) for name in self._checks}
        return f"{type(self).__name__}({', '.join(f'{name}={_short(shown[name])}' for name in shown if _told(shown[name]))})"


def _told(value: Any) -> bool:
    return getattr(value, "size", 1) > 0


def _short(value: Any) -> str:
    shape = getattr(value, "shape", None)
    if shape is not None and value.size > 4:
        return f"<{'x'.join(map(str, shape))} {value.dtype}>"
    if isinstance(value, (list, dict)) and len(value) > 4:
        return f"<{len(value)} entries>"
    return repr(value)
