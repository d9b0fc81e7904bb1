# SPDX-License-Identifier: MIT
"""The code blocks of a Markdown document, with the marks in front of them.

A mark is an HTML comment on a line of its own between the text and a block. These are known:

    <!-- not run: REASON -->               the block is shown, and not run
    <!-- run first: COMMAND -->            prepares what the block takes to be there
    <!-- interrupted after: COMMAND -->    the block's first command runs until this one has ended
    <!-- python before: STATEMENT -->      goes before the block's Python
"""
import dataclasses
import re

MARKS = ("not run", "run first", "interrupted after", "python before")
_MARK = re.compile(r"<!-- ([a-z ]+): (.*) -->$")
_LANGUAGES = {"py": "python", "c++": "cpp", "console": "shell", "sh": "shell", "bash": "shell",
              "js": "javascript"}


@dataclasses.dataclass
class Block:
    file: str
    line: int  # of the block's first line, from 1
    language: str  # of a fence; "" of an indented block
    text: str
    marks: dict

    def place(self):
        return f"{self.file}:{self.line}"

    def kind(self):
        """"shell", "json", "python", "javascript", "cpp", "toml", or whatever else the fence says; "" if unknown."""
        if self.language:
            return _LANGUAGES.get(self.language, self.language)
        if self.text.startswith("$ "):
            return "shell"
        if self.text.startswith(("{", "[{")):
            return "json"
        return "cpp" if self.text.startswith("#include") else ""

    def commands(self):
        """The commands of a shell session, each with the output that is shown below it."""
        found = []
        for line in self.text.replace("\\\n", "").splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            elif found:
                found[-1][1].append(line)
        return [(command, "\n".join(shown).strip()) for command, shown in found]


def blocks_of(file, text):
    """The blocks in their order. Raises ValueError for a mark that is unknown or before no block."""
    lines = text.splitlines()
    blocks, marks, at = [], {}, 0
    while at < len(lines):
        line = lines[at]
        mark = _MARK.match(line)
        if mark:
            if mark[1] not in MARKS:
                raise ValueError(f"{file}:{at + 1}: no such mark: {mark[1]}")
            marks[mark[1]] = mark[2]
        block, end = _block_at(file, lines, at, marks)
        if block:
            blocks.append(block)
        elif line and not mark and marks:
            raise ValueError(f"{file}:{at + 1}: a mark stands before no code block")
        if block:
            marks = {}
        at = end
    if marks:
        raise ValueError(f"{file}:{len(lines)}: a mark stands before no code block")
    return blocks


def _block_at(file, lines, at, marks):
    """The block that begins there, or nothing; and the line behind it."""
    fence = re.match(r" *```+ *([\w+]*)", lines[at])
    if fence:
        end = next((i for i in range(at + 1, len(lines)) if lines[i].strip().startswith("```")),
                   len(lines))
        text = "\n".join(lines[at + 1:end])
        return Block(file, at + 2, fence[1].lower(), text, marks), end + 1
    if not lines[at].startswith("    ") or (at > 0 and lines[at - 1].strip()):
        return None, at + 1
    end = at
    while end < len(lines) and (lines[end].startswith("    ") or not lines[end].strip()):
        end += 1
    text = "\n".join(line[4:] for line in lines[at:end]).rstrip()
    return Block(file, at + 1, "", text, marks), end
