# SPDX-License-Identifier: MIT
"""Reads structs and enumerations, with their comments, from the public headers of the C++ client."""
import dataclasses
import re

#: Names in Python that differ from those in C++.
_RENAMED = {"PlanRequest": "Request", "PlanResponse": "Answer"}


def snake(name):
    """Returns "go_round" for "kGoRound"."""
    return re.sub(r"(?<=.)(?=[A-Z])", "_", name[1:]).lower()


def python_name(cpp_name):
    parts = [_RENAMED.get(part, part) for part in cpp_name.split("::")]
    return "".join(parts)


@dataclasses.dataclass
class Member:
    type: str  # of C++
    name: str
    default: str  # of C++; empty if there is none
    doc: str


@dataclasses.dataclass
class Struct:
    cpp_name: str
    doc: str
    members: list

    @property
    def name(self):
        return self.cpp_name

    @property
    def python_name(self):
        return python_name(self.cpp_name)


@dataclasses.dataclass
class Enum:
    cpp_name: str
    doc: str
    values: list
    docs: list

    @property
    def python_name(self):
        return python_name(self.cpp_name)

    @property
    def python_values(self):
        return [snake(value) for value in self.values]

    @property
    def python_docs(self):
        return list(zip(self.python_values, self.docs))


def _closing(text, position):
    """Returns the position after the brace that closes the one at `position`; ignores comments."""
    depth = 0
    while position < len(text):
        if text.startswith("//", position):
            position = text.index("\n", position)
        elif text[position] == "{":
            depth += 1
        elif text[position] == "}":
            depth -= 1
            if depth == 0:
                return position + 1
        position += 1
    raise ValueError("a brace is not closed")


def _statements(text):
    """Yields the statements of a struct or namespace: their comment and their text."""
    doc, position = [], 0
    while position < len(text):
        if text[position].isspace():
            position += 1
        elif text.startswith("//", position):
            end = text.find("\n", position)
            line = text[position:end]
            # Another comment ends the documentation before it.
            doc = doc + [line[3:]] if line.startswith("///") else []
            position = end
        elif text[position] == "#":
            position = text.find("\n", position)
        else:
            end = _end_of_statement(text, position)
            trailing, after = _trailing_comment(text, end)
            yield "\n".join(doc + trailing), text[position:end]
            doc, position = [], after


def _end_of_statement(text, position):
    begin = position
    while position < len(text):
        if text.startswith("//", position):
            position = text.index("\n", position)
        elif text[position] == ";":
            return position + 1
        elif text[position] == "{":
            head = text[begin:position]
            position = _closing(text, position)
            is_function = "(" in head and "=" not in head.split("(")[0]
            if is_function or head.startswith("namespace"):
                return position
            continue
        elif text.startswith(("public:", "private:"), position):
            return text.index(":", position) + 1
        position += 1
    return position


def _trailing_comment(text, position):
    match = re.compile(r"[ \t]*///<(.*)\n").match(text, position)
    return ([match.group(1)], match.end()) if match else ([], position)


def _read_enum(doc, name, body, enums):
    values, docs = [], []
    pending = []
    for line in body.splitlines():
        line = line.strip()
        if line.startswith("///"):
            pending.append(line[3:].lstrip("<"))
            continue
        for value in re.findall(r"\bk\w+", re.sub(r"\s*///.*", "", line)):
            values.append(value)
            docs.append(" ".join(pending).strip())
            pending = []
        trailing = re.search(r"///<(.*)", line)
        if trailing and docs:
            docs[-1] = (docs[-1] + " " + trailing.group(1)).strip()
    enums.append(Enum(name, doc, values, docs))


_MEMBER = re.compile(r"(?P<type>[\w:<>, ]+?) (?P<name>\w+)(?: = (?P<default>.+)|(?P<braces> ?\{.*\}))?;")


def _read_struct(doc, name, body, structs, enums):
    struct = Struct(name, doc, [])
    for member_doc, text in _statements(body):
        # An enumeration or a struct inside, and perhaps a member of that type.
        inner = re.match(r"(enum class|struct) (\w+) \{", text)
        if inner:
            end = _closing(text, text.index("{"))
            inner_body = text[text.index("{") + 1:end - 1]
            inner_name = f"{name}::{inner.group(2)}"
            if inner.group(1) == "struct":
                _read_struct(member_doc, inner_name, inner_body, structs, enums)
            else:
                _read_enum(member_doc, inner_name, inner_body, enums)
            text = f"{inner.group(2)} {text[end:].strip()}"
            if text.endswith(f"{inner.group(2)} ;"):
                continue
        text = re.sub(r"\s+", " ", text)
        match = _MEMBER.fullmatch(text)
        if match and "(" not in match.group("type") and not text.startswith(("using ", "static ")):
            default = match.group("default") or (match.group("braces") or "").strip()
            struct.members.append(Member(match.group("type"), match.group("name"), default, member_doc))
    structs.append(struct)


def read(text, structs, enums):
    """Appends the structs and enumerations of a header, inner ones before those around them."""
    body = text[text.index("namespace camway {") + len("namespace camway {"):text.rindex("}  // namespace")]
    for doc, statement in _statements(body + "\n"):
        head = re.match(r"(enum class|struct) (\w+) \{", statement)
        if head:
            inner = statement[statement.index("{") + 1:_closing(statement, statement.index("{")) - 1]
            if head.group(1) == "struct":
                _read_struct(doc, head.group(2), inner, structs, enums)
            else:
                _read_enum(doc, head.group(2), inner, enums)
