# SPDX-License-Identifier: MIT
"""What an answer says, in frames. Needs no Blender."""
from __future__ import annotations

import math
import re
from typing import NamedTuple, Sequence

from .motion import Difference, Path, difference_of
from .request import Shot
from .run import plain


# A path that comes back to the artist's for less than this goes on being corrected.
_SAME_STRETCH_S = 0.25


# How messages name keyframes: by their place in the request, counted from 0.
_KEYFRAME = re.compile(r"\bkeyframes\[(\d+)\]|\bkeyframe (\d+)\b")


class Collision(NamedTuple):
    """A stretch of the artist's path that collides, or a keyframe of it."""
    begin: float
    end: float
    thing: str
    words: str


class Stretch(NamedTuple):
    """A stretch, in frames, in which the path is another one than the artist's."""
    begin: float
    end: float
    largest: Difference

    @property
    def words(self) -> str:
        return words_of(self.largest)


def length_words(metres: float) -> str:
    """Returns a length in the unit that suits it: "12 mm", "1.9 m"."""
    for unit, size in (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6)):
        if metres >= 0.9995 * size:
            return f"{metres / size:.3g} {unit}"
    return "0 mm" if metres < 1e-9 else f"{metres / 1e-9:.3g} nm"


def words_of(difference: Difference) -> str:
    """Returns "12 mm, 0.3°", without what is too small to see."""
    words = [length_words(difference.distance_m)]
    if difference.angle_deg >= 0.005:
        words.append(f"{difference.angle_deg:.2g}°")
    return ", ".join(words)


def frame_words(frame: float) -> str:
    return f"{frame:.0f}" if abs(frame - round(frame)) < 0.01 else f"{frame:.1f}"


class Answer:
    """The answer of `camway plan` to a request with keyframes at `frames`."""

    def __init__(self, shot: Shot, frames: Sequence[float], request: dict, content: dict):
        self.shot, self.frames, self.request, self.content = shot, frames, request, content
        self.status: str = content["status"]
        self.path = Path(content["segments"]) if content["segments"] else None
        self.clearance_m: float = content["certificate"]["clearance_lower_bound"]
        self.is_certified: bool = content["certificate"]["certified"]

    @property
    def has_path(self) -> bool:
        """Whether there is a path to show: without `infeasible`, which only repeats the request's path."""
        return self.path is not None and self.status in ("ok", "partial", "timeout")

    @property
    def faulty_frames(self) -> list[float]:
        """The frames of given keyframes that collide and were not repaired: of the artist's keys, if there are."""
        if self.status != "invalid":
            return []
        frames = [self.frames[fault["keyframe"]] for fault in self.content.get("keyframe_faults", [])]
        return [frame for frame in frames if frame in self._unmoved] or frames

    @property
    def _unmoved(self) -> set[float]:
        return self.shot.fixed | {self.frames[0], self.frames[-1]}

    @property
    def rank(self) -> int:
        """Returns how good the answer is, compared with others."""
        return ("internal_error", "invalid", "infeasible", "timeout", "partial", "ok").index(self.status)

    @property
    def is_final(self) -> bool:
        """Whether other sampled keyframes cannot help: the artist's own ones collide or are shut off."""
        if proof := self.content.get("infeasibility"):
            return all(self.frames[proof["keyframe_" + side]] in self._unmoved for side in ("inside", "outside"))
        if self.status == "invalid":
            return not self.faulty_frames or set(self.faulty_frames) <= self._unmoved
        return self.status == "internal_error"

    @property
    def message(self) -> str:
        """Camway's own words, with keyframes named by their frames."""
        def by_frame(match: re.Match) -> str:
            index = int(match[1] or match[2])
            return f"keyframe at frame {frame_words(self.frames[index])}" if index < len(self.frames) else match[0]

        words = _KEYFRAME.sub(by_frame, plain(self.content["message"]))
        if len(self.faulty_frames) > 1:
            words += "; all that collide: frames " + ", ".join(map(frame_words, self.faulty_frames))
        return words

    def frame_of_keyframes(self, origin: str) -> list[float]:
        """Returns the frames of keyframes that were `given` or `inserted`."""
        return [self.shot.frame_at(k["time"]) for k in self.content["keyframes"] if k["origin"] == origin]

    def remaining(self) -> list[Collision]:
        return collisions_of(self.shot, self.content["remaining_collisions"], "remains")

    def warnings(self) -> list[str]:
        """Returns what else the answer says that a user has to know."""
        words = list(self.content.get("warnings", []))
        if "time_scale" in self.content:
            words.append("the path is slowed; an animated lens keeps its times")
        if self.content.get("deadline_reached"):
            words.append("the deadline ended planning early")
        return words


def collisions_of(shot: Shot, intervals: Sequence[dict], word: str = "") -> list[Collision]:
    """Returns the collisions of an answer or of a check, in frames."""
    found = []
    for interval in intervals:
        witness = interval.get("witness", {})
        words = [f"{length_words(witness['depth_m'])} deep"] if witness.get("depth_m", 0.0) > 0.0 else []
        if witness.get("feature"):
            words.append(witness["feature"])
        if word:
            words.insert(0, word)
        found.append(Collision(shot.frame_at(interval["t_begin"]), shot.frame_at(interval["t_end"]),
                               witness.get("object", ""), ", ".join(words)))
    return found


def changed_stretches(answer: Answer) -> list[Stretch]:
    """Returns where the path is farther from the artist's than `shot.within`, compared at equal times.

    A slowed path is another one at equal times, so there Camway's own list of corrections counts.
    """
    shot, path = answer.shot, answer.path
    if "time_scale" in answer.content:
        return [Stretch(*map(shot.frame_at, c["changed"]), Difference(c["moved_m"], c["turned_deg"]))
                for c in answer.content["corrections"] if c["kind"] != "none"]
    stretches: list[Stretch] = []
    for sample in shot.samples:
        here = difference_of(sample.pose, path.pose(shot.time_s(sample.frame)))
        if here.share_of(shot.within) <= 1.0:
            continue
        if stretches and sample.frame - stretches[-1].end <= _SAME_STRETCH_S * shot.fps:
            begin, _, largest = stretches[-1]
            stretches[-1] = Stretch(begin, sample.frame, largest.with_largest(here))
        else:
            stretches.append(Stretch(sample.frame, sample.frame, here))
    return stretches


def whole_frames(shot: Shot, path: Path) -> list[float]:
    """Returns the frames to bake: the two ends of the path, and each whole frame between."""
    first, last = shot.frame_at(path.begin_s), shot.frame_at(path.end_s)
    near = 1e-3  # of a frame: an end that is a whole frame up to rounding
    inner = range(math.ceil(first + near), math.floor(last - near) + 1)
    ends = [round(f) if abs(f - round(f)) < near else f for f in (first, last)]
    return [float(ends[0]), *map(float, inner), float(ends[1])]
