# SPDX-License-Identifier: MIT
"""Classes of data: their conversion to C++ and back, JSON, and the texts of faults."""
import copy
import dataclasses
import inspect
import json
import pickle
import unittest

import numpy as np
import support

import camway
from camway import _native


class PackageTest(unittest.TestCase):
    def test_every_public_name_is_documented(self):
        for name in camway.__all__:
            with self.subTest(name):
                value = getattr(camway, name)
                if isinstance(value, type) or inspect.isfunction(value):
                    self.assertTrue(inspect.getdoc(value))
        for kind in (camway.Client, camway.Watch, camway.PendingPlan, camway.Path, camway.Scene, camway.Body,
                     camway.Request, camway.Answer, camway.SceneMesh):
            for name, member in vars(kind).items():
                if name.startswith("_") or not (inspect.isroutine(member) or isinstance(member, property)):
                    continue
                with self.subTest(f"{kind.__name__}.{name}"):
                    self.assertTrue(inspect.getdoc(member))

    def test_classes_say_what_each_member_is(self):
        for name in camway._types.__all__:
            kind = getattr(camway, name)
            if not dataclasses.is_dataclass(kind):
                continue
            for member in dataclasses.fields(kind):
                with self.subTest(f"{name}.{member.name}"):
                    self.assertIn(f"    {member.name}: ", inspect.getdoc(kind))
                    self.assertNotRegex(inspect.getdoc(kind), r"std::|::k[A-Z]|PlanRe")

    def test_a_misspelled_member_is_refused(self):
        with self.assertRaises(AttributeError):
            camway.Request().clearence_m = 0.1
        with self.assertRaises(TypeError):
            camway.Request(clearence_m=0.1)

    def test_data_can_be_copied_compared_and_pickled(self):
        request = camway.Request.from_json(support.request_document("office-graze-column"))
        for other in (copy.deepcopy(request), pickle.loads(pickle.dumps(request))):
            self.assertEqual(other, request)
            other.keyframes[0].position_m = (0.0, 0.0, 0.0)
            self.assertNotEqual(other, request)
        self.assertNotEqual(request, 1)


class ConversionTest(unittest.TestCase):
    def refused(self, error, text, **members):
        with self.assertRaisesRegex(error, text):
            _native.request_to_json(camway.Request(**members))

    def test_faults_name_the_member(self):
        pose = camway.Keyframe()
        self.refused(ValueError, r"^keyframes\[1\]\.position_m: must be 3 numbers, not 2$",
                     keyframes=[pose, camway.Keyframe(position_m=(1.0, 2.0))])
        self.refused(TypeError, r"^keyframes\[0\]\.position_m\[2\]: must be a number, not str$",
                     keyframes=[camway.Keyframe(position_m=(1.0, 2.0, "3"))])
        self.refused(TypeError, r"^keyframes\[0\]: must be a camway.Keyframe, not dict$", keyframes=[{}])
        self.refused(TypeError, r"^keyframes: must be a list, not int$", keyframes=3)
        self.refused(TypeError, r"^camera\.near_m: must be a number, not NoneType$", camera=camway.Camera(near_m=None))
        known = "closest, shortest, smoothest, safest"
        self.refused(ValueError, f"^objective: 'fastest' is unknown; the values are {known}$", objective="fastest")
        self.refused(ValueError, r"^max_inserted_keyframes: is beyond the range$", max_inserted_keyframes=2**40)
        self.refused(TypeError, r"^seed: must be a whole number, not float$", seed=1.5)
        self.refused(ValueError, r"^body\.vertices_m: must be an array of rows of 3 numbers$",
                     body=camway.Body.mesh([[1, 2]], [[0, 0, 0]]))
        self.refused(TypeError, r"^body\.triangles: must be an array of rows of 3 numbers, all whole$",
                     body=camway.Body.mesh([[1, 2, 3]], [[0.5, 0, 0]]))
        self.refused(TypeError, r"^scene: must be a text, not bytes$", scene=b"office")
        with self.assertRaisesRegex(TypeError, "^request: must be a camway.Request, not NoneType$"):
            _native.request_to_json(None)

    def test_arrays_will_do_for_points(self):
        wanted = camway.Request.from_json(support.request_document("office-graze-column"))
        given = copy.deepcopy(wanted)
        for keyframe in given.keyframes:
            keyframe.position_m = np.array(keyframe.position_m)
            keyframe.orientation_wxyz = list(keyframe.orientation_wxyz)
        self.assertEqual(_native.request_to_json(given), _native.request_to_json(wanted))

    def test_invalid_requests_name_their_field(self):
        request = camway.Request(keyframes=[camway.Keyframe(), camway.Keyframe(orientation_wxyz=(0, 0, 0, 0))])
        with self.assertRaises(camway.InvalidRequest) as raised:
            request.to_json()
        self.assertEqual(raised.exception.field, "keyframes[1].orientation_wxyz")
        self.assertEqual(raised.exception.status, "invalid")
        for text, field in (("camera: is missing", "camera"), ("out/r.json: camera: is missing", "camera"),
                            ("request: options.limits.speed_m_per_s: is -1", "options.limits.speed_m_per_s"),
                            ("invalid: keyframes[3].position_m[2]: is NaN", "keyframes[3].position_m[2]"),
                            ("invalid: keyframe 0 collides with a lamp", None)):
            self.assertEqual(camway.InvalidRequest(text).field, field, text)


class JsonTest(unittest.TestCase):
    def test_requests_come_back_from_json(self):
        rng = support.generator(self)
        seen = set()
        for _ in range(200):
            document = support.random_document(rng)
            seen |= set(document["options"]) | {document.get("body", {}).get("type")}
            request = camway.Request.from_json(document)
            again = camway.Request.from_json(request.to_json())
            # An angle may be off by a rounding, once.
            third = camway.Request.from_json(again.to_json())
            self.assertEqual(third, again)
            self.assertTrue(_nearly(request, again), f"{request}\n{again}")
        self.assertGreaterEqual(len(seen), 20)

    def test_documents_say_what_the_request_says(self):
        document = support.request_document("office-graze-column")
        written = camway.Request.from_json(document).to_json()
        for name, value in document["camera"].items():
            self.assertAlmostEqual(written["camera"][name], value, places=12)
        for one, other in zip(written["keyframes"], document["keyframes"], strict=True):
            self.assertEqual(one["position"], other["position"])
        self.assertNotIn("options", written)

    def test_answers_come_back_from_json(self):
        scene = camway.Scene.load(support.SCENES / "office.obj")
        for name in ("office-graze-column", "office-impossible-safe"):
            answer = camway.plan(scene, support.request_document(name))
            again = camway.Answer.from_json(answer.to_json())
            self.assertEqual(again.path, answer.path)
            self.assertEqual(json.dumps(again.to_json(timing=False)["segments"]),
                             json.dumps(answer.to_json(timing=False)["segments"]))
            self.assertEqual(again.status, answer.status)
            self.assertEqual(again.keyframes, answer.keyframes)
            self.assertEqual(again.infeasibility, answer.infeasibility)

    def test_faults_of_documents_are_those_of_the_command(self):
        bad_camera = {"fov_x_deg": 90, "fov_y_deg": 60, "near": -1}
        for document in ({}, {"camera": {}}, {"camera": bad_camera, "keyframes": []}, {"keyframes": [], "speed": 3}):
            with self.assertRaises(camway.InvalidRequest) as raised:
                camway.Request.from_json(document)
            done = support.subprocess.run([str(support.PROGRAMS / "camway"), "plan", "--request", "-"], text=True,
                                          input=json.dumps(document), capture_output=True, check=False)
            self.assertIn(str(raised.exception).removeprefix("request: "), done.stderr)


def _nearly(one, other):
    if dataclasses.is_dataclass(one):
        return all(_nearly(getattr(one, each.name), getattr(other, each.name)) for each in dataclasses.fields(one))
    if isinstance(one, (float, np.ndarray)) and not isinstance(one, bool):
        return np.allclose(one, other, rtol=4e-16, atol=0)
    if isinstance(one, (list, tuple)):
        return len(one) == len(other) and all(map(_nearly, one, other))
    return one == other


if __name__ == "__main__":
    unittest.main()
