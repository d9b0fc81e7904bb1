# SPDX-License-Identifier: MIT
"""The panel "Camway" in the sidebar of the 3D viewport."""
from __future__ import annotations

import textwrap

import bpy

from .answer import frame_words
from .camera_copy import copy_of
from .operators import camera_of

_ICONS = {"ok": "CHECKMARK", "partial": "ERROR", "timeout": "ERROR"}

# Pixels of a letter, about, and of the margins of a panel, at the usual scale of the interface.
_LETTER, _MARGIN = 7.5, 50


class CAMWAY_UL_collisions(bpy.types.UIList):
    """Collisions; a click goes to the frame."""

    def draw_item(self, context, layout, data, item, icon, active_data, active_name):
        begin, end = frame_words(item.begin), frame_words(item.end)
        row = layout.split(factor=0.4)
        row.label(text=begin if begin == end else f"{begin} - {end}")
        row.label(text=item.thing or item.words)


class _Part:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Camway"


class CAMWAY_PT_main(_Part, bpy.types.Panel):
    bl_label = "Camway"

    def draw(self, context):
        settings, layout = context.scene.camway, self.layout
        camera = camera_of(context)
        column = layout.column(align=True)
        column.label(text="Camera" if settings.camera or not camera else f"Camera: the active one, {camera.name}")
        column.prop(settings, "camera", text="")
        column = layout.column(align=True)
        column.label(text="Obstacles" if settings.collection else "Obstacles: all that is visible")
        column.prop(settings, "collection", text="")
        layout.prop(settings, "clearance_m")
        self._draw_planner(settings)
        layout.operator("camway.plan", icon="PLAY")
        if camera and camera.camway.status:
            self._draw_result(context, camera)

    def _draw_planner(self, settings):
        column = self.layout.column(align=True)
        column.prop(settings, "plan_with")
        if settings.plan_with == "DAEMON":
            for name in ("daemon_scene", "daemon_prefix", "daemon_url"):
                column.prop(settings, name)

    def _draw_result(self, context, camera):
        layout, result = self.layout, camera.camway
        box = layout.box()
        _write(context, box, f"{result.status}: {result.message}", _ICONS.get(result.status, "CANCEL"))
        for line in result.lines:
            _write(context, box, line.text, "DOT")
        if result.collisions:
            layout.label(text="Collisions of your path:")
            layout.template_list("CAMWAY_UL_collisions", "", result, "collisions", result, "row", rows=3)
            if 0 <= result.row < len(result.collisions):
                layout.label(text=result.collisions[result.row].words)
            layout.operator("camway.select_obstacle", icon="RESTRICT_SELECT_OFF")
        copy = copy_of(camera)
        if copy:
            other = camera if context.scene.camera == copy else copy
            layout.operator("camway.look_through", icon="VIEW_CAMERA", text=f"Look Through {other.name}")


class CAMWAY_PT_options(_Part, bpy.types.Panel):
    bl_label = "Options"
    bl_parent_id = "CAMWAY_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings, layout = context.scene.camway, self.layout
        layout.use_property_split = True
        column = layout.column(heading="Obstacles")
        column.prop(settings, "scene_at")
        column.prop(settings, "with_hidden_in_render")
        column = layout.column()
        column.prop(settings, "body")
        if settings.body == "BALL":
            column.prop(settings, "radius_m")
        for names in (("keys", "within_m", "within_deg", "repair"), ("objective", "orientation", "deadline_s"),
                      ("speed_limit", "turn_limit", "retime"), ("more_options",)):
            column = layout.column()
            for name in names:
                column.prop(settings, name)


def _write(context, layout, text: str, icon: str) -> None:
    """Writes a text in as many lines as the width of the panel takes; Blender breaks none."""
    scale = context.preferences.system.ui_scale
    letters = max(20, int((context.region.width / scale - _MARGIN) / _LETTER))
    column = layout.column(align=True)
    column.scale_y = 0.8
    for i, line in enumerate(textwrap.wrap(text, letters)):
        column.label(text=line, icon=icon if i == 0 else "BLANK1")


CLASSES = (CAMWAY_UL_collisions, CAMWAY_PT_main, CAMWAY_PT_options)


def register() -> None:
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
