# SPDX-License-Identifier: MIT
"""The buttons of the panel, for scripts as well."""
import time

import bpy
from bpy.props import BoolProperty, StringProperty

from . import camera_copy, preferences
from .job import Job
from .run import CamwayError

# Steps of a job are done for this long, then Blender draws and reads the keyboard.
_SLICE_S = 0.05

# What the user is told in words; OSError is a full disk or a folder that cannot be written.
_FAILURES = (CamwayError, OSError)


def camera_of(context: bpy.types.Context) -> bpy.types.Object | None:
    """Returns the camera that the panel is about, or None; of a copy, its original."""
    camera = context.scene.camway.camera or context.scene.camera
    if camera is None or camera.type != "CAMERA":
        return None
    return camera.get(camera_copy.SOURCE) or camera


class CAMWAY_OT_plan(bpy.types.Operator):
    """Plan a path free of collision through the keys of the camera, and put it onto a copy"""
    bl_idname = "camway.plan"
    bl_label = "Plan"
    bl_options = {"UNDO"}

    wait: BoolProperty(name="Wait", default=False, options={"SKIP_SAVE"},
                       description="Return when the path is there, as scripts need it")
    program: StringProperty(name="Program", options={"SKIP_SAVE"},
                            description="The camway program; that of the preferences if empty")
    folder: StringProperty(name="Folder", options={"SKIP_SAVE"},
                           description="Keep scene.obj, request.json and response.json here")

    @classmethod
    def poll(cls, context):
        return camera_of(context) is not None

    def _begin(self, context):
        program = self.program or preferences.program_of(context)
        self._job = Job(context, camera_of(context), program, self.folder)
        self._steps = self._job.steps(context)

    def execute(self, context):
        """Plans and waits: operators that are executed cannot go on in the background."""
        try:
            self._begin(context)
            for _ in self._steps:
                if not self._job.is_reading:
                    time.sleep(0.001)  # a child runs
        except _FAILURES as error:
            return self._fail(context, error)
        return self._end(context)

    def invoke(self, context, event):
        if self.wait or bpy.app.background:
            return self.execute(context)
        try:
            self._begin(context)
        except _FAILURES as error:
            return self._fail(context, error)
        self._timer = context.window_manager.event_timer_add(_SLICE_S, window=context.window)
        context.window_manager.progress_begin(0.0, 1.0)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._stop(context)
            self.report({"INFO"}, "Camway: cancelled")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"} if self._job.is_reading else {"PASS_THROUGH"}
        try:
            until = time.monotonic() + _SLICE_S
            was_reading = True
            while was_reading and time.monotonic() < until:
                share, words = next(self._steps)
                was_reading = self._job.is_reading
            context.window_manager.progress_update(share)
            context.workspace.status_text_set(f"Camway: {words} (Esc cancels)")
        except StopIteration:
            self._stop(context)
            return self._end(context)
        except _FAILURES as error:
            self._stop(context)
            return self._fail(context, error)
        except Exception:
            self._stop(context)  # a fault of ours: Blender shows it, and the window is as before
            raise
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender closes the window or the file."""
        self._stop(context)

    def _stop(self, context):
        """Ends the job, and with it the program, and takes the progress from the window."""
        self._steps.close()
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def _fail(self, context, error):
        camera = camera_of(context)
        if camera:
            camera.camway.begin()
            camera.camway.status, camera.camway.message = "error", str(error)
        self.report({"ERROR"}, f"Camway: {error}")
        return {"CANCELLED"}

    def _end(self, context):
        result = self._job.camera.camway
        words = f"Camway: {result.status}: {result.message}"
        if result.status in ("invalid", "infeasible", "internal_error"):
            self.report({"ERROR"}, words)
            return {"CANCELLED"}
        self.report({"INFO"} if result.status == "ok" else {"WARNING"}, words)
        return {"FINISHED"}


class CAMWAY_OT_look_through(bpy.types.Operator):
    """Make the corrected copy the active camera of the scene, or the original again"""
    bl_idname = "camway.look_through"
    bl_label = "Look through the Other"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        camera = camera_of(context)
        return camera is not None and camera_copy.copy_of(camera) is not None

    def execute(self, context):
        camera = camera_of(context)
        copy = camera_copy.copy_of(camera)
        context.scene.camway.camera = camera
        context.scene.camera = camera if context.scene.camera == copy else copy
        return {"FINISHED"}


class CAMWAY_OT_select_obstacle(bpy.types.Operator):
    """Select what the camera collides with in the row that is picked"""
    bl_idname = "camway.select_obstacle"
    bl_label = "Select the Obstacle"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        camera = camera_of(context)
        return camera is not None and 0 <= camera.camway.row < len(camera.camway.collisions)

    def execute(self, context):
        result = camera_of(context).camway
        thing = context.view_layer.objects.get(result.collisions[result.row].owner)
        if thing is None:
            self.report({"WARNING"}, "Camway: it is not in this scene any more")
            return {"CANCELLED"}
        for other in context.view_layer.objects:
            other.select_set(other == thing)
        context.view_layer.objects.active = thing
        return {"FINISHED"}


CLASSES = (CAMWAY_OT_plan, CAMWAY_OT_look_through, CAMWAY_OT_select_obstacle)


def register() -> None:
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
