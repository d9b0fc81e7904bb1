# SPDX-License-Identifier: MIT
"""Installs the archive of the add-on as a user does, and plans with it. Blender's folders are those of the test."""
import os
import pathlib
import shutil
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import rooms  # noqa: E402

scripts = pathlib.Path(os.environ["BLENDER_USER_SCRIPTS"])
shutil.rmtree(scripts, ignore_errors=True)
rooms.new_room()
camera = rooms.new_camera(rooms.along_x())

bpy.ops.preferences.addon_install(filepath=os.environ["CAMWAY_BLENDER_ZIP"])
bpy.ops.preferences.addon_enable(module="camway")
installed = pathlib.Path(sys.modules["camway"].__file__)
assert scripts in installed.parents, installed

preferences = bpy.context.preferences.addons["camway"].preferences
preferences.program = os.environ.pop("CAMWAY")
assert bpy.ops.camway.plan() == {"FINISHED"}
assert rooms.touching_frames(bpy.data.objects["Cam.camway"]) == []

preferences.program = "/nowhere/else"
try:
    bpy.ops.camway.plan()
except RuntimeError as error:
    assert "/nowhere/else" in str(error), error
else:
    raise AssertionError("a program that is not there was found")

bpy.ops.preferences.addon_disable(module="camway")
assert not hasattr(bpy.types.Scene, "camway")
