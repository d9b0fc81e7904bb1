# SPDX-License-Identifier: MIT
"""The common part of the tests that run in Blender, without a window and with the real program."""
import json
import pathlib
import sys
import tempfile
import time
import unittest

import bpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[2] / "tools/blender"), str(HERE)]
sys.dont_write_bytecode = True

import camway  # noqa: E402
import rooms  # noqa: E402
from camway import run, shot_reader  # noqa: E402
from camway.motion import Difference, difference_of  # noqa: E402

# What floats of Blender leave of a position in a room, in metres, and of an angle, in degrees.
FLOAT = Difference(2e-6, 1e-4)


class CamwayTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def plan(self, camera, **settings):
        """Runs the operator as a script does, and returns what it left with the camera."""
        scene = bpy.context.scene
        scene.camway.camera = camera
        for name, value in settings.items():
            setattr(scene.camway, name, value)
        try:
            self.returned = bpy.ops.camway.plan(wait=True, folder=str(self.folder))
        except RuntimeError as error:
            self.returned = str(error)
        return camera.camway

    def planned(self, camera, **settings):
        """Plans, requires a proved path, and returns the copy."""
        result = self.plan(camera, **settings)
        self.assertEqual((result.status, self.returned), ("ok", {"FINISHED"}), result.message)
        return bpy.data.objects[camera.name + ".camway"]

    def read(self, name):
        return json.loads((self.folder / name).read_text())

    def poses(self, camera, frames):
        """Poses in metres at frames, from the matrix in the world."""
        found = []
        for frame in frames:
            rooms.go_to(frame)
            found.append(shot_reader.pose_of(camera.matrix_world, bpy.context.scene.unit_settings.scale_length))
        return found

    def assert_same(self, camera, copy, frames, limit=FLOAT):
        for frame, a, b in zip(frames, self.poses(camera, frames), self.poses(copy, frames)):
            difference = difference_of(a, b)
            self.assertLessEqual(difference.share_of(limit), 1.0, f"frame {frame}: {difference}")

    def assert_kept_files_belong_together(self):
        """The request that is kept has the answer that is kept."""
        steps = run.plan(run.find_program(), self.folder, self.read("request.json"))
        kept = self.read("response.json")["segments"]
        with self.assertRaises(StopIteration) as end:
            while True:
                next(steps)
        self.assertEqual(end.exception.value["segments"], kept)

    def lines(self, result):
        return "\n".join(line.text for line in result.lines)


def run_tests(module):
    """Runs the tests of a module, and ends Blender with their outcome."""
    camway.register()
    started = time.monotonic()
    chosen = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    outcome = unittest.main(module=module, argv=["blender", *chosen], exit=False)
    print(f"{outcome.result.testsRun} tests in {time.monotonic() - started:.1f} s")
    sys.exit(not outcome.result.wasSuccessful())
