# SPDX-License-Identifier: MIT
"""Pages of the manual for programs and their commands."""

import re

from roff import bold, escaped, italic, page, prose, verbatim

_SUMMARIES = {"camway": "smooth camera paths through keyframes, corrected until free of collision",
              "camwayd": "daemon that plans camera paths free of collision, over LCM"}


def file_name(command):
    return command.path.replace(" ", "-")


def _reference(name, section):
    return f"{bold(name)}({section})"


def _value(option):
    # A long form may be broken where a part of it ends.
    form = italic(option.form).replace("][", "]\\:[") if option.form else ""
    if option.choices:
        return escaped("{") + (escaped("|") + "\\:").join(bold(word) for word in option.choices) + escaped("}")
    return form + (" ..." if option.repeats and option.form else "")


def _synopsis(command):
    words = [bold(command.path), escaped("[") + italic("OPTIONS") + escaped("]")]
    if command.commands:
        words.append(italic("COMMAND"))
    for option in command.positionals:
        word = italic(option.word) + (" ..." if option.repeats else "")
        words.append(word if option.required else f"[{word}]")
    return [" ".join(words)]


def _remarks(option):
    """Yields the remarks beside the description of an option: range, default, other flags."""
    if option.required and option.names:
        yield "Required."
    if option.check and not option.choices:
        yield f"Values: {option.check}."
    if option.default:
        yield f"Default: {option.default}."
    if option.needs:
        yield f"Needs {', '.join(f'`{name}`' for name in option.needs)}."
    if option.excludes:
        yield f"Not with {', '.join(f'`{name}`' for name in option.excludes)}."


def _option(option):
    head = ", ".join(bold(name) for name in option.names) if option.names else italic(option.word)
    if option.names and option.form:
        head += " " + _value(option)
    description = option.description.rstrip(".")
    yield ".TP"
    yield head
    yield prose(" ".join([description + ".", *_remarks(option)]))


def _options(options):
    for option in options:
        yield from _option(option)


def _groups(command):
    """Options by group, the usual one first."""
    groups = {"Options": []}
    for option in command.flags:
        groups.setdefault(option.group, []).append(option)
    return groups


def _footer(command):
    """Divides the text under the help into description, exit codes and examples."""
    text, codes, examples = [], [], []
    # A line that does not end a sentence goes on in the next.
    for line in re.sub(r"([^.\n])\n(?!Example: |Exit codes: )", r"\1 ", command.footer).split("\n"):
        if line.startswith("Exit codes: "):
            codes = re.split(r"[;,] (?=\d )", line.removeprefix("Exit codes: ").rstrip("."))
        elif line.startswith("Example: "):
            examples.append(line.removeprefix("Example: "))
        elif line:
            text.append(line)
    return text, codes, examples


def _sections(command, heading=".SH"):
    if command.positionals:
        yield f"{heading} ARGUMENTS"
        yield from _options(command.positionals)
    for group, options in _groups(command).items():
        if options:
            yield f'{heading} "{escaped(group.rstrip(":")).upper() if heading == ".SH" else escaped(group)}"'
            yield from _options(options)


def _subcommands(command):
    """Yields the commands below a command: those of `camway` have pages of their own, others stand in its page."""
    yield ".SH COMMANDS"
    if " " not in command.path:
        for sub in command.commands:
            yield from [".TP", _reference(file_name(sub), 1), prose(sub.description + ".")]
        return
    for sub in command.commands:
        yield f'.SS "{escaped(sub.path)}"'
        yield from _synopsis(sub)
        yield ".PP"
        yield prose(sub.description + ".")
        yield from _options(sub.positionals)
        yield from _options(option for option in sub.flags if "--help" not in option.names)


def _see_also(command, section):
    if command.path == "camwayd":
        return [(name, number) for name, number in (("camway", 1), ("camwayd.toml", 5), ("systemctl", 1))]
    if command.path == "camway":
        return [("camwayd", 8)]
    return [("camway", 1), ("camwayd", 8)]


def command_page(command, section, date, version):
    """The lines of the page of a command."""
    text, codes, examples = _footer(command)
    manual = "System Administration" if section == 8 else "User Commands"
    summary = _SUMMARIES.get(command.path, command.description)
    lines = page(file_name(command).upper(), section, date, version, manual)
    lines += [".SH NAME", f"{escaped(file_name(command))} \\- {escaped(summary[0].lower() + summary[1:])}"]
    lines += [".SH SYNOPSIS", *_synopsis(command), ".SH DESCRIPTION", prose(command.description + ".")]
    for paragraph in text:
        lines += [".PP", prose(paragraph)]
    lines += _sections(command)
    if command.commands:
        lines += _subcommands(command)
    if codes:
        lines.append(".SH EXIT STATUS")
        for code in codes:
            number, _, meaning = code.partition(" ")
            lines += [".TP", bold(number), prose(meaning + ".")]
    if examples:
        lines += [".SH EXAMPLES", *verbatim(examples)[1:]]
    lines += [".SH SEE ALSO", ", ".join(_reference(*entry) for entry in _see_also(command, section))]
    lines += [".PP", "The documents of Camway are in " + italic("/usr/share/doc/camway") + " (package camway\\-doc)."]
    return lines


def import_page(name, formats, date, version):
    """The page of a program that others start."""
    return [
        *page(name.upper(), 8, date, version, "System Administration"),
        ".SH NAME", f"{escaped(name)} \\- reads scene files for camway and camwayd",
        ".SH SYNOPSIS", f"{bold(name)} {italic('FILE')} {italic('MEMORY_BYTES')} {italic('CPU_SECONDS')}",
        ".SH DESCRIPTION",
        prose(f"Reads a scene file ({formats}) in a confined process and writes what is in it, in a form of its "
              "own, to its standard output. `camway` and `camwayd` start it for each file, so that a damaged file "
              "cannot harm them. It is not meant to be called by hand: `camway info --scene FILE` shows what a "
              "file holds."),
        ".SH SEE ALSO", f"{_reference('camway', 1)}, {_reference('camwayd', 8)}"]
