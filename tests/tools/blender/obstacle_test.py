# SPDX-License-Identifier: MIT
"""Tests of what the add-on takes for an obstacle, and of its errors.

    CAMWAY=build/dev/bin/camway blender -b --factory-startup --python-exit-code 1 \\
        --python tests/tools/blender/obstacle_test.py
"""
import math
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from blender_case import CamwayTest, run_tests  # noqa: E402
import rooms  # noqa: E402
from camway import animation, request  # noqa: E402


class SceneTest(CamwayTest):
    """What is in the way, and what is not."""

    def names(self):
        return {line[2:] for line in (self.folder / "scene.obj").read_text().splitlines() if line.startswith("g ")}

    def points(self, name):
        """The distinct vertices of an object of the scene file."""
        points, found, current = [], set(), None
        for line in (self.folder / "scene.obj").read_text().splitlines():
            kind, *rest = line.split(" ")
            if kind == "v":
                points.append(tuple(map(float, rest)))
            elif kind == "g":
                current = line[2:]
            elif current == name:
                found.update(points[int(i) - 1] for i in rest)
        return found

    def test_names_are_kept(self):
        rooms.new_room()
        rooms.box("Saule 1", (0, 2.5, 1), (0.1, 0.1, 0.1))
        rooms.box("a  b\\", (0, 2.5, 1), (0.1, 0.1, 0.1))
        rooms.box("柱", (0.3, -0.9, 1.5), (0.2, 0.2, 3))
        camera = rooms.new_camera(rooms.along_x())
        self.planned(camera)
        self.assertEqual(self.names(), {"floor", "wall right", "wall left", "wall back", "wall front", "Saule 1",
                                        "Saule 1#2", "a  b", "?"})
        self.assertEqual({row.thing for row in camera.camway.collisions}, {"Säule 1"})

    def test_hidden_things_are_left_out(self):
        for hide in ("hide_viewport", "hide_render", "hide_set", "exclude", "collection"):
            rooms.new_room()
            pillar = bpy.data.objects["Säule 1"]
            inner = bpy.data.collections.new("inner")
            bpy.context.scene.collection.children.link(inner)
            if hide == "hide_set":
                pillar.hide_set(True)
            elif hide in ("exclude", "collection"):
                inner.objects.link(pillar)
                bpy.context.scene.collection.objects.unlink(pillar)
                layer = bpy.context.view_layer.layer_collection.children["inner"]
                layer.exclude, inner.hide_viewport = hide == "exclude", hide == "collection"
            else:
                setattr(pillar, hide, True)
            camera = rooms.new_camera(rooms.along_x())
            self.planned(camera)
            self.assertNotIn("Saule 1", self.names(), hide)
            self.assertEqual(len(camera.camway.collisions), 0)
        self.plan(camera, with_hidden_in_render=True)
        self.assertNotIn("Saule 1", self.names())  # it is hidden from the viewport as well
        inner.hide_viewport, pillar.hide_render = False, True
        self.planned(camera, with_hidden_in_render=True)
        self.assertIn("Saule 1", self.names())

    def test_only_a_collection_can_be_in_the_way(self):
        rooms.new_room()
        camera = rooms.new_camera(rooms.along_x())
        only = bpy.data.collections.new("only")
        only.objects.link(bpy.data.objects["wall back"])
        self.planned(camera, collection=only)
        self.assertEqual(self.names(), {"wall back"})

    def test_what_the_camera_carries_is_not_in_the_way(self):
        rooms.new_room(pillar=None)
        camera = rooms.new_camera(rooms.along_x())
        rig = rooms.box("rig", (0, 0, 0), (0.5, 0.5, 0.5), parent=camera)
        rooms.box("handle", (0, 0, 0), (0.5, 0.5, 0.5), parent=rig)
        self.planned(camera)
        self.assertTrue({"rig", "handle"}.isdisjoint(self.names()))

    def test_modifiers_are_applied(self):
        rooms.new_room(pillar=(1.2, -2.0))
        array = bpy.data.objects["Säule 1"].modifiers.new("two", "ARRAY")
        array.relative_offset_displace = (0, 8, 0)  # the second one stands in the way
        ball = rooms.box("ball", (-2, 2, 2), (1, 1, 1))
        ball.modifiers.new("smooth", "SUBSURF").levels = 2
        camera = rooms.new_camera(rooms.along_x())
        copy = self.planned(camera)
        self.assertTrue(len(camera.camway.collisions))
        self.assertEqual(len(self.points("Saule 1")), 16)
        self.assertEqual(len(self.points("ball")), 98)
        self.assertEqual(rooms.touching_frames(copy), [])

    def test_instances_are_included(self):
        rooms.new_room()
        pillar = bpy.data.objects["Säule 1"]
        kit = bpy.data.collections.new("kit")
        kit.objects.link(pillar)
        bpy.context.scene.collection.objects.unlink(pillar)
        instancer = rooms.empty("Set")
        instancer.instance_type, instancer.instance_collection = "COLLECTION", kit
        camera = rooms.new_camera(rooms.along_x())
        copy = self.planned(camera)
        rows = {(row.thing, row.owner) for row in camera.camway.collisions}
        self.assertEqual(rows, {("Set/Säule 1", "Set")})
        self.assertEqual(rooms.touching_frames(copy), [])
        bpy.ops.camway.select_obstacle()
        self.assertEqual(bpy.context.view_layer.objects.active, instancer)

    def test_other_surfaces_are_meshes_too(self):
        rooms.new_room(pillar=None)
        bpy.ops.curve.primitive_bezier_circle_add(radius=0.3, location=(2, 2, 1))
        bpy.context.object.data.bevel_depth = 0.1
        bpy.ops.object.text_add(location=(-2, 2, 1))
        bpy.ops.object.metaball_add(location=(0, -2.5, 1), radius=0.3)
        self.planned(rooms.new_camera(rooms.along_x()))
        self.assertLessEqual({"BezierCircle", "Text", "Mball"}, self.names())

    def test_coordinates_are_those_of_the_world(self):
        rooms.new_room(unit=0.5)
        parent = rooms.empty("parent", (1, 2, 3))
        parent.rotation_euler, parent.scale = (0.3, 0.2, 0.1), (1, 2, 3)
        thing = rooms.box("thing", (0.1, 0.2, 0.3), (0.5, 0.6, 0.7), parent=parent)
        bpy.context.view_layer.update()
        expected = sorted(tuple(thing.matrix_world @ v.co * 0.5) for v in thing.data.vertices)
        self.plan(rooms.new_camera(rooms.along_x()))
        for a, b in zip(sorted(self.points("thing")), expected):
            self.assertLess(math.dist(a, b), 1e-6)

    def test_moving_obstacles_are_told_and_stand_still(self):
        rooms.new_room()
        pillar = bpy.data.objects["Säule 1"]
        for frame, y in ((1, 2.0), (61, 0.4), (121, 2.0)):
            pillar.location.y = y
            pillar.keyframe_insert("location", frame=frame)
        camera = rooms.new_camera(rooms.along_x())
        self.planned(camera)
        self.assertIn("moving obstacles stand still for Camway: Saule 1", self.lines(camera.camway))
        self.assertEqual(len(camera.camway.collisions), 0)
        bpy.context.scene.frame_set(61)
        self.planned(camera, scene_at="CURRENT")
        self.assertTrue(len(camera.camway.collisions))
        self.assertEqual(bpy.context.scene.frame_current, 61)


class BlockTest(CamwayTest):
    """A block that encloses much of the way, keys left out."""

    def test_a_way_round_is_found_whatever_the_turns(self):
        for turn in (0, 450, 1450):
            rooms.new_room(pillar=None)
            rooms.box("block", (1.4, 0.4, 1.5), (1.6, 1.0, 3))
            camera = rooms.new_camera(rooms.along_x(turned=(0, 0, turn)))
            copy = self.planned(camera)
            self.assertEqual(rooms.touching_frames(copy), [])
            self.assertIn("collision", camera.camway.message)
            self.assert_kept_files_belong_together()
            turned = [animation.curve_of(copy, "rotation_euler", 2).evaluate(f) for f in (1, 121)]
            self.assertAlmostEqual(math.degrees(turned[1] - turned[0]), turn, delta=1e-3)



class ErrorTest(CamwayTest):
    def test_a_key_in_an_obstacle_is_named_by_its_frame(self):
        rooms.new_room(pillar=(0.18, 0.1))  # a corner of the near plane is in it at frame 61
        camera = rooms.new_camera(rooms.along_x(degrees=(85, 0, 0)))
        result = self.plan(camera)
        self.assertEqual(result.status, "invalid")
        self.assertIn("keyframe at frame 61: the near quadrilateral collides", result.message)
        self.assertIn("frame 61", self.returned)
        self.assertIn((61.0, "keyframe in collision"), [(row.begin, row.words) for row in result.collisions])
        self.assertNotIn("Cam.camway", bpy.data.objects)
        copy = self.planned(camera, repair=True)
        self.assertEqual(rooms.touching_frames(copy), [])

    def test_a_closed_room_is_proved(self):
        rooms.new_room(pillar=None)
        rooms.box("closet", (0, 0.1, 1.5), (1, 1, 2))
        camera = rooms.new_camera(rooms.along_x())
        result = self.plan(camera)
        self.assertEqual(result.status, "infeasible")
        self.assertRegex(result.message, "no path exists: keyframe at frame 61 is inside .*, keyframe at frame 1 out")
        self.assertIn("no path exists", self.returned)
        self.assertEqual(self.read("response.json")["status"], "infeasible")
        self.assertNotIn("Cam.camway", bpy.data.objects)

    def test_an_earlier_copy_stays_and_is_told(self):
        rooms.new_room(pillar=None)
        camera = rooms.new_camera(rooms.along_x())
        self.planned(camera)
        rooms.box("closet", (0, 0.1, 1.5), (1, 1, 2))
        self.plan(camera)
        self.assertIn("Cam.camway is still that of an earlier run", self.lines(camera.camway))
        self.assertIn("Cam.camway", bpy.data.objects)

    def test_a_partial_answer_is_shown_with_what_remains(self):
        rooms.new_room()
        camera = rooms.new_camera(rooms.along_x())
        for key in (k for c in animation.fcurves_of(camera) for k in c.keyframe_points):
            key.interpolation = "LINEAR"
        result = self.plan(camera, more_options='"max_inserted_keyframes": 0')
        self.assertEqual((result.status, self.returned), ("partial", {"FINISHED"}))
        self.assertIn("Cam.camway", bpy.data.objects)
        self.assertTrue([row for row in result.collisions if row.words.startswith("remains")])
        self.assertNotIn("body", self.read("request.json"))  # a later try asked for a ball

    def test_a_slowed_path_ends_later_and_says_so(self):
        rooms.new_room()
        camera = rooms.new_camera(rooms.along_x())
        copy = self.planned(camera, speed_limit=1.0)
        points = animation.curve_of(copy, "location", 0).keyframe_points
        self.assertGreater(points[-1].co.x, 130.0)
        self.assertIn("after the scene's last frame, 121", self.lines(camera.camway))
        self.assertIn("is slowed", self.lines(camera.camway))
        bpy.context.scene.frame_end = 300
        places = [pose.position for pose in self.poses(copy, [1 + i / 2 for i in range(400)])]
        self.assertLess(max(math.dist(a, b) for a, b in zip(places, places[1:])) * 48, 1.001)
        self.assertEqual(rooms.touching_frames(copy), [])

    def test_a_missing_program_is_named(self):
        rooms.new_room()
        camera = rooms.new_camera(rooms.along_x())
        with self.assertRaisesRegex(RuntimeError, "'/nowhere/camway' was not found"):
            bpy.ops.camway.plan(wait=True, program="/nowhere/camway")
        self.assertEqual(camera.camway.status, "error")
        self.assertIn("Preferences", camera.camway.message)

    def test_what_cannot_be_planned_is_told(self):
        rooms.new_room()
        still = rooms.new_camera([(1, rooms.BEGIN, (85, 0, -90))])
        self.assertIn("does not move from frame 1 to 121", self.plan(still).message)
        flat = rooms.new_camera(rooms.along_x(), name="flat")
        flat.data.type = "ORTHO"
        self.assertIn("not a perspective camera", self.plan(flat).message)
        self.assertEqual(self.plan(flat, body="BALL").status, "ok")
        camera = rooms.new_camera(rooms.along_x(), name="wrong")
        self.assertIn("More options: this is no JSON", self.plan(camera, body="NEAR", more_options="seed = 3").message)
        self.assertIn("sed", self.plan(camera, more_options='"sed": 3').message)
        for thing in [t for t in bpy.data.objects if t.type == "MESH"]:
            bpy.data.objects.remove(thing)
        self.assertIn("nothing in the way", self.plan(camera, more_options="").message)

    def test_without_a_camera_there_is_no_button(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.assertFalse(bpy.ops.camway.plan.poll())


if __name__ == "__main__":
    run_tests(__name__)
