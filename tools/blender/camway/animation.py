# SPDX-License-Identifier: MIT
"""F-curves of a data-block, in every version of Blender."""
from __future__ import annotations

from typing import Iterable, Iterator

import bpy


def fcurves_of(block: bpy.types.ID):
    """Returns the F-curves of the action of a data-block; an empty list if it has none.

    Blender 4.4 put the curves of an action into slots, and 5.0 removed `Action.fcurves`.
    """
    data = getattr(block, "animation_data", None)
    if data is None or data.action is None:
        return []
    if not hasattr(data, "action_slot"):
        return data.action.fcurves
    for layer in data.action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(data.action_slot) if data.action_slot else None
            if bag is not None:
                return bag.fcurves
    return []


def curve_of(block: bpy.types.ID, path: str, index: int):
    """Returns the F-curve of a property, or None."""
    return next((c for c in fcurves_of(block) if c.data_path == path and c.array_index == index), None)


def _moved_by(thing: bpy.types.Object) -> Iterator[bpy.types.ID]:
    """The data-blocks that an object's place depends on directly."""
    if thing.parent:
        yield thing.parent
        if thing.parent.type == "CURVE":
            yield thing.parent.data
    for constraint in thing.constraints:
        target = getattr(constraint, "target", None)
        if target and not constraint.mute:
            yield target
            if target.type == "CURVE":  # its animation moves what follows it
                yield target.data


def movers_of(camera: bpy.types.Object) -> list[bpy.types.ID]:
    """Returns the camera and all whose animation can move it: parents, targets of constraints, and theirs."""
    found: list[bpy.types.ID] = [camera]
    for block in found:
        if isinstance(block, bpy.types.Object):
            found.extend(other for other in _moved_by(block) if other not in found)
    return found


def key_frames_of(blocks: Iterable[bpy.types.ID]) -> set[float]:
    """Returns the frames of all keys, and of the ends of NLA strips. Muted curves do not count."""
    frames: set[float] = set()
    for block in blocks:
        for curve in fcurves_of(block):
            if not curve.mute:
                frames.update(round(key.co.x, 4) for key in curve.keyframe_points)
        for track in getattr(getattr(block, "animation_data", None), "nla_tracks", ()):
            if not track.mute:
                frames.update(frame for strip in track.strips for frame in (strip.frame_start, strip.frame_end))
    return frames
