# SPDX-License-Identifier: MIT
"""The preferences of the add-on."""
import bpy
from bpy.props import StringProperty


class CamwayPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="camway", subtype="FILE_PATH",
        description="The camway program; if empty, $CAMWAY, or else camway on the PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


def program_of(context: bpy.types.Context) -> str:
    """Returns the program that the user set, or an empty text."""
    addon = context.preferences.addons.get(__package__)
    return addon.preferences.program if addon and addon.preferences else ""


def register() -> None:
    bpy.utils.register_class(CamwayPreferences)


def unregister() -> None:
    bpy.utils.unregister_class(CamwayPreferences)
