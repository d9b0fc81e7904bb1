# SPDX-License-Identifier: MIT
"""Puts a path onto a copy of the camera, as F-curves, and markers onto the timeline."""
from __future__ import annotations

import array
import math
from typing import Sequence

import bpy
from mathutils import Euler, Quaternion

from . import animation
from .answer import Answer, Stretch, whole_frames
from .motion import Pose, difference_of
from .shot_reader import frame_set, unit_of

SUFFIX = ".camway"
SOURCE = "camway_source"  # the property of the copy that holds the original

# Points of a frame at which what Blender plays is compared with the path.
CHECKS_PER_FRAME = 4

# Slopes are differences over this many frames to either side. Much less would show the rounding of the
# floats that rotations of Blender are made of, much more the bend of the path.
_SLOPE_FRAMES = 0.1

# How keys are shown: Blender colours keys by these types.
GIVEN, SAMPLED, INSERTED, BAKED = "KEYFRAME", "BREAKDOWN", "EXTREME", "JITTER"


class Frames:
    """A path by frames, in Blender units, with the channels of a rotation mode that run on without jumps."""

    def __init__(self, answer: Answer, unit_m: float, mode: str):
        self._path, self._shot, self._unit_m, self.mode = answer.path, answer.shot, unit_m, mode

    def pose(self, frame: float) -> Pose:
        return self._path.pose(self._shot.time_s(frame))

    def location(self, frame: float) -> list[float]:
        return [x / self._unit_m for x in self.pose(frame).position]

    def rotation(self, frame: float, near: Sequence[float] | None) -> list[float]:
        """Returns the channels of the rotation that continue `near`: any number of turns, either sign."""
        quaternion = Quaternion(self.pose(frame).orientation)
        if self.mode == "QUATERNION":
            if near and quaternion.dot(Quaternion(near)) < 0.0:
                quaternion.negate()
            return list(quaternion)
        return list(quaternion.to_euler(self.mode, Euler(near, self.mode)) if near else
                    quaternion.to_euler(self.mode))


def _channels(path: Frames, frames: Sequence[float], first_rotation: Sequence[float]) -> list[list[tuple]]:
    """Returns (value, slope per frame) of each frame, for location and then rotation channels."""
    rows, near = [], first_rotation
    for frame in frames:
        near = path.rotation(frame, near)
        here = path.location(frame) + near
        # At both ends of the path the slope is that of a parabola through three points inside.
        inwards = {frames[0]: 1.0, frames[-1]: -1.0}.get(frame, 0.0)
        steps, weights = ((-1.0, 1.0), (-0.5, 0.5)) if not inwards else ((inwards, 2.0 * inwards), (2.0, -0.5))
        places = [frame + step * _SLOPE_FRAMES for step in steps]
        others = [path.location(place) + path.rotation(place, near) for place in places]
        sign = inwards or 1.0
        rows.append([(x, sign * (weights[0] * (a - x) + weights[1] * (b - x)) / _SLOPE_FRAMES)
                     for x, a, b in zip(here, *others)])
    return [list(channel) for channel in zip(*rows)]


def _fill(curve: bpy.types.FCurve, frames: Sequence[float], channel: Sequence[tuple], types: Sequence[str]) -> None:
    """Makes a curve of Bézier keys with the slopes given: between frames it is as near as a cubic can be."""
    points = curve.keyframe_points
    points.add(len(frames) - len(points))
    thirds = [(b - a) / 3.0 for a, b in zip(frames, frames[1:])]
    left, right = [-thirds[0], *(-third for third in thirds)], [*thirds, thirds[-1]]
    for name, runs in (("co", [0.0] * len(frames)), ("handle_left", left), ("handle_right", right)):
        flat = array.array("f")
        for frame, (value, slope), run in zip(frames, channel, runs):
            flat.extend((frame + run, value + run * slope))
        points.foreach_set(name, flat)
    for point, kind in zip(points, types):
        point.interpolation = "BEZIER"
        point.handle_left_type = point.handle_right_type = "FREE"
        point.type = kind
    # Updating computes automatic handles only; free ones stay.
    curve.update()


def _key_types(answer: Answer, frames: Sequence[float]) -> list[str]:
    """Returns the type of the key at each frame: that of the keyframe of the path nearest to it, if any."""
    types = {frame: BAKED for frame in frames}
    marks = [(frame, INSERTED) for frame in answer.frame_of_keyframes("inserted")]
    given = list(zip(answer.frames, answer.frame_of_keyframes("given")))
    for kind, is_fixed in ((SAMPLED, False), (GIVEN, True)):  # later ones win
        marks += [(frame, kind) for asked, frame in given if (asked in answer.shot.fixed) == is_fixed]
    for frame, kind in marks:
        types[min(frames, key=lambda f: abs(f - frame))] = kind
    return [types[frame] for frame in frames]


def copy_of(camera: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the copy that an earlier run made of this camera, or None."""
    copies = [thing for thing in bpy.data.objects if thing.get(SOURCE) == camera]
    return next((copy for copy in copies if copy.name == camera.name + SUFFIX), copies[0] if copies else None)


def _still_copy(scene: bpy.types.Scene, camera: bpy.types.Object) -> bpy.types.Object:
    """Returns a copy of the camera with its own lens, without parent, constraints or animation of its place.

    It takes the place of an earlier copy, wherever that was used.
    """
    earlier = copy_of(camera)
    copy = camera.copy()
    copy.data = camera.data.copy()
    if copy.data.animation_data and copy.data.animation_data.action:
        slot = getattr(copy.data.animation_data, "action_slot", None)
        copy.data.animation_data.action = copy.data.animation_data.action.copy()
        if slot is not None:
            copy.data.animation_data.action_slot = copy.data.animation_data.action.slots[slot.identifier]
    copy.animation_data_clear()
    copy.constraints.clear()
    copy.parent = None
    copy.delta_location, copy.delta_scale = (0, 0, 0), (1, 1, 1)
    copy.delta_rotation_euler, copy.delta_rotation_quaternion = (0, 0, 0), (1, 0, 0, 0)
    mirrored = camera.matrix_world.determinant() < 0.0
    copy.scale = (-1 if mirrored else 1, 1, 1)
    if copy.rotation_mode == "AXIS_ANGLE":
        copy.rotation_mode = "QUATERNION"
    copy[SOURCE] = camera
    copy.camway.begin()
    # Collections of linked files take no objects.
    for collection in [c for c in camera.users_collection if not c.library] or [scene.collection]:
        collection.objects.link(copy)
    if earlier:
        _replace(earlier, copy)
    copy.name, copy.data.name = camera.name + SUFFIX, camera.data.name + SUFFIX
    return copy


def _replace(earlier: bpy.types.Object, copy: bpy.types.Object) -> None:
    """Removes an earlier copy with all that only it used."""
    for collection in earlier.users_collection:
        if copy.name not in collection.objects:
            collection.objects.link(copy)
        collection.objects.unlink(earlier)
    action, data = earlier.animation_data and earlier.animation_data.action, earlier.data
    lens = data.animation_data and data.animation_data.action
    earlier.user_remap(copy)
    bpy.data.objects.remove(earlier)
    if data.users == 0:
        bpy.data.cameras.remove(data)
    for used in {action, lens} - {None}:  # one and the same, it may be
        if used.users == 0:
            bpy.data.actions.remove(used)


def _rotation_path(mode: str) -> str:
    return "rotation_quaternion" if mode == "QUATERNION" else "rotation_euler"


def put_on_copy(scene: bpy.types.Scene, camera: bpy.types.Object, answer: Answer) -> bpy.types.Object:
    """Returns a copy of the camera that follows the path of an answer, key by key."""
    copy = _still_copy(scene, camera)
    path = Frames(answer, unit_of(scene), copy.rotation_mode)
    frames = whole_frames(answer.shot, answer.path)
    place = _rotation_path(copy.rotation_mode)
    frame_set(scene, frames[0])
    channels = _channels(path, frames, list(getattr(camera, place)))
    types = _key_types(answer, frames)
    # Without an action of its own, Blender 4.4 would add the keys to that of the lens.
    copy.animation_data_create().action = bpy.data.actions.new(copy.name)
    for name, part in (("location", channels[:3]), (place, channels[3:])):
        # A first key makes the curves, in every version of Blender.
        copy.keyframe_insert(name, frame=frames[0])
        for index, channel in enumerate(part):
            _fill(animation.curve_of(copy, name, index), frames, channel, types)
    return copy


def playback_of(scene: bpy.types.Scene, copy: bpy.types.Object, answer: Answer) -> float:
    """Returns how far what Blender plays is from the path, in metres, motion blur included.

    That is the largest distance of a point of the body from where it was proved, at CHECKS_PER_FRAME times
    of each frame.
    """
    path = Frames(answer, unit_of(scene), copy.rotation_mode)
    place = _rotation_path(copy.rotation_mode)
    curves = [animation.curve_of(copy, name, i) for name in ("location", place)
              for i in range(len(getattr(copy, name)))]
    frames = whole_frames(answer.shot, answer.path)
    largest_m = 0.0
    for begin, end in zip(frames, frames[1:]):
        for step in range(CHECKS_PER_FRAME + (end == frames[-1])):
            frame = begin + (end - begin) * step / CHECKS_PER_FRAME
            values = [curve.evaluate(frame) for curve in curves]
            turn = (Quaternion(values[3:]).normalized() if path.mode == "QUATERNION" else
                    Euler(values[3:], path.mode).to_quaternion())
            played = Pose(tuple(x * unit_of(scene) for x in values[:3]), tuple(turn))
            here = difference_of(played, path.pose(frame))
            largest_m = max(largest_m, here.distance_m + math.radians(here.angle_deg) * answer.shot.radius_m)
    return largest_m


def put_markers(scene: bpy.types.Scene, camera: bpy.types.Object, stretches: Sequence[Stretch]) -> None:
    """Marks where the path was corrected, in place of the markers of an earlier run."""
    prefix = f"camway {camera.name}: "
    for marker in [m for m in scene.timeline_markers if m.name.startswith(prefix)]:
        scene.timeline_markers.remove(marker)
    for number, stretch in enumerate(stretches, 1):
        begin, end = math.floor(stretch.begin), math.ceil(stretch.end)
        scene.timeline_markers.new(f"{prefix}corrected {number} ({stretch.words})", frame=begin)
        if end > begin:
            scene.timeline_markers.new(f"{prefix}end {number}", frame=end)
