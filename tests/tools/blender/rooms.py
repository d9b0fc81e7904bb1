# SPDX-License-Identifier: MIT
"""Rooms and cameras that the tests in Blender make, and what they look at there."""
import math

import bpy
from mathutils import Euler, Vector
from mathutils.bvhtree import BVHTree

# A straight way along X, at the height of the eye, which the pillar stands in.
BEGIN, MIDDLE, END = (-3.0, -1.0, 1.5), (0.0, 0.1, 1.5), (3.0, 1.0, 1.5)


def box(name, location, size, parent=None):
    """Adds a box, with its sizes as scale."""
    bpy.ops.mesh.primitive_cube_add(size=1, location=location)
    thing = bpy.context.object
    thing.name, thing.scale = name, size
    thing.parent = parent
    return thing


def empty(name, location=(0, 0, 0)):
    thing = bpy.data.objects.new(name, None)
    thing.location = location
    bpy.context.scene.collection.objects.link(thing)
    return thing


def new_room(fps=24, fps_base=1.0, frames=(1, 121), unit=1.0, pillar=(1.2, 0.4)):
    """Makes an empty file with a room of 8 x 6 x 3 Blender units, and a pillar at `pillar`."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = fps, fps_base
    scene.frame_start, scene.frame_end = frames
    scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
    scene.unit_settings.system, scene.unit_settings.scale_length = "METRIC", unit
    box("floor", (0, 0, -0.05), (8, 6, 0.1))
    for name, place, size in (("wall right", (4, 0, 1.5), (0.1, 6, 3)), ("wall left", (-4, 0, 1.5), (0.1, 6, 3)),
                              ("wall back", (0, 3, 1.5), (8, 0.1, 3)), ("wall front", (0, -3, 1.5), (8, 0.1, 3))):
        box(name, place, size)
    if pillar:
        box("Säule 1", (*pillar, 1.5), (0.3, 0.3, 3))
    return scene


def new_camera(keys, name="Cam", mode="XYZ", lens=35.0, near=0.1):
    """Adds a camera with keys (frame, location, rotation in degrees)."""
    data = bpy.data.cameras.new(name)
    data.lens, data.clip_start, data.clip_end = lens, near, 90.0
    camera = bpy.data.objects.new(name, data)
    camera.rotation_mode = mode
    bpy.context.scene.collection.objects.link(camera)
    for frame, location, degrees in keys:
        camera.location = location
        euler = Euler([math.radians(a) for a in degrees], "XYZ")
        if mode == "QUATERNION":
            camera.rotation_quaternion = euler.to_quaternion()
        else:
            camera.rotation_euler = euler
        camera.keyframe_insert("location", frame=frame)
        camera.keyframe_insert("rotation_quaternion" if mode == "QUATERNION" else "rotation_euler", frame=frame)
    bpy.context.scene.camera = camera
    return camera


def along_x(last=121, degrees=(85, 0, -90), turned=(0, 0, 0)):
    """Three keys on the way that the pillar stands in; `turned` is what the last key turns further."""
    ends = [tuple(a + share * b for a, b in zip(degrees, turned)) for share in (0.0, 0.5, 1.0)]
    return [(1, BEGIN, ends[0]), (1 + last // 2, MIDDLE, ends[1]), (last, END, ends[2])]


def go_to(frame):
    whole = math.floor(frame)
    bpy.context.scene.frame_set(whole, subframe=frame - whole)


def near_quad(camera):
    """The corners of the near plane in the world, by Blender's own account of what the camera shows."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    data = camera.evaluated_get(depsgraph).data
    corners = data.view_frame(scene=bpy.context.scene)
    world = camera.evaluated_get(depsgraph).matrix_world.normalized()
    return [world @ (Vector(c) * (data.clip_start / -c[2])) for c in corners]


def obstacles():
    """A tree of all visible triangles, independent of the scene file that the add-on writes."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    points, faces = [], []
    for instance in depsgraph.object_instances:
        if instance.object.type != "MESH" or instance.object.hide_render:
            continue
        mesh = instance.object.to_mesh()
        faces += [[i + len(points) for i in polygon.vertices] for polygon in mesh.polygons]
        points += [instance.matrix_world @ v.co for v in mesh.vertices]
        instance.object.to_mesh_clear()
    return BVHTree.FromPolygons(points, faces)


def touching_frames(camera, per_frame=4):
    """The frames, and parts of frames, at which the near plane of a camera cuts a visible mesh."""
    scene, tree = bpy.context.scene, obstacles()
    found = []
    for step in range((scene.frame_end - scene.frame_start) * per_frame + 1):
        go_to(scene.frame_start + step / per_frame)
        if BVHTree.FromPolygons(near_quad(camera), [(0, 1, 2, 3)]).overlap(tree):
            found.append(scene.frame_start + step / per_frame)
    return found
