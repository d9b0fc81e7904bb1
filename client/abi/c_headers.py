# SPDX-License-Identifier: MIT
"""The declarations in the headers of the C interface, read from their text."""
import re
from pathlib import Path

HEADERS = Path(__file__).resolve().parents[1] / "include/camway/c"
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_STRUCT = re.compile(r"typedef struct (\w+) \{(.*?)\} \1;", re.DOTALL)
_ENUM = re.compile(r"enum \{(.*?)\};", re.DOTALL)
_HANDLER = re.compile(r"typedef (\w+) \(\*(\w+)\)\(([^)]*)\);")
_FUNCTION = re.compile(r"([\w ]+?[ *]+)(camway_\w+)\(([^;{}]*)\);")


class Declared:
    """`structs`: members of each struct with their types, by name. `constants`: names. `functions`, `handlers`:
    types, by name."""

    def __init__(self, folder=HEADERS):
        self.structs, self.constants, self.functions, self.handlers = {}, [], {}, {}
        for header in sorted(folder.glob("*.h")):
            self._read(_COMMENT.sub(" ", header.read_text()))

    def _read(self, text):
        for name, body in _STRUCT.findall(text):
            self.structs[name] = dict(member for line in body.split(";") for member in _members_of(line))
        for body in _ENUM.findall(text):
            self.constants += re.findall(r"(\w+) *=", body)
        for result, name, parameters in _HANDLER.findall(text):
            self.handlers[name] = _signature(result, parameters)
        for result, name, parameters in _FUNCTION.findall(_STRUCT.sub("", _HANDLER.sub("", text))):
            self.functions[name] = _signature(result, parameters)


def _members_of(line):
    """Names and types of the members that a line declares, such as "double a[3], b" or a handler."""
    line = _plain(line)
    pointer = re.match(r"(\w+) \( ?\*(\w+)\)\((.*)\)$", line)
    if pointer:
        return [(pointer[2], _signature(pointer[1], pointer[3]))]
    base = re.match(r"((?:const )?\w+) ", line)
    return [(name, f"{base[1]} {stars}{size}".rstrip())
            for stars, name, size in re.findall(r"(\**)(\w+)((?:\[\d+\])*)(?=,|$)", line)]


def _signature(result, parameters):
    """The types of a function, without the names of its parameters."""
    return f"{_plain(result)}({', '.join(map(_type_of, parameters.split(',')))})"


def _plain(text):
    """A declaration with single blanks, its stars at the names."""
    return " ".join(re.sub(r"\s*(\*+)\s*", r" \1", text).split())


def _type_of(parameter):
    parameter = _plain(parameter)
    if parameter == "void":
        return parameter
    return re.sub(r"(.*[ *])\w+((?:\[\d+\])?)$", r"\1\2", parameter).rstrip()


def cxx_types(folder=HEADERS.parent):
    """Headers of the C++ client, and the structs and classes that they define."""
    headers = sorted(folder.glob("*.h"))
    defined = re.compile(r"^(?:struct|class) (\w+) \{", re.MULTILINE)
    return ([header.name for header in headers],
            [name for header in headers for name in defined.findall(header.read_text())])
