# SPDX-License-Identifier: MIT
"""Runs the `camway` program. Needs no Blender."""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
from typing import Iterator, NamedTuple, Sequence

from .motion import Path, Sample
from .request import Shot, request_of

# A triangle 1,000 km away, for paths that are only interpolated.
_NOTHING_NEAR = "g nothing\nv 1e6 0 -1e6\nv 1000001 0 -1e6\nv 1e6 1 -1e6\nf 1 2 3\n"

# Interpolation takes milliseconds; a program that takes this long hangs.
_LONGEST_INTERPOLATION_S = 60.0

# A program that is ended cancels its request at a daemon first, which takes milliseconds.
_LONGEST_END_S = 2.0

# How long a daemon may take to forget a scene. It forgets by itself when it ends.
_LONGEST_UNLOAD_S = 5.0


class CamwayError(Exception):
    """Something that the user has to be told, in words."""


def find_program(given: str = "") -> str:
    """Returns the path of the program: `given`, else $CAMWAY, else `camway` on the PATH."""
    wanted = given or os.environ.get("CAMWAY") or "camway"
    found = shutil.which(os.path.expanduser(wanted))
    if not found:
        raise CamwayError(f"The program {wanted!r} was not found. Set its path in Edit > Preferences > Add-ons > "
                          "Camway, or put its folder on the PATH.")
    return found


def write_json(file: pathlib.Path, content: dict) -> None:
    file.write_text(json.dumps(content, allow_nan=False), encoding="utf-8")


class Child:
    """A running `camway`. Its standard output and error go to files beside its input."""

    def __init__(self, program: str, arguments: Sequence[str], folder: pathlib.Path):
        self._files = [folder / "stdout.txt", folder / "stderr.txt"]
        with open(self._files[0], "wb") as output, open(self._files[1], "wb") as errors:
            try:
                self._process = subprocess.Popen([program, *arguments], stdin=subprocess.DEVNULL, stdout=output,
                                                 stderr=errors, cwd=folder)
            except OSError as error:
                raise CamwayError(f"{program} does not start: {error.strerror}") from error

    def is_running(self) -> bool:
        return self._process.poll() is None

    def wait(self, seconds: float | None = None) -> None:
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.stop()
            raise CamwayError(f"camway did not end within {seconds:g} s") from None

    def stop(self) -> None:
        """Ends the program if it still runs. It keeps no state that a signal could harm."""
        if self.is_running():
            self._process.terminate()
            try:
                self._process.wait(_LONGEST_END_S)
            except subprocess.TimeoutExpired:
                self._process.kill()
        self._process.wait()

    @property
    def code(self) -> int:
        return self._process.returncode

    @property
    def output(self) -> str:
        return self._files[0].read_text(encoding="utf-8", errors="replace")

    @property
    def words(self) -> str:
        """What it said on standard error, without its name and the names of our files."""
        text = self._files[1].read_text(encoding="utf-8", errors="replace").strip()
        return plain(text) or f"camway ended with exit code {self.code} and said nothing"


def plain(text: str) -> str:
    """Returns a message without the names of the program and of our request file before it."""
    for prefix in ("camway: ", "request.json: ", "interpolation.json: "):
        text = text.removeprefix(prefix)
    return text


def running(child: Child) -> Iterator[None]:
    """Yields while the child runs. It is killed if nobody asks on."""
    try:
        while child.is_running():
            yield
    finally:
        child.stop()


def interpolate(program: str, folder: pathlib.Path, shot: Shot, keyframes: list[Sample]) -> Path:
    """Returns the path through keyframes before any correction."""
    (folder / "nothing.obj").write_text(_NOTHING_NEAR)
    request = request_of(shot, keyframes, "nothing.obj")
    request["options"] = {"max_inserted_keyframes": 0}
    write_json(folder / "interpolation.json", request)
    child = Child(program, ["plan", "--no-cache", "--request", "interpolation.json", "--response",
                            "interpolated.json"], folder)
    child.wait(_LONGEST_INTERPOLATION_S)
    if child.code not in (0, 3):
        raise CamwayError(child.words)
    return Path(read_json(folder / "interpolated.json", child)["segments"])


def read_json(file: pathlib.Path, child: Child) -> dict:
    """Returns the content of a file that the child wrote."""
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        raise CamwayError(child.words) from None


class Daemon(NamedTuple):
    """A daemon that plans, and the name of its scene to plan in."""
    scene: str
    prefix: str = ""
    url: str = ""

    @property
    def flags(self) -> list[str]:
        """How the program reaches it."""
        return [word for flag, value in (("--prefix", self.prefix), ("--url", self.url)) if value
                for word in (flag, value)]


def send_scene(program: str, folder: pathlib.Path, daemon: Daemon) -> Iterator[None]:
    """Makes `scene.obj` the scene of the daemon; yields while that takes."""
    child = Child(program, ["scene", "load", daemon.scene, "--upload", "scene.obj", *daemon.flags], folder)
    yield from running(child)
    if child.code != 0:
        raise CamwayError(child.words)


def forget_scene(program: str, folder: pathlib.Path, daemon: Daemon) -> None:
    """Has the daemon forget a scene, as far as it answers."""
    try:
        Child(program, ["scene", "unload", daemon.scene, *daemon.flags], folder).wait(_LONGEST_UNLOAD_S)
    except CamwayError:
        pass  # it is gone, and the scene with it


def plan(program: str, folder: pathlib.Path, request: dict, daemon: Daemon | None = None) -> Iterator[None]:
    """Plans, here or by a daemon; yields while the program runs, and returns the answer."""
    write_json(folder / "request.json", request)
    response = folder / "response.json"
    response.unlink(missing_ok=True)
    by = ["--daemon", daemon.scene, *daemon.flags] if daemon else []
    child = Child(program, ["plan", "--request", "request.json", "--response", response.name, *by], folder)
    yield from running(child)
    answer = read_json(response, child)
    if answer["status"] == "unknown_scene":
        raise CamwayError(answer["message"])
    return answer


def check(program: str, folder: pathlib.Path, request: dict, path: Path) -> Iterator[None]:
    """Looks where a path collides; yields while the program runs, and returns its verdict."""
    write_json(folder / "request.json", request)
    write_json(folder / "path.json", {"segments": path.segments})
    child = Child(program, ["check", "--json", "--request", "request.json", "--response", "path.json"], folder)
    yield from running(child)
    if child.code not in (0, 3):
        raise CamwayError(child.words)
    return json.loads(child.output)
