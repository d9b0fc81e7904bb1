# SPDX-License-Identifier: MIT
"""The page camwayd.toml(5), made of the sample configuration: its comments are the text."""

import re

from roff import bold, escaped, italic, line, page, prose, verbatim

_SCENE_KEY = re.compile(r"([a-z_]+): (.*)")


def _blocks(text):
    """Pairs of the comment lines and the `key = value` lines that follow them, by table."""
    table, comment, keys = "", [], []
    for row in [*text.splitlines(), "[end]"]:
        if row.startswith("#") and not re.match(r"# [a-z_]+ = ", row):
            if keys:
                yield table, comment, keys
                comment, keys = [], []
            comment.append(row[2:] if row != "#" else "")
        elif row.startswith("["):
            if keys or (comment and not table):
                yield table, comment, keys
                comment, keys = [], []
            table = row
        elif row:
            keys.append(row.removeprefix("# "))


def _paragraphs(comment):
    """Prose, and lines that are indented as they are."""
    lines, words = [], []
    for row in [*comment, ""]:
        if row.startswith("    "):
            if words:
                lines += [prose(" ".join(words))]
                words = []
            lines += verbatim([row.strip()])
        elif row:
            words.append(row)
        elif words:
            lines += [".PP", prose(" ".join(words))]
            words = []
    return lines


def _entry(comment, keys):
    """A list entry: the keys, then their text."""
    lines = []
    for place, key in enumerate(keys):
        name, _, value = key.partition(" = ")
        lines += [".TQ" if place else ".TP", f"{bold(name)} = {escaped(value)}"]
    return lines + [prose(" ".join(comment))] if comment else lines


def _scene(comment, keys):
    """List entries of [[scene]], whose text has a line for each key."""
    values = dict(key.split(" = ", 1) for key in keys)
    about, name = [], None
    texts = {}
    for row in comment:
        found = _SCENE_KEY.match(row)
        if found and found[1] in values:
            name = found[1]
            texts[name] = [found[2]]
        elif row:
            (texts[name] if name else about).append(row.strip())
    lines = [prose(" ".join(about))] if about else []
    for name, value in values.items():
        lines += _entry(texts.get(name, []), [f"{name} = {value}"])
    return lines


def configuration_page(sample, date, version):
    """The lines of the page. `sample` is the text of camwayd.toml."""
    lines = page("CAMWAYD.TOML", 5, date, version, "File Formats")
    lines += [".SH NAME", f"camwayd.toml \\- configuration of {bold('camwayd')}(8)", ".SH SYNOPSIS",
              italic("/etc/camway/camwayd.toml"), ".SH DESCRIPTION"]
    last = ""
    for table, comment, keys in _blocks(sample):
        if not table:
            lines += _paragraphs([row for row in comment if "SPDX" not in row])
            lines += [".SH TABLES"]
            continue
        if table != last:
            lines.append(f'.SS "{line(escaped(table))}"')
        lines += _scene(comment, keys) if table.startswith("[[") else _entry(comment, keys)
        last = table
    return lines + [".SH SEE ALSO", f"{bold('camwayd')}(8)"]
