#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the tables of members in docs/wire.md from the .lcm files.

  docs/wire_tables.py           replaces each table in docs/wire.md
  docs/wire_tables.py --check   fails if a table differs from what would be written, or a type has none

A table stands between two remarks:

  <!-- members of camera_t -->
  <!-- end of members -->

The meaning of a member is the remark beside it. A remark that goes on is indented further than members are;
a remark on a line of its own, indented like members, is a row above the members that follow it.
"""

import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
PAGE = HERE / "wire.md"
TYPES = HERE.parent / "lcmtypes"
PLACE = re.compile(r"<!-- members of (\w+) -->\n.*?<!-- end of members -->", re.DOTALL)
CONSTANT = re.compile(r"^const \w+ (.*)$")
MEMBER = re.compile(r"^([\w.]+) (\w+)((?:\[\w+\])*)$")
CONTINUED = re.compile(r"^ {9,}//")
# What Markdown would take for markup, or a reader for prose: names, channels, sets of characters.
CODE = re.compile(r"\w*_<\w+>|\[A-Za-z0-9_[^\]]*\](?:\{[\d,]+\})?|\b\w+(?:\.\w+)*_\w+(?:\.\w+)*(?:\[\])?(?:\.\w+)?")


@dataclass
class Row:
    name: str  # "" for a remark above members
    kind: str  # type, or number of a constant
    remark: list = field(default_factory=list)


@dataclass
class Struct:
    constants: list
    members: list


def read_struct(path):
    inside, pending, rows = False, [], {True: [], False: []}
    last = None
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if not inside:
            inside = line.startswith("{") or (line.startswith("struct") and line.endswith("{"))
            continue
        code, _, remark = line.partition("//")
        code, remark = code.strip(), remark.strip()
        if code == "}":
            break
        if not code:
            if remark and CONTINUED.match(line) and last:
                last.remark.append(remark)
            elif remark:
                pending.append(remark)
            continue
        statement = code.removesuffix(";").replace("camway.", "")
        constant, member = CONSTANT.match(statement), MEMBER.match(re.sub(r"\s+", " ", statement))
        if constant:
            pairs = [pair.split("=") for pair in constant[1].split(",")]
            last = Row(", ".join(f"`{name.strip()}`" for name, _ in pairs), ", ".join(value.strip() for _, value in pairs))
        elif member:
            last = Row(f"`{member[2]}`", f"`{member[1]}{member[3]}`")
        else:
            sys.exit(f"wire_tables.py: {path.name}:{number}: this is neither a member nor a constant: {code}")
        of_constants = constant is not None
        if pending:
            rows[of_constants].append(Row("", "", pending))
            pending = []
        if remark:
            last.remark.append(remark)
        rows[of_constants].append(last)
    return Struct(rows[True], rows[False])


def meaning(row):
    text = " ".join(row.remark)
    limit = re.search(r"\[max (\d+)\] ?", text)
    if limit:
        text = text.replace(limit[0], "").strip()
        text = f"{text}; " if text else ""
        text += f"at most {limit[1]} bytes"
    text = CODE.sub(lambda found: f"`{found[0]}`", text.replace("`", ""))
    return text.replace("|", r"\|")


def table(head, rows):
    lines = [f"| {head[0]} | {head[1]} | meaning |", "|---|---|---|"]
    for row in rows:
        lines.append(f"| {row.name} | {row.kind} | {meaning(row)} |" if row.name else f"| | | *{meaning(row)}* |")
    return "\n".join(lines) + "\n"


def members_of(type_name):
    struct = read_struct(TYPES / f"camway_{type_name}.lcm")
    parts = [table(("member", "type"), struct.members)]
    if struct.constants:
        parts.append(table(("constant", "number"), struct.constants))
    return "\n".join(parts)


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        print(__doc__, file=sys.stderr)
        return 2
    page = PAGE.read_text()
    written = PLACE.sub(lambda place: f"<!-- members of {place[1]} -->\n\n{members_of(place[1])}\n<!-- end of members -->", page)
    known = {path.stem.removeprefix("camway_") for path in TYPES.glob("camway_*_t.lcm")}
    faults = [f"{name} has no table" for name in sorted(known - set(PLACE.sub(r"\1", found[0]) for found in PLACE.finditer(page)))]
    if not check:
        PAGE.write_text(written)
    elif written != page:
        faults.append("a table is not what the .lcm files say; run docs/wire_tables.py")
    for fault in faults:
        print(f"wire_tables.py: {PAGE.name}: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
