# SPDX-License-Identifier: MIT
"""What the panel asks for, and what a run left with the camera. Both are saved in the .blend file."""
from __future__ import annotations

import json

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

from .motion import Difference
from .run import CamwayError, Daemon


def _is_camera(_, thing: bpy.types.Object) -> bool:
    return thing.type == "CAMERA"


class CamwaySettings(bpy.types.PropertyGroup):
    """The settings of a scene, as `scene.camway`."""
    camera: PointerProperty(
        name="Camera", type=bpy.types.Object, poll=_is_camera,
        description="Camera whose path is planned; the active camera of the scene if empty")
    collection: PointerProperty(
        name="Obstacles", type=bpy.types.Collection,
        description="Only what is in this collection is in the way; everything visible if empty")
    with_hidden_in_render: BoolProperty(
        name="Also hidden in renders", default=False,
        description="What is visible in the viewport but not in renders is in the way, too")
    scene_at: EnumProperty(
        name="Obstacles at", default="FIRST",
        items=(("FIRST", "First frame", "Where obstacles are at the first frame of the path"),
               ("CURRENT", "Current frame", "Where obstacles are at the current frame")),
        description="Obstacles that move are planned for as they are at one frame")
    keys: EnumProperty(
        name="Your keys", default="AUTO",
        items=(("AUTO", "Keep, unless baked", "Keep keys, except where most frames have one"),
               ("KEEP", "Keep all", "The path meets the camera at each key"),
               ("CHOOSE", "Follow the motion", "The path follows the motion, and may miss keys where it is corrected")),
        description="Whether the path has to meet the camera at its keys")
    plan_with: EnumProperty(
        name="Plan with", default="HERE",
        items=(("HERE", "This computer", "The camway program plans"),
               ("DAEMON", "A daemon", "A running camwayd plans, here or elsewhere")),
        description="Who plans")
    daemon_scene: StringProperty(
        name="Its scene",
        description="Scene of the daemon to plan in; if empty, what is visible is sent, and forgotten afterwards")
    daemon_prefix: StringProperty(name="Prefix", default="CAMWAY", description="First part of the daemon's channels")
    daemon_url: StringProperty(
        name="Network", description="LCM network of the daemon, as udpm://239.255.76.67:7667?ttl=1; if empty, "
                                    "$LCM_DEFAULT_URL, or else this computer alone")
    body: EnumProperty(
        name="Body", default="NEAR",
        items=(("NEAR", "Near plane", "The part of the near plane that the camera sees"),
               ("BALL", "Ball", "A ball about the eye, as for a real camera")),
        description="What must not touch anything")
    radius_m: FloatProperty(name="Radius (m)", default=0.15, min=1e-4, soft_max=2.0, precision=3)
    clearance_m: FloatProperty(
        name="Clearance (m)", default=0.0, min=0.0, soft_max=1.0, precision=3,
        description="Least distance of the body from everything")
    objective: EnumProperty(
        name="Corrections", default="closest",
        items=[(name, name.capitalize(), what) for name, what in (
            ("closest", "Stay close to your path, and smooth"), ("shortest", "As short as possible"),
            ("smoothest", "As little bending as possible"), ("safest", "Away from everything"))])
    orientation: EnumProperty(
        name="Turning", default="free",
        items=(("free", "Free", "Turn the camera as needed"), ("level", "Level", "Do not tilt the horizon"),
               ("keep", "Keep", "Do not turn the camera")),
        description="What a correction may do to the orientation")
    repair: BoolProperty(
        name="Move keys that collide", default=False,
        description="Move a key that collides to the nearest free place, instead of refusing it")
    deadline_s: FloatProperty(
        name="Deadline (s)", default=10.0, min=0.1, soft_max=600.0,
        description="Seconds after which planning ends with what is proved by then")
    speed_limit: FloatProperty(
        name="Speed (m/s)", default=0.0, min=0.0, description="Largest speed of the eye; 0 for no limit")
    turn_limit: FloatProperty(
        name="Turning (°/s)", default=0.0, min=0.0, description="Largest turn rate; 0 for no limit")
    retime: BoolProperty(
        name="Slow down to meet limits", default=True,
        description="The path may take longer than your keys say, where it has to")
    within_m: FloatProperty(
        name="Stay within (m)", default=0.01, min=1e-5, soft_max=1.0, precision=4,
        description="Where nothing is in the way, the path is nowhere farther from your curves")
    within_deg: FloatProperty(
        name="Stay within (°)", default=1.0, min=0.01, max=90.0,
        description="Where nothing is in the way, the path is nowhere turned further from your curves")
    more_options: StringProperty(
        name="More options", description='Further options of a Camway request, as JSON: "max_shrink": 0.3')

    @property
    def within(self) -> Difference:
        return Difference(self.within_m, self.within_deg)

    def daemon(self) -> Daemon | None:
        """Returns the daemon that plans, its scene empty if it is sent; None if this computer plans."""
        if self.plan_with == "HERE":
            return None
        return Daemon(self.daemon_scene.strip(), self.daemon_prefix.strip(), self.daemon_url.strip())

    def body_of_request(self) -> dict | None:
        return {"type": "sphere", "radius_m": self.radius_m} if self.body == "BALL" else None

    def options_of_request(self) -> dict:
        """Returns the `options` of a request (`docs/requests.md`)."""
        orientation = {"policy": self.orientation}
        if self.orientation == "level":
            orientation["up"] = [0, 0, 1]
        options = {"objective": self.objective, "orientation": orientation, "clearance_m": self.clearance_m,
                   "repair_keyframes": self.repair, "deadline_s": self.deadline_s}
        limits = {"speed_m_per_s": self.speed_limit, "turn_rate_deg_per_s": self.turn_limit}
        limits = {name: value for name, value in limits.items() if value > 0.0}
        if limits:
            options["limits"] = {**limits, "retime": self.retime}
        try:
            options.update(json.loads(f"{{{self.more_options}}}"))
        except ValueError as error:
            raise CamwayError(f'More options: this is no JSON like "max_shrink": 0.3, "seed": 2 ({error})') from None
        return options


class CamwayCollision(bpy.types.PropertyGroup):
    """A row of the list of collisions."""
    begin: FloatProperty()
    end: FloatProperty()
    thing: StringProperty(description="What the camera touches: object, or instancer/object")
    owner: StringProperty(description="Name of the object, or of the one that makes the instance")
    words: StringProperty()


class CamwayLine(bpy.types.PropertyGroup):
    """A line of text."""
    text: StringProperty()


def _go_to_row(result: "CamwayResult", context: bpy.types.Context) -> None:
    if 0 <= result.row < len(result.collisions):
        row = result.collisions[result.row]
        context.scene.frame_set(round((row.begin + row.end) / 2.0))


class CamwayResult(bpy.types.PropertyGroup):
    """What the last run said, as `camera.camway`."""
    status: StringProperty(description="Status of the answer (docs/answers.md), error, or empty before the first run")
    message: StringProperty()
    strays_m: FloatProperty(description="How far the path as interpolated strays from your curves, metres")
    strays_deg: FloatProperty(description="The same of the orientation, degrees")
    clearance_m: FloatProperty(description="Proved distance from everything, metres")
    played_m: FloatProperty(description="How far what Blender plays is from the proved path, metres at the body")
    lines: CollectionProperty(type=CamwayLine)
    collisions: CollectionProperty(type=CamwayCollision)
    row: IntProperty(update=_go_to_row)

    def begin(self) -> None:
        """Forgets the last run."""
        for name in ("status", "message", "strays_m", "strays_deg", "clearance_m", "played_m"):
            self.property_unset(name)
        self.lines.clear()
        self.collisions.clear()

    def say(self, text: str) -> None:
        self.lines.add().text = text


CLASSES = (CamwaySettings, CamwayCollision, CamwayLine, CamwayResult)


def register() -> None:
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.camway = PointerProperty(type=CamwaySettings)
    bpy.types.Object.camway = PointerProperty(type=CamwayResult)


def unregister() -> None:
    del bpy.types.Scene.camway, bpy.types.Object.camway
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
