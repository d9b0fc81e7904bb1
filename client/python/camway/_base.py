# SPDX-License-Identifier: MIT
"""The base of the classes of data."""
from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from camway import _native
from camway._native import Path

Floats: TypeAlias = npt.NDArray[np.float64]
Integers: TypeAlias = npt.NDArray[np.int64]
Booleans: TypeAlias = npt.NDArray[np.bool_]
#: Three numbers: a tuple, a list or an array.
Vector: TypeAlias = "Sequence[float] | Floats"
#: Four numbers w, x, y, z.
Quaternion: TypeAlias = "Sequence[float] | Floats"

_Default = TypeVar("_Default")

__all__ = ["Booleans", "Floats", "Integers", "Lazy", "Path", "Quaternion", "Struct", "Vector", "field"]


def field(make: Callable[[], _Default]) -> _Default:
    """Returns the default of a member that each object has for itself."""
    made: _Default = dataclasses.field(default_factory=make)
    return made


class Struct:
    """A class of data. Equal if all members are equal; arrays by their elements."""

    __slots__ = ()
    __hash__ = None  # type: ignore[assignment]  # the members can change

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        names = [member.name for member in dataclasses.fields(self)]
        return all(_is_equal(getattr(self, name), getattr(other, name)) for name in names)


class Lazy(Struct):
    """A class of data whose objects, where C++ made them, get a member when it is first asked for. From then on they
    have it as others do: it can be changed, and stays the same object."""

    __slots__ = ("_source",)

    if not TYPE_CHECKING:  # where a member that is misspelled has to be found

        def __getattr__(self, name):
            return _native.fill_member(self, name)

    def __getstate__(self) -> tuple[None, dict[str, Any]]:
        """Returns all members, for copies and pickles: the source is in C++."""
        return None, {member.name: getattr(self, member.name) for member in dataclasses.fields(self)}


def _is_equal(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.array_equal(one, other)
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(one) == len(other) and all(map(_is_equal, one, other))
    return bool(one == other)
