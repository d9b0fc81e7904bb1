# SPDX-License-Identifier: MIT
"""Structs of the C++ client as Python's data classes: types, defaults and comments."""
import re
import textwrap

import header_parser

#: Structs that Python has in a form of its own: as futures, arguments and key files.
SKIPPED_STRUCTS = {"PlanHandlers", "PendingPlan", "ClientOptions"}
#: Structs of numbers alone, lists of which are arrays in Python, and their columns.
ROWS = {
    "OccupancyBox": "min x, y, z, max x, y, z",
    "OccupancySphere": "center x, y, z, radius",
    "OccupancyRay": "origin x, y, z, direction x, y, z, range",
    "OccupancyDistance": "point x, y, z, largest distance",
    "OccupancySpherePath": "from x, y, z, to x, y, z, radius",
}
#: Structs that users fill: their arrays may be anything of which NumPy makes an array.
_INPUTS = {"Camera", "Body", "Keyframe", "PathEnd", "PathFrame", "Orientation", "MotionLimits", "Bounds",
           "PlanRequest", "OccupancyBatch", "SceneBox", "ScenePoints", "SceneMesh", "Pose", "Segment"}
#: Structs of many members, most of which a program does not look at: those are converted when they are asked for.
LAZY = {"PlanResponse"}
#: Functions of the classes, which `_functions.py` has.
_MIXINS = {"Body": "BodyFunctions", "Orientation": "OrientationFunctions", "PlanRequest": "RequestFunctions",
           "PlanResponse": "AnswerFunctions", "Keyframe": "KeyframeFunctions", "PathKeyframe": "PathKeyframeFunctions",
           "SceneMesh": "SceneMeshFunctions", "Latency": "LatencyFunctions", "DaemonStatus": "OutcomeFunctions",
           "SceneAnswer": "OutcomeFunctions", "OccupancyAnswer": "OutcomeFunctions",
           "SceneMap": "OutcomeFunctions", "SceneTriangles": "OutcomeFunctions"}

PREAMBLE = '''# SPDX-License-Identifier: MIT
"""The data of requests and answers. Written by client/python/generate_types.py from the headers of the
C++ client, whose structs these are; lengths are metres, angles radians, times seconds."""
from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from camway import _functions
from camway._base import Booleans, Floats, Integers, Lazy, Path, Quaternion, Struct, Vector, field

'''

_NUMBERS = {"double": "float", "bool": "bool", "std::string": "str", "int": "int"}


def _is_integer(cpp):
    return re.fullmatch(r"(std::)?u?int\d*(_t)?", cpp) is not None


def _inside(cpp, name):
    match = re.fullmatch(rf"std::{name}<(.*)>", cpp)
    return match.group(1) if match else None


class _Type:
    """The annotation and the default of a member, for its type in C++."""

    def __init__(self, member, struct):
        self._struct = struct
        self._is_input = struct.name in _INPUTS
        self.annotation, self.default = self._of(member.type.replace("Point", "std::array<double, 3>")
                                                 if struct.name == "Body" else member.type, member.default)

    def _of(self, cpp, default):
        if cpp in _NUMBERS or _is_integer(cpp):
            return self._number(cpp, default)
        if optional := _inside(cpp, "optional"):
            return f"{self._of(optional, '')[0]} | None", "None"
        if array := _inside(cpp, "array"):
            return self._array(array, default)
        if element := _inside(cpp, "vector"):
            return self._list(element)
        return self._named(cpp, default)

    @staticmethod
    def _number(cpp, default):
        annotation = _NUMBERS.get(cpp, "int")
        blank = {"float": "0.0", "int": "0", "bool": "False", "str": '""'}[annotation]
        text = {"true": "True", "false": "False", "": blank}.get(default, default)
        return annotation, text

    def _array(self, inside, default):
        element, length = inside.rsplit(", ", 1)
        numbers = [part.strip() for part in default.strip("{}").split(",") if part.strip()]
        if rows := _inside(element, "array"):
            shape = f"({length}, {rows.rsplit(', ', 1)[1]})"
            return self._floats(), f"field(lambda: np.zeros({shape}))"
        if _inside(element, "optional"):
            return "Sequence[float | None]", f"({', '.join(['None'] * int(length))})"
        if _is_integer(element):
            return f"tuple[int, ...]", f"(0,) * {length}"
        values = [repr(float(number)) for number in numbers] or ["0.0"] * int(length)
        exact = f"tuple[{', '.join(['float'] * int(length))}]"
        annotation = {"3": "Vector", "4": "Quaternion"}[length] if self._is_input else exact
        return annotation, f"({', '.join(values)})"

    def _floats(self):
        return "npt.ArrayLike" if self._is_input else "Floats"

    def _list(self, element):
        if element in ROWS:
            return "npt.ArrayLike", "()"
        if array := _inside(element, "array"):
            number, length = array.rsplit(", ", 1)
            is_real = number == "double"
            annotation = "npt.ArrayLike" if self._is_input else "Floats" if is_real else "Integers"
            kind = "float" if is_real else "np.int64"
            return annotation, f"field(lambda: np.empty((0, {length}), {kind}))" if not self._is_input else "()"
        if element == "bool":
            return "Booleans", "field(lambda: np.empty(0, bool))"
        if element == "std::uint8_t":
            return "bytes", 'b""'
        if _inside(element, "optional"):
            return "Floats", "field(lambda: np.empty(0))"
        if _is_integer(element):
            return "Integers", "field(lambda: np.empty(0, np.int64))"
        if _inside(element, "vector"):
            return "Sequence[npt.ArrayLike]", "()"
        name = self._python_name(element)
        return f"list[{name}]", "field(list)"

    def _python_name(self, cpp):
        inner = {"Shape", "Policy", "Method", "Stage", "Up", "Unknown", "Kind", "Part"}
        return header_parser.python_name(f"{self._struct.name}::{cpp}" if cpp in inner else cpp)

    def _named(self, cpp, default):
        name = self._python_name(cpp)
        value = re.search(r"\bk\w+$", default)
        if value:
            return name, f'"{header_parser.snake(value.group())}"'
        if cpp in ("Status",):
            return name, '"no_answer"'
        return name, f"field(lambda: {name}())"


def doc_in_python(doc):
    """Returns a comment of C++ with the names of Python."""
    doc = " ".join(line.strip() for line in doc.splitlines()).strip()
    doc = re.sub(r"`?\bk([A-Z]\w*)\b`?", lambda m: f'"{header_parser.snake("k" + m.group(1))}"', doc)
    doc = doc.replace("PlanRequest", "Request").replace("PlanResponse", "Answer")
    doc = re.sub(r"`PlanHandlers::", "`", doc)
    doc = re.sub(r"(\w)::(\w)", r"\1.\2", doc).replace("\\", "\\\\")
    return doc


def _code_in_python(line):
    line = line.strip().replace("::", ".").replace("{", "(").replace("}", ")").replace("//", "#")
    return re.sub(r";(\s*#|$)", r"\1", line)


def _class_doc(struct):
    """The paragraphs of a struct's comment, code lines in Python, and its members."""
    lines, paragraph = [], []

    def end():
        if paragraph:
            lines.extend(textwrap.wrap(doc_in_python("\n".join(paragraph)), 96))
            paragraph.clear()

    for line in struct.doc.splitlines():
        if line.startswith("     "):
            end()
            lines.append("    " + _code_in_python(line))
        elif not line.strip():
            end()
            lines.append("")
        else:
            paragraph.append(line)
    end()
    lines += ["", "Attributes:"]
    for member in struct.members:
        doc = doc_in_python(member.doc) or "see the class"
        columns = [ROWS[row] for row in ROWS if f"<{row}>" in member.type]
        if columns:
            doc += f" An array with the columns {columns[0]}."
        if "optional<double>>" in member.type and "hit" in member.name or member.name == "distances_m":
            doc = doc.replace("unset if", "infinite if")
        lines += textwrap.wrap(f"{member.name}: {doc}", 92, initial_indent="    ", subsequent_indent="        ")
    return lines


def data_class(struct):
    mixin = _MIXINS.get(struct.name)
    base = "Lazy" if struct.name in LAZY else "Struct"
    bases = f"_functions.{mixin}, {base}" if mixin else base
    doc = _class_doc(struct)
    lines = ["", "@dataclasses.dataclass(slots=True, eq=False)", f"class {struct.python_name}({bases}):",
             f'    """{doc[0]}'] + [f"    {line}".rstrip() for line in doc[1:]] + ['    """', ""]
    for member in struct.members:
        kind = _Type(member, struct)
        lines.append(f"    {member.name}: {kind.annotation} = {kind.default}")
    return "\n".join(lines) + "\n"


def epilogue(structs, enums):
    names = sorted([struct.python_name for struct in structs] + [enum.python_name for enum in enums] + ["SceneShape"])
    return ('\n#: What an object of a scene can be.\nSceneShape: TypeAlias = "SceneMesh | SceneBox | SceneSphere | '
            'SceneCylinder | ScenePoints | SceneVoxels"\n\n'
            + "__all__ = [\n" + "".join(f'    "{name}",\n' for name in names) + "]\n")
