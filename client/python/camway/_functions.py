# SPDX-License-Identifier: MIT
"""Functions of the classes of data, which `_types.py` has."""
from __future__ import annotations

import json
import math
import os
import pathlib
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from camway import _errors, _native

if TYPE_CHECKING:
    from camway import _types
    from camway._base import Vector

#: A JSON document: as text, or as `json.load` returns it.
Document: TypeAlias = "str | Mapping[str, Any]"


def text_of(document: Document) -> str:
    """Returns the text of a JSON document. Its numbers and lists may be NumPy's. Raises InvalidRequest for a number that
    JSON does not have."""
    if isinstance(document, str):
        return document
    try:
        return json.dumps(document, default=_plain, allow_nan=False)
    except ValueError as error:
        raise _errors.InvalidRequest(f"{_not_finite(document) or 'document'}: is not finite") from error


def _not_finite(value: Any, name: str = "") -> str | None:
    """Returns the name of the first number in a document that is not finite, such as "keyframes[1].position[0]"."""
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, float):
        return None if math.isfinite(value) else name
    parts: Iterable[tuple[str, Any]] = ()
    if isinstance(value, Mapping):
        parts = ((f"{name}.{key}" if name else str(key), part) for key, part in value.items())
    elif isinstance(value, (list, tuple)):
        parts = ((f"{name}[{i}]", part) for i, part in enumerate(value))
    return next((found for part, inside in parts if (found := _not_finite(inside, part)) is not None), None)


def _plain(value: Any) -> Any:
    """Returns a number or an array of NumPy as Python's."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"a document of JSON has no {type(value).__name__}")


def request_of(request: _types.Request | Mapping[str, Any]) -> _types.Request:
    """Returns the request of an argument that may be a dictionary as in request files."""
    if not isinstance(request, Mapping):
        return request
    from camway import _types

    return _types.Request.from_json(request)


def read_text(file: str | os.PathLike[str]) -> str:
    """Returns the text of a file."""
    return pathlib.Path(file).read_text(encoding="utf-8")


class OutcomeFunctions:
    """Functions of answers."""

    __slots__ = ()

    status: Any

    @property
    def ok(self) -> bool:
        """Whether the status is "ok"."""
        return bool(self.status == "ok")


class BodyFunctions:
    """Makers of bodies."""

    __slots__ = ()

    @staticmethod
    def box(size_m: Vector, center_m: Vector = (0.0, 0.0, 0.0)) -> _types.Body:
        """Returns a solid box along the camera's axes."""
        return _body("box", size_m=size_m, center_m=center_m)

    @staticmethod
    def sphere(radius_m: float, center_m: Vector = (0.0, 0.0, 0.0)) -> _types.Body:
        """Returns a solid ball."""
        return _body("sphere", radius_m=radius_m, center_m=center_m)

    @staticmethod
    def convex(pieces_m: Sequence[npt.ArrayLike]) -> _types.Body:
        """Returns the union of the convex hulls of sets of points."""
        return _body("convex", pieces_m=pieces_m)

    @staticmethod
    def mesh(vertices_m: npt.ArrayLike, triangles: npt.ArrayLike) -> _types.Body:
        """Returns a surface, which has no inside."""
        return _body("mesh", vertices_m=vertices_m, triangles=triangles)

    @staticmethod
    def solid_mesh(vertices_m: npt.ArrayLike, triangles: npt.ArrayLike) -> _types.Body:
        """Returns a closed surface and its inside. Each edge has two triangles, which run through it in
        opposite directions."""
        return _body("solid_mesh", vertices_m=vertices_m, triangles=triangles)


def _body(shape: _types.BodyShape, **members: Any) -> _types.Body:
    from camway import _types

    return _types.Body(shape=shape, **members)


class OrientationFunctions:
    """Makers of policies of orientation."""

    __slots__ = ()

    @staticmethod
    def keep() -> _types.Orientation:
        """Returns the policy that no correction turns the camera."""
        from camway import _types

        return _types.Orientation(policy="keep")

    @staticmethod
    def level(up: Vector) -> _types.Orientation:
        """Returns the policy that the horizon does not tilt."""
        from camway import _types

        return _types.Orientation(policy="level", up=up)

    @staticmethod
    def target(target_m: Vector, cone_rad: float = 0.0) -> _types.Orientation:
        """Returns the policy that the camera looks towards a point."""
        from camway import _types

        return _types.Orientation(policy="target", target_m=target_m, cone_rad=cone_rad)


class RequestFunctions:
    """JSON of requests, as docs/requests.md has it."""

    __slots__ = ()

    @staticmethod
    def from_json(document: Document, folder: str | os.PathLike[str] = ".") -> _types.Request:
        """Reads a request file. The mesh of a body is relative to `folder`. `scale`, `up`, `unknown` and
        `voxel_m` are not part of a request: `Scene.of_request` reads those. Raises InvalidRequest."""
        return _native.request_from_json(text_of(document), "request", os.fspath(folder))

    @staticmethod
    def load(file: str | os.PathLike[str]) -> _types.Request:
        """Reads a request file, as `from_json` does. Raises OSError for a file that cannot be read."""
        folder, name = os.path.split(os.fspath(file))
        return _native.request_from_json(read_text(file), name, folder)

    def to_json(self) -> dict[str, Any]:
        """Returns the request as a request file has it, without members that are for a daemon alone. Options that have
        their default are left out. Raises InvalidRequest for a request that is wrong."""
        made: dict[str, Any] = json.loads(_native.request_to_json(self))
        return made


class AnswerFunctions(OutcomeFunctions):
    """JSON of answers, as docs/answers.md has it."""

    __slots__ = ()

    @staticmethod
    def from_json(document: Document) -> _types.Answer:
        """Reads an answer file. Raises InvalidRequest for a document that is none."""
        return _native.answer_from_json(text_of(document), "answer")

    @staticmethod
    def load(file: str | os.PathLike[str]) -> _types.Answer:
        """Reads an answer file, as `from_json` does."""
        return _native.answer_from_json(read_text(file), os.fspath(file))

    def to_json(self, timing: bool = True) -> dict[str, Any]:
        """Returns the answer as an answer file has it."""
        made: dict[str, Any] = json.loads(_native.answer_to_json(self, timing))
        return made


class KeyframeFunctions:
    """Makers of keyframes."""

    __slots__ = ()

    @staticmethod
    def from_arrays(positions_m: npt.ArrayLike, orientations_wxyz: npt.ArrayLike | None = None,
                    times_s: npt.ArrayLike | None = None) -> list[_types.Keyframe]:
        """Returns a keyframe for each row of arrays: of three numbers, of four, and one time each. Without
        orientations, all look down -Z. Raises ValueError for arrays of another shape."""
        from camway import _types

        positions = _rows(positions_m, 3, "positions_m")
        count = len(positions)
        orientations = ([[1.0, 0.0, 0.0, 0.0]] * count if orientations_wxyz is None
                        else _rows(orientations_wxyz, 4, "orientations_wxyz"))
        times: list[float | None] = [None] * count if times_s is None else np.ravel(np.asarray(times_s, float)).tolist()
        for name, length in (("orientations_wxyz", len(orientations)), ("times_s", len(times))):
            if length != count:
                raise ValueError(f"{name}: are {length}, and there are {count} positions")
        return [_types.Keyframe(time_s, position_m, orientation)
                for time_s, position_m, orientation in zip(times, positions, orientations)]


def _rows(array: npt.ArrayLike, columns: int, name: str) -> list[list[float]]:
    """Returns the rows of an array of numbers. Raises ValueError for an array of another shape."""
    numbers = np.asarray(array, float)
    if numbers.ndim != 2 or numbers.shape[1] != columns:
        raise ValueError(f"{name}: must be an array of rows of {columns} numbers")
    rows: list[list[float]] = numbers.tolist()
    return rows


class PathKeyframeFunctions:
    """Functions of the keyframes of answers."""

    __slots__ = ()

    time_s: Any
    position_m: Any
    orientation_wxyz: Any
    image: Any

    def again(self) -> _types.Keyframe:
        """Returns the keyframe of a request for the same path (`Answer.frame`)."""
        from camway import _types

        return _types.Keyframe(self.time_s, self.position_m, self.orientation_wxyz, self.image)


class LatencyFunctions:
    """Functions of histograms."""

    __slots__ = ()

    def quantile_s(self, q: float) -> float:
        """Returns the upper bound of the bucket that holds the quantile `q`; 0 for an empty histogram."""
        return _native.latency_quantile_s(self, q)

    def since(self, before: _types.Latency) -> _types.Latency:
        """Returns the histogram of the durations that were added since `before`, an earlier state."""
        return _native.latency_since(self, before)


class SceneMeshFunctions:
    """Makers of meshes to upload."""

    __slots__ = ()

    @staticmethod
    def from_arrays(vertices_m: npt.ArrayLike, triangles: npt.ArrayLike) -> _types.SceneMesh:
        """Returns a mesh to upload: an array of points, and an array of triples of their indices. The daemon
        gets the same doubles. Raises ValueError for arrays of another shape."""
        from camway import _types

        points = np.ascontiguousarray(vertices_m, "<f8")
        corners = np.ascontiguousarray(triangles)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ValueError("vertices_m: must be an array of rows of 3 numbers")
        if not np.isfinite(points).all():
            raise ValueError(f"vertices_m[{np.argmin(np.isfinite(points).all(axis=1))}]: is not finite")
        if corners.ndim != 2 or corners.shape[1] != 3 or corners.dtype.kind not in "iu":
            raise ValueError("triangles: must be an array of rows of 3 numbers, all whole")
        if corners.size and not 0 <= corners.min() <= corners.max() < len(points):
            raise ValueError("triangles: must be indices of vertices, counted from 0")
        header = ("ply\nformat binary_little_endian 1.0\n"
                  f"element vertex {len(points)}\n"
                  "property double x\nproperty double y\nproperty double z\n"
                  f"element face {len(corners)}\nproperty list uchar int vertex_indices\nend_header\n")
        faces = np.empty(len(corners), np.dtype([("count", "u1"), ("corners", "<i4", (3,))]))
        faces["count"] = 3
        faces["corners"] = corners
        return _types.SceneMesh(bytes=header.encode() + points.tobytes() + faces.tobytes(), format="ply")
