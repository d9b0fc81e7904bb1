# SPDX-License-Identifier: MIT
"""Tests of the scripts that `camway export --format blender` writes: Blender runs them.

    CAMWAY=build/dev/bin/camway blender -b --factory-startup --python-exit-code 1 \\
        --python tests/tools/blender/script_test.py
"""
import json
import math
import os
import pathlib
import subprocess
import sys

import bpy
from mathutils import Quaternion

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from blender_case import CamwayTest, run_tests  # noqa: E402
import rooms  # noqa: E402
from camway.animation import fcurves_of  # noqa: E402

PROGRAM = os.environ.get("CAMWAY", "camway")
REQUESTS = pathlib.Path(__file__).resolve().parents[3] / "scenes/requests"
CLOSE = 1e-5
SINGLE_PRECISION = 1e-6  # of numbers near 1 that Blender computes from others


def camway(*words):
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True).stdout


class ScriptTest(CamwayTest):
    def run_script(self, request, *words):
        """Plans a request of the scenes, exports it, and runs the script in an empty file."""
        file = REQUESTS / f"{request}.json"
        response = self.folder / "response.json"
        camway("plan", "--request", file, "--response", response)
        self.answer, self.request = self.read("response.json"), json.loads(file.read_text())
        script = self.folder / "shot.py"
        camway("export", response, "--request", file, "--format", "blender", "--out", script, *words)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        exec(compile(script.read_text(), str(script), "exec"), {"__name__": "__main__"})
        self.scene = bpy.context.scene
        return self.scene.camera

    def samples(self, fps):
        return json.loads(camway("sample", self.folder / "response.json", "--fps", fps, "--json"))

    def assert_at(self, camera, frame, position, orientation):
        rooms.go_to(frame)
        place, turn, _ = camera.matrix_world.decompose()
        self.assertLess((place - type(place)(position)).length, CLOSE, frame)
        sign = 1 if turn.dot(Quaternion(orientation)) > 0 else -1
        for x, y in zip(turn, orientation):
            self.assertAlmostEqual(sign * x, y, delta=CLOSE, msg=frame)

    def test_the_camera_is_where_the_path_is(self):
        camera = self.run_script("office-graze-column")
        samples = self.samples(24)
        for i, sample in enumerate(samples):
            self.assert_at(camera, 1 + i, sample["position"], sample["orientation"])
        self.assertEqual((self.scene.frame_start, self.scene.frame_end), (1, len(samples)))

    def test_between_frames_it_moves_straight(self):
        camera = self.run_script("office-graze-column", "--fps", 12)
        samples = self.samples(12)
        for i, (a, b) in enumerate(zip(samples, samples[1:])):
            sign = 1 if sum(x * y for x, y in zip(a["orientation"], b["orientation"])) > 0 else -1
            blend = [x + sign * y for x, y in zip(a["orientation"], b["orientation"])]
            length = math.hypot(*blend)
            self.assert_at(camera, 1.5 + i, [0.5 * (x + y) for x, y in zip(a["position"], b["position"])],
                           [x / length for x in blend])
        for curve in fcurves_of(camera):
            self.assertEqual({point.interpolation for point in curve.keyframe_points}, {"LINEAR"})

    def test_lens_and_rate_are_those_of_the_request(self):
        camera = self.run_script("office-graze-column", "--fps", 23.976, "--width", 1000)
        self.assertAlmostEqual(math.degrees(camera.data.angle_x), self.request["camera"]["fov_x_deg"], delta=1e-4)
        frame = camera.data.view_frame(scene=self.scene)
        height = max(c.y for c in frame) / -frame[0].z
        expected = math.tan(math.radians(self.request["camera"]["fov_y_deg"]) / 2)
        self.assertAlmostEqual(height, expected, delta=SINGLE_PRECISION)
        self.assertAlmostEqual(camera.data.clip_start, self.request["camera"]["near"], delta=1e-7)
        self.assertAlmostEqual(self.scene.render.fps / self.scene.render.fps_base, 23.976, delta=1e-5)
        self.assertEqual(self.scene.render.resolution_x, 1000)

    def test_both_fields_of_view_are_those_of_the_request_in_a_picture_of_any_size(self):
        for width, height in ((1000, 1000), (1920, 1080), (640, 1200)):
            camera = self.run_script("office-graze-column", "--width", width, "--height", height)
            frame = camera.data.view_frame(scene=self.scene)
            for axis, angle in ((0, "fov_x_deg"), (1, "fov_y_deg")):
                shown = 2 * math.atan(max(corner[axis] for corner in frame) / -frame[0].z)
                self.assertAlmostEqual(math.degrees(shown), self.request["camera"][angle],
                                       delta=math.degrees(SINGLE_PRECISION))

    def test_markers_are_at_the_corrected_stretch(self):
        self.run_script("office-graze-column")
        begin, end = self.scene.timeline_markers
        changed = self.answer["corrections"][0]["changed"]
        self.assertRegex(begin.name, r"^corrected 1 \(\d+ mm\)$")
        self.assertEqual(end.name, "end 1")
        self.assertEqual([begin.frame, end.frame], [1 + round(24 * time) for time in changed])

    def test_names_are_no_code(self):
        name = 'Zoë "1"\\\n#; raise'
        self.assertEqual(self.run_script("office-free-door", "--name", name).name, name)

    def test_import_takes_the_script_back(self):
        self.run_script("office-graze-column", "--name", "Hero")
        done = subprocess.run([PROGRAM, "import", self.folder / "shot.py", "--request", self.folder / "again.json"],
                              check=True, capture_output=True, text=True)
        self.assertIn("blender, camera 'Hero': 171 poses, 24 frames a second", done.stderr)
        self.assertAlmostEqual(self.read("again.json")["camera"]["fov_y_deg"], self.request["camera"]["fov_y_deg"])


if __name__ == "__main__":
    run_tests(__name__)
