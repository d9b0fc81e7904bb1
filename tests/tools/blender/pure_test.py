#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of the parts of the Blender add-on that need no Blender, with the real program.

    CAMWAY=build/dev/bin/camway tests/tools/blender/pure_test.py
"""
import math
import os
import pathlib
import shutil
import stat
import sys
import tempfile
import time
import unittest
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools/blender"))

import make_archive  # noqa: E402
from camway import answer, motion, request, run  # noqa: E402
from camway.motion import Difference, Path, Pose, Sample  # noqa: E402

PROGRAM = os.environ.get("CAMWAY", "camway")
VIEW = request.View(54.0, 32.0, 0.1)

# A wall across X = 1, from which a slot about Y = 0 is left out.
WALL = """g lower
v 1 -5 -5
v 1 -0.5 -5
v 1 -0.5 5
v 1 -5 5
f 1 2 3 4
g upper
v 1 0.5 -5
v 1 5 -5
v 1 5 5
v 1 0.5 5
f 5 6 7 8
"""


def about_z(degrees):
    return math.cos(math.radians(degrees) / 2.0), 0.0, 0.0, math.sin(math.radians(degrees) / 2.0)


def shot_of(pose, frames=range(1, 102), fixed=(), fps=24.0, **members):
    """A shot whose pose at a frame is `pose(frame)`."""
    samples = [Sample(float(frame), Pose(*pose(frame))) for frame in frames]
    return request.Shot(samples, {float(f) for f in fixed}, fps, VIEW, **members)


class MotionTest(unittest.TestCase):
    def test_turns_are_measured_by_the_shorter_way(self):
        for degrees in (0.0, 1e-5, 30.0, 120.0, 179.0):
            opposite = tuple(-x for x in about_z(degrees))
            self.assertAlmostEqual(motion.turn_deg(about_z(0.0), opposite), degrees, delta=1e-9)
        self.assertAlmostEqual(motion.turn_deg(about_z(0.0), about_z(270.0)), 90.0, delta=1e-9)

    def test_a_path_ends_where_its_segments_end(self):
        segment = {"t0": 1.0, "t1": 3.0, "position": [[x, 0, 0] for x in range(4)], "orientation": [about_z(0.0)] * 7}
        path = Path([segment, {**segment, "t0": 3.0, "t1": 4.0, "position": [[3, y, 0] for y in range(4)]}])
        for time_s, position in ((0.0, (0, 0, 0)), (2.0, (1.5, 0, 0)), (3.5, (3, 1.5, 0)), (9.0, (3, 3, 0))):
            self.assertEqual(path.pose(time_s).position, position)

    def test_jumps_are_steps_unlike_their_neighbours(self):
        def with_cut(frame):
            return (0.01 * frame + (3.0 if frame >= 40 else 0.0), 0.0, 0.0), about_z(0.0)
        limit = Difference(0.01, 1.0)
        self.assertEqual(motion.jumps(shot_of(with_cut).samples, limit), [40.0])
        self.assertEqual(motion.jumps(shot_of(lambda f: ((f * f, 0, 0), about_z(5 * f))).samples, limit), [])


class KeyframesTest(unittest.TestCase):
    """`choose_keyframes` with the interpolation of the real program."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def choose(self, shot):
        return request.choose_keyframes(shot, lambda keys: run.interpolate(PROGRAM, self.folder, shot, keys))

    def assert_follows(self, shot, chosen):
        """The path is within the limits of every sample, by what the program says of its own path."""
        worst = Difference()
        for sample in shot.samples:
            worst = worst.with_largest(motion.difference_of(sample.pose, chosen.path.pose(shot.time_s(sample.frame))))
        self.assertLessEqual(worst.share_of(shot.within), 1.0)
        self.assertAlmostEqual(worst.distance_m, chosen.strays.distance_m, delta=1e-9)
        self.assertAlmostEqual(worst.angle_deg, chosen.strays.angle_deg, delta=1e-6)

    def test_turns_of_any_number_come_out_as_they_were(self):
        for degrees in (90.0, 450.0, 3600.0):
            shot = shot_of(lambda f: ((0.02 * f, 0.0, 1.5), about_z(degrees * (f - 1) / 100)), fixed=(1, 101))
            chosen = self.choose(shot)
            self.assert_follows(shot, chosen)
            self.assertLess(len(chosen.keyframes), 3 + degrees / 30.0)

    def test_curves_are_followed_within_the_limits(self):
        def curve(frame):
            turn = 0.1 * (frame - 1)
            return (2 * math.cos(turn), 3 * math.sin(0.7 * turn), 0.1 * turn ** 2), about_z(40 * math.sin(turn))
        for within in (Difference(0.1, 5.0), Difference(0.01, 1.0), Difference(0.001, 0.1)):
            shot = shot_of(curve, fixed=(1, 40, 101), within=within)
            chosen = self.choose(shot)
            self.assert_follows(shot, chosen)
            self.assertLessEqual(shot.fixed, {k.frame for k in chosen.keyframes})

    def test_a_camera_that_stops_and_goes_does_not_ring(self):
        shot = shot_of(lambda f: ((0.1 * min(max(f - 30, 0), 40), 0, 0), about_z(0)), fixed=(1, 30, 70, 101))
        self.assert_follows(shot, self.choose(shot))

    def test_keyframes_are_at_whole_frames_where_they_can_be(self):
        frames = [1 + i / 2 for i in range(201)]
        shot = shot_of(lambda f: ((math.sin(0.1 * f), 0, 0), about_z(9 * f)), frames, fixed=(1, 101))
        self.assertTrue(all(k.frame.is_integer() for k in self.choose(shot).keyframes))

    def test_no_gap_turns_far(self):
        shot = shot_of(lambda f: ((0, 0, 0), about_z(25.0 * f)))
        frames = sorted(request.with_turns(shot, {0, 100}))
        self.assertTrue(all(25.0 * (b - a) <= request.LARGEST_TURN_DEG for a, b in zip(frames, frames[1:])))

    def test_samples_in_an_obstacle_are_left_out_and_fixed_ones_kept(self):
        shot = shot_of(lambda f: ((0.1 * f, 0, 0), about_z(0)), fixed=(1, 50, 101))
        every_fifth = [s for s in shot.samples if s.frame % 5 == 0 or s.frame in shot.fixed]
        hit = {"t_begin": shot.time_s(45), "t_end": shot.time_s(55), "witness": {"object": "post"}}
        first = next(request.choices(shot, every_fifth, [hit]))
        frames = {k.frame for k in first}
        self.assertEqual({f for f in frames if 45 <= f <= 55}, {50.0})
        self.assertLessEqual({1.0, 25.0, 80.0, 101.0}, frames)
        *_, last = request.choices(shot, every_fifth, [hit])
        self.assertEqual({k.frame for k in last}, {1.0, 50.0, 101.0})

    def test_what_an_obstacle_encloses_is_left_out_in_the_end(self):
        shot = shot_of(lambda f: ((0.1 * f, 0, 0), about_z(0)), fixed=(1, 101))
        hits = [{"t_begin": shot.time_s(f), "t_end": shot.time_s(f + 1), "witness": {"object": "block"}}
                for f in (20, 80)]
        tries = [{k.frame for k in choice} for choice in request.choices(shot, shot.samples, hits)]
        self.assertIn(50.0, tries[0])
        self.assertNotIn(50.0, tries[1])

    def test_sizes_of_the_picture_become_angles(self):
        corners = [(x, y, -2.0) for x in (-1.0, 1.0) for y in (-0.5, 0.5)]
        view = request.view_of(corners, 0.1)
        self.assertAlmostEqual(view.fov_x_deg, 2 * math.degrees(math.atan(0.5)))
        self.assertAlmostEqual(view.fov_y_deg, 2 * math.degrees(math.atan(0.25)))
        shifted = request.view_of([(x + 0.5, y, z) for x, y, z in corners], 0.1)
        self.assertAlmostEqual(shifted.fov_x_deg, 2 * math.degrees(math.atan(0.75)))
        self.assertEqual(request.widest([view, shifted._replace(near_m=0.2)]),
                         (shifted.fov_x_deg, view.fov_y_deg, 0.2))
        self.assertAlmostEqual(view.corner_m, 0.1 * math.hypot(1.0, 0.5, 0.25))


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "scene.obj").write_text(WALL)

    def finish(self, steps):
        while True:
            try:
                next(steps)
            except StopIteration as end:
                return end.value

    def plan(self, shot, **members):
        asked = {**request.request_of(shot, shot.samples, "scene.obj"), **members}
        content = self.finish(run.plan(PROGRAM, self.folder, asked))
        return answer.Answer(shot, [s.frame for s in shot.samples], asked, content)

    def crossing(self, y=0.0, first=7):
        """Two keys, at `first` and two seconds later, on both sides of the wall. The camera looks along -X."""
        orientation = tuple(0.5 for _ in range(4))  # -Z of the camera is -X of the world
        samples = [Sample(first, Pose((-1.0, y, 0.0), orientation)),
                   Sample(first + 48.0, Pose((3.0, y, 0.0), orientation))]
        return request.Shot(samples, {s.frame for s in samples}, 24.0, VIEW)

    def test_an_answer_counts_in_frames_of_the_shot(self):
        reply = self.plan(self.crossing())
        self.assertEqual((reply.status, reply.is_certified), ("ok", True))
        self.assertEqual(reply.frame_of_keyframes("given"), [7.0, 55.0])
        self.assertEqual(answer.whole_frames(reply.shot, reply.path), [float(f) for f in range(7, 56)])
        self.assertEqual(answer.changed_stretches(reply), [])

    def test_a_collision_is_named_with_its_frames_and_corrected(self):
        shot = self.crossing(y=0.52)
        found = self.finish(run.check(PROGRAM, self.folder, request.request_of(shot, shot.samples, "scene.obj"),
                                      run.interpolate(PROGRAM, self.folder, shot, shot.samples)))
        row, = answer.collisions_of(shot, found["collisions"])
        self.assertEqual(row.thing, "upper")
        # The eye is at the wall half way, the near plane 0.1 m behind it on the way.
        self.assertAlmostEqual((row.begin + row.end) / 2.0, 7 + 48 * 0.525, delta=0.3)
        reply = self.plan(shot)
        self.assertEqual(reply.status, "ok")
        self.assertTrue(reply.frame_of_keyframes("inserted"))
        ends = shot.samples
        shot.samples = [Sample(7 + f, Pose((-1 + 4 * f / 48, 0.52, 0), ends[0].pose.orientation)) for f in range(49)]
        stretch, = answer.changed_stretches(reply)
        self.assertTrue(7 < stretch.begin < row.begin and row.end < stretch.end < 55)
        self.assertGreater(stretch.largest.distance_m, 0.05)

    def test_messages_name_keyframes_by_frames(self):
        shot = self.crossing()
        inside = Sample(31.0, Pose((1.1, 2.0, 0.0), shot.samples[0].pose.orientation))
        shot.samples.insert(1, inside)
        reply = self.plan(shot)
        self.assertEqual((reply.status, reply.faulty_frames), ("invalid", [31.0]))
        self.assertTrue(reply.message.startswith("keyframe at frame 31: the near quadrilateral collides"), reply.message)
        self.assertFalse(reply.is_final)  # the keyframe was sampled
        shot.fixed.add(31.0)
        self.assertTrue(reply.is_final)
        self.assertFalse(reply.has_path)

    def test_a_missing_program_is_named(self):
        with self.assertRaisesRegex(run.CamwayError, "'/nowhere/camway' was not found"):
            run.find_program("/nowhere/camway")

    def test_the_words_of_the_program_are_told(self):
        shot = self.crossing()
        for change, words in (({"options": {"clearance_m": -1}}, "clearance_m"), ({"scene": "gone.obj"}, "no such file"),
                              ({"wrong": 1}, "wrong")):
            asked = {**request.request_of(shot, shot.samples, "scene.obj"), **change}
            try:
                told = self.finish(run.plan(PROGRAM, self.folder, asked))["message"]
            except run.CamwayError as error:
                told = str(error)
            self.assertIn(words, told)
            self.assertNotIn("request.json", run.plain(told))

    def script(self, text):
        file = self.folder / "program"
        file.write_text("#!/bin/sh\n" + text)
        file.chmod(file.stat().st_mode | stat.S_IXUSR)
        return str(file)

    def test_a_program_that_says_nothing_is_an_error(self):
        with self.assertRaisesRegex(run.CamwayError, "exit code 9"):
            self.finish(run.plan(self.script("exit 9\n"), self.folder, {}))
        with self.assertRaisesRegex(run.CamwayError, "broken pipe of doom"):
            self.finish(run.plan(self.script("echo camway: broken pipe of doom >&2; exit 1\n"), self.folder, {}))
        with self.assertRaisesRegex(run.CamwayError, "does not start"):
            self.finish(run.plan(str(self.folder / "scene.obj"), self.folder, {}))

    def test_a_run_that_is_given_up_ends_the_program(self):
        steps = run.plan(self.script("echo $$ >pid; exec sleep 600\n"), self.folder, {})
        pid = self.folder / "pid"
        while not (pid.exists() and pid.read_text().strip()):
            next(steps)
            time.sleep(0.001)
        steps.close()
        with self.assertRaises(ProcessLookupError):
            os.kill(int(pid.read_text()), 0)

    def test_numbers_that_are_not_finite_are_never_sent(self):
        with self.assertRaises(ValueError):
            self.finish(run.plan(PROGRAM, self.folder, {"scale": math.nan}))


class WordsTest(unittest.TestCase):
    def test_lengths_have_a_unit_that_suits_them(self):
        for metres, words in ((1.9, "1.9 m"), (0.0123, "12.3 mm"), (0.9996, "1 m"), (4e-6, "4 µm"), (3e-8, "30 nm"),
                              (0.0, "0 mm")):
            self.assertEqual(answer.length_words(metres), words)

    def test_frames_are_whole_where_they_can_be(self):
        self.assertEqual([answer.frame_words(f) for f in (12.0, 12.004, 12.49)], ["12", "12", "12.5"])

    def test_a_path_that_ends_between_frames_has_a_key_there(self):
        shot = shot_of(lambda f: ((f, 0, 0), about_z(0)), [1.0, 1.5, 2.0, 2.25], fps=8.0)
        segment = {"t0": 0.0, "t1": 1.25 / 8.0, "position": [(0, 0, 0)] * 4, "orientation": [about_z(0)] * 7}
        self.assertEqual(answer.whole_frames(shot, Path([segment])), [1.0, 2.0, 2.25])


class ArchiveTest(unittest.TestCase):
    """Two builds of a release are compared byte by byte, in folders whose files have other times and modes."""

    def test_same_modules_give_the_same_bytes(self):
        made = []
        with tempfile.TemporaryDirectory() as folder:
            for checkout, mode, at_s in (("one", 0o644, 1e9), ("other", 0o755, 1.7e9)):
                package = pathlib.Path(folder, checkout, "camway")
                shutil.copytree(ROOT / "tools/blender/camway", package, ignore=shutil.ignore_patterns("__pycache__"))
                for module in sorted(package.iterdir(), reverse=checkout == "other"):
                    module.chmod(mode)
                    os.utime(module, (at_s, at_s))
                archive = pathlib.Path(folder, f"{checkout}.zip")
                make_archive.make_archive(archive, package.parent)
                made.append(archive.read_bytes())
            with zipfile.ZipFile(archive) as read:
                names = read.namelist()
                self.assertEqual(names, sorted(f"camway/{module.name}" for module in package.glob("*.py")))
                self.assertIn("camway/__init__.py", names)
                self.assertEqual(read.read("camway/__init__.py"), (package / "__init__.py").read_bytes())
        self.assertEqual(*made)


if __name__ == "__main__":
    unittest.main()
