# SPDX-License-Identifier: MIT
"""Writes the visible meshes of a scene, evaluated and in world space, as an OBJ file in metres."""
from __future__ import annotations

import array
import pathlib
import unicodedata
from typing import Iterator, NamedTuple, TextIO

import bpy
from mathutils import Matrix

WITH_SURFACE = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


# Camway cuts names that are longer, and the number of a second one of a name has to fit, too.
_LONGEST_NAME = 100


class Owner(NamedTuple):
    """What a name in the scene file stands for."""
    shown: str  # its name as Blender shows it, "instancer/object" for an instance
    name: str   # the object, or the one that makes the instance


class Thing(NamedTuple):
    """Something with a surface, as the depsgraph shows it."""
    name: str  # in the scene file
    owner: Owner
    world: Matrix


def plain_name(name: str, taken: dict[str, int]) -> str:
    """Returns a name for the scene file: printable ASCII in one line, as Camway answers with, and not taken yet.

    Letters lose their accents, and what has no counterpart becomes '?', as it would in an answer.
    """
    letters = (c for c in unicodedata.normalize("NFKD", name) if not unicodedata.combining(c))
    plain = "".join(c if " " <= c <= "~" else "?" for c in letters).strip().rstrip("\\")[:_LONGEST_NAME]
    plain = plain or "unnamed"
    taken[plain] = taken.get(plain, 0) + 1
    return plain if taken[plain] == 1 else plain_name(f"{plain}#{taken[plain]}", taken)


class _Filter:
    """Tells which visible objects are obstacles: not what the camera carries, and by the settings."""

    def __init__(self, camera: bpy.types.Object, settings):
        self._carried = {camera.name, *(child.name for child in camera.children_recursive)}
        self._inside = set(settings.collection.all_objects.keys()) if settings.collection else None
        self._with_hidden = settings.with_hidden_in_render

    def takes(self, thing: bpy.types.Object, owner: bpy.types.Object) -> bool:
        """Whether something is an obstacle; `owner` makes the instance, or is the same."""
        if thing.type not in WITH_SURFACE or owner.name in self._carried:
            return False
        if self._inside is not None and owner.name not in self._inside:
            return False
        return self._with_hidden or not (thing.hide_render or owner.hide_render)


def visible(depsgraph: bpy.types.Depsgraph, camera: bpy.types.Object,
            settings) -> Iterator[tuple[Thing, bpy.types.Object]]:
    """Yields what has a surface and is visible in the viewport, instances too, each with its evaluated object.

    The object is valid until the next step of the iteration.
    """
    obstacles, names = _Filter(camera, settings), {}
    for instance in depsgraph.object_instances:
        thing = instance.object
        owner = instance.parent if instance.is_instance and instance.parent else thing
        if not instance.show_self or not obstacles.takes(thing, owner):
            continue
        shown = thing.name if owner == thing else f"{owner.name}/{thing.name}"
        yield Thing(plain_name(shown, names), Owner(shown, owner.name), instance.matrix_world.copy()), thing


def _write_mesh(file: TextIO, name: str, mesh: bpy.types.Mesh, world: Matrix, unit_m: float, first: int) -> None:
    """Writes a mesh. `first` vertices are in the file already."""
    flat = array.array("f", bytes(12 * len(mesh.vertices)))
    mesh.vertices.foreach_get("co", flat)
    # In doubles: a Matrix of Blender would round the product to floats.
    (a, b, c, d), (e, f, g, h), (i, j, k, m) = (tuple(x * unit_m for x in row) for row in world[:3])
    points = zip(flat[0::3], flat[1::3], flat[2::3])
    file.writelines(f"v {a * x + b * y + c * z + d:.12g} {e * x + f * y + g * z + h:.12g} "
                    f"{i * x + j * y + k * z + m:.12g}\n" for x, y, z in points)
    corners = array.array("i", bytes(12 * len(mesh.loop_triangles)))
    mesh.loop_triangles.foreach_get("vertices", corners)
    first += 1
    file.write(f"g {name}\n")
    file.writelines(f"f {p + first} {q + first} {r + first}\n"
                    for p, q, r in zip(corners[0::3], corners[1::3], corners[2::3]))


def write_scene(path: pathlib.Path, depsgraph: bpy.types.Depsgraph, camera: bpy.types.Object, settings,
                unit_m: float) -> dict[str, Owner]:
    """Writes the scene as it is now, in metres; `unit_m` is the length of a Blender unit.

    Returns what the names in the file stand for.
    """
    owners: dict[str, Owner] = {}
    count = 0
    with open(path, "w", encoding="utf-8") as file:
        for thing, evaluated in visible(depsgraph, camera, settings):
            mesh = evaluated.to_mesh()
            if mesh is not None:
                mesh.calc_loop_triangles()
                if mesh.loop_triangles:
                    _write_mesh(file, thing.name, mesh, thing.world, unit_m, count)
                    count += len(mesh.vertices)
                    owners[thing.name] = thing.owner
            evaluated.to_mesh_clear()
    return owners


def places(depsgraph: bpy.types.Depsgraph, camera: bpy.types.Object, settings) -> dict[str, Matrix]:
    """Returns where each visible thing is now."""
    return {thing.name: thing.world for thing, _ in visible(depsgraph, camera, settings)}


def moved(before: dict[str, Matrix], now: dict[str, Matrix]) -> list[str]:
    """Returns the names of things that are elsewhere, came, or went."""
    least = 1e-5  # of a Blender unit, or of a column of the rotation: above rounding

    def is_same(a: Matrix, b: Matrix) -> bool:
        return all(abs(x - y) <= least for p, q in zip(a, b) for x, y in zip(p, q))

    return sorted({name for name in before.keys() | now.keys()
                   if name not in before or name not in now or not is_same(before[name], now[name])})
