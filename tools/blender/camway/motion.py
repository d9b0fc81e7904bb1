# SPDX-License-Identifier: MIT
"""Poses, and paths as Camway sends them: Bézier segments. Needs no Blender.

Positions are in metres, orientations unit quaternions (w, x, y, z), camera to world, times in seconds.
"""
from __future__ import annotations

import bisect
import math
from typing import NamedTuple, Sequence

Vector = tuple[float, ...]


class Pose(NamedTuple):
    """Where a camera is and how it is turned."""
    position: Vector
    orientation: Vector


class Sample(NamedTuple):
    """The pose of the artist's camera at a frame, which need not be whole."""
    frame: float
    pose: Pose


class Difference(NamedTuple):
    """How far two poses are apart, or the largest such distance along a path."""
    distance_m: float = 0.0
    angle_deg: float = 0.0

    def with_largest(self, other: Difference) -> Difference:
        """Returns the larger of the two, member by member."""
        return Difference(max(self.distance_m, other.distance_m), max(self.angle_deg, other.angle_deg))

    def share_of(self, limit: Difference) -> float:
        """Returns the difference as a multiple of `limit`: above 1 if a member exceeds its limit."""
        return max(self.distance_m / limit.distance_m, self.angle_deg / limit.angle_deg)


def turn_deg(a: Sequence[float], b: Sequence[float]) -> float:
    """Returns the angle of the shorter turn between two orientations. Accurate for small angles, too."""
    sign = 1.0 if sum(x * y for x, y in zip(a, b)) >= 0.0 else -1.0
    return math.degrees(4.0 * math.atan2(math.hypot(*(x - sign * y for x, y in zip(a, b))),
                                         math.hypot(*(x + sign * y for x, y in zip(a, b)))))


def difference_of(a: Pose, b: Pose) -> Difference:
    return Difference(math.dist(a.position, b.position), turn_deg(a.orientation, b.orientation))


def bezier(points: Sequence[Sequence[float]], u: float) -> Vector:
    """Evaluates a Bézier curve of any degree by de Casteljau's algorithm."""
    while len(points) > 1:
        points = [tuple((1.0 - u) * a + u * b for a, b in zip(p, q)) for p, q in zip(points, points[1:])]
    return tuple(points[0])


class Path:
    """The path of an answer or of a check: its `segments`, in order of time."""

    def __init__(self, segments: Sequence[dict]):
        if not segments:
            raise ValueError("a path needs a segment")
        self.segments = segments
        self._begins = [segment["t0"] for segment in segments]

    @property
    def begin_s(self) -> float:
        return self.segments[0]["t0"]

    @property
    def end_s(self) -> float:
        return self.segments[-1]["t1"]

    def pose(self, time_s: float) -> Pose:
        """Returns the pose at a time, which is clamped to the path."""
        index = max(0, bisect.bisect_right(self._begins, time_s) - 1)
        segment = self.segments[index]
        duration_s = segment["t1"] - segment["t0"]
        u = min(1.0, max(0.0, (time_s - segment["t0"]) / duration_s))
        four = bezier(segment["orientation"], u)
        length = math.hypot(*four)
        return Pose(bezier(segment["position"], u), tuple(x / length for x in four))


def jumps(samples: Sequence[Sample], limit: Difference) -> list[float]:
    """Returns the frames at which the camera jumps, as at a cut.

    A jump is a step that is ten times as large as both of its neighbours, and exceeds `limit`.
    """
    much = 10.0
    steps = [difference_of(a.pose, b.pose).share_of(limit) for a, b in zip(samples, samples[1:])]
    padded = [0.0, *steps, 0.0]
    return [samples[i + 1].frame for i, step in enumerate(steps)
            if step > 1.0 + much * max(padded[i], padded[i + 2])]
