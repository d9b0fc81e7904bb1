#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the ABI of the client's libraries and the fingerprints of messages with those of the last release.

  abi.py check|update --facts PROGRAM --library C++ --c-library C
  abi.py release          marks the lists as those of the version that CMakeLists.txt has
  abi.py facts FILE.cpp   writes the program PROGRAM, which prints what only a compiler knows

The lists are client/abi/symbols.txt (functions), client/abi/layouts.txt (structs and constants of C) and
lcmtypes/fingerprints.txt. A line that came after the release begins with "+". docs/versions.md has the policy.
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

from c_headers import Declared, cxx_types

ROOT = Path(__file__).resolve().parents[2]
POLICY = "docs/versions.md"
UPDATE = "cmake --build build/dev --target abi_update"
LISTS = {
    "client/abi/symbols.txt":
        "Functions that the shared libraries export: of C with their types, of C++ with their names.",
    "client/abi/layouts.txt":
        "C: sizes of structs, offsets and sizes of members, constants, handlers. C++: sizes of structs.",
    "lcmtypes/fingerprints.txt": "Fingerprints of the messages: programs with others do not understand each other.",
}
_NOTE = "# Compared with the build by the test client.abi; client/abi/abi.py writes it.\n"


def versions():
    """The version of Camway, and that of the C ABI."""
    camway = re.search(r"project\(camway VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    base = (ROOT / "client/include/camway/c/base.h").read_text()
    return camway, ".".join(re.search(rf"CAMWAY_ABI_{part} (\d+)", base)[1] for part in ("MAJOR", "MINOR"))


class List:
    """The lines of a list by their keys, those that came after the release in `new`."""

    def __init__(self, file):
        self.file = file
        self.released, self.lines, self.new = None, {}, set()
        path = ROOT / file
        for line in path.read_text().splitlines() if path.exists() else []:
            if line.startswith("released: "):
                words = line.split()
                self.released = None if words[1] == "none" else (words[1], words[3])
            elif line and not line.startswith("#"):
                key, value = entry(line.removeprefix("+ "))
                self.lines[key] = value
                if line.startswith("+ "):
                    self.new.add(key)

    def write(self):
        released = "released: " + (f"{self.released[0]} abi {self.released[1]}" if self.released else "none")
        lines = [("+ " if key in self.new else "") + f"{key} {value}".rstrip()
                 for key, value in sorted(self.lines.items())]
        (ROOT / self.file).write_text(f"# {LISTS[self.file]}\n{_NOTE}{released}\n\n" + "\n".join(lines) + "\n")


def entry(line):
    """Key and value of a line: "c camway_plan camway_status(...)" has the first two words as its key."""
    words = line.split(" ", 2)
    return f"{words[0]} {words[1]}", words[2] if len(words) > 2 else ""


def facts_program():
    """A program that prints layouts, constants and fingerprints."""
    declared, (headers, classes) = Declared(), cxx_types()
    types = sorted(path.stem.removeprefix("camway_") for path in (ROOT / "lcmtypes").glob("*.lcm"))
    lines = ["// Written by client/abi/abi.py.", "#include <cinttypes>", "#include <cstdio>"]
    lines += [f"#include <camway/{name}>" for name in headers]
    lines += [f"#include <camway/{name}.hpp>" for name in types]
    lines += ["int main() {"]
    for name, members in declared.structs.items():
        lines.append(f'  std::printf("c {name} size %zu\\n", sizeof({name}));')
        lines += [f'  std::printf("c {name}.{member} at %zu, size %zu\\n", '
                  f'offsetof({name}, {member}), sizeof({name}::{member}));' for member in members]
    lines += [f'  std::printf("c {name} is %d\\n", static_cast<int>({name}));' for name in declared.constants]
    lines += [f'  std::printf("c++ camway::{name} size %zu\\n", sizeof(camway::{name}));' for name in classes]
    lines += [f'  std::printf("wire {name} %016" PRIx64 "\\n", static_cast<std::uint64_t>(camway::{name}::getHash()));'
              for name in types]
    return "\n".join(lines + ["}", ""])


def exported(library):
    """The functions that a library exports: names as in C++, and the library's name with its version."""
    soname = re.search(r"SONAME.*\[(.*)\]", output_of("readelf", "-d", library))[1]
    # Weak symbols are inline functions, which every program has itself.
    return soname, sorted(set(re.findall(r" [TDB] (.*?)@@(\S+)", output_of("nm", "-DC", "--defined-only", library))))


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def built(arguments):
    """Returns the lines of the build, by list."""
    declared = Declared()
    found = {file: {} for file in LISTS}
    soname, symbols = exported(arguments.c_library)
    for name in declared.functions.keys() ^ {symbol for symbol, _ in symbols}:
        sys.exit(f"{name}: is declared in the headers of the C interface, or exported by {soname}, but not both")
    for name, version in symbols:
        found["client/abi/symbols.txt"][f"c {name}"] = f"{soname} {version} {declared.functions[name]}"
    for name, types in declared.handlers.items():
        found["client/abi/layouts.txt"][f"c {name}"] = types
    soname, symbols = exported(arguments.library)
    for name, version in symbols:
        # A key is a word: names have blanks in their types.
        found["client/abi/symbols.txt"][f"c++ {name.replace(' ', '')}"] = f"{soname} {version}"
    for line in output_of(arguments.facts).splitlines():
        key, value = entry(line)
        struct, _, member = key.removeprefix("c ").partition(".")
        if member in declared.structs.get(struct, {}):
            value += f", {declared.structs[struct][member]}"
        found["lcmtypes/fingerprints.txt" if key.startswith("wire ") else "client/abi/layouts.txt"][key] = value
    return found


def may_grow(key, before, now, structs):
    """Returns whether a struct may change its size: it begins with `struct_size`, and gets larger."""
    name = key.removeprefix("c ")
    if "struct_size" not in structs.get(name, {}):
        return False
    return int(now.split()[1]) > int(before.split()[1])


def needed(key, is_added, released, now):
    """Returns the increment of a version that a difference to a release still needs, in words; None if it needs none."""
    same_minor = released[0].rsplit(".", 1)[0] == now[0].rsplit(".", 1)[0]
    if not key.startswith("c "):
        return "a new minor version of Camway" if same_minor else None
    if is_added:
        return "a higher CAMWAY_ABI_MINOR" if released[1] == now[1] else None
    return "a higher CAMWAY_ABI_MAJOR" if released[1].split(".")[0] == now[1].split(".")[0] else None


def differences(listed, found, now, structs):
    """Each difference as (key, words, whether an update may list it)."""
    for key in sorted(listed.lines.keys() | found.keys()):
        before, after = listed.lines.get(key), found.get(key)
        is_added = before is None or (before != after and after and may_grow(key, before, after, structs))
        if before == after and key not in listed.new:
            continue
        need = needed(key, is_added or key in listed.new, listed.released, now) if listed.released else None
        if before == after and need is None:
            continue
        what = ("is new" if before is None or before == after else "is gone" if after is None
                else f"was '{before}', and is '{after}'")
        remedy = f"that needs {need} ({POLICY})" if need else f"list it: {UPDATE}"
        yield key, f"{listed.file}: {key}: {what}; {remedy}", need is None


def check(arguments, update):
    now, structs = versions(), Declared().structs
    faults = []
    for file, found in built(arguments).items():
        listed = List(file)
        for key, words, may_be_listed in list(differences(listed, found, now, structs)):
            if not update or not may_be_listed:
                faults.append(words)
            elif found.get(key) is None:
                del listed.lines[key]
                listed.new.discard(key)
            else:
                if listed.released and key not in listed.lines:
                    listed.new.add(key)
                listed.lines[key] = found[key]
        if update:
            listed.write()
    print("\n".join(faults))
    return 1 if faults else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("check", "update"):
        command = commands.add_parser(name)
        for option in ("facts", "library", "c-library"):
            command.add_argument(f"--{option}", required=True)
    commands.add_parser("release")
    commands.add_parser("facts").add_argument("file", type=Path)
    arguments = parser.parse_args()
    if arguments.command == "facts":
        arguments.file.write_text(facts_program())
    elif arguments.command == "release":
        for file in LISTS:
            listed = List(file)
            listed.released, listed.new = versions(), set()
            listed.write()
    else:
        return check(arguments, arguments.command == "update")
    return 0


if __name__ == "__main__":
    sys.exit(main())
