# SPDX-License-Identifier: MIT
"""Planning in this process, without a daemon."""
from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy.typing as npt

from camway import _errors, _functions, _native, _types

_IMPORT = "camway-import"


def _find_programs() -> None:
    """Tells C++ where the programs are that read scene files: in CAMWAY_PROGRAMS, or in `bin` of the installation
    or of the build that this package is part of; else it looks on the PATH."""
    package = pathlib.Path(__file__).resolve().parent
    said = os.environ.get("CAMWAY_PROGRAMS")
    # PREFIX/lib/python3/dist-packages/camway, and BUILD/python/camway.
    folders = [pathlib.Path(said)] if said else [package.parents[3] / "bin", package.parents[1] / "bin"]
    for folder in folders:
        if said or (folder / _IMPORT).is_file():
            _native.set_import_program_folder(str(folder.absolute()))
            return


_find_programs()


class CamwayWarning(UserWarning):
    """Something of a scene or a request that is worth a look: faces that an import left out, quaternions that look
    as if they were in the other order."""


class Scene:
    """A scene in this process, to plan in. Immutable, so threads may share it. `load`, `from_arrays` and `of_request`
    make scenes."""

    def __init__(self, native: _native.Scene) -> None:
        """Made by `load`, `from_arrays` and `of_request` alone."""
        self._native = native

    @staticmethod
    def load(file: str | os.PathLike[str], *, scale: float = 1.0, up: str = "as-in-file", unknown: str = "free",
             voxel_m: float | None = None, body_bounds: _types.Bounds | None = None,
             use_cache: bool = True) -> Scene:
        """Reads a scene file, in a process of its own (`camway-import`) that is confined. Raises InvalidRequest for a
        file that cannot be read, and LimitExceeded.

        Args:
            file: a file in any format that `camway plan` reads
            scale: metres per unit of the file
            up: "as-in-file", "z-to-y" or "y-to-z"
            unknown: whether the unknown space of an OctoMap counts as "free" or "occupied"
            voxel_m: edge of the voxels of a cloud of points; None: chosen from the cloud
            body_bounds: a box that no body may leave
            use_cache: whether prepared scenes are kept, as `camway plan` does
        """
        return Scene(_native.Scene.load(os.fspath(file), scale=scale, up=up, unknown=unknown, voxel_m=voxel_m,
                                        body_bounds=body_bounds or _types.Bounds(), use_cache=use_cache))

    @staticmethod
    def from_arrays(vertices_m: npt.ArrayLike, triangles: npt.ArrayLike, *, name: str = "scene",
                    body_bounds: _types.Bounds | None = None) -> Scene:
        """Makes a scene of an array of points and an array of triples of their indices. Raises ValueError for arrays
        that are no mesh."""
        return Scene(_native.Scene.from_arrays(vertices_m, triangles, name=name,
                                               body_bounds=body_bounds or _types.Bounds()))

    @staticmethod
    def of_request(file: str | os.PathLike[str], *, use_cache: bool = True) -> Scene:
        """Reads the scene that a request file names, with the file's `scale`, `up`, `unknown` and `voxel_m`."""
        document = json.loads(_functions.read_text(file))
        if not isinstance(document, dict) or not document.get("scene"):
            raise _errors.InvalidRequest(f"{os.fspath(file)}: scene: is missing")
        reading = {name: document[name] for name in ("scale", "up", "unknown", "voxel_m") if name in document}
        return Scene.load(pathlib.Path(file).parent / document["scene"], use_cache=use_cache, **reading)

    @property
    def info(self) -> _types.SceneInfo:
        """Name, digest, number of triangles and bounds."""
        return self._native.info

    @property
    def warnings(self) -> list[str]:
        """Sentences about parts of the file that the import left out or rounded."""
        return self._native.warnings

    def __repr__(self) -> str:
        info = self.info
        return f"<camway.Scene {info.name!r} of {info.num_triangles} triangles>"


def _native_of(scene: Scene) -> _native.Scene:
    """Returns the scene of C++. Raises TypeError for what is no scene, such as the name of a file."""
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: must be a camway.Scene, not {type(scene).__name__}")
    return scene._native


def plan(scene: Scene, request: _types.Request | Mapping[str, Any], *, folder: str | os.PathLike[str] = ".",
         on_progress: Callable[[_types.PlanProgress], None] | None = None) -> _types.Answer:
    """Plans a path in this process: the bits of the answer are those of `camway plan` and of the daemon. Statuses are
    as of `Client.plan`. Ctrl-C, and whatever `on_progress` raises, end it. Other threads run meanwhile.

    Args:
        scene: the scene; `scene` of the request does not count
        request: a request, or a dictionary as in request files
        folder: of a dictionary, the folder to which the mesh file of its body is relative
        on_progress: called in this thread, about twenty times a second
    """
    if isinstance(request, Mapping):
        text = _functions.text_of(request)
        answer, notes = _native.plan_json(_native_of(scene), text, "request", os.fspath(folder), on_progress)
    else:
        answer, notes = _native.plan_request(_native_of(scene), request, on_progress)
    for note in notes:
        warnings.warn(note, CamwayWarning, stacklevel=2)
    checked: _types.Answer = _errors.checked(answer)
    return checked


@dataclasses.dataclass(frozen=True)
class Check:
    """The verdict on a path.

    Attributes:
        free: whether the whole path is proved free of collision
        report: the verdict and its grounds, as `camway check --json` writes them
        text: the same in words
    """

    free: bool
    report: dict[str, Any]
    text: str


def check(scene: Scene, request: _types.Request | Mapping[str, Any],
          answer: _types.Answer | _native.Path | Mapping[str, Any], *, folder: str | os.PathLike[str] = ".") -> Check:
    """Proves a path free of collision, whoever made it, or lists where it collides: `camway check`.

    Args:
        scene: the scene
        request: what the path is checked for: camera or body, clearance, bounds
        answer: an answer, a path, or a dictionary as in answer files
        folder: of a dictionary, the folder to which the mesh file of its body is relative
    """
    request_text = _functions.text_of(request.to_json() if isinstance(request, _types.Request) else dict(request))
    if isinstance(answer, _native.Path):
        path_text = _native.path_to_json(answer)
    elif isinstance(answer, _types.Answer):
        path_text = _native.answer_to_json(answer, False)
    else:
        path_text = _functions.text_of(dict(answer))
    free, report, text = _native.check(_native_of(scene), request_text, path_text, os.fspath(folder))
    return Check(free, json.loads(report), text)
