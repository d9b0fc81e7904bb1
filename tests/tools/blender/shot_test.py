# SPDX-License-Identifier: MIT
"""Tests of the path that the add-on puts onto the copy of a camera.

    CAMWAY=build/dev/bin/camway blender -b --factory-startup --python-exit-code 1 \\
        --python tests/tools/blender/shot_test.py
"""
import math
import pathlib
import sys

import bpy
from mathutils import Quaternion

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from blender_case import CamwayTest, run_tests  # noqa: E402
import rooms  # noqa: E402
from camway import animation, camera_copy, request, run  # noqa: E402
from camway.answer import Answer  # noqa: E402
from camway.motion import Difference, Path, Sample  # noqa: E402


class PillarTest(CamwayTest):
    """A pillar stands in the way of a camera that turns by 450 degrees and rolls by 30."""

    def setUp(self):
        super().setUp()
        self.scene = rooms.new_room()
        self.camera = rooms.new_camera(rooms.along_x(turned=(0, 30, 450)))
        self.before = self.curves(self.camera)

    def curves(self, camera):
        return [(c.data_path, c.array_index, [(*k.co, *k.handle_left, k.interpolation) for k in c.keyframe_points])
                for c in animation.fcurves_of(camera)]

    def test_the_copy_is_free_where_the_original_touches_the_pillar(self):
        touched = rooms.touching_frames(self.camera)
        copy = self.planned(self.camera)
        self.assertTrue(touched)
        self.assertEqual(rooms.touching_frames(copy), [])
        rows = list(self.camera.camway.collisions)
        self.assertEqual({(row.thing, row.owner) for row in rows}, {("Säule 1", "Säule 1")})
        for frame in touched:
            self.assertTrue(any(row.begin - 0.5 <= frame <= row.end + 0.5 for row in rows), frame)

    def test_what_blender_plays_is_proved_free_by_the_program(self):
        """The poses of the copy, four for each frame, joined by straight motion, go through `camway check`."""
        copy = self.planned(self.camera, clearance_m=0.005)
        frames = [1 + step / 4 for step in range(481)]
        poses = self.poses(copy, frames)
        segments = []
        for frame, a, b in zip(frames, poses, poses[1:]):
            sign = 1.0 if sum(x * y for x, y in zip(a.orientation, b.orientation)) > 0.0 else -1.0
            line = [[((n - i) * x + i * y) / n for x, y in zip(p, q)] for n, p, q in
                    ((3, a.position, b.position), (6, a.orientation, [sign * y for y in b.orientation]))
                    for i in range(n + 1)]
            segments.append({"t0": (frame - 1) / 24, "t1": (frame - 0.75) / 24, "position": line[:4],
                             "orientation": line[4:]})
        asked = self.read("request.json")
        asked["options"]["clearance_m"] = 0.0
        checking = run.check(run.find_program(), self.folder, asked, Path(segments))
        with self.assertRaises(StopIteration) as end:
            while True:
                next(checking)
        self.assertEqual(end.exception.value["verdict"], "free")

    def test_the_original_is_left_as_it_was(self):
        self.scene.frame_set(17)
        copy = self.planned(self.camera)
        self.assertEqual(self.curves(self.camera), self.before)
        self.assertEqual(self.scene.frame_current, 17)
        self.assertEqual(self.scene.camera, self.camera)
        self.assertNotEqual(copy.data, self.camera.data)
        self.assertNotEqual(copy.animation_data.action, self.camera.animation_data.action)

    def test_keys_roll_and_turns_beyond_360_degrees_are_kept(self):
        copy = self.planned(self.camera)
        self.assert_same(self.camera, copy, (1, 61, 121))
        values = []
        for frame in range(1, 122):
            self.scene.frame_set(frame)
            values.append([math.degrees(x) for x in copy.rotation_euler])
        for value, expected in zip(values[-1], (85.0, 30.0, 360.0)):
            self.assertAlmostEqual(value, expected, delta=1e-3)
        self.assertAlmostEqual(values[-1][2] - values[0][2], 450.0, delta=1e-3)
        self.assertLess(max(abs(b - a) for p, q in zip(values, values[1:]) for a, b in zip(p, q)), 10.0)

    def test_keys_are_coloured_by_what_they_are(self):
        copy = self.planned(self.camera)
        kinds = {k.co.x: k.type for k in animation.curve_of(copy, "location", 0).keyframe_points}
        self.assertEqual(set(kinds), set(map(float, range(1, 122))))
        self.assertEqual([f for f, kind in kinds.items() if kind == "KEYFRAME"], [1.0, 61.0, 121.0])
        inserted = [1 + 24 * k["time"] for k in self.read("response.json")["keyframes"] if k["origin"] == "inserted"]
        self.assertTrue(inserted)
        for frame in inserted:
            self.assertEqual(kinds[float(round(frame))], "EXTREME")
        self.assertIn("JITTER", kinds.values())

    def test_markers_are_at_the_corrected_stretch(self):
        copy = self.planned(self.camera)
        begin, end = self.scene.timeline_markers
        self.assertRegex(begin.name, r"^camway Cam: corrected 1 \(\d+ mm, [\d.]+°\)$")
        self.assertEqual(end.name, "camway Cam: end 1")
        row = self.camera.camway.collisions[0]
        self.assertTrue(begin.frame < row.begin and row.end < end.frame)
        others = [f for f in range(1, 122) if not begin.frame - 1 <= f <= end.frame + 1]
        self.assert_same(self.camera, copy, others, Difference(0.0105, 1.05))

    def test_a_row_goes_to_its_frame_and_selects_its_obstacle(self):
        self.planned(self.camera)
        result = self.camera.camway
        result.row = 1
        row = result.collisions[1]
        self.assertTrue(row.begin - 0.5 <= self.scene.frame_current <= row.end + 0.5)
        bpy.ops.camway.select_obstacle()
        self.assertEqual([thing.name for thing in bpy.context.selected_objects], ["Säule 1"])

    def test_a_second_run_takes_the_place_of_the_first(self):
        first = self.planned(self.camera)
        bpy.ops.camway.look_through()
        self.assertEqual(self.scene.camera, first)
        follower = rooms.empty("follower")
        follower.constraints.new("COPY_LOCATION").target = first
        counts = [len(data) for data in (bpy.data.objects, bpy.data.cameras, bpy.data.actions)]
        self.scene.camway.camera = None  # the panel is about the original of the active camera
        second = self.planned(bpy.context.scene.camera.get("camway_source"), clearance_m=0.02)
        self.assertEqual(counts, [len(data) for data in (bpy.data.objects, bpy.data.cameras, bpy.data.actions)])
        self.assertEqual((second.name, second.data.name), ("Cam.camway", "Cam.camway"))
        self.assertEqual((self.scene.camera, follower.constraints[0].target), (second, second))
        self.assertEqual(len(self.scene.timeline_markers), 2)
        bpy.ops.camway.look_through()
        self.assertEqual(self.scene.camera, self.camera)

    def test_planning_for_a_copy_plans_for_its_original(self):
        copy = self.planned(self.camera)
        self.scene.camera, self.scene.camway.camera = copy, None
        self.assertEqual(bpy.ops.camway.plan(wait=True), {"FINISHED"})
        self.assertNotIn("Cam.camway.camway", bpy.data.objects)

    def test_a_clearance_is_kept(self):
        self.planned(self.camera, clearance_m=0.1)
        self.assertGreaterEqual(self.camera.camway.clearance_m, 0.1)

    def test_what_blender_plays_is_compared_with_the_clearance(self):
        self.planned(self.camera)
        result = self.camera.camway
        self.assertLess(result.played_m, 1e-4)
        self.assertGreater(result.played_m, 0.0)
        self.assertIn("less than its clearance", self.lines(result))

    def test_curves_that_are_off_are_seen(self):
        copy = self.planned(self.camera)
        content = self.read("response.json")
        shot = request.Shot([Sample(1.0, None)], set(), 24.0, request.View(54.0, 32.0, 0.1))
        reply = Answer(shot, [], {}, content)
        self.assertAlmostEqual(camera_copy.playback_of(self.scene, copy, reply), self.camera.camway.played_m, 6)
        for path, index, change, expected_m in (("location", 1, 0.01, 0.01), ("rotation_euler", 0, 0.1, 0.1 * 0.1)):
            curve = animation.curve_of(copy, path, index)
            for key in list(curve.keyframe_points)[50:52]:  # what lies between two frames counts
                key.handle_right.y += change
            curve.update()
            self.assertGreater(camera_copy.playback_of(self.scene, copy, reply), expected_m / 3)
            for key in list(curve.keyframe_points)[50:52]:
                key.handle_right.y -= change
            curve.update()

    def test_a_ball_can_be_the_body(self):
        self.planned(self.camera, body="BALL", radius_m=0.2)
        copy = bpy.data.objects["Cam.camway"]
        tree = rooms.obstacles()
        for pose in self.poses(copy, range(1, 122)):
            self.assertGreater(tree.find_nearest(pose.position)[3], 0.2)

    def test_a_baked_camera_is_followed_and_corrected(self):
        for frame, pose in zip(range(1, 122), self.poses(self.camera, range(1, 122))):
            self.camera.location = pose.position
            self.camera.rotation_euler = Quaternion(pose.orientation).to_euler("XYZ", self.camera.rotation_euler)
            self.camera.keyframe_insert("location", frame=frame)
            self.camera.keyframe_insert("rotation_euler", frame=frame)
        copy = self.planned(self.camera)
        self.assertEqual(rooms.touching_frames(copy), [])
        self.assertEqual(self.plan(self.camera, keys="KEEP").status, "invalid")

    def test_undo_takes_it_back(self):
        bpy.ops.ed.undo_push(message="before")
        self.planned(self.camera)
        bpy.ops.ed.undo_push(message="planned")
        bpy.ops.ed.undo()
        self.assertNotIn("Cam.camway", bpy.data.objects)
        self.assertEqual(len(bpy.context.scene.timeline_markers), 0)
        self.assertEqual(self.curves(bpy.data.objects["Cam"]), self.before)


class RoundTripTest(CamwayTest):
    """What a camera has, its copy has."""

    def test_frame_rates_are_kept(self):
        for fps, base in ((24, 1.0), (25, 1.0), (30, 1.0), (30, 1.001)):
            scene = rooms.new_room(fps, base)
            camera = rooms.new_camera(rooms.along_x())
            copy = self.planned(camera)
            times = [k["time"] for k in self.read("request.json")["keyframes"]]
            self.assertEqual((times[0], times[-1]), (0.0, 120 / (fps / scene.render.fps_base)))
            self.assertEqual(scene.render.fps, fps)
            self.assertAlmostEqual(scene.render.fps_base, base, delta=1e-6)
            self.assert_same(camera, copy, (1, 61, 121))

    def test_the_path_begins_at_the_first_key(self):
        rooms.new_room(frames=(1, 200))
        camera = rooms.new_camera([(frame + 30, *rest) for frame, *rest in rooms.along_x()])
        copy = self.planned(camera)
        points = animation.curve_of(copy, "location", 0).keyframe_points
        self.assertEqual((points[0].co.x, points[-1].co.x), (31.0, 151.0))
        self.assert_same(camera, copy, (1, 31, 91, 151, 200))

    def test_a_key_between_frames_is_met(self):
        rooms.new_room(pillar=None)
        camera = rooms.new_camera([(1.25, rooms.BEGIN, (85, 0, -90)), (50.5, rooms.MIDDLE, (85, 0, 0)),
                                   (100.75, rooms.END, (85, 0, -90))])
        self.assert_same(camera, self.planned(camera), (1.25, 50.5, 100.75))

    def test_all_that_the_lens_has_is_kept(self):
        rooms.new_room()
        camera = rooms.new_camera(rooms.along_x())
        data = camera.data
        data.sensor_fit, data.sensor_width, data.sensor_height = "VERTICAL", 24.9, 18.7
        data.shift_x, data.dof.use_dof, data.dof.aperture_fstop = 0.1, True, 1.4
        data.dof.focus_object = bpy.data.objects["floor"]
        for frame, lens in ((1, 24.0), (121, 70.0)):
            data.lens = lens
            data.keyframe_insert("lens", frame=frame)
        copy = self.planned(camera)
        for name in ("sensor_fit", "sensor_width", "sensor_height", "shift_x", "clip_start", "clip_end", "type"):
            self.assertEqual(getattr(copy.data, name), getattr(data, name))
        self.assertEqual((copy.data.dof.aperture_fstop, copy.data.dof.focus_object), (data.dof.aperture_fstop,
                                                                                     data.dof.focus_object))
        self.assertNotEqual(copy.data.animation_data.action, data.animation_data.action)
        for frame in (1, 47, 121):
            bpy.context.scene.frame_set(frame)
            self.assertEqual(copy.data.lens, data.lens)
            self.assertEqual([tuple(c) for c in copy.data.view_frame(scene=bpy.context.scene)],
                             [tuple(c) for c in data.view_frame(scene=bpy.context.scene)])

    def test_the_view_is_what_blender_shows_at_its_widest(self):
        for fit, pixel, shift in (("AUTO", 1.0, 0.0), ("VERTICAL", 1.0, 0.0), ("HORIZONTAL", 2.0, 0.0),
                                  ("AUTO", 1.0, 0.2)):
            scene = rooms.new_room(pillar=None)
            scene.render.pixel_aspect_x = pixel
            camera = rooms.new_camera(rooms.along_x())
            camera.data.sensor_fit, camera.data.shift_x = fit, shift
            for frame, lens in ((1, 50.0), (61, 24.0), (121, 70.0)):
                camera.data.lens = lens
                camera.data.keyframe_insert("lens", frame=frame)
            self.planned(camera)
            asked = self.read("request.json")["camera"]
            scene.frame_set(61)
            corners = [camera.matrix_world.inverted() @ c for c in rooms.near_quad(camera)]
            self.assertAlmostEqual(asked["near"], 0.1, delta=1e-8)
            for axis, name in ((0, "fov_x_deg"), (1, "fov_y_deg")):
                half = max(abs(c[axis]) for c in corners)
                self.assertAlmostEqual(0.1 * math.tan(math.radians(asked[name]) / 2), half, delta=1e-6)

    def test_an_angle_of_view_is_the_usual_one(self):
        rooms.new_room(pillar=None)
        self.planned(rooms.new_camera(rooms.along_x(), lens=35.0))
        asked = self.read("request.json")["camera"]
        self.assertAlmostEqual(asked["fov_x_deg"], 54.43222, delta=1e-4)
        self.assertAlmostEqual(asked["fov_y_deg"], 32.2688, delta=1e-4)

    def test_units_of_the_scene_become_metres(self):
        scene = rooms.new_room(unit=0.01)
        for thing in bpy.data.objects:  # the same room in centimetres
            thing.location, thing.scale = thing.location * 100, thing.scale * 100
        keys = [(frame, [100 * x for x in place], degrees) for frame, place, degrees in rooms.along_x()]
        camera = rooms.new_camera(keys, near=10.0)
        camera.data.clip_end = 9000.0
        copy = self.planned(camera)
        asked = self.read("request.json")
        self.assertAlmostEqual(asked["camera"]["near"], 0.1, delta=1e-7)
        for value, expected in zip(asked["keyframes"][0]["position"], rooms.BEGIN):
            self.assertAlmostEqual(value, expected, delta=1e-6)
        scene.frame_set(1)
        self.assertAlmostEqual(copy.location.x, -300.0, delta=1e-3)
        self.assertTrue(list(self.camera_rows(camera)))
        self.assertEqual(rooms.touching_frames(copy), [])
        self.assert_same(camera, copy, (1, 61, 121))

    def camera_rows(self, camera):
        return [(row.begin, row.thing) for row in camera.camway.collisions]

    def test_a_saved_file_has_it_all(self):
        rooms.new_room(30, 1.001)
        camera = rooms.new_camera(rooms.along_x(turned=(0, 30, 450)))
        copy = self.planned(camera)
        frames = (1, 33, 61, 78, 121)
        poses, rows = self.poses(copy, frames), self.camera_rows(camera)
        file = str(self.folder / "shot.blend")
        bpy.ops.wm.save_as_mainfile(filepath=file)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=file)
        camera, copy = bpy.data.objects["Cam"], bpy.data.objects["Cam.camway"]
        self.assertEqual(self.poses(copy, frames), poses)
        self.assertEqual((self.camera_rows(camera), camera.camway.status), (rows, "ok"))
        self.assertEqual(bpy.context.scene.camway.camera, camera)
        self.assertEqual(len(bpy.context.scene.timeline_markers), 2)
        self.planned(camera)  # and goes on
        self.assertEqual(len([c for c in bpy.data.objects if c.type == "CAMERA"]), 2)

    def test_a_camera_of_a_linked_file_gets_a_copy_here(self):
        rooms.new_room()
        rooms.new_camera(rooms.along_x())
        rig = bpy.data.collections.new("rig")
        rig.objects.link(bpy.data.objects["Cam"])
        bpy.context.scene.collection.children.link(rig)
        file = str(self.folder / "rig.blend")
        bpy.ops.wm.save_as_mainfile(filepath=file)
        rooms.new_room()
        with bpy.data.libraries.load(file, link=True) as (_, linked):
            linked.collections = ["rig"]
        bpy.context.scene.collection.children.link(linked.collections[0])
        camera = linked.collections[0].objects["Cam"]
        self.assertIsNotNone(camera.library)
        rooms.new_camera([(1, (0, 0, 0), (0, 0, 0))])  # of the same name
        copy = self.planned(camera)
        self.assertIsNone(copy.library)
        self.assertEqual(rooms.touching_frames(copy), [])

    def test_rotation_modes_are_kept(self):
        for mode in ("QUATERNION", "ZXY", "YZX"):
            rooms.new_room()
            camera = rooms.new_camera(rooms.along_x(turned=(0, 10, 120)), mode=mode)
            copy = self.planned(camera)
            self.assertEqual(copy.rotation_mode, mode)
            self.assert_same(camera, copy, (1, 61, 121))
            self.assertEqual(rooms.touching_frames(copy), [])

    def test_quaternions_run_on_whatever_their_signs(self):
        rooms.new_room(pillar=None)
        camera = rooms.new_camera(rooms.along_x(turned=(0, 0, 300)), mode="QUATERNION")
        for curve in animation.fcurves_of(camera):  # -q, which is the same rotation
            if curve.data_path == "rotation_quaternion":
                for key in curve.keyframe_points:
                    key.co.y = -key.co.y
                curve.update()
        first = [animation.curve_of(camera, "rotation_quaternion", i).evaluate(1) for i in range(4)]
        copy = self.planned(camera)
        curves = [animation.curve_of(copy, "rotation_quaternion", i) for i in range(4)]
        rows = [[c.evaluate(f) for c in curves] for f in range(1, 122)]
        self.assertTrue(all(sum(a * b for a, b in zip(p, q)) > 0.9 for p, q in zip([first, *rows], rows)))

    def test_axis_and_angle_become_a_quaternion(self):
        rooms.new_room(pillar=None)
        camera = rooms.new_camera(rooms.along_x())
        camera.rotation_mode = "AXIS_ANGLE"
        for frame, angle in ((1, 0.0), (121, 1.0)):
            camera.rotation_axis_angle = (angle, 0, 0, 1)
            camera.keyframe_insert("rotation_axis_angle", frame=frame)
        copy = self.planned(camera)
        self.assertEqual(copy.rotation_mode, "QUATERNION")
        self.assert_same(camera, copy, (1, 121))

    def test_a_parent_that_turns_is_included(self):
        """The parent turns twice, is scaled and moves the camera alone; the copy has no parent."""
        rooms.new_room(pillar=(2.5, 2.0))
        table = rooms.empty("turntable")
        table.scale = (0.5, 0.5, 0.5)
        camera = rooms.new_camera([(1, (0, -4, 3), (80, 0, 0))])
        camera.animation_data_clear()
        camera.parent = table
        for frame, degrees in ((1, 0), (121, 720)):
            table.rotation_euler = (0, 0, math.radians(degrees))
            table.keyframe_insert("rotation_euler", frame=frame)
        copy = self.planned(camera)
        self.assertIsNone(copy.parent)
        self.assertEqual(tuple(copy.scale), (1, 1, 1))
        self.assert_same(camera, copy, range(1, 122), Difference(0.0101, 1.01))
        turned = [animation.curve_of(copy, "rotation_euler", 2).evaluate(f) for f in (1, 121)]
        self.assertAlmostEqual(math.degrees(turned[1] - turned[0]), 720.0, delta=1e-3)

    def test_a_mirrored_parent_mirrors_the_picture_and_not_the_way(self):
        rooms.new_room(pillar=None)
        parent = rooms.empty("mirror")
        parent.scale = (-2, 1, 1)
        camera = rooms.new_camera([(1, (1, -1, 1.5), (85, 10, 20)), (61, (0, 0, 1.5), (85, 0, 90))])
        camera.parent = parent
        copy = self.planned(camera)
        for frame in (1, 61):
            bpy.context.scene.frame_set(frame)
            # Blender shears what a scaled parent turns: the direction of view counts, and the place.
            for axis in (2, 3):
                a, b = (thing.matrix_world.col[axis].to_3d() for thing in (camera, copy))
                if axis == 2:
                    a.normalize()
                self.assertLess((a - b).length, 1e-5)
            self.assertLess(copy.matrix_world.determinant(), 0.0)

    def test_constraints_and_their_targets_are_included(self):
        rooms.new_room(pillar=None)
        target = rooms.empty("target")
        camera = rooms.new_camera([(1, (-2, -2, 1.5), (0, 0, 0)), (121, (2, -2, 1.5), (0, 0, 0))])
        track = camera.constraints.new("TRACK_TO")
        track.target, track.track_axis, track.up_axis = target, "TRACK_NEGATIVE_Z", "UP_Y"
        for frame, place in ((1, (0, 2, 1)), (40, (2, 2, 2)), (121, (-2, 2, 1))):
            target.location = place
            target.keyframe_insert("location", frame=frame)
        copy = self.planned(camera)
        self.assertEqual(len(copy.constraints), 0)
        times = [round(k["time"] * 24 + 1, 6) for k in self.read("request.json")["keyframes"]]
        self.assertIn(40.0, times)
        self.assert_same(camera, copy, range(1, 122), Difference(0.0101, 1.01))

    def test_motion_without_keys_is_read_over_the_scene(self):
        rooms.new_room(pillar=None, frames=(1, 50))
        camera = rooms.new_camera([(1, (0, 0, 1.5), (85, 0, 0))])
        camera.animation_data_clear()
        driver = camera.driver_add("location", 0).driver
        driver.expression = "sin(frame / 10)"
        copy = self.planned(camera)
        self.assert_same(camera, copy, range(1, 51), Difference(0.0101, 1.01))

    def test_cuts_are_told(self):
        rooms.new_room(pillar=None)
        camera = rooms.new_camera(rooms.along_x())
        for curve in animation.fcurves_of(camera):
            for key in curve.keyframe_points:
                key.interpolation = "CONSTANT"
        self.plan(camera)
        self.assertIn("the camera jumps before frame 61", self.lines(camera.camway))


if __name__ == "__main__":
    run_tests(__name__)
