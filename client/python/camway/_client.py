# SPDX-License-Identifier: MIT
"""The client of a daemon."""
from __future__ import annotations

import atexit
import math
import os
import weakref
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from camway import _errors, _functions, _native, _types
from camway._pending import PendingPlan
from camway._watch import Watch

if TYPE_CHECKING:
    from types import TracebackType

    import numpy.typing as npt

    from camway._base import Vector

_Answer = TypeVar("_Answer")

# Threads of C++ that call Python must have ended before the interpreter does, and threads of Python that wait in C++
# must not come back while it ends.
_clients: weakref.WeakSet[Client] = weakref.WeakSet()


def _close_all() -> None:
    for client in list(_clients):
        client.close()
    _native.close_exit_gate()


atexit.register(_close_all)


class Client:
    """A connection to a Camway daemon over LCM: `camway::Client` of C++.

        with camway.Client() as client:
            answer = client.plan(camway.Request(scene="office", keyframes=[
                camway.Keyframe(position_m=(1.0, 2.0, 1.6)), camway.Keyframe(position_m=(9.0, 2.0, 1.6))]))
            positions_m, orientations = answer.path.evaluate(np.linspace(0.0, answer.path.end_s, 100))

    A request without an answer is repeated under the same id, also across a restart of the daemon. What is no
    result raises an error (`camway.Error`); Ctrl-C ends a call that waits. Other threads run while a call waits.

    Handlers run on the client's own thread: they must be quick, and must not make a call that waits. What they
    raise goes to `sys.unraisablehook`. Thread-safe. A client does not work in a process that is forked from its
    own: make one after the fork.
    """

    def __init__(self, url: str = "", *, prefix: str = "CAMWAY", key_file: str | os.PathLike[str] | None = None,
                 key_window_s: float = 30.0, client_id: str = "", deadline_s: float = 60.0,
                 change_deadline_s: float = 0.0, try_timeout_s: float = 0.4, backoff: float = 1.6,
                 max_try_timeout_s: float = 5.0, jitter: float = 0.2, seed: int = 0, watch_lease_s: float = 30.0,
                 successor_wait_s: float = math.inf, retries: int = 5) -> None:
        """Opens the network. Raises InvalidRequest for options that are wrong, and NetworkUnusable.

        Args:
            url: URL of the LCM network; empty: LCM_DEFAULT_URL of the environment, or else multicast on this host.
                To reach other hosts, "udpm://239.255.76.67:7667?ttl=1" here and as the daemon's `--url`.
            prefix: first part of all channel names, the same as the daemon's
            key_file: keys that sign messages, in the format of the daemon's `auth.key_file`
            key_window_s: largest difference between the time of a signed message and the local clock
            client_id: name of this client, different from all others; empty: random
            deadline_s: largest duration of a call; a plan lasts at least until the deadline of its request, once a daemon
                was heard
            change_deadline_s: time for a change of a scene; 0 for the daemon's default
            try_timeout_s: wait before the first repetition of a request
            backoff: factor from one wait to the next
            max_try_timeout_s: longest wait before a repetition
            jitter: largest random change of a wait, as a fraction of it
            seed: random seed of the jitter; 0: a different one for each client
            watch_lease_s: time for which a path stays watched after the last message of the client
            successor_wait_s: time to wait for the next daemon if one refuses a change because it is stopping
            retries: repetitions without a sign of life from a daemon after which a call ends
        """
        options = {name: value for name, value in locals().items() if name not in ("self", "key_file", "__class__")}
        options["key_file"] = None if key_file is None else os.fspath(key_file)
        self._native = _native.NativeClient(options)
        self._pending: weakref.WeakSet[PendingPlan] = weakref.WeakSet()
        self._watches: weakref.WeakSet[Watch] = weakref.WeakSet()
        _clients.add(self)

    def close(self) -> None:
        """Ends all calls, and the client's thread. May be repeated. Pending plans end with NoAnswer."""
        self._native.close()
        for pending in list(self._pending):
            pending._abandon()
        for watch in list(self._watches):
            watch._end()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def __del__(self) -> None:
        if hasattr(self, "_watches"):
            self.close()

    @property
    def client_id(self) -> str:
        """The id under which the daemon knows this client."""
        return self._native.client_id

    @property
    def warning(self) -> str:
        """A warning about the network; empty if there is none."""
        return self._native.warning

    def plan(self, request: _types.Request | Mapping[str, Any], *, timeout_s: float | None = None,
             on_progress: Callable[[_types.PlanProgress], None] | None = None) -> _types.Answer:
        """Requests a path and waits for the answer. "ok", "partial" and "infeasible" are results; another status
        raises its error, which has the answer. After `timeout_s` the request is cancelled, and Timeout raised. A
        request may be a dictionary as in request files, whose `scene` is the daemon's name of the scene."""
        asked = _functions.request_of(request)
        answer: _types.Answer = _errors.checked(self._native.plan(asked, timeout_s, on_progress))
        return answer

    def plan_async(self, request: _types.Request | Mapping[str, Any], *,
                   on_progress: Callable[[_types.PlanProgress], None] | None = None) -> PendingPlan:
        """Requests a path and returns at once: a future, which coroutines may await."""
        pending = PendingPlan(self._native)
        request_id = self._native.plan_async(_functions.request_of(request), pending._take, on_progress)
        pending._request_id = request_id
        self._pending.add(pending)
        return pending

    def cancel(self, request_id: int) -> None:
        """Cancels a plan request of this client. Its answer comes soon. Has no effect on other ids."""
        self._native.cancel(request_id)

    def watch(self, request: _types.Request | Mapping[str, Any],
              on_event: Callable[[_types.WatchEvent], None] | None = None) -> Watch:
        """Requests a path and has the daemon watch it. Events go to `on_event`; without it, iterate over the watch.
        They are the answer; then each change of the scene that breaks the path, the corrected path, and a better one
        once an obstacle is gone. If the request cannot be sent, the only event is "ended"."""
        watch = Watch(self._native, _functions.request_of(request), on_event)
        self._watches.add(watch)
        return watch

    def occupancy(self, scene: str, *, points_m: npt.ArrayLike = (), boxes: npt.ArrayLike = (),
                  spheres: npt.ArrayLike = (), rays: npt.ArrayLike = (), distances: npt.ArrayLike = (),
                  sphere_paths: npt.ArrayLike = (), deadline_s: float = 0.0) -> _types.OccupancyAnswer:
        """Queries the occupancy map of a scene with arrays, a row for each query; see `OccupancyBatch` for the
        columns. The answer has arrays of the same lengths; a distance is infinite if nothing is within range."""
        batch = _types.OccupancyBatch(scene, deadline_s, points_m, boxes, spheres, rays, distances, sphere_paths)
        return self._checked(self._native.occupancy(batch))

    def load_scene(self, scene: str, mesh: _types.SceneMesh | None = None, *, occupancy_resolution_m: float = 0.0,
                   body_bounds: _types.Bounds | None = None) -> _types.SceneAnswer:
        """Makes a scene of one mesh, or replaces the scene of that name; without a mesh it is empty. The resolution
        of the occupancy map (0: none) and the bounds that no body may leave hold for all later revisions."""
        return self._checked(self._native.load_scene(scene, mesh or _types.SceneMesh(), occupancy_resolution_m,
                                                     body_bounds or _types.Bounds()))

    def unload_scene(self, scene: str) -> _types.SceneAnswer:
        """Removes a scene from the daemon."""
        return self._checked(self._native.unload_scene(scene))

    def list_scenes(self) -> list[_types.SceneInfo]:
        """Returns all scenes of the daemon, in order of name."""
        return self._checked(self._native.list_scenes()).scenes

    def describe_scene(self, scene: str) -> _types.SceneAnswer:
        """Returns a scene with all its `objects`."""
        return self._checked(self._native.describe_scene(scene))

    def put_object(self, scene: str, object: str, shape: _types.SceneShape,
                   pose: _types.Pose | None = None) -> _types.SceneAnswer:
        """Adds an object to a scene, or replaces the object of that name. Each change makes a new revision; a plan
        keeps the revision with which it began. `SceneMesh.from_arrays` makes a shape of NumPy's arrays."""
        return self._checked(self._native.put_object(scene, object, shape, pose or _types.Pose()))

    def move_object(self, scene: str, object: str, pose: _types.Pose) -> _types.SceneAnswer:
        """Moves an object of a scene."""
        return self._checked(self._native.move_object(scene, object, pose))

    def remove_object(self, scene: str, object: str) -> _types.SceneAnswer:
        """Removes an object from a scene."""
        return self._checked(self._native.remove_object(scene, object))

    def scene_history(self, scene: str) -> list[_types.SceneRevision]:
        """Returns the revisions of a scene that can be restored, oldest first, and the change that made each."""
        return self._checked(self._native.scene_history(scene)).revisions

    def restore_scene(self, scene: str, revision: int, restore_as: str = "") -> _types.SceneAnswer:
        """Makes a new revision of a scene with the objects of an earlier one. With `restore_as`, makes or replaces
        the scene of that name instead."""
        return self._checked(self._native.restore_scene(scene, revision, restore_as))

    def insert_scan(self, scene: str, object: str, points_m: npt.ArrayLike, origin_m: Vector) -> _types.SceneAnswer:
        """Inserts a scan into an object that is an OctoMap: a sensor at `origin_m` saw `points_m`, in the world."""
        return self._checked(self._native.insert_scan(scene, object, points_m, origin_m))

    def export_map(self, scene: str) -> _types.SceneMap:
        """Returns the occupancy map of a scene, as the bytes of a file of OctoMap (.bt)."""
        return self._checked(self._native.export_map(scene))

    def export_map_to(self, scene: str, file: str) -> _types.SceneAnswer:
        """Has the daemon write the occupancy map of a scene to a file below one of its scene roots."""
        return self._checked(self._native.export_map_to(scene, file))

    def object_triangles(self, scene: str, digest: str) -> _types.SceneTriangles:
        """Returns the triangles of the object of a scene that has this digest, as arrays."""
        return self._checked(self._native.object_triangles(scene, digest))

    def cancel_scene_calls(self) -> None:
        """Ends all calls about scenes that other threads wait in: with Cancelled, or with the answer if the change
        was made already."""
        self._native.cancel_scene_calls()

    def status(self, timeout_s: float = 3.0) -> _types.DaemonStatus:
        """Waits for the next heartbeat of the daemon, which comes once a second by default."""
        return self._checked(self._native.status(timeout_s))

    @staticmethod
    def _checked(answer: _Answer) -> _Answer:
        checked: _Answer = _errors.checked(answer)
        return checked
