#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the types on which C++ and Python must agree, from the public headers of the C++ client.

    generate_types.py --headers FOLDER --python _types.py --cpp described.h

Each struct of the headers becomes a data class with the same members, defaults and comments, and a
table of its members for the module in C++. Each enumeration becomes a set of strings. So Python has
the members of C++, and a member that is added there is here as well.
"""
import argparse
import pathlib
import textwrap

import header_parser
import python_types

_HEADERS = ("status", "path", "body", "constraints", "correction", "plan", "daemon_status", "occupancy",
            "scene", "watch", "client")


def read_headers(folder):
    structs, enums = [], []
    for name in _HEADERS:
        text = (pathlib.Path(folder) / f"{name}.h").read_text()
        header_parser.read(text, structs, enums)
    skipped = python_types.SKIPPED_STRUCTS | set(python_types.ROWS)
    # DaemonStatus has a list of SceneInfo, so a class may name one that follows: annotations are texts.
    return [struct for struct in structs if struct.name not in skipped], enums


def python_text(structs, enums):
    parts = [python_types.PREAMBLE]
    for enum in enums:
        names = ", ".join(f'"{name}"' for name in enum.python_values)
        doc = python_types.doc_in_python(enum.doc)
        values = [f"{name}: {python_types.doc_in_python(text)}" for name, text in enum.python_docs if text]
        lines = textwrap.wrap(doc, 98) + [line for value in values for line in
                                         textwrap.wrap(f"- {value}", 98, subsequent_indent="  ")]
        parts.append("\n".join(f"#: {line}" for line in lines))
        parts.append(f"{enum.python_name}: TypeAlias = Literal[{names}]\n")
    parts.append("")
    for struct in structs:
        parts.append(python_types.data_class(struct))
    parts.append(python_types.epilogue(structs, enums))
    return "\n".join(parts)


def cpp_text(structs, enums):
    lines = ["// SPDX-License-Identifier: MIT", "// Written by client/python/generate_types.py.",
             "#pragma once", "", "#include <camway/client.h>", "", "#include <array>", "#include <tuple>",
             "#include <utility>", "", "namespace camway::python {", "",
             "template <class Struct>", "struct Described;", "template <class Enum>", "struct Names;", ""]
    for enum in enums:
        values = ", ".join(f'std::pair{{{enum.cpp_name}::{value}, "{name}"}}'
                           for value, name in zip(enum.values, enum.python_values))
        lines += [f"template <>", f"struct Names<{enum.cpp_name}> {{",
                  f"  static constexpr std::array kValues = {{{values}}};", "};", ""]
    for struct in structs:
        names = ", ".join(f'"{member.name}"' for member in struct.members)
        visits = " ".join(f"visit({i}, value.{member.name});" for i, member in enumerate(struct.members))
        lines += ["template <>", f"struct Described<{struct.cpp_name}> {{",
                  f'  static constexpr const char* kName = "{struct.python_name}";',
                  f"  static constexpr bool kIsLazy = {str(struct.name in python_types.LAZY).lower()};",
                  f"  static constexpr std::array<const char*, {len(struct.members)}> kMembers = {{{names}}};",
                  "  template <class Visit, class Struct>",
                  "  static void visit_members(const Visit& visit, Struct& value) {",
                  f"    {visits}", "  }", "};", ""]
    types = ", ".join(struct.cpp_name for struct in structs)
    lines += [f"using DescribedTypes = std::tuple<{types}>;", "", "}  // namespace camway::python", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--headers", required=True)
    parser.add_argument("--python", required=True)
    parser.add_argument("--cpp", required=True)
    arguments = parser.parse_args()
    structs, enums = read_headers(arguments.headers)
    for file, text in ((arguments.python, python_text(structs, enums)), (arguments.cpp, cpp_text(structs, enums))):
        pathlib.Path(file).parent.mkdir(parents=True, exist_ok=True)
        pathlib.Path(file).write_text(text)


if __name__ == "__main__":
    main()
