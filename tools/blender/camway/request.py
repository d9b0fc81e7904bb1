# SPDX-License-Identifier: MIT
"""From the poses of a shot to a request for `camway plan`. Needs no Blender."""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Callable, Iterable, Iterator, NamedTuple, Sequence

from .motion import Difference, Path, Pose, Sample, difference_of, turn_deg

# A request takes the shorter turn between neighbouring keyframes. Beyond 180 degrees that is the wrong
# one, and well below it is hardly ever the artist's.
LARGEST_TURN_DEG = 120.0

# Each round halves the gaps that stray, or better, so that a gap of a thousand frames is cut into frames.
MOST_ROUNDS = 12


# Sampled keyframes this near to a collision are left out, to make room for its correction; tried in order.
MARGINS_S = (0.5, 2.0, math.inf)


class View(NamedTuple):
    """What the near plane of a camera spans: full angles, and the distance of the plane."""
    fov_x_deg: float
    fov_y_deg: float
    near_m: float

    @property
    def corner_m(self) -> float:
        """The distance of a corner of the near quadrilateral from the eye."""
        return self.near_m * math.hypot(1.0, *(math.tan(math.radians(angle) / 2.0) for angle in self[:2]))


def view_of(corners: Sequence[Sequence[float]], near_m: float) -> View:
    """Returns the least symmetric view that holds the corners of a picture, given in the camera's frame."""
    x, y = (2.0 * math.degrees(math.atan(max(abs(c[axis] / c[2]) for c in corners))) for axis in (0, 1))
    return View(x, y, near_m)


def widest(views: Iterable[View]) -> View:
    """Returns the view whose near quadrilateral has the largest angles and near distance of all."""
    return View(*(max(values) for values in zip(*views)))


@dataclass
class Shot:
    """A camera's motion, sampled, and what is asked of Camway. `fixed` holds the frames of keyframes that
    the path must meet: the artist's keys, and both ends."""
    samples: list[Sample]
    fixed: set[float]
    fps: float
    view: View
    body: dict | None = None
    options: dict = field(default_factory=dict)
    within: Difference = Difference(0.01, 1.0)

    @property
    def radius_m(self) -> float:
        """The distance of the farthest point of the body from the eye."""
        return self.body["radius_m"] if self.body else self.view.corner_m

    def time_s(self, frame: float) -> float:
        return (frame - self.samples[0].frame) / self.fps

    def frame_at(self, time_s: float) -> float:
        return self.samples[0].frame + time_s * self.fps


class Chosen(NamedTuple):
    """Keyframes, the path that Camway interpolates through them, and how far it strays from the shot."""
    keyframes: list[Sample]
    path: Path
    strays: Difference


def with_turns(shot: Shot, chosen: set[int], avoid: Callable[[float], bool] = lambda _: False) -> set[int]:
    """Adds samples to those chosen, so that no gap between neighbours turns by LARGEST_TURN_DEG.

    Frames to avoid, and frames that are not whole, are added only if the limit leaves no others.
    """
    samples, result = shot.samples, set(chosen)
    steps = [0.0, *(turn_deg(a.pose.orientation, b.pose.orientation)
                    for a, b in zip(samples, samples[1:]))]
    turned, candidate, rank = 0.0, None, -1
    for i in range(1, len(samples)):
        if turned + steps[i] > LARGEST_TURN_DEG and i - 1 not in result:
            cut = i - 1 if candidate is None else candidate
            result.add(cut)
            turned, candidate, rank = sum(steps[cut + 1:i]), None, -1
        turned += steps[i]
        frame = samples[i].frame
        if i in result:
            turned, candidate, rank = 0.0, None, -1
        elif (here := 2 * (not avoid(frame)) + frame.is_integer()) >= rank:
            candidate, rank = i, here
    return result


def _worst_of_gaps(shot: Shot, chosen: list[int], path: Path) -> tuple[Difference, list[int]]:
    """Returns how far the path strays, and of each gap that strays too far the sample to add."""
    strays, additions = Difference(), []
    for begin, end in zip(chosen, chosen[1:]):
        worst, share = None, 1.0
        for i in range(begin + 1, end):
            here = difference_of(shot.samples[i].pose, path.pose(shot.time_s(shot.samples[i].frame)))
            strays = strays.with_largest(here)
            if here.share_of(shot.within) > share:
                worst, share = i, here.share_of(shot.within)
        if worst is not None:
            additions.append(_whole_frame_near(shot, worst, begin, end))
    return strays, additions


def _whole_frame_near(shot: Shot, index: int, begin: int, end: int) -> int:
    """Returns the sample at a whole frame next to `index`, inside of the gap, or `index` if there is none."""
    for i in (index, index - 1, index + 1):
        if begin < i < end and shot.samples[i].frame.is_integer():
            return i
    return index


def choose_keyframes(shot: Shot, interpolate: Callable[[list[Sample]], Path]) -> Chosen:
    """Chooses the fewest samples, roughly, whose interpolation by Camway stays within `shot.within` of all.

    Begins with the fixed ones. `interpolate` returns the path that Camway makes of keyframes.
    """
    frames = {round(frame, 4) for frame in shot.fixed}
    chosen = {i for i, s in enumerate(shot.samples) if round(s.frame, 4) in frames}
    chosen = with_turns(shot, chosen | {0, len(shot.samples) - 1})
    best = None
    for _ in range(MOST_ROUNDS):
        order = sorted(chosen)
        path = interpolate([shot.samples[i] for i in order])
        strays, additions = _worst_of_gaps(shot, order, path)
        best = Chosen([shot.samples[i] for i in order], path, strays)
        if not additions:
            break
        chosen.update(additions)
    return best


def loosened(shot: Shot, keyframes: list[Sample], stretches: Sequence[tuple[float, float]], margin_s: float,
             keep_turns: bool = True) -> list[Sample]:
    """Returns the keyframes without those that are not fixed and lie in or near one of `stretches`.

    A correction needs that room: Camway moves no given keyframe. `stretches` holds times. Where the
    camera turns far, `keep_turns` keeps samples that tell the way.
    """
    def is_near(frame: float, margin: float = margin_s) -> bool:
        return any(t0 - margin <= shot.time_s(frame) <= t1 + margin for t0, t1 in stretches)

    fixed = {round(frame, 4) for frame in shot.fixed} | {round(keyframes[i].frame, 4) for i in (0, -1)}
    kept = {k.frame for k in keyframes if round(k.frame, 4) in fixed or not is_near(k.frame)}
    indices = {i for i, sample in enumerate(shot.samples) if sample.frame in kept}
    if keep_turns:
        indices = with_turns(shot, indices, lambda frame: is_near(frame, 0.0))
    return [shot.samples[i] for i in sorted(indices)]


def _spans(collisions: Sequence[dict]) -> list[tuple[float, float]]:
    """Returns the time from the first collision with each object to the last one with it."""
    spans: dict[str, tuple[float, float]] = {}
    for collision in collisions:
        name = collision["witness"]["object"]
        spans[name] = (spans.get(name, (collision["t_begin"],))[0], collision["t_end"])
    return list(spans.values())


def choices(shot: Shot, keyframes: list[Sample], collisions: Sequence[dict]) -> Iterator[list[Sample]]:
    """Yields lists of keyframes to plan with, each with more room for corrections than the one before.

    `collisions` are those of the path through `keyframes`. A sampled keyframe in an obstacle would be
    refused, and one that is enclosed by an obstacle would be proved to be out of reach.
    """
    stretches = [(c["t_begin"], c["t_end"]) for c in collisions]
    seen: list[list[Sample]] = []
    for room, margin_s in [(stretches, MARGINS_S[0]), *((_spans(collisions), m) for m in MARGINS_S)]:
        choice = loosened(shot, keyframes, room, margin_s)
        if choice not in seen:
            seen.append(choice)
            yield choice


def without_turns(shot: Shot, keyframes: list[Sample], collisions: Sequence[dict]) -> list[Sample]:
    """Returns keyframes for a way round obstacles on which the camera need not turn as the artist's does."""
    return loosened(shot, keyframes, _spans(collisions), MARGINS_S[0], keep_turns=False)


def turned_along(shot: Shot, keyframes: list[Sample], way: Path) -> list[Sample]:
    """Adds the keyframes that large turns need, at places of `way`, a free path through `keyframes`."""
    given = {k.frame: k for k in keyframes}
    indices = with_turns(shot, {i for i, sample in enumerate(shot.samples) if sample.frame in given})
    return [given.get(s.frame) or Sample(s.frame, Pose(way.pose(shot.time_s(s.frame)).position, s.pose.orientation))
            for s in (shot.samples[i] for i in sorted(indices))]


def request_of(shot: Shot, keyframes: Sequence[Sample], scene: str) -> dict:
    """Returns the request, as `docs/requests.md` has it."""
    request = {
        "scene": scene,
        "camera": {"fov_x_deg": shot.view.fov_x_deg, "fov_y_deg": shot.view.fov_y_deg, "near": shot.view.near_m},
        "keyframes": [{"time": shot.time_s(k.frame), "position": list(k.pose.position),
                       "orientation": list(k.pose.orientation)} for k in keyframes],
        "options": shot.options,
    }
    if shot.body:
        request["body"] = shot.body
    return request
