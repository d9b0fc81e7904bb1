# SPDX-License-Identifier: MIT
"""Tests of the add-on with a real daemon, in a network namespace.

    CAMWAY=build/dev/bin/camway tools/scripts/netns.sh blender -b --factory-startup --python-exit-code 1 \\
        --python tests/tools/blender/daemon_test.py
"""
import os
import pathlib
import subprocess
import sys
import time

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from blender_case import CamwayTest, run_tests  # noqa: E402
import rooms  # noqa: E402
from camway import run  # noqa: E402

PROGRAM = run.find_program()
DAEMON = os.environ.get("CAMWAYD", str(pathlib.Path(PROGRAM).with_name("camwayd")))
PATIENCE_S = 60.0


class DaemonTest(CamwayTest):
    def setUp(self):
        super().setUp()
        self.log = self.folder / "camwayd.log"
        with open(self.log, "wb") as log:
            self.daemon = subprocess.Popen([DAEMON, "--prefix", "BLEND", "--scene-roots", str(self.folder)], stdout=log, stderr=log)
        self.addCleanup(self.stop)
        until = time.monotonic() + PATIENCE_S
        while "serving" not in self.log.read_text():
            self.assertIsNone(self.daemon.poll(), self.log.read_text())
            self.assertLess(time.monotonic(), until)
            time.sleep(0.02)
        self.scene = rooms.new_room()
        self.camera = rooms.new_camera(rooms.along_x())

    def stop(self):
        self.daemon.terminate()
        self.assertEqual(self.daemon.wait(PATIENCE_S), 0)

    def ask(self, *words):
        done = subprocess.run([PROGRAM, *words, "--prefix", "BLEND"], capture_output=True, text=True, check=False,
                              cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_daemon_plans_what_this_computer_plans(self):
        here = self.planned(self.camera)
        poses = self.poses(here, range(1, 122, 10))
        response = self.read("response.json")
        there = self.planned(self.camera, plan_with="DAEMON", daemon_prefix="BLEND")
        self.assertEqual(rooms.touching_frames(there), [])
        self.assertEqual(poses, self.poses(there, range(1, 122, 10)))
        self.assertEqual(self.read("response.json")["segments"], response["segments"])
        self.assertIn("status=ok", self.log.read_text())
        self.assertRegex(self.read("response.json")["scene"], "^blender-")
        # What was sent is forgotten.
        self.assertNotIn("blender-", self.ask("scene", "list"))

    def test_a_scene_of_the_daemon_counts_and_not_what_is_visible(self):
        self.planned(self.camera)  # leaves scene.obj
        self.ask("scene", "load", "set", "--upload", "scene.obj")
        bpy.data.objects.remove(bpy.data.objects["Säule 1"])
        copy = self.planned(self.camera, plan_with="DAEMON", daemon_prefix="BLEND", daemon_scene="set")
        self.assertEqual(self.read("response.json")["scene"], "set")
        self.assertTrue(self.read("response.json")["corrections"])
        self.assertIn("daemon's scene set", self.lines(self.camera.camway))
        rooms.box("Säule 1", (1.2, 0.4, 1.5), (0.3, 0.3, 3))
        self.assertEqual(rooms.touching_frames(copy), [])
        self.assertIn("set", self.ask("scene", "list"))

    def test_what_the_daemon_refuses_is_said(self):
        result = self.plan(self.camera, plan_with="DAEMON", daemon_prefix="BLEND", daemon_scene="cellar")
        self.assertEqual(result.status, "error")
        self.assertIn("cellar", result.message)
        result = self.plan(self.camera, daemon_prefix="NOBODY", daemon_scene="")
        self.assertEqual(result.status, "error")
        self.assertIn("no daemon", result.message)


if __name__ == "__main__":
    run_tests(__name__)
