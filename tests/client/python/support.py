# SPDX-License-Identifier: MIT
"""Scenes, requests and a daemon for the tests of the package for Python."""
import json
import os
import pathlib
import random
import subprocess
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[3]
PROGRAMS = pathlib.Path(os.environ["CAMWAY_PROGRAMS"])
SCENES = SOURCE / "scenes"
_PATIENCE_S = 60.0


def request_document(name):
    return json.loads((SCENES / "requests" / f"{name}.json").read_text())


def run_camway(*arguments):
    """Runs the command; returns its exit code and its standard error."""
    done = subprocess.run([str(PROGRAMS / "camway"), *map(str, arguments)], capture_output=True, text=True,
                          timeout=_PATIENCE_S, check=False)
    return done.returncode, done.stderr


def random_document(rng):
    """A request file in the office with any of the options; valid, whether or not it has a path."""
    document = {"scene": "office.obj", "camera": {"fov_x_deg": rng.uniform(20, 120), "fov_y_deg": rng.uniform(20, 100),
                                                  "near": rng.uniform(0.02, 0.2)}}
    has_times = rng.random() < 0.5
    # Near each other: a path through the whole building takes seconds, which the deadline may cut short.
    begin = _point(rng)
    document["keyframes"] = [_keyframe(rng, begin, i if has_times else None) for i in range(rng.randint(2, 4))]
    if rng.random() < 0.5:
        document["body"] = rng.choice(_BODIES)(rng)
    options = {name: make(rng) for name, make in _OPTIONS.items() if rng.random() < 0.3}
    if has_times:
        options.pop("default_speed_m_per_s", None)
    document["options"] = options
    return document


def _point(rng):
    return [rng.uniform(1, 29), rng.uniform(0.5, 2.0), rng.uniform(1, 19)]


def _keyframe(rng, begin, number):
    keyframe = {"position": [coordinate + rng.uniform(-1.5, 1.5) for coordinate in begin],
                "orientation": [rng.gauss(0, 1) for _ in range(4)]}
    return keyframe if number is None else {"time": number * 2.5 + rng.random(), **keyframe}


_TETRAHEDRON = {"vertices": [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]],
                "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]}
_BODIES = (
    lambda rng: {"type": "box", "size": [rng.uniform(0.05, 0.3) for _ in range(3)], "center": [0.0, 0.1, -0.1]},
    lambda rng: {"type": "sphere", "radius_m": rng.uniform(0.05, 0.3)},
    lambda rng: {"type": "convex", "points": [[rng.uniform(-0.2, 0.2) for _ in range(3)] for _ in range(6)]},
    lambda rng: {"type": "convex", "pieces": [[[rng.uniform(-0.2, 0.2) for _ in range(3)] for _ in range(5)],
                                              [[0.0, 0.0, 0.0], [0.1, 0.1, 0.1]]]},
    lambda rng: {"type": "mesh", **_TETRAHEDRON},
    lambda rng: {"type": "mesh", "solid": True, **_TETRAHEDRON},
)
_OPTIONS = {
    "method": lambda rng: "ladder",
    "objective": lambda rng: rng.choice(["closest", "shortest", "smoothest", "safest"]),
    "orientation": lambda rng: rng.choice([
        {"policy": "keep"}, {"policy": "level", "up": [0, 1, 0.2]}, {"policy": "free", "max_turn_deg": 33.3},
        {"policy": "target", "target": _point(rng), "cone_deg": 21.0}]),
    "clearance_m": lambda rng: rng.uniform(0, 0.05),
    "bounds": lambda rng: {"min": [-1.0, None, -1.5], "max": [None, 12.0, 25.0]},
    "default_speed_m_per_s": lambda rng: rng.uniform(0.5, 3),
    "viewing_distance_m": lambda rng: rng.uniform(1, 10),
    "limits": lambda rng: {"speed_m_per_s": rng.uniform(1, 5), "turn_rate_deg_per_s": 77.0, "retime": True},
    "max_inserted_keyframes": lambda rng: rng.choice([0, 5, 50]),
    "max_shrink": lambda rng: 0.0,
    "repair_keyframes": lambda rng: True,
    "clearance_profile": lambda rng: True,
    "interval_tolerance_m": lambda rng: rng.uniform(1e-4, 1e-2),
    "chord_error_m": lambda rng: rng.uniform(1e-3, 1e-2),
    "seed": lambda rng: rng.randint(1, 1000),
}


def generator(test):
    """Random numbers for a test, the same in each run unless CAMWAY_TEST_SEED is set."""
    return random.Random(f"{test.id().split('.', 1)[1]} {os.environ.get('CAMWAY_TEST_SEED', 1)}")


class Daemon:
    """camwayd with the office, for as long as the context lasts."""

    def __init__(self, *arguments):
        if "CAMWAY_NETNS" not in os.environ:
            raise RuntimeError("run this through tools/scripts/netns.sh: its messages would go to the network")
        self._log = tempfile.TemporaryFile("w+")
        scene = f"office={SCENES / 'office.obj'},occupancy=0.25"
        self.process = subprocess.Popen([str(PROGRAMS / "camwayd"), "--scene", scene, *arguments], stdout=self._log,
                                        stderr=subprocess.STDOUT)

    def log(self):
        self._log.seek(0)
        return self._log.read()

    def __enter__(self):
        give_up_at_s = time.monotonic() + _PATIENCE_S
        while "[info] ready" not in self.log():
            if self.process.poll() is not None or time.monotonic() > give_up_at_s:
                raise RuntimeError(self.log())
            time.sleep(0.02)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(_PATIENCE_S)
        self._log.close()
