// SPDX-License-Identifier: MIT
#include "tools/make_scenes/furniture.h"

namespace camway::make_scenes {
namespace {

void add_legs(Scene& scene, const Placement& at, Um half_x, Um half_z, Um thickness, Um height) {
  for (const Um x : {-half_x, half_x - thickness}) {
    for (const Um z : {-half_z, half_z - thickness}) {
      scene.add_box(at, {x, 0, z}, {x + thickness, height, z + thickness});
    }
  }
}

/// Books of varying height and thickness, side by side from `x0` on a board whose top is at `y`.
void add_books(Scene& scene, const Placement& at, Um x0, Um x1, Um y, Dice& dice) {
  Um x = x0 + mm(20 + dice.below(200));
  for (Um count = 1 + dice.below(2); count > 0; --count) {
    const Um thickness = mm(60 + dice.below(160));
    const Um height = mm(180 + dice.below(120));
    if (x + thickness > x1) return;
    scene.add_box(at, {x, y, mm(-150)}, {x + thickness, y + height, mm(90)});
    x += thickness + mm(dice.below(90));
  }
}

}  // namespace

void add_desk(Scene& scene, const Placement& at) {
  add_table(scene, at, mm(1600), mm(800), mm(740));
  scene.add_box(at, {mm(280), 0, mm(-350)}, {mm(700), mm(705), mm(330)});
  scene.add_box(at, {mm(-120), mm(740), mm(-260)}, {mm(120), mm(755), mm(-100)});
  scene.add_box(at, {mm(-20), mm(755), mm(-200)}, {mm(20), mm(860), mm(-170)});
  scene.add_box(at, {mm(-270), mm(850), mm(-170)}, {mm(270), mm(1190), mm(-140)});
}

void add_chair(Scene& scene, const Placement& at) {
  for (const Um x : {mm(-225), mm(185)}) {  // the back's posts are the rear legs
    scene.add_box(at, {x, 0, mm(-225)}, {x + mm(40), mm(950), mm(-185)});
    scene.add_box(at, {x, 0, mm(185)}, {x + mm(40), mm(410), mm(225)});
  }
  scene.add_box(at, {mm(-225), mm(410), mm(-225)}, {mm(225), mm(450), mm(225)});
  scene.add_box(at, {mm(-185), mm(650), mm(-220)}, {mm(185), mm(930), mm(-190)});
}

void add_shelf(Scene& scene, const Placement& at, Um length, Dice& dice) {
  const Um half = length / 2;
  scene.add_box(at, {-half, 0, mm(-175)}, {-half + mm(25), mm(2000), mm(175)});
  scene.add_box(at, {half - mm(25), 0, mm(-175)}, {half, mm(2000), mm(175)});
  scene.add_box(at, {-half + mm(25), 0, mm(-175)}, {half - mm(25), mm(2000), mm(-165)});
  for (int board = 0; board < 5; ++board) {
    const Um y = mm(80 + 420 * board);
    scene.add_box(at, {-half + mm(25), y, mm(-165)}, {half - mm(25), y + mm(25), mm(175)});
    if (board < 4) add_books(scene, at, -half + mm(25), half - mm(25), y + mm(25), dice);
  }
}

void add_table(Scene& scene, const Placement& at, Um length, Um width, Um height) {
  const Um top = mm(35);
  add_legs(scene, at, length / 2 - mm(30), width / 2 - mm(30), mm(60), height - top);
  scene.add_box(at, {-length / 2, height - top, -width / 2}, {length / 2, height, width / 2});
}

void add_lamp(Scene& scene, const Placement& at) {
  scene.add_prism(at, {0, 0, 0}, mm(150), mm(25), 8);
  scene.add_prism(at, {0, mm(25), 0}, mm(15), mm(1425), 6);
  scene.add_prism(at, {0, mm(1450), 0}, mm(180), mm(300), 8);
}

void add_plant(Scene& scene, const Placement& at, Dice& dice) {
  scene.add_prism(at, {0, 0, 0}, mm(180), mm(350), 8);
  scene.add_prism(at, {0, mm(350), 0}, mm(12), mm(350), 6);
  for (int leaf = 0; leaf < 12; ++leaf) {
    const int direction = static_cast<int>(dice.below(24));
    const Point tip = on_circle(mm(250 + dice.below(200)), direction);
    const Point side = on_circle(mm(60), direction + 6);
    const Um root = mm(500 + dice.below(190));
    const Um rise = mm(100 + dice.below(500));
    const Point middle{tip[0] / 2, root + rise, tip[2] / 2};
    scene.add_triangle(at({0, root, 0}), at({middle[0] + side[0], middle[1], middle[2] + side[2]}),
                       at({tip[0], root + rise * 3 / 4, tip[2]}));
    scene.add_triangle(at({0, root, 0}), at({tip[0], root + rise * 3 / 4, tip[2]}),
                       at({middle[0] - side[0], middle[1], middle[2] - side[2]}));
  }
}

void add_bench(Scene& scene, const Placement& at, Um length) {
  scene.add_box(at, {-length / 2, mm(400), mm(-200)}, {length / 2, mm(450), mm(200)});
  scene.add_box(at, {-length / 2 + mm(100), 0, mm(-180)},
                {-length / 2 + mm(180), mm(400), mm(180)});
  scene.add_box(at, {length / 2 - mm(180), 0, mm(-180)}, {length / 2 - mm(100), mm(400), mm(180)});
}

void add_safe(Scene& scene, const Placement& at) {
  scene.add_box(at, {mm(-500), mm(80), mm(-500)}, {mm(500), mm(1280), mm(500)});
  scene.add_box(at, {mm(-580), 0, mm(-580)}, {mm(580), mm(1360), mm(580)});
}

}  // namespace camway::make_scenes
