# SPDX-License-Identifier: MIT
"""Writes the visible meshes of a scene, evaluated and in world space, as an OBJ file in metres."""
from __future__ import annotations

import array
import pathlib
from typing import Iterator, NamedTuple, TextIO

import bpy
from mathutils import Matrix

WITH_SURFACE = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


class Thing(NamedTuple):
    """An object as the depsgraph shows it; instances have the object that makes them as `owner`."""
    name: str
    owner: str
    world: Matrix


def plain_name(name: str) -> str:
    """Returns a name that stays one line of an OBJ file and that its reader does not change."""
    printable = "".join(c if c.isprintable() else " " for c in name).strip()
    return printable.rstrip("\\") or "unnamed"


def _is_part(thing: bpy.types.Object, owner: bpy.types.Object, camera: bpy.types.Object, settings) -> bool:
    """Whether a visible object is an obstacle: not what the camera carries, and by the settings."""
    if thing.type not in WITH_SURFACE or owner.original == camera or owner.original in camera.children_recursive:
        return False
    if settings.collection and owner.name not in settings.collection.all_objects:
        return False
    return settings.with_hidden_in_render or not (thing.hide_render or owner.hide_render)


def visible(depsgraph: bpy.types.Depsgraph, camera: bpy.types.Object,
            settings) -> Iterator[tuple[Thing, bpy.types.Object]]:
    """Yields what has a surface and is visible in the viewport, instances too, each with its evaluated object.

    The object is valid until the next step of the iteration.
    """
    names: dict[str, int] = {}
    for instance in depsgraph.object_instances:
        thing = instance.object
        owner = instance.parent if instance.is_instance and instance.parent else thing
        if not instance.show_self or not _is_part(thing, owner, camera, settings):
            continue
        name = plain_name(thing.name if owner == thing else f"{owner.name}/{thing.name}")
        names[name] = names.get(name, 0) + 1
        if names[name] > 1:
            name = f"{name}#{names[name]}"
        yield Thing(name, owner.name, instance.matrix_world.copy()), thing


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
                unit_m: float) -> dict[str, str]:
    """Writes the scene as it is now, in metres; `unit_m` is the length of a Blender unit.

    Returns the names of the objects that own what was written, by the names in the file.
    """
    owners: dict[str, str] = {}
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
