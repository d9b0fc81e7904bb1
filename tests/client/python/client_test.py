# SPDX-License-Identifier: MIT
"""The client against a daemon."""
import asyncio
import concurrent.futures
import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
import weakref

import numpy as np
import support

import camway



def setUpModule():
    unittest.enterModuleContext(support.Daemon())


WALL = camway.SceneBox((0.2, 3.0, 3.0))


def request_of(name, scene="office", **members):
    request = camway.Request.from_json(support.request_document(name))
    request.scene = scene
    for member, value in members.items():
        setattr(request, member, value)
    return request


def long_request(deadline_s=30.0):
    request = request_of("office-wall-tour", deadline_s=deadline_s, clearance_m=0.05, max_shrink=0.5, objective="shortest")
    request.camera = camway.Camera(1.7, 1.5, 0.35)
    request.keyframes = (request.keyframes + request.keyframes[-2:0:-1]) * 4
    return request


class ClientTest(unittest.TestCase):
    def setUp(self):
        self.client = self.enterContext(camway.Client())

    def test_plans_have_the_bits_of_planning_here(self):
        office = camway.Scene.load(support.SCENES / "office.obj")
        rng = support.generator(self)
        documents = [support.request_document(name) for name in ("office-graze-column", "office-impossible-safe")]
        for document in documents + [support.random_document(rng) for _ in range(3)]:
            answers = []
            for plan in (lambda request: self.client.plan(request), lambda request: camway.plan(office, request)):
                request = camway.Request.from_json(document)
                request.scene = "office"
                try:
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore", camway.CamwayWarning)
                        answers.append(plan(request))
                except camway.Error as error:
                    answers.append(error.answer)
            for member in ("status", "message", "path", "keyframes", "frame", "collisions", "remaining", "certified",
                           "clearance_lower_bound_m", "corrections", "infeasibility", "keyframe_faults", "bounds",
                           "viewing_distance_m"):
                self.assertEqual(getattr(answers[0], member), getattr(answers[1], member), f"{member} of {document}")

    def test_errors_are_those_of_the_cpp_client(self):
        with self.assertRaises(camway.UnknownScene) as raised:
            self.client.plan(request_of("office-graze-column", "attic"))
        self.assertRegex(str(raised.exception), "^the daemon does not hold scene \"attic\": scene: 'attic' is unknown")
        self.assertEqual(raised.exception.answer.status, "unknown_scene")
        with self.assertRaises(camway.InvalidRequest) as raised:
            self.client.plan(camway.Request("office", keyframes=[camway.Keyframe()]))
        self.assertEqual(raised.exception.field, "keyframes")
        with self.assertRaises(camway.UnknownScene) as raised:
            self.client.describe_scene("attic")
        self.assertIn(str(raised.exception), support.run_camway("scene", "describe", "attic")[1])
        with self.assertRaises(camway.NoMap) as raised:
            self.client.load_scene("blank")
            self.client.occupancy("blank", points_m=[[0, 0, 0]])
        _, said = support.run_camway("occupancy", "--daemon", "blank", "--point", "0,0,0")
        self.assertIn(str(raised.exception), said)
        with self.assertRaisesRegex(camway.InvalidRequest, "^points_m: are none$"):
            self.client.insert_scan("office", "map", [], (0, 0, 0))
        with self.assertRaisesRegex(camway.InvalidRequest, "prefix"):
            camway.Client(prefix="not a prefix")
        with self.assertRaisesRegex(camway.InvalidRequest, "nowhere"):
            camway.Client(key_file="/nowhere/keys")
        self.client.close()
        with self.assertRaisesRegex(camway.InvalidRequest, "^this client is closed$"):
            self.client.list_scenes()

    def test_results_without_a_path_are_no_errors(self):
        answer = self.client.plan(request_of("office-impossible-safe"))
        self.assertEqual((answer.status, answer.ok, answer.certified), ("infeasible", False, False))
        self.assertEqual(len(answer.infeasibility.triangles), 12)
        self.assertTrue(self.client.plan(request_of("office-graze-column")).ok)

    def test_the_viewing_distance_is_that_of_the_file_of_the_command(self):
        for options in ({}, {"viewing_distance_m": 2.5}, {"max_inserted_keyframes": 0}):
            document = support.request_document("office-graze-column")
            document = document | {"options": options, "scene": str(support.SCENES / "office.obj")}
            with tempfile.TemporaryDirectory() as folder:
                asked, written = pathlib.Path(folder) / "request.json", pathlib.Path(folder) / "answer.json"
                asked.write_text(json.dumps(document))
                support.run_camway("plan", "--request", asked, "--response", written)
                wanted = json.loads(written.read_text())
            request = camway.Request.from_json(document)
            request.scene = "office"
            answer = self.client.plan(request)
            self.assertEqual(answer.viewing_distance_m, wanted.get("viewing_distance_m", 0.0))
            self.assertEqual(answer.to_json().get("viewing_distance_m"), wanted.get("viewing_distance_m"))
            self.assertEqual(answer.viewing_distance_m > 0.0, any(each.moved_m > 0.0 for each in answer.corrections))

    def test_many_plans_are_pending_at_a_time(self):
        pending = [self.client.plan_async(request_of("office-graze-column", seed=i + 1)) for i in range(20)]
        done, _ = concurrent.futures.wait(pending, timeout=60)
        self.assertEqual({each.result().status for each in done}, {"ok"})
        self.assertEqual({each.result().request_id for each in done}, {each.request_id for each in pending})

    def test_coroutines_await_and_cancel(self):
        async def both():
            good = await self.client.plan_async(request_of("office-graze-column"))
            waiting = asyncio.ensure_future(_awaited(self.client.plan_async(long_request())))
            await asyncio.sleep(0.3)
            waiting.cancel()
            with self.assertRaises(asyncio.CancelledError):
                await waiting
            return good

        async def _awaited(pending):
            return await pending

        self.assertTrue(asyncio.run(both()).ok)
        pending = self.client.plan_async(long_request())
        self.assertTrue(pending.cancel())
        with self.assertRaisesRegex(camway.Cancelled, "the request was cancelled"):
            pending.result(20)
        self.assertFalse(pending.cancel())

    def test_progress_comes_on_the_client_thread(self):
        seen = []
        request = long_request()
        request.progress_period_s = 0.1

        def note(now):
            seen.append((now.stage, threading.get_ident()))

        pending = self.client.plan_async(request, on_progress=note)
        while len(seen) < 2:
            time.sleep(0.02)
        pending.cancel()
        self.assertIn("correcting", [stage for stage, _ in seen])
        self.assertNotIn(threading.get_ident(), [thread for _, thread in seen])

    def test_what_a_handler_raises_is_reported(self):
        seen = []
        hook, sys.unraisablehook = sys.unraisablehook, lambda args: seen.append(args.exc_value)
        try:
            self.client.watch(request_of("office-graze-column"), lambda event: 1 / 0)
            while not seen:
                time.sleep(0.02)
        finally:
            sys.unraisablehook = hook
        self.assertIsInstance(seen[0], ZeroDivisionError)

    def test_a_handler_cannot_wait_for_its_client(self):
        # It would wait for the thread that it runs on, with all other calls behind it.
        seen = []

        def ask(_):
            pending, watch = self.client.plan_async(long_request()), self.client.watch(long_request())
            for call in (lambda: self.client.plan(request_of("office-graze-column")), self.client.list_scenes,
                         self.client.status, lambda: pending.result(30), lambda: watch.next_event(30)):
                try:
                    seen.append(call())
                except (camway.Error, TimeoutError) as error:
                    seen.append(error)
            pending.cancel()
            watch.unwatch()

        with camway.Client() as other:
            pending = self.client.plan_async(request_of("office-graze-column"))
            pending.add_done_callback(lambda _: seen.append(other.list_scenes()[0].name))
            pending.result(60)
            self.client.watch(request_of("office-graze-column"), ask)
            while len(seen) < 6:
                time.sleep(0.02)
        self.assertEqual([type(each) for each in seen], [str] + [camway.Busy] * 5)
        self.assertRegex(str(seen[1]), "^a handler of this client must not wait for it")
        self.assertTrue(self.client.plan(request_of("office-graze-column")).ok)

    def test_requests_may_be_dictionaries(self):
        document = {**support.request_document("office-graze-column"), "scene": "office"}
        request = camway.Request.from_json(document)
        self.assertEqual(self.client.plan(document).path, self.client.plan(request).path)
        self.assertEqual(self.client.plan_async(document).result(60).path, self.client.plan(request).path)
        with self.client.watch(document) as watch:
            self.assertEqual(watch.next_event(60).answer.path, self.client.plan(request).path)
        with self.assertRaisesRegex(camway.InvalidRequest, "^request: keyframe: is unknown"):
            self.client.plan({**document, "keyframe": []})

    def test_arguments_of_a_wrong_type_are_named(self):
        request = request_of("office-graze-column")
        for kind, text, call in (
                (TypeError, "timeout_s: must be a number, not str", lambda: self.client.plan(request, timeout_s="1")),
                (ValueError, "timeout_s: must be seconds, not NaN",
                 lambda: self.client.plan(request, timeout_s=float("nan"))),
                (TypeError, "timeout_s: must be a number, not str", lambda: self.client.status("1")),
                (TypeError, "on_progress: must be a function, not int",
                 lambda: self.client.plan_async(request, on_progress=3)),
                (TypeError, "request: must be a camway.Request, not str", lambda: self.client.plan("office")),
                (TypeError, "on_event: must be a function, not int", lambda: self.client.watch(request, 3)),
                (TypeError, "scene: must be a text, not bytes", lambda: self.client.describe_scene(b"office")),
                (TypeError, "revision: must be a whole number, not str",
                 lambda: self.client.restore_scene("office", "1")),
                (TypeError, "request_id: must be a whole number, not str", lambda: self.client.cancel("1")),
                (ValueError, "timeout_s: must be seconds, not NaN",
                 lambda: self.client.watch(request).unwatch(float("nan"))),
                (TimeoutError, "no event came within 0.0 s",
                 lambda: self.client.watch(long_request()).next_event(0.0))):
            with self.assertRaisesRegex(kind, f"^{text}$"):
                call()

    def test_a_call_has_a_timeout(self):
        with self.assertRaisesRegex(camway.Timeout, r"no answer came within 0\.2 s \(timeout_s\)"):
            self.client.plan(long_request(), timeout_s=0.2)

    def test_ctrl_c_ends_calls_that_wait(self):
        with camway.Client(prefix="NOBODY") as other:
            for call in (lambda: self.client.plan(long_request()), lambda: other.status(20.0), other.list_scenes):
                threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
                with self.assertRaises(KeyboardInterrupt):
                    call()

    def test_scenes_are_made_changed_and_restored(self):
        client, vertices = self.client, np.array([[0, 0, 0], [4, 0, 0], [4, 0, 4], [0, 0, 4]], float)
        made = client.load_scene("room", camway.SceneMesh.from_arrays(vertices, [[0, 1, 2], [0, 2, 3]]),
                                 occupancy_resolution_m=0.1, body_bounds=camway.Bounds(max_m=(None, 9.0, None)))
        self.assertEqual((made.scene.num_triangles, made.scene.bounds_max_m), (2, (4.0, 0.0, 4.0)))
        self.assertEqual(made.scene.body_bounds.max_m, (None, 9.0, None))
        self.assertIn("room", [scene.name for scene in client.list_scenes()])
        put = client.put_object("room", "wall", WALL, camway.Pose((2.0, 1.5, 2.0)))
        self.assertEqual(put.objects[0].kind, "box")
        moved = client.move_object("room", "wall", camway.Pose((3.0, 1.5, 2.0)))
        self.assertEqual(moved.objects[0].pose.position_m, (3.0, 1.5, 2.0))
        for name, shape in (("ball", camway.SceneSphere(0.5)), ("pipe", camway.SceneCylinder(0.2, 2.0)),
                            ("cloud", camway.ScenePoints([[0, 0, 1], [1, 0, 1]], 0.1)),
                            ("map", camway.SceneVoxels(0.1))):
            self.assertEqual(client.put_object("room", name, shape).objects[0].name, name)
        client.insert_scan("room", "map", [[1.0, 1.0, 1.0], [1.0, 1.2, 1.0]], (0.0, 1.0, 1.0))
        names = [each.name for each in client.describe_scene("room").objects]
        self.assertEqual(names, ["ball", "cloud", "map", "pipe", "room", "wall"])
        client.remove_object("room", "ball")
        history = client.scene_history("room")
        self.assertEqual([each.operation for each in history][:3], ["load", "put", "move"])
        client.restore_scene("room", history[0].revision, "room2")
        room = client.describe_scene("room2")
        self.assertEqual(len(room.objects), 1)
        got = client.object_triangles("room2", room.objects[0].digest)
        np.testing.assert_array_equal(got.vertices_m[got.triangles], vertices[np.array([[0, 1, 2], [0, 2, 3]])])
        self.assertEqual(client.export_map("room").bytes[:8], b"# Octoma")
        for scene in ("room", "room2"):
            client.unload_scene(scene)
        with self.assertRaises(camway.UnknownScene):
            client.describe_scene("room2")

    def test_vertices_arrive_bit_for_bit(self):
        rng = np.random.default_rng(7)
        vertices = rng.normal(size=(60, 3)) * rng.uniform(1e-3, 1e3, (60, 1))
        triangles = np.arange(60).reshape(20, 3)
        self.client.load_scene("cloud", camway.SceneMesh.from_arrays(vertices, triangles))
        digest = self.client.describe_scene("cloud").objects[0].digest
        got = self.client.object_triangles("cloud", digest)
        np.testing.assert_array_equal(got.vertices_m[got.triangles], vertices[triangles])
        self.assertEqual(digest, camway.Scene.from_arrays(vertices, triangles).info.digest)
        self.client.unload_scene("cloud")

    def test_occupancy_answers_arrays(self):
        rng = np.random.default_rng(3)
        points = rng.uniform((0, 0, 0), (30, 10, 20), (500, 3))
        boxes = np.concatenate([points, points + 0.01], axis=1)
        answer = self.client.occupancy(
            "office", points_m=points, boxes=boxes.reshape(-1, 2, 3), spheres=np.c_[points, np.full(500, 0.3)],
            rays=[[15, 1.6, 10, 0, -1, 0, 5], [15, 1e3, 10, 0, 1, 0, 5]], distances=np.c_[points, np.full(500, 50.0)],
            sphere_paths=[[15, 1.6, 10, 15, -5, 10, 0.1]])
        self.assertEqual((answer.points_occupied.dtype, answer.points_occupied.shape), (bool, (500,)))
        self.assertGreater(answer.points_occupied.sum(), 0)
        # Boxes and spheres that hold an occupied point are occupied, and at distance 0.
        self.assertTrue(answer.boxes_occupied[answer.points_occupied].all())
        self.assertTrue((answer.distances_m[answer.points_occupied] == 0.0).all())
        self.assertTrue(((answer.distances_m <= 0.3) == answer.spheres_occupied)[answer.distances_m != 0.3].all())
        self.assertLess(answer.rays_hit_m[0], 2.0)
        self.assertEqual(answer.rays_hit_m[1], np.inf)
        self.assertLess(answer.sphere_paths_hit_m[0], 2.0)
        with self.assertRaisesRegex(ValueError, "^spheres: must be an array of rows of 4 numbers$"):
            self.client.occupancy("office", spheres=[[1, 2, 3]])

    def test_status_counts(self):
        self.client.plan(request_of("office-free-straight"))
        status = self.client.status()
        self.assertGreater(sum(status.plan_answers), 0)
        self.assertGreater(status.planning.quantile_s(0.5), 0.0)
        self.assertEqual(status.planning.since(status.planning).count, 0)
        self.assertIn("office", [scene.name for scene in status.scenes])


class WatchTest(unittest.TestCase):
    def setUp(self):
        self.client = self.enterContext(camway.Client())
        made = self.client.load_scene("hall", camway.SceneMesh.from_arrays(
            [[0, 0, 0], [9, 0, 0], [9, 0, 9], [0, 0, 9]], [[0, 1, 2], [0, 2, 3]]))
        self.revision = made.scene.revision
        keyframes = [camway.Keyframe(0.0, (1, 1.5, 4)), camway.Keyframe(5.0, (8, 1.5, 4))]
        self.request = camway.Request("hall", keyframes=keyframes)

    def test_a_watch_is_iterated_over(self):
        kinds = []
        with self.client.watch(self.request) as watch:
            for event in watch:
                kinds.append(event.kind)
                if event.kind == "answer" and len(kinds) == 1:
                    self.assertTrue(event.answer.ok)
                    self.client.put_object("hall", "wall", WALL, camway.Pose((4.5, 1.5, 4)))
                elif event.kind == "answer":
                    break
        self.assertEqual(kinds, ["answer", "broken", "answer"])
        self.assertEqual(event.answer.scene_revision, self.revision + 1)
        with self.assertRaises(EOFError):
            watch.next_event(1.0)
        self.assertEqual(list(watch), [])

    def test_coroutines_iterate_over_a_watch(self):
        async def watch_once():
            async for event in self.client.watch(self.request):
                return event

        self.assertEqual(asyncio.run(watch_once()).kind, "answer")

        async def give_up():
            watch = self.client.watch(self.request)
            self.assertEqual((await anext(watch)).kind, "answer")
            with self.assertRaises(TimeoutError):
                await asyncio.wait_for(anext(watch), 0.1)
            self.client.put_object("hall", "wall", WALL, camway.Pose((4.5, 1.5, 4)))
            return await anext(watch)

        self.assertEqual(asyncio.run(give_up()).kind, "broken")

    def test_no_event_is_lost_to_a_wait_that_was_given_up(self):
        watch = self.client.watch(self.request)
        self.assertEqual(watch.next_event(20.0).kind, "answer")
        with self.assertRaises(TimeoutError):
            watch.next_event(0.05)
        self.client.put_object("hall", "wall", WALL, camway.Pose((4.5, 1.5, 4)))
        self.assertEqual([watch.next_event(20.0).kind for _ in range(2)], ["broken", "answer"])

    def test_a_watch_ends_where_the_daemon_confirms_it(self):
        events = []
        watch = self.client.watch(self.request, events.append)
        while not events:
            time.sleep(0.01)
        self.assertTrue(watch.unwatch(timeout_s=10.0))
        with self.assertRaises(TimeoutError):
            self.client.watch(self.request, events.append).next_event(0.05)

    def test_a_request_that_cannot_be_sent_ends_at_once(self):
        events = list(self.client.watch(camway.Request("x" * 200)))
        self.assertEqual([event.kind for event in events], ["ended"])
        self.assertEqual(events[0].status, "invalid")


class EndTest(unittest.TestCase):
    """The end of clients, with calls and watches that are under way."""

    def test_pending_calls_end_with_their_client(self):
        client = camway.Client()
        pending = [client.plan_async(long_request(1.0)) for _ in range(3)]
        watch = client.watch(long_request(1.0))
        client.close()
        for each in pending:
            with self.assertRaisesRegex(camway.NoAnswer, "the client was destroyed"):
                each.result(10)
        self.assertEqual([event.kind for event in watch if event.kind != "lost"], [])

    def test_a_client_that_nobody_holds_is_destroyed(self):
        client = camway.Client()
        native = weakref.ref(client._native)
        pending = client.plan_async(long_request(1.0))
        client.watch(request_of("office-graze-column"))
        del client
        gc.collect()
        self.assertIsNone(native())
        self.assertTrue(pending.done())

    def test_a_handler_may_close_its_client(self):
        client, closed = camway.Client(), threading.Event()

        def close(_):
            client.close()
            closed.set()

        client.watch(request_of("office-graze-column"), close)
        self.assertTrue(closed.wait(20))

    def test_a_process_ends_with_calls_pending(self):
        code = ("import camway, client_test; c = camway.Client(); "
                "p = c.plan_async(client_test.long_request(1.0), on_progress=print); "
                "w = c.watch(client_test.long_request(1.0), print); "
                "s = lambda: [c.status(30) for _ in range(99)]; l = lambda: [c.list_scenes() for _ in range(9999)]; "
                "[__import__('threading').Thread(target=t, daemon=True).start() for t in (s, l, l)]; "
                "__import__('time').sleep(float(__import__('sys').argv[1]))")
        for wait_s in (0.0, 0.1, 0.3):
            done = subprocess.run([sys.executable, "-B", "-c", code, str(wait_s)], cwd=os.path.dirname(__file__),
                                  timeout=60, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_forked_process_says_that_it_needs_a_client_of_its_own(self):
        client = camway.Client()
        pending, watch = client.plan_async(long_request()), client.watch(long_request())
        child = os.fork()
        if child == 0:
            code = 1
            try:
                for call in (client.list_scenes, pending.result, watch.next_event):
                    with self.assertRaisesRegex(camway.Error, "forked"):
                        call()
                client.close()
                with camway.Client() as own:
                    code = 0 if own.plan(request_of("office-graze-column")).ok else 2
            finally:
                os._exit(code)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)
        pending.cancel()
        watch.unwatch()
        self.assertTrue(client.plan(request_of("office-graze-column")).ok)
        client.close()

    def test_threads_share_a_client(self):
        with camway.Client() as client, concurrent.futures.ThreadPoolExecutor(8) as pool:
            answers = list(pool.map(lambda i: client.plan(request_of("office-graze-column", seed=i + 1)), range(16)))
        self.assertEqual({answer.status for answer in answers}, {"ok"})

    def test_a_thousand_plans_leak_nothing(self):
        request = request_of("office-free-straight")
        office = camway.Scene.load(support.SCENES / "office.obj")

        def plan(count):
            with camway.Client() as client:
                for i in range(count):
                    camway.plan(office, request).path.evaluate(np.zeros(10))
                    if i % 5 == 0:
                        client.plan(request)

        plan(200)
        before = _resident_bytes()
        plan(1000)
        # A leaked answer would be 1000 times 10 kB and more.
        self.assertLess(_resident_bytes() - before, 3_000_000)


def _resident_bytes():
    gc.collect()
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class NobodyTest(unittest.TestCase):
    def test_without_a_daemon_it_says_so(self):
        with camway.Client(prefix="NOBODY", retries=0, try_timeout_s=0.1) as client:
            with self.assertRaisesRegex(camway.NoDaemon, "no daemon was heard .*NOBODY_") as raised:
                client.plan(request_of("office-graze-column"))
            self.assertIsInstance(raised.exception, ConnectionError)
            with self.assertRaises(camway.NoDaemon):
                client.status(0.1)

    def test_a_network_that_cannot_be_used_is_an_error(self):
        with self.assertRaises(camway.NetworkUnusable):
            camway.Client("nonsense://")


if __name__ == "__main__":
    unittest.main()
