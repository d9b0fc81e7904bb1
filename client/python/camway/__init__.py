# SPDX-License-Identifier: MIT
"""Camera paths through keyframes, proved free of collision: the client of Camway's daemon, and planning itself.

Lengths are metres, angles radians, times seconds. Quaternions are w, x, y, z and rotate camera to world; the camera
looks down -Z, with +Y up. docs/python.md has examples.
"""
from camway import _errors, _native, _types

_native.load_classes(_types, _errors)

from camway._client import Client  # noqa: E402
from camway._errors import (  # noqa: E402
    BadAnswer,
    Busy,
    Cancelled,
    Error,
    InternalError,
    InvalidRequest,
    LimitExceeded,
    Malformed,
    NetworkUnusable,
    NoAnswer,
    NoDaemon,
    NoMap,
    OldScene,
    Overloaded,
    Stopping,
    Timeout,
    UnknownScene,
    Unreachable,
)
from camway._native import Path, __version__  # noqa: E402
from camway._pending import PendingPlan  # noqa: E402
from camway._planning import CamwayWarning, Check, Scene, check, plan  # noqa: E402
from camway._types import *  # noqa: E402, F403
from camway._types import __all__ as _data  # noqa: E402
from camway._watch import Watch  # noqa: E402

__all__ = [
    "BadAnswer", "Busy", "CamwayWarning", "Cancelled", "Check", "Client", "Error", "InternalError", "InvalidRequest",
    "LimitExceeded", "Malformed", "NetworkUnusable", "NoAnswer", "NoDaemon", "NoMap", "OldScene", "Overloaded", "Path",
    "PendingPlan", "Scene", "Stopping", "Timeout", "UnknownScene", "Unreachable", "Watch", "__version__", "check",
    "plan",
]
__all__ += _data
