# SPDX-License-Identifier: MIT
"""Errors: one class for each status of C++ that is no result. Their texts are those of C++."""
from __future__ import annotations

import re
from typing import Any

# Before the field there may be the status and the document: "invalid: ", "request: ", "out/r.json: ".
_FIELD = re.compile(r"(?:^|(?<=: ))([a-z_]+(?:\[\d+\])*(?:\.[a-z_0-9]+(?:\[\d+\])*)*): ")
_NO_FIELD = re.compile(r"^(?:invalid|warning|request|answer)$|\.json$")

#: Statuses of a plan whose answer is a result.
RESULTS = frozenset({"ok", "partial", "infeasible"})


class Error(Exception):
    """A call that failed. The text names the failure and its remedy.

    Attributes:
        status: name of the status in C++, such as "unknown_scene"
        answer: the whole answer, where there is one
    """

    status: str = "internal_error"

    def __init__(self, text: str, answer: Any = None) -> None:
        super().__init__(text)
        self.answer = answer


class InvalidRequest(Error, ValueError):
    """The request is wrong. `answer.keyframe_faults` has the keyframes that collide.

    Attributes:
        field: the member at fault, as the text names it: "keyframes[1].orientation_wxyz"; None if the text
            names none
    """

    status = "invalid"

    def __init__(self, text: str, answer: Any = None) -> None:
        super().__init__(text, answer)
        names = [match.group(1) for match in _FIELD.finditer(text)]
        self.field: str | None = next((name for name in names if not _NO_FIELD.search(name)), None)


class Timeout(Error, TimeoutError):
    """The deadline came first. `answer.path` is the best path so far, if there is one."""

    status = "timeout"


class UnknownScene(Error, LookupError):
    """The daemon holds no scene of this name."""

    status = "unknown_scene"


class InternalError(Error):
    """A fault of Camway itself."""

    status = "internal_error"


class Overloaded(Error):
    """The daemon's queue stayed full until the call's deadline."""

    status = "overloaded"


class Malformed(Error):
    """The daemon could not read the request: client and daemon do not match."""

    status = "malformed"


class NoMap(Error):
    """The scene was loaded without an occupancy map."""

    status = "no_map"


class Cancelled(Error):
    """The caller cancelled the request."""

    status = "cancelled"


class LimitExceeded(Error):
    """The request would exceed a limit, which the text names."""

    status = "limit"


class OldScene(Error):
    """The daemon holds an older revision of the scene than `Request.least_revision`."""

    status = "old_scene"


class Unreachable(Error, ConnectionError):
    """No answer of a daemon came: the base of the five that follow."""

    status = "no_answer"


class Stopping(Unreachable):
    """The daemon stopped before it changed anything, and no other daemon was heard."""

    status = "stopping"


class NoDaemon(Unreachable):
    """No answer came, and no daemon was heard."""

    status = "no_daemon"


class NoAnswer(Unreachable):
    """A daemon was heard, but its answer did not come completely."""

    status = "no_answer"


class NetworkUnusable(Unreachable):
    """LCM cannot be opened or cannot send."""

    status = "network_unusable"


class BadAnswer(Unreachable):
    """The answer cannot be read: client and daemon do not match."""

    status = "bad_answer"


class Busy(Error):
    """A call that waits was made in a handler of the same client."""

    status = "busy"


_CLASSES: dict[str, type[Error]] = {
    each.status: each
    for each in (InvalidRequest, Timeout, UnknownScene, InternalError, Overloaded, Malformed, NoMap, Cancelled,
                 LimitExceeded, OldScene, Stopping, NoDaemon, NoAnswer, NetworkUnusable, BadAnswer, Busy)
}


def error_of(status: str, text: str, answer: Any = None) -> Error:
    """Returns the error of a status."""
    return _CLASSES.get(status, Error)(text, answer)


def checked(answer: Any) -> Any:
    """Returns an answer that is a result; raises the error of any other status."""
    if answer.status in RESULTS:
        return answer
    raise error_of(answer.status, answer.error, answer)
