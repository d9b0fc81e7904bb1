# SPDX-License-Identifier: MIT
"""Completions of a program for fish: a line for each flag of each command."""

_CODE = r"""
# Tests whether the words before the cursor are the command of a path: `__NAME_at scene load`.
function __NAME_at
    set -l path
    for word in (commandline -opc)[2..]
        if contains -- (string join ' ' -- $path $word) $__NAME_paths
            set -a path $word
        end
    end
    test "$path" = "$argv"
end

complete -c NAME -f
"""


def _quoted(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def _line(program, command, *words):
    below = command.path.split()[1:]
    return " ".join(["complete", "-c", program.name, "-n", _quoted(" ".join([f"__{program.name}_at", *below])), *words])


def _value(option):
    return {"choice": ["-x", "-a", _quoted(" ".join(option.choices))], "file": ["-r", "-F"], "named_file": ["-r", "-F"],
            "folder": ["-x", "-a", "'(__fish_complete_directories)'"], "any": ["-x"], "": []}[option.kind]


def _lines(program, command):
    for sub in command.commands:
        yield _line(program, command, "-a", sub.name, "-d", _quoted(sub.description))
    for option in command.flags:
        names = [word for name in option.names
                 for word in (("-l", name[2:]) if name.startswith("--") else ("-s", name[1:]))]
        yield _line(program, command, *names, *_value(option), "-d", _quoted(option.short_description))
    for option in command.positionals[:1]:
        if option.kind in ("file", "folder", "named_file"):
            yield _line(program, command, "-F")


def fish_completion(program):
    paths = [command.path.split(" ", 1)[1] for command in program.all() if " " in command.path]
    head = f"# Completions of {program.name} for fish. Made from its help: do not edit.\n\n"
    table = f"set -g __{program.name}_paths {' '.join(_quoted(path) for path in paths)}\n"
    lines = [line for command in program.all() for line in _lines(program, command)]
    return head + table + _CODE.replace("NAME", program.name) + "\n".join(lines) + "\n"
