# SPDX-License-Identifier: MIT
"""Reads the motion of a camera from the evaluated scene."""
from __future__ import annotations

import math
from typing import Iterator

import bpy
from mathutils import Matrix

from . import animation
from .motion import Difference, Pose, Sample, difference_of
from .request import Shot, View, view_of, widest
from .run import CamwayError

# Between two whole frames lies one more sample: curves bend there, too.
SAMPLES_PER_FRAME = 2

# Keys on more than this share of the frames are baked ones, that no artist set.
BAKED_SHARE = 0.5

# A camera that moves less than this at the ends of the scene holds still.
_STILL = Difference(1e-6, 1e-4)


def rotation_of(world: Matrix) -> Matrix:
    """Returns the rotation of a camera as Blender renders it, whatever the scale of its parents.

    It looks along -Z of the matrix, exactly, with Y up. `Matrix.decompose` would turn a mirrored camera
    to look backwards.
    """
    z = world.col[2].to_3d().normalized()
    x = world.col[1].to_3d().cross(z).normalized()
    return Matrix((x, z.cross(x), z)).transposed()


def pose_of(world: Matrix, unit_m: float) -> Pose:
    """Returns the pose of a camera; `unit_m` is the length of a Blender unit in metres."""
    return Pose(tuple(x * unit_m for x in world.translation), tuple(rotation_of(world).to_quaternion()))


def fps_of(scene: bpy.types.Scene) -> float:
    return scene.render.fps / scene.render.fps_base


def unit_of(scene: bpy.types.Scene) -> float:
    """Returns the length of a Blender unit in metres."""
    return scene.unit_settings.scale_length


def frame_set(scene: bpy.types.Scene, frame: float) -> None:
    """Goes to a frame, which need not be whole."""
    whole = math.floor(frame)
    scene.frame_set(whole, subframe=frame - whole)


def require_perspective(camera: bpy.types.Object) -> None:
    if camera.data.type != "PERSP":
        raise CamwayError(f"{camera.name} is not a perspective camera. Camway moves a near plane with an angle of "
                          "view; choose Ball as the body to plan for this camera.")


def _view(scene: bpy.types.Scene, camera: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> View:
    data = camera.evaluated_get(depsgraph).data
    return view_of([tuple(corner) for corner in data.view_frame(scene=scene)], data.clip_start * unit_of(scene))


def _frames(scene: bpy.types.Scene, keys: set[float]) -> list[float]:
    """Returns the frames to look at: all of the scene, those between, and the keys among them."""
    first, last = scene.frame_start, scene.frame_end
    steps = range((last - first) * SAMPLES_PER_FRAME + 1)
    frames = {first + step / SAMPLES_PER_FRAME for step in steps} | {k for k in keys if first <= k <= last}
    return sorted(frames)


def _without_still_ends(samples: list[Sample], keys: set[float]) -> list[Sample]:
    """Returns the samples from the first key to the last, and those beyond in which the camera moves."""
    inside = [k for k in keys if samples[0].frame <= k <= samples[-1].frame]
    first, last = (min(inside), max(inside)) if inside else (samples[0].frame, samples[0].frame)

    def is_still(a: Sample, b: Sample) -> bool:
        return difference_of(a.pose, b.pose).share_of(_STILL) <= 1.0

    begin, end = 0, len(samples) - 1
    while begin < end and samples[begin].frame < first and is_still(samples[begin], samples[begin + 1]):
        begin += 1
    while end > begin and samples[end].frame > last and is_still(samples[end], samples[end - 1]):
        end -= 1
    return samples[begin:end + 1]


def _fixed(samples: list[Sample], keys: set[float], which: str) -> set[float]:
    """Returns the frames that the path has to meet: keys that an artist set."""
    inside = {k for k in keys if samples[0].frame <= k <= samples[-1].frame}
    frames = samples[-1].frame - samples[0].frame
    is_baked = len(inside) > 3 and len(inside) - 1 > BAKED_SHARE * frames
    return set() if which == "CHOOSE" or (which == "AUTO" and is_baked) else inside


def read_shot(context: bpy.types.Context, camera: bpy.types.Object, within: Difference,
              which_keys: str) -> Iterator[float]:
    """Reads the motion of a camera over the frames of the scene; returns the `Shot`.

    Yields the share that is done. Leaves the scene at another frame.
    """
    scene, depsgraph = context.scene, context.evaluated_depsgraph_get()
    keys = animation.key_frames_of(animation.movers_of(camera))
    frames = _frames(scene, keys)
    samples, views = [], []
    for done, frame in enumerate(frames):
        frame_set(scene, frame)
        world = camera.evaluated_get(depsgraph).matrix_world
        samples.append(Sample(frame, pose_of(world, unit_of(scene))))
        if camera.data.type == "PERSP":
            views.append(_view(scene, camera, depsgraph))
        yield done / len(frames)
    samples = _without_still_ends(samples, keys)
    if len(samples) < 2:
        raise CamwayError(f"{camera.name} does not move from frame {scene.frame_start} to {scene.frame_end}: "
                          "it needs two keys there.")
    return Shot(samples, _fixed(samples, keys, which_keys), fps_of(scene), widest(views or [View(50.0, 30.0, 0.1)]),
                within=within)
