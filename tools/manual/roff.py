# SPDX-License-Identifier: MIT
"""Text in roff's language, by the macros of man(7)."""

import re


def escaped(text):
    """Plain text: every character stands for itself, also in a copy from the page."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga")
    return text.replace("^", "\\(ha").replace("~", "\\(ti")


def line(text):
    """A line of text, which must not begin like a request of roff."""
    return "\\&" + text if text.startswith(".") else text


def prose(text):
    """A sentence or more, in which `words` between backticks are bold."""
    parts = re.split(r"`([^`\n]+)`", text)
    return line("".join(f"\\fB{escaped(part)}\\fR" if place % 2 else escaped(part) for place, part in enumerate(parts)))


def bold(text):
    return f"\\fB{escaped(text)}\\fR"


def italic(text):
    return f"\\fI{escaped(text)}\\fR"


def verbatim(lines):
    """Lines that are set as they are."""
    return [".PP", ".nf", ".RS 4", *(line(escaped(text)) for text in lines), ".RE", ".fi"]


def page(title, section, date, version, manual):
    """The head of a page."""
    return [f'.TH "{escaped(title)}" {section} "{date}" "{escaped(version)}" "{manual}"', ".nh", ".ad l"]
