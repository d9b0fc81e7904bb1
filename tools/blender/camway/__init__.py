# SPDX-License-Identifier: MIT
"""Camway for Blender: plans a path free of collision through the keys of a camera.

The modules `motion`, `request`, `run` and `answer` need no Blender and are tested without it.
"""
bl_info = {
    "name": "Camway",
    "description": "Camera paths proved free of collision",
    "author": "The Camway authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar > Camway",
    "category": "Animation",
}


def _parts():
    """The modules with classes of Blender, in the order in which they are registered."""
    from . import operators, panel, preferences, settings
    return settings, preferences, operators, panel


def register():
    for part in _parts():
        part.register()


def unregister():
    for part in reversed(_parts()):
        part.unregister()
