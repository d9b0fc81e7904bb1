# SPDX-License-Identifier: MIT
"""A shell on a terminal of its own, in which a test types as a user does."""

import os
import pty
import re
import select
import signal
import time

_LONGEST_S = 60.0        # a bound for machines under load, not a measure
_MARK = "ready-to-type"


class TypedShell:
    """Runs `command` in `folder`, and `setup` in it. A shell's prompt must be empty."""

    def __init__(self, command, setup, folder, environment):
        self._process, self._terminal = pty.fork()
        if self._process == 0:
            os.chdir(folder)
            os.execvpe(command[0], command, {**os.environ, **environment, "TERM": "dumb", "COLUMNS": "200"})
        # The mark is put together by the shell, so that its echo is not taken for it.
        self._send(f"{setup}\necho ready-''to-type\n")
        self._read_until(_MARK + "\r\n")

    def completed(self, text, end):
        """Types `text` and a tab, until the line ends with `end`; returns what the terminal showed."""
        self._send(text + "\t")
        shown = self._read_until(end)
        self._send("\x15")  # clears the line
        return shown

    def _send(self, text):
        os.write(self._terminal, text.encode())

    def _read_until(self, end):
        shown, latest = "", time.monotonic() + _LONGEST_S
        while end not in re.sub(r"[\a\b]", "", shown):
            if time.monotonic() > latest or not select.select([self._terminal], [], [], 1.0)[0]:
                if time.monotonic() > latest:
                    raise TimeoutError(f"'{end}' does not come; the terminal shows: {shown!r}")
                continue
            shown += os.read(self._terminal, 4096).decode(errors="replace")
        return shown

    def close(self):
        os.kill(self._process, signal.SIGKILL)
        os.waitpid(self._process, 0)
        os.close(self._terminal)
