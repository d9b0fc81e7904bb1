#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes how every message with a channel or a subject is laid out on the wire, from the .lcm files alone.

  generate_layout.py --source LAYOUT.cpp --limits LIMITS.h --members MEMBERS.h --types TYPE... --files FILE.lcm...

LAYOUT.cpp defines `layout_of` for each TYPE. LIMITS.h holds the limit of each string as a constant, for the code that
has to keep it. MEMBERS.h lists the members of every struct, and their partners in other structs, for code that treats
all of them alike (member.h). A string member has its limit beside it, in bytes without the final NUL, as a remark of
this form:

  string scene;   // name of a scene [max 128]

Ends with 1 and names file and line where a member cannot be read, a string has no limit, or a list has no count
before it.
"""

import argparse
import re
import sys
from dataclasses import dataclass
from pathlib import Path

SIZES = {"byte": 1, "boolean": 1, "int8_t": 1, "int16_t": 2, "int32_t": 4, "int64_t": 8, "float": 4, "double": 8}
MEMBER = re.compile(r"^(?P<type>[A-Za-z_][\w.]*)\s+(?P<name>\w+)(?P<sizes>(\[\w+\])*)$")
LIMIT = re.compile(r"\[max (\d+)\]")


class Mistake(Exception):
    """What is wrong with a line of a file."""


@dataclass
class Member:
    type: str
    name: str
    sizes: list  # of an array, outermost first: a number, or the name of the member that counts
    limit: int | None  # of a string
    place: str


def read_struct(path):
    """Returns the name and the members of the struct in a file; constants are left out."""
    name, members, inside = None, [], False
    for number, line in enumerate(path.read_text().splitlines(), 1):
        code, _, remark = line.partition("//")
        code = code.strip()
        place = f"{path.name}:{number}"
        if code.startswith("struct "):
            name = code.split()[1].rstrip("{")
        inside = inside or code.startswith("{") or code.endswith("{")
        for statement in code.strip("{}").split(";"):
            statement = statement.strip()
            if not inside or not statement or statement.startswith(("const ", "struct ", "package ")):
                continue
            found = MEMBER.match(statement)
            if not found:
                raise Mistake(f"{place}: this is no member: {statement}")
            limit = LIMIT.search(remark)
            members.append(Member(found["type"].removeprefix("camway."), found["name"],
                                  re.findall(r"\[(\w+)\]", found["sizes"]), int(limit[1]) if limit else None, place))
    if name is None:
        raise Mistake(f"{path.name}: holds no struct")
    return name, members


class Generator:
    def __init__(self, structs):
        self._structs = structs
        self._arrays = {}  # name of a C++ array -> its lines
        self._order = []
        self.limits = []  # (constant, bytes)

    def fixed_size(self, type_name, place):
        """Bytes of a type, or None if they depend on its content."""
        if type_name in SIZES:
            return SIZES[type_name]
        if type_name == "string":
            return None
        total = 0
        for member in self.struct(type_name, place):
            size = self.member_size(member)
            if size is None:
                return None
            total += size
        return total

    def struct(self, type_name, place):
        if type_name not in self._structs:
            raise Mistake(f"{place}: there is no type {type_name}")
        return self._structs[type_name]

    def member_size(self, member):
        size = self.fixed_size(member.type, member.place)
        for count in member.sizes:
            if not count.isdigit() or size is None:
                return None
            size *= int(count)
        return size

    def array(self, type_name):
        """Name of the array that describes a type; writes it on first use."""
        name = "k" + "".join(word.capitalize() for word in type_name.removesuffix("_t").split("_"))
        if name not in self._arrays:
            self._arrays[name] = self.lines(type_name, self._structs[type_name], "")
            self._order.append(name)
        return name

    def lines(self, type_name, members, prefix):
        result, counted = [], None
        for member in members:
            following = members[members.index(member) + 1:]
            if any(m.sizes and m.sizes[0] == member.name for m in following):
                counted = member.name  # LCM writes the count just before the list, as int32_t
                if member.type != "int32_t":
                    raise Mistake(f"{member.place}: the count of a list has to be an int32_t")
                continue
            result += self.line(type_name, member, prefix, counted)
        return result

    def line(self, type_name, member, prefix, counted):
        name = f'"{prefix}{member.name}"'
        size = self.member_size(member)
        if size is not None:
            return [f"fixed({name}, {size}),"]
        if member.type == "string" and not member.sizes:
            if member.limit is None:
                raise Mistake(f"{member.place}: the string {member.name} needs a limit: [max BYTES]")
            constant = f"{type_name.removesuffix('_t')}_{prefix}{member.name}".replace(".", "_")
            if not prefix:
                self.limits.append((constant, member.limit))
            return [f"text({name}, {member.limit}),"]
        if not member.sizes:
            return self.lines(type_name, self.struct(member.type, member.place), f"{prefix}{member.name}.")
        return self.list_line(member, name, counted)

    def list_line(self, member, name, counted):
        if member.sizes[0] != counted:
            raise Mistake(f"{member.place}: the count of {member.name} has to stand just before it")
        element = Member(member.type, member.name, member.sizes[1:], None, member.place)
        size = self.member_size(element)
        if size is not None:
            return [f"list({name}, {size}),"]
        if element.sizes or member.type == "string":
            raise Mistake(f"{member.place}: lists of strings or of arrays of structs are not supported")
        return [f"list_of({name}, {self.array(member.type)}),"]

    def source(self, types):
        tables = [(t, self.array(t)) for t in types]
        includes = "\n".join(f"#include <camway/{t}.hpp>" for t in types)
        arrays = "\n\n".join(f"constexpr Field {name}[] = {{\n    " + "\n    ".join(self._arrays[name]) + "\n};"
                             for name in self._order)
        layouts = "\n".join(
            f"template <>\nLayout layout_of<{t}>() {{\n  return {{\"{t}\", {t}::getHash(), {name}, max_bytes_of(\"{t}\")}};\n}}"
            for t, name in tables)
        return SOURCE.format(includes=includes, arrays=arrays, layouts=layouts)

    def limits_header(self):
        lines = "\n".join(f"inline constexpr std::size_t {name} = {limit};" for name, limit in sorted(set(self.limits)))
        return HEADER.format(lines=lines)


def members_header(structs):
    """The members of every struct, as lcmtypes/wire/member.h describes them."""
    tables = []
    for name, members in sorted(structs.items()):
        counts = {m.sizes[0] for m in members if m.sizes}
        listed = [m for m in members if m.name not in counts]
        names = [m.name for m in listed]
        tables.append(MEMBERS.format(
            name=name, all=",\n      ".join(described(name, m) for m in listed),
            marks=",\n      ".join(f"Mark{{&{name}::{flag}, &{name}::{marked}}}"
                                   for flag in names for marked in marked_by(flag, names)),
            has=",\n      ".join(" || ".join(f"requires(const {name}& message, Other& other) {{ {form}; }}"
                                            for form, _ in partners(n, names)) for n in names),
            common="\n    ".join("\n    else ".join(f"if constexpr (requires {{ {form}; }}) {action}"
                                                   for form, action in partners(n, names))
                                for n in sorted(names, key=is_flag))))
    includes = "\n".join(f"#include <camway/{name}.hpp>" for name in sorted(structs))
    return MEMBERS_HEADER.format(includes=includes, tables="\n".join(tables))


def is_flag(name):
    return name.startswith("has_")


def marked_by(flag, names):
    """The members that a flag marks: has_x marks x, or else the members x_..."""
    x = flag.removeprefix("has_")
    return [n for n in names if is_flag(flag) and (n == x or x not in names and n.startswith(x + "_"))]


def partners(name, names):
    """The forms that a member may have in another struct, each with the statement that visits both: the same name; x.y
    for x_y, if several members begin with x_; the optional that a flag marks."""
    forms = [(f"other.{name}", f"visit(message.{name}, other.{name});")]
    x, _, y = name.partition("_")
    if y and not is_flag(name) and sum(n.startswith(x + "_") for n in names) > 1:
        forms.append((f"group(other.{x})->{y}",
                      f"{{ if (auto* part = group(other.{x})) visit(message.{name}, part->{y}); }}"))
    if marked := marked_by(name, names):
        optional = f"other.{marked[0] if len(marked) == 1 else name.removeprefix('has_')}"
        forms.append((f"mark(message.{name}, {optional})", f"mark(message.{name}, {optional});"))
    return forms


def described(struct, member):
    pointer = f'"{member.name}", &{struct}::{member.name}'
    if member.type == "string":
        return f"Text{{{pointer}, {member.limit}}}"
    if member.sizes and not member.sizes[0].isdigit():
        columns = member.sizes[1] if len(member.sizes) > 1 else 0
        return f"List{{{pointer}, &{struct}::{member.sizes[0]}, {columns}}}"
    return f"Plain{{{pointer}}}"


SOURCE = """// Generated from the .lcm files by lcmtypes/wire/generate_layout.py. Do not edit.
#include "lcmtypes/wire/layout.h"

{includes}

namespace camway::wire {{
namespace {{

constexpr Field fixed(std::string_view name, std::size_t bytes) {{
  return {{.kind = Field::Kind::kFixed, .name = name, .bytes = bytes}};
}}
constexpr Field text(std::string_view name, std::size_t max_length) {{
  return {{.kind = Field::Kind::kString, .name = name, .max_length = max_length}};
}}
constexpr Field list(std::string_view name, std::size_t element_bytes) {{
  return {{.kind = Field::Kind::kList, .name = name, .bytes = element_bytes}};
}}
constexpr Field list_of(std::string_view name, std::span<const Field> element) {{
  return {{.kind = Field::Kind::kList, .name = name, .element = element}};
}}
constexpr std::size_t max_bytes_of(std::string_view type) {{
  if (type.starts_with("fleet_")) return kMaxFleetBytes;
  return type == "envelope_t" ? kMaxEnvelopeBytes : kMaxMessageBytes;
}}

{arrays}

}}  // namespace

{layouts}

}}  // namespace camway::wire
"""

HEADER = """// Generated from the .lcm files by lcmtypes/wire/generate_layout.py. Do not edit.
#pragma once

#include <cstddef>

/// The longest that each string of a message may be, in bytes without the final NUL.
namespace camway::wire::max_bytes {{

{lines}

}}  // namespace camway::wire::max_bytes
"""


MEMBERS_HEADER = """// Generated from the .lcm files by lcmtypes/wire/generate_layout.py. Do not edit.
#pragma once

#include "lcmtypes/wire/member.h"

{includes}

namespace camway::wire {{

{tables}
}}  // namespace camway::wire
"""

MEMBERS = """template <>
struct Members<{name}> {{
  static constexpr auto kAll = std::make_tuple(
      {all});
  static constexpr auto kMarks = std::make_tuple(
      {marks});
  template <class Other>
  static constexpr std::array<bool, std::tuple_size_v<decltype(kAll)>> kHas{{
      {has}}};
  template <class Message, class Other, class Visit>
  static void common(Message& message, Other& other, const Visit& visit) {{
    {common}
  }}
}};
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--limits", type=Path, required=True)
    parser.add_argument("--members", type=Path, required=True)
    parser.add_argument("--types", nargs="+", required=True)
    parser.add_argument("--files", nargs="+", type=Path, required=True)
    words = parser.parse_args()
    try:
        structs = dict(read_struct(path) for path in words.files)
        generator = Generator(structs)
        missing = [t for t in words.types if t not in structs]
        if missing:
            raise Mistake(f"no file holds these types: {', '.join(missing)}")
        source = generator.source(words.types)
    except Mistake as mistake:
        print(f"generate_layout.py: {mistake}", file=sys.stderr)
        return 1
    words.source.write_text(source)
    words.limits.write_text(generator.limits_header())
    words.members.write_text(members_header(structs))
    return 0


if __name__ == "__main__":
    sys.exit(main())
