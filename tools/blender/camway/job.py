# SPDX-License-Identifier: MIT
"""A run from the camera to its corrected copy, in steps that leave Blender's window responsive."""
from __future__ import annotations

import pathlib
import shutil
import tempfile
import uuid
from typing import Iterator, Sequence

import bpy

from . import camera_copy, run, scene_file, shot_reader
from .answer import Answer, Collision, changed_stretches, collisions_of, frame_words, length_words, words_of
from .motion import Sample, jumps
from .request import Chosen, Shot, choices, choose_keyframes, request_of, turned_along, without_turns
from .run import CamwayError

# Names of moving obstacles that a warning lists.
_MOST_NAMES = 5


class Job:
    """Plans one camera. `steps` does the work, each step in some milliseconds; (share, words) is its progress.

    Objects are looked up by name again after each wait: undo, which may happen meanwhile, replaces them.
    """

    def __init__(self, context: bpy.types.Context, camera: bpy.types.Object, program: str, folder: str = ""):
        if context.scene.camway.body == "NEAR":
            shot_reader.require_perspective(camera)
        self._program = run.find_program(program)
        self._camera_key = (camera.name, camera.library.filepath if camera.library else None)
        self._scene_name = context.scene.name
        self._given_folder = folder
        self._owners: dict[str, scene_file.Owner] = {}
        self._notes: list[str] = []
        self._daemon = context.scene.camway.daemon()
        self._is_sent = False  # the scene, to the daemon
        self.is_reading = True  # frames change: nobody should edit

    @property
    def camera(self) -> bpy.types.Object:
        camera = bpy.data.objects.get(self._camera_key)
        if camera is None:
            raise CamwayError(f"{self._camera_key[0]} is gone")
        return camera

    @property
    def scene(self) -> bpy.types.Scene:
        scene = bpy.data.scenes.get(self._scene_name)
        if scene is None:
            raise CamwayError(f"the scene {self._scene_name} is gone")
        return scene

    def steps(self, context: bpy.types.Context) -> Iterator[tuple[float, str]]:
        folder = pathlib.Path(self._given_folder or tempfile.mkdtemp(prefix="camway_"))
        folder.mkdir(parents=True, exist_ok=True)
        frame = self.scene.frame_current_final
        try:
            shot = yield from self._read(context, folder)
            chosen = choose_keyframes(shot, lambda keys: run.interpolate(self._program, folder, shot, keys))
            shot_reader.frame_set(self.scene, frame)
            self.is_reading = False
            yield from self._send(folder)
            before = yield from self._collisions(folder, shot, chosen)
            answer = yield from self._plan(folder, shot, chosen, before)
            run.write_json(folder / "request.json", answer.request)  # of several, those that belong together
            run.write_json(folder / "response.json", answer.content)
            frame = self.scene.frame_current_final
            self._finish(chosen, answer, before)
        finally:
            if self._scene_name in bpy.data.scenes:
                shot_reader.frame_set(self.scene, frame)
            if self._is_sent:
                run.forget_scene(self._program, folder, self._daemon)
            if not self._given_folder:
                shutil.rmtree(folder, ignore_errors=True)

    def _read(self, context: bpy.types.Context, folder: pathlib.Path) -> Iterator[tuple[float, str]]:
        settings, scene, camera = context.scene.camway, context.scene, self.camera
        options = settings.options_of_request()
        here = scene.frame_current_final
        reading = shot_reader.read_shot(context, camera, settings.within, settings.keys)
        while True:
            try:
                yield 0.5 * next(reading), "reading the camera"
            except StopIteration as end:
                shot = end.value
                break
        shot.body, shot.options = settings.body_of_request(), options
        yield 0.5, "writing the scene"
        shot_reader.frame_set(scene, shot.samples[0].frame if settings.scene_at == "FIRST" else here)
        depsgraph = context.evaluated_depsgraph_get()
        self._owners = scene_file.write_scene(folder / "scene.obj", depsgraph, camera, settings,
                                              shot_reader.unit_of(scene))
        if not self._owners and not (self._daemon and self._daemon.scene):
            raise CamwayError("There is nothing in the way: no visible object has a surface.")
        self._note_motion(context, shot)
        if found := jumps(shot.samples, shot.within):
            self._notes.append("the camera jumps before frame " + ", ".join(map(frame_words, found[:_MOST_NAMES])) +
                               "; Camway plans a quick motion there")
        return shot

    def _note_motion(self, context: bpy.types.Context, shot: Shot) -> None:
        """Warns of obstacles that are elsewhere at the middle or the end of the shot."""
        settings, names = context.scene.camway, set()
        depsgraph = context.evaluated_depsgraph_get()
        here = scene_file.places(depsgraph, self.camera, settings)
        for index in (0, len(shot.samples) // 2, -1):
            shot_reader.frame_set(context.scene, shot.samples[index].frame)
            names.update(scene_file.moved(here, scene_file.places(depsgraph, self.camera, settings)))
        if names:
            listed = ", ".join(sorted(names)[:_MOST_NAMES])
            more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
            self._notes.append(f"moving obstacles stand still for Camway: {listed}{more}")

    def _send(self, folder: pathlib.Path) -> Iterator[tuple[float, str]]:
        """Sends the scene to the daemon, unless the user named one that it has."""
        if self._daemon is None:
            return
        if self._daemon.scene:
            self._notes.append(f"planned in the daemon's scene {self._daemon.scene}, not among what is visible here")
            return
        self._daemon = self._daemon._replace(scene=f"blender-{uuid.uuid4().hex[:12]}")
        self._is_sent = True
        yield from _with_words(run.send_scene(self._program, folder, self._daemon), 0.55, "sending the scene")

    def _collisions(self, folder: pathlib.Path, shot: Shot, chosen: Chosen) -> Iterator[tuple[float, str]]:
        """Returns where the artist's path collides with what is visible, as `camway check` has it."""
        if not self._owners:
            return []
        request = request_of(shot, chosen.keyframes, "scene.obj")
        checking = run.check(self._program, folder, request, chosen.path)
        return (yield from _with_words(checking, 0.6, "looking for collisions"))["collisions"]

    def _plan(self, folder: pathlib.Path, shot: Shot, chosen: Chosen,
              before: Sequence[dict]) -> Iterator[tuple[float, str]]:
        """Returns the answer with the most of the sampled keyframes that Camway finds a path with."""
        best = None
        for keyframes in choices(shot, chosen.keyframes, before):
            answer = yield from self._ask(folder, shot, keyframes)
            if best is None or answer.rank > best.rank:
                best = answer
            if answer.status == "ok" or answer.is_final:
                return answer
        # Samples that tell the way of a large turn are in the obstacle. So the way comes first, of a ball
        # that the body fits in however it is turned, and then the turn along it.
        keyframes = without_turns(shot, chosen.keyframes, before)
        ball = {"body": {"type": "sphere", "radius_m": shot.radius_m}}
        way = yield from self._ask(folder, shot, keyframes, ball, {"repair_keyframes": True})
        if way.status != "ok":
            return best
        answer = yield from self._ask(folder, shot, turned_along(shot, keyframes, way.path))
        return answer if answer.rank > best.rank or answer.is_final else best

    def _ask(self, folder: pathlib.Path, shot: Shot, keyframes: list[Sample], members: dict = {},
             options: dict = {}) -> Iterator[tuple[float, str]]:
        """Returns Camway's answer for keyframes; `members` and `options` replace those of the request."""
        request = {**request_of(shot, keyframes, "scene.obj"), **members}
        request["options"] = {**shot.options, **options}
        content = yield from _with_words(run.plan(self._program, folder, request, self._daemon), 0.7, "planning")
        return Answer(shot, [k.frame for k in keyframes], request, content)

    def _finish(self, chosen: Chosen, answer: Answer, before: Sequence[dict]) -> None:
        camera, result = self.camera, self.camera.camway
        result.begin()
        result.status, result.message = answer.status, _headline(answer, before)
        result.strays_m, result.strays_deg = chosen.strays
        self._list(result, collisions_of(answer.shot, before))
        self._list(result, [Collision(f, f, "", "keyframe in collision") for f in answer.faulty_frames])
        result.say(f"as interpolated, the path strays up to {words_of(chosen.strays)} from your curves")
        for note in self._notes + answer.warnings():
            result.say(note)
        if answer.has_path:
            self._list(result, answer.remaining())
            self._put(answer)
        elif camera_copy.copy_of(camera):
            result.say(f"{camera_copy.copy_of(camera).name} is still that of an earlier run")

    def _put(self, answer: Answer) -> None:
        """Makes the copy and the markers, and says how well Blender plays the path."""
        scene, camera, result = self.scene, self.camera, self.camera.camway
        copy = camera_copy.put_on_copy(scene, camera, answer)
        camera_copy.put_markers(scene, camera, changed_stretches(answer))
        played_m = camera_copy.playback_of(scene, copy, answer)
        result.clearance_m, result.played_m = answer.clearance_m, played_m
        words = f"what Blender plays, between frames too, is within {length_words(played_m)} of the path"
        if answer.is_certified:
            is_free = played_m < answer.clearance_m
            words += (", less than" if is_free else ", which is not less than")
            words += f" its clearance of {length_words(answer.clearance_m)}" + ("" if is_free else ": ask for more")
        result.say(words)
        last = answer.shot.frame_at(answer.path.end_s)
        if last > scene.frame_end + 1e-3:
            result.say(f"the path ends at frame {frame_words(last)}, after the scene's last frame, {scene.frame_end}")

    def _list(self, result, collisions: Sequence[Collision]) -> None:
        for collision in collisions:
            row = result.collisions.add()
            row.begin, row.end, _, row.words = collision
            owner = self._owners.get(collision.thing, scene_file.Owner(collision.thing, ""))
            row.thing, row.owner = owner.shown, owner.name


def _headline(answer: Answer, before: Sequence[dict]) -> str:
    """Returns Camway's message. Without sampled keyframes in the obstacle, there may be nothing to correct."""
    nothing = "no collision to correct"
    if before and answer.message.startswith(nothing):
        count = f"{len(before)} collision{'s' if len(before) > 1 else ''} of your path corrected"
        return count + answer.message.removeprefix(nothing)
    return answer.message


def _with_words(running: Iterator[None], share: float, words: str) -> Iterator[tuple[float, str]]:
    """Yields progress for each step of a program that runs; returns its result."""
    while True:
        try:
            next(running)
        except StopIteration as end:
            return end.value
        yield share, words
