# SPDX-License-Identifier: MIT
"""Planning without a daemon: the same bits as the command, evaluation of paths, checks, interruptions."""
import gc
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock
import warnings

import numpy as np
import support

import camway


def slow_document():
    """A request that takes many seconds."""
    document = support.request_document("office-wall-tour")
    tour = document["keyframes"]
    document["keyframes"] = (tour + tour[-2:0:-1]) * 4
    document["camera"] = {"fov_x_deg": 100, "fov_y_deg": 90, "near": 0.35}
    document["options"] = {"clearance_m": 0.05, "max_shrink": 0.5, "deadline_s": 60, "objective": "shortest"}
    return document


class PlanTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.office = camway.Scene.load(support.SCENES / "office.obj")

    def test_answers_are_those_of_the_command(self):
        rng = support.generator(self)
        documents = [support.request_document(name) for name in ("office-graze-slalom", "office-impossible-shaft")]
        documents += [support.random_document(rng) for _ in range(12)]
        statuses = set()
        with tempfile.TemporaryDirectory() as folder:
            requests = [pathlib.Path(folder) / f"{i}.json" for i in range(len(documents))]
            for file, document in zip(requests, documents):
                file.write_text(json.dumps(document | {"scene": str(support.SCENES / "office.obj")}))
            out = pathlib.Path(folder) / "out"
            out.mkdir()
            support.run_camway("plan", "--no-timing", "--response-dir", out, *(["--request", *requests]))
            for file, document in zip(requests, documents):
                wanted = json.loads((out / file.name).read_text())
                for given in (document, camway.Request.from_json(document)):
                    answer = self.answer(given)
                    statuses.add(answer.status)
                    made = answer.to_json(timing=False)
                    for name in ("status", "segments", "keyframes", "collisions", "remaining_collisions",
                                 "certificate", "clearance_profile", "scene_digest", "viewing_distance_m"):
                        self.assertEqual(made.get(name), wanted.get(name), f"{name} of {document}")
        self.assertGreaterEqual(statuses, {"ok", "infeasible", "invalid"})

    def answer(self, request):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", camway.CamwayWarning)
            try:
                return camway.plan(self.office, request)
            except camway.Error as error:
                return error.answer

    def test_a_scene_of_arrays_is_one_of_a_file(self):
        vertices = np.array([[0, 0, 0], [4, 0, 0], [4, 0, 4], [0, 0, 4.0]])
        plate = camway.Scene.from_arrays(vertices, [[0, 1, 2], [0, 2, 3]], name="plate")
        self.assertEqual(plate.info.num_triangles, 2)
        self.assertEqual(plate.info.bounds_max_m, (4.0, 0.0, 4.0))
        request = camway.Request(keyframes=[camway.Keyframe(position_m=(1, 1, 1)),
                                            camway.Keyframe(position_m=(3, -1, 3))])
        answer = camway.plan(plate, request)
        self.assertEqual(answer.status, "ok")
        self.assertGreater(len(answer.collisions), 0)
        triangle, origin = [[0, 1, 2]], [[0.0, 0.0, 0.0]]
        for vertices_m, triangles in (([[0, 0, np.nan]] * 3, triangle), (origin, triangle), (origin, [])):
            with self.assertRaises(ValueError):
                camway.Scene.from_arrays(vertices_m, triangles)

    def test_a_check_proves_what_was_planned(self):
        request = support.request_document("office-graze-column")
        answer = camway.plan(self.office, request)
        for path in (answer, answer.path, answer.to_json()):
            checked = camway.check(self.office, request, path)
            self.assertTrue(checked.free, checked.text)
        raw = camway.plan(self.office, request | {"options": {"max_inserted_keyframes": 0}})
        self.assertEqual(raw.status, "partial")
        self.assertFalse(camway.check(self.office, camway.Request.from_json(request), raw.path).free)

    def test_errors_name_the_file_of_a_scene(self):
        with self.assertRaisesRegex(camway.InvalidRequest, "nowhere.obj"):
            camway.Scene.load("nowhere.obj")
        with self.assertRaisesRegex(ValueError, "^up: 'left' is unknown; the values are as-in-file, z-to-y, y-to-z$"):
            camway.Scene.load(support.SCENES / "office.obj", up="left")

    def test_the_name_of_a_file_is_no_scene(self):
        for call in (camway.plan, lambda *arguments: camway.check(*arguments, {})):
            with self.assertRaisesRegex(TypeError, "^scene: must be a camway.Scene, not str$"):
                call("scenes/office.obj", support.request_document("office-graze-column"))

    def test_without_the_program_that_reads_scenes_it_says_where_it_looked(self):
        self.assertIn("camway-import is neither in /nowhere, beside this program nor on PATH",
                      self.load_in_another_process(CAMWAY_PROGRAMS="/nowhere"))

    def test_a_cache_that_is_set_up_wrong_is_warned_of(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(
                os.environ, CAMWAY_CACHE_DIR=os.path.join(folder, "cache"), CAMWAY_CACHE_BYTES="2GiB"):
            with self.assertWarnsRegex(UserWarning, "^CAMWAY_CACHE_BYTES is '2GiB'; it must be a whole number"):
                camway.Scene.load(str(support.SCENES / "office.obj"))

    def test_the_package_finds_the_programs_of_its_build(self):
        self.assertEqual(self.load_in_another_process(), "")

    def load_in_another_process(self, **environment):
        """Returns the standard error of a process that reads a scene, with nothing on its PATH."""
        inherited = {name: value for name, value in os.environ.items() if name != "CAMWAY_PROGRAMS"}
        code = "import camway; camway.Scene.load(__import__('sys').argv[1], use_cache=False)"
        done = subprocess.run([sys.executable, "-B", "-c", code, str(support.SCENES / "office.obj")], text=True,
                              env=inherited | {"PATH": "/nowhere"} | environment, capture_output=True, check=False)
        return done.stderr

    def test_a_scene_of_a_request_is_read_as_it_says(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "request.json"
            document = {"scene": str(support.SCENES / "office.obj"), "scale": 2.0, "up": "y-to-z"}
            file.write_text(json.dumps(document))
            self.assertEqual(camway.Scene.of_request(file).info.bounds_max_m, (60.0, 0.0, 21.6))

    def test_progress_is_told_and_can_end_a_plan(self):
        class Enough(Exception):
            pass

        def look(progress):
            stages.append(progress.stage)
            if progress.since_receipt_s > 0.3:
                raise Enough

        stages = []
        with self.assertRaises(Enough):
            camway.plan(self.office, slow_document(), on_progress=look)
        self.assertIn("correcting", stages)

    def test_ctrl_c_ends_a_plan_and_other_threads_run_meanwhile(self):
        ticks = []
        stop = threading.Event()

        def tick():
            while not stop.wait(0.01):
                ticks.append(time.monotonic())

        ticker = threading.Thread(target=tick)
        ticker.start()
        threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            camway.plan(self.office, slow_document())
        stop.set()
        ticker.join()
        self.assertGreater(len([tick for tick in ticks if tick > begin]), 5)

    def test_a_deadline_raises_timeout_with_the_best_path(self):
        document = slow_document()
        document["options"]["deadline_s"] = 0.1
        with self.assertRaises(camway.Timeout) as raised:
            camway.plan(self.office, document)
        self.assertIsInstance(raised.exception, TimeoutError)
        self.assertGreater(len(raised.exception.answer.path), 0)
        self.assertTrue(raised.exception.answer.deadline_reached)

    def test_quaternions_in_the_other_order_cause_a_warning(self):
        document = {"camera": {"fov_x_deg": 80, "fov_y_deg": 60, "near": 0.1},
                    "keyframes": [{"position": [12.5, 1.6, 12.8], "orientation": [0, -0.928, 0, 0.374]},
                                  {"position": [13.0, 1.6, 13.3], "orientation": [0, -0.928, 0, 0.374]}]}
        with self.assertWarns(camway.CamwayWarning):
            camway.plan(self.office, document)


class PathTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        office = camway.Scene.load(support.SCENES / "office.obj")
        cls.path = camway.plan(office, support.request_document("office-graze-slalom")).path

    def test_evaluation_is_that_of_the_curves(self):
        times = np.random.default_rng(1).uniform(self.path.begin_s - 1, self.path.end_s + 1, 2000)
        positions, orientations = self.path.evaluate(times)
        self.assertEqual((positions.shape, orientations.shape), ((2000, 3), (2000, 4)))
        for time_s, position, orientation in zip(times, positions, orientations):
            wanted = _evaluated(self.path.segments, time_s)
            np.testing.assert_allclose(position, wanted[0], rtol=0, atol=1e-12)
            np.testing.assert_allclose(orientation, wanted[1], rtol=0, atol=1e-12)

    def test_evaluation_has_the_bits_of_single_poses_and_of_the_command(self):
        times = np.linspace(self.path.begin_s, self.path.end_s, 301)
        positions, orientations = self.path.evaluate(times)
        for time_s, position, orientation in zip(times, positions, orientations):
            pose = self.path.pose(float(time_s))
            self.assertEqual(tuple(position), pose.position_m)
            self.assertEqual(tuple(orientation), pose.orientation_wxyz)

    def test_times_may_have_any_shape(self):
        for times, shape in ((1.0, ()), ([], (0,)), ([[1, 2, 3], [4, 5, 6]], (2, 3))):
            positions, orientations = self.path.evaluate(times)
            self.assertEqual((positions.shape, orientations.shape), (shape + (3,), shape + (4,)))
        self.assertTrue(np.isnan(self.path.evaluate([math.nan])[0]).all())
        self.assertTrue(np.isnan(camway.Path().evaluate([0.0])[1]).all())
        for times in (["soon"], None, "1", [1j], [[1], [1, 2]], np.array([1.0], object)):
            with self.assertRaisesRegex(TypeError, "^times_s: must be an array of numbers, not "):
                self.path.evaluate(times)
        with self.assertRaisesRegex(TypeError, "^time_s: must be a number, not str$"):
            self.path.pose("1")

    def test_control_points_are_views_that_keep_the_path(self):
        path = camway.Path(self.path.segments)
        segments = path.segments
        positions, orientations, joints = path.control_positions_m, path.control_orientations_wxyz, path.joints_s
        for view, name in ((positions, "position_m"), (orientations, "orientation_wxyz")):
            np.testing.assert_array_equal(view, [getattr(segment, name) for segment in segments])
            self.assertTrue(np.shares_memory(view, getattr(path, f"control_{name.replace('_', 's_', 1)}")), name)
            with self.assertRaises(ValueError):
                view[0] = 0.0
            with self.assertRaises(ValueError):
                view.setflags(write=True)
        self.assertEqual(joints.tolist(), [segment.t0_s for segment in segments] + [path.end_s])
        wanted = positions.copy()
        del path, segments
        gc.collect()
        others = [camway.Path(self.path.segments[:1]) for _ in range(100)]
        np.testing.assert_array_equal(positions, wanted)
        del others
        empty = camway.Path()
        self.assertEqual((empty.control_positions_m.shape, empty.control_orientations_wxyz.shape, empty.joints_s.shape),
                         ((0, 4, 3), (0, 7, 4), (0,)))

    def test_paths_are_made_of_segments(self):
        self.assertEqual(camway.Path(self.path.segments), self.path)
        segments = self.path.segments
        segments[1].t0_s += 1e-9
        with self.assertRaisesRegex(ValueError, r"segments\[1\]: does not begin where the one before ends"):
            camway.Path(segments)
        segments = self.path.segments
        segments[0].position_m = np.full((4, 3), np.inf)
        with self.assertRaisesRegex(ValueError, r"segments\[0\]: holds numbers that are not finite"):
            camway.Path(segments)


def _evaluated(segments, time_s):
    """An oracle: the sums of Bernstein polynomials."""
    segment = next((each for each in reversed(segments) if each.t0_s <= time_s), segments[0])
    u = min(max((time_s - segment.t0_s) / (segment.t1_s - segment.t0_s), 0.0), 1.0)

    def curve(points):
        degree = len(points) - 1
        return sum(math.comb(degree, i) * u**i * (1 - u) ** (degree - i) * point for i, point in enumerate(points))

    orientation = curve(segment.orientation_wxyz)
    return curve(segment.position_m), orientation / np.linalg.norm(orientation)


if __name__ == "__main__":
    unittest.main()
