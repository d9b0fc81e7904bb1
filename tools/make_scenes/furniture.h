// SPDX-License-Identifier: MIT
#pragma once

#include "tools/make_scenes/solid.h"

/// Furniture. Each function adds a piece to the object that was begun last. The piece stands on the
/// floor at the origin of its placement (y = 0); its front faces +z of its own frame.
namespace camway::make_scenes {

/// 1.6 x 0.8 m, 0.74 m high, with a drawer block and a screen; the chair's side is +z.
void add_desk(Scene& scene, const Placement& at);
/// 0.45 x 0.45 m, seat at 0.45 m, back 0.95 m high on the -z side.
void add_chair(Scene& scene, const Placement& at);
/// `length` x 0.35 m, 2.0 m high, five boards with books.
void add_shelf(Scene& scene, const Placement& at, Um length, Dice& dice);
/// A table top of `length` (x) by `width` (z) on four legs.
void add_table(Scene& scene, const Placement& at, Um length, Um width, Um height);
/// A shade of 0.36 m on a pole of 3 cm, 1.75 m high.
void add_lamp(Scene& scene, const Placement& at);
/// A pot with leaves of single triangles, about 1.3 m high.
void add_plant(Scene& scene, const Placement& at, Dice& dice);
/// A bench of `length`, 0.4 m deep and 0.45 m high.
void add_bench(Scene& scene, const Placement& at, Um length);
/// A closed steel box, 1 x 1 x 1.2 m inside, with walls of 8 cm.
void add_safe(Scene& scene, const Placement& at);

}  // namespace camway::make_scenes
