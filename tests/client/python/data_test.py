# SPDX-License-Identifier: MIT
"""Classes of data: their conversion to C++ and back, JSON, and the texts of faults."""
import copy
import dataclasses
import inspect
import json
import pickle
import sys
import threading
import unittest

import numpy as np
import support

import camway
from camway import _native

# Threads take turns after nearly each step of the interpreter, so that they meet in the middle of a change.
SHORT_SWITCH_S = 1e-6


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


class LazyTest(unittest.TestCase):
    """Answers whose members are converted when they are asked for are as others."""

    @classmethod
    def setUpClass(cls):
        cls.office = camway.Scene.load(support.SCENES / "office.obj")

    def answer(self, name="office-graze-slalom"):
        return camway.plan(self.office, support.request_document(name))

    def test_members_do_not_depend_on_the_order_in_which_they_are_asked_for(self):
        names = [member.name for member in dataclasses.fields(camway.Answer)]
        rng = support.generator(self)
        document = self.answer().to_json(timing=False)
        whole = camway.Answer(**{name: getattr(camway.Answer.from_json(document), name) for name in names})
        self.assertGreater(len(whole.keyframes), 2)
        for _ in range(20):
            lazy = camway.Answer.from_json(document)
            for name in rng.sample(names, rng.randint(0, len(names))):
                value = getattr(lazy, name)
                self.assertEqual(value, getattr(whole, name), name)
                self.assertIs(type(value), type(getattr(whole, name)), name)
                self.assertIs(getattr(lazy, name), value, "each time the same object")
            self.assertEqual(lazy, whole)
            self.assertEqual(repr(lazy), repr(whole))

    def test_members_can_be_changed_and_stay_so(self):
        answer = self.answer()
        answer.message = "mine"
        answer.keyframes.append(answer.keyframes[0])
        answer.keyframes[1].position_m = (1.0, 2.0, 3.0)
        answer.collisions = []
        self.assertEqual(answer.message, "mine")
        self.assertIs(answer.keyframes[-1], answer.keyframes[0])
        self.assertEqual(answer.keyframes[1].position_m, (1.0, 2.0, 3.0))
        self.assertEqual(answer.collisions, [])
        self.assertNotEqual(answer, self.answer())

    def test_they_are_copied_and_pickled_whole(self):
        wanted = self.answer().to_json(timing=False)
        for copied in (copy.copy, copy.deepcopy, lambda answer: pickle.loads(pickle.dumps(answer)),
                       lambda answer: dataclasses.replace(answer, message=answer.message)):
            answer = self.answer()
            status = answer.status
            other = copied(answer)
            del answer
            self.assertEqual(other.status, status)
            self.assertEqual(other.to_json(timing=False), wanted)
            with self.assertRaises(AttributeError):
                other._source  # noqa: B018  it would be of the process that made it
        self.assertEqual(set(dataclasses.asdict(self.answer())), set(camway.Answer.__match_args__))

    def test_there_are_no_other_members(self):
        for answer in (self.answer(), camway.Answer()):
            with self.assertRaisesRegex(AttributeError, "^'(camway._types.)?Answer' object has no attribute 'keyframe_'$"):
                answer.keyframe_
            with self.assertRaises(AttributeError):
                answer.keyframe_ = 3
            self.assertFalse(hasattr(answer, "__array__"))

    def test_threads_see_the_same_objects(self):
        self.addCleanup(sys.setswitchinterval, sys.getswitchinterval())
        sys.setswitchinterval(SHORT_SWITCH_S)
        for _ in range(20):
            answer, seen, barrier = self.answer("office-graze-column"), [], threading.Barrier(8)

            def look():
                barrier.wait()
                seen.append([answer.keyframes, answer.corrections, answer.path])

            threads = [threading.Thread(target=look) for _ in range(8)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(len({tuple(map(id, each)) for each in seen}), 1)


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

    def test_keyframes_are_made_of_arrays(self):
        rng = np.random.default_rng(5)
        positions, orientations = rng.normal(size=(6, 3)), rng.normal(size=(6, 4))
        made = camway.Keyframe.from_arrays(positions.astype(np.float32), orientations[::-1], range(6))
        self.assertEqual(made, [camway.Keyframe(float(i), positions[i].astype(np.float32).tolist(),
                                                orientations[5 - i].tolist()) for i in range(6)])
        self.assertIs(type(made[0].position_m[0]), float)
        self.assertEqual(camway.Keyframe.from_arrays([[1, 2, 3]]), [camway.Keyframe(position_m=(1.0, 2.0, 3.0))])
        self.assertEqual(camway.Keyframe.from_arrays(np.empty((0, 3))), [])
        for text, arguments in (("positions_m: must be an array of rows of 3 numbers", [[1, 2, 3]]),
                                ("positions_m: must be an array of rows of 3 numbers", [1.0]),
                                ("orientations_wxyz: are 1, and there are 2 positions",
                                 [positions[:2], orientations[:1]]),
                                ("times_s: are 2, and there are 1 positions", [positions[:1], None, [0, 1]])):
            with self.assertRaisesRegex(ValueError, f"^{text}$"):
                camway.Keyframe.from_arrays(*arguments)

    def test_numbers_of_documents_may_be_numpys_and_have_to_be_finite(self):
        wanted = support.request_document("office-graze-column")
        given = copy.deepcopy(wanted)
        for keyframe in given["keyframes"]:
            keyframe["position"] = np.array(keyframe["position"])
            keyframe["orientation"] = np.array(keyframe["orientation"])
        given["camera"]["near"] = np.float64(given["camera"]["near"])
        self.assertEqual(camway.Request.from_json(given), camway.Request.from_json(wanted))
        given["keyframes"][1]["position"][2] = np.nan
        with self.assertRaisesRegex(camway.InvalidRequest, r"^keyframes\[1\]\.position\[2\]: is not finite$") as raised:
            camway.Request.from_json(given)
        self.assertEqual(raised.exception.field, "keyframes[1].position[2]")
        given["keyframes"][1]["position"] = {1.0, 2.0}
        with self.assertRaisesRegex(TypeError, "^a document of JSON has no set$"):
            camway.Request.from_json(given)
        with self.assertRaisesRegex(ValueError, r"^vertices_m\[1\]: is not finite$"):
            camway.SceneMesh.from_arrays([[0, 0, 0], [1, np.nan, 0], [0, 1, 0]], [[0, 1, 2]])

    def test_texts_are_characters(self):
        self.refused(ValueError, "^scene: has a surrogate, which is no character$", scene="b\udc80")

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
