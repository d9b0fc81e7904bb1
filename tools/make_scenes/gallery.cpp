// SPDX-License-Identifier: MIT
#include "tools/make_scenes/gallery.h"

#include <cstdlib>
#include <string>

namespace camway::make_scenes {
namespace {

using namespace gallery;

/// Adds a closed prism of three sides from `from` to `to`. `thickness` is the length of two edges
/// of its section, which lie along the two axes with the smallest components of the wire's
/// direction.
void add_wire(Scene& scene, const Point& from, const Point& to, Um thickness) {
  std::size_t major = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::abs(to[axis] - from[axis]) > std::abs(to[major] - from[major])) major = axis;
  }
  const auto moved = [&](Point p, std::size_t axis) {
    p[axis] += thickness;
    return p;
  };
  const std::size_t second = (major + 1) % 3;
  const std::size_t third = (major + 2) % 3;
  const std::array<Point, 3> a{from, moved(from, second), moved(from, third)};
  const std::array<Point, 3> b{to, moved(to, second), moved(to, third)};
  for (std::size_t i = 0; i < 3; ++i) scene.add_quad(a[i], a[(i + 1) % 3], b[(i + 1) % 3], b[i]);
  scene.add_triangle(a[0], a[2], a[1]);
  scene.add_triangle(b[0], b[1], b[2]);
}

void add_corridor(Scene& scene) {
  const Um thick = mm(200);
  scene.begin_object("floor");
  add_slab(scene, {0, kLength, -thick, kWidth + thick, -thick, 0});
  scene.begin_object("ceiling");
  add_slab(scene, {0, kLength, -thick, kWidth + thick, kHeight, kHeight + thick});
  scene.begin_object("wall_north");
  add_wall(scene, WallAlongX{0, kLength, 0, kHeight, -thick, 0});
  scene.begin_object("wall_south");
  add_wall(scene, WallAlongX{0, kLength, 0, kHeight, kWidth, kWidth + thick});
}

void add_cube(Scene& scene) {
  const Um half = mm(25);
  scene.begin_object("cube_floating");
  scene.add_box({}, {kCubeX - half, kEyeY - half, kMiddleZ - half},
                {kCubeX + half, kEyeY + half, kMiddleZ + half});
}

void add_poles(Scene& scene) {
  scene.begin_object("poles");
  int pole = 0;
  for (const Um dx : {mm(-600), mm(0), mm(600)}) {
    for (const Um z : {mm(700), mm(1350), mm(2000), mm(2650)}) {
      const Um shift = pole % 2 == 0 ? mm(0) : mm(180);
      scene.add_prism({}, {kPolesX + dx + shift, 0, z}, mm(5), kHeight, 6);
      ++pole;
    }
  }
  scene.begin_object("spike");  // ends in mid air: enclosed by the sweep of a camera above its foot
  scene.add_prism({}, {kPolesX + mm(1500), 0, kMiddleZ}, mm(5), mm(1600), 6);
}

void add_wires(Scene& scene) {
  const Um thin = mm(1);
  scene.begin_object("wires");
  for (const Um y : {mm(400), mm(900), mm(1400), mm(1900), mm(2400)}) {
    add_wire(scene, {kWiresX, y, 0}, {kWiresX, y, mm(3000)}, thin);
  }
  scene.begin_object("wires_slanting");
  add_wire(scene, {kWiresX + mm(500), 0, mm(300)}, {kWiresX + mm(900), kHeight, mm(2900)}, thin);
  add_wire(scene, {kWiresX + mm(1300), 0, mm(2900)}, {kWiresX + mm(900), kHeight, mm(200)}, thin);
  add_wire(scene, {kWiresX - mm(1500), mm(2200), mm(500)}, {kWiresX + mm(1500), mm(2100), mm(900)},
           thin);
}

void add_single_triangles(Scene& scene) {
  const auto p = [](Um dx, Um y, Um z) { return Point{kTrianglesX + dx, y, z}; };
  scene.begin_object("triangle_facing");
  scene.add_triangle(p(0, mm(1300), mm(1800)), p(0, mm(1300), mm(2200)), p(0, mm(1700), mm(2000)));
  scene.begin_object("triangle_edge_on");
  scene.add_triangle(p(mm(500), mm(1500), mm(1000)), p(mm(900), mm(1500), mm(1000)),
                     p(mm(700), mm(1900), mm(1000)));
  scene.begin_object("triangle_level");
  scene.add_triangle(p(mm(600), mm(1600), mm(2300)), p(mm(1000), mm(1600), mm(2500)),
                     p(mm(700), mm(1600), mm(2800)));
  scene.begin_object("triangle_tiny");  // a millimetre
  scene.add_triangle(p(mm(1400), mm(1600), mm(2000)), p(mm(1401), mm(1600), mm(2000)),
                     p(mm(1400), mm(1601), mm(2001)));
}

void add_plates(Scene& scene) {
  const auto p = [](Um dx, Um y, Um z) { return Point{kPlatesX + dx, y, z}; };
  scene.begin_object("plate_edge_on");  // in the plane of the corridor's middle
  scene.add_quad(p(mm(-600), mm(1200), kMiddleZ), p(mm(600), mm(1200), kMiddleZ),
                 p(mm(600), mm(2000), kMiddleZ), p(mm(-600), mm(2000), kMiddleZ));
  scene.begin_object("plate_level");
  scene.add_quad(p(mm(-500), mm(1600), mm(300)), p(mm(-500), mm(1600), mm(1200)),
                 p(mm(500), mm(1600), mm(1200)), p(mm(500), mm(1600), mm(300)));
  scene.begin_object("plate_facing");
  scene.add_quad(p(mm(1200), 0, mm(1000)), p(mm(1200), 0, mm(3000)),
                 p(mm(1200), mm(1100), mm(3000)), p(mm(1200), mm(1100), mm(1000)));
}

void add_louvre(Scene& scene) {
  const Um end = mm(2200);
  scene.begin_object("louvre_frame");
  scene.add_box({}, {kLouvreX - mm(60), 0, end}, {kLouvreX + mm(60), kHeight, end + mm(50)});
  scene.begin_object("louvre_slats");
  for (Um y = mm(100); y < kHeight - mm(150); y += mm(150)) {
    const auto p = [&](Um dx, Um dy, Um z) { return Point{kLouvreX + dx, y + dy, z}; };
    const std::array<Point, 4> near{p(mm(-50), 0, 0), p(mm(50), mm(60), 0), p(mm(50), mm(68), 0),
                                    p(mm(-50), mm(8), 0)};
    std::array<Point, 4> far = near;
    for (Point& corner : far) corner[2] = end;
    for (std::size_t i = 0; i < 4; ++i) {
      scene.add_quad(near[i], near[(i + 1) % 4], far[(i + 1) % 4], far[i]);
    }
    scene.add_quad(near[3], near[2], near[1], near[0]);
    scene.add_quad(far[0], far[1], far[2], far[3]);
  }
}

/// A ring of square section about the x axis, hung from the ceiling by a wire.
void add_ring(Scene& scene) {
  const Um half = mm(20);
  const auto at = [](Um radius, Um dx, int k) {
    const Point c = on_circle(radius, k % 24);
    return Point{kRingX + dx, kEyeY + c[0], kMiddleZ + c[2]};
  };
  scene.begin_object("ring");
  for (int k = 0; k < 24; ++k) {
    const auto section = [&](int i) {
      return std::array<Point, 4>{at(kRingRadius - half, -half, i),
                                  at(kRingRadius + half, -half, i), at(kRingRadius + half, half, i),
                                  at(kRingRadius - half, half, i)};
    };
    const std::array<Point, 4> a = section(k);
    const std::array<Point, 4> b = section(k + 1);
    for (std::size_t i = 0; i < 4; ++i) scene.add_quad(a[i], a[(i + 1) % 4], b[(i + 1) % 4], b[i]);
  }
  scene.begin_object("ring_wire");
  add_wire(scene, {kRingX, kEyeY + kRingRadius, kMiddleZ}, {kRingX, kHeight, kMiddleZ}, mm(2));
}

/// Adds triangles from one vertex to a square zigzag below it, which no spatial subdivision
/// separates.
void add_fan(Scene& scene) {
  constexpr int kPerSide = 60;
  const Um half = mm(600);
  const Point apex{kFanX, mm(2300), mm(1500)};
  const auto rim = [&](int k) {
    const int side = k / kPerSide % 4;
    const Um along = -half + 2 * half * (k % kPerSide) / kPerSide;
    const Um y = k % 2 == 0 ? mm(1300) : mm(1350);
    switch (side) {
      case 0:
        return Point{apex[0] + along, y, apex[2] - half};
      case 1:
        return Point{apex[0] + half, y, apex[2] + along};
      case 2:
        return Point{apex[0] - along, y, apex[2] + half};
      default:
        return Point{apex[0] - half, y, apex[2] - along};
    }
  };
  scene.begin_object("fan");
  for (int k = 0; k < 4 * kPerSide; ++k) scene.add_triangle(apex, rim(k + 1), rim(k));
}

void add_nasty(Scene& scene) {
  const auto p = [](Um dx, Um y, Um z) { return Point{kFanX + dx, y, z}; };
  scene.begin_object("slivers");  // two metres long, a tenth of a millimetre wide and less
  for (Um i = 0; i < 8; ++i) {
    const Um z = mm(1000 + 150 * i);
    scene.add_triangle(p(mm(1000), mm(500), z), p(mm(3000), mm(600), z),
                       p(mm(3000), mm(600), z + 100 - 12 * i));
  }
  scene.begin_object("duplicates");
  for (int i = 0; i < 5; ++i) {
    scene.add_triangle(p(mm(1200), mm(1500), mm(800)), p(mm(1200), mm(1500), mm(1200)),
                       p(mm(1200), mm(1900), mm(1000)));
  }
  scene.begin_object("degenerate");  // a point, a doubled edge, three points in a line
  scene.add_triangle(p(0, mm(300), mm(500)), p(0, mm(300), mm(500)), p(0, mm(300), mm(500)));
  scene.add_triangle(p(0, mm(300), mm(600)), p(mm(200), mm(300), mm(600)),
                     p(mm(200), mm(300), mm(600)));
  scene.add_triangle(p(0, mm(300), mm(700)), p(mm(100), mm(300), mm(700)),
                     p(mm(200), mm(300), mm(700)));
}

void add_slot(Scene& scene) {
  const Um half = mm(150);
  scene.begin_object("wall_slot");
  add_wall(scene, WallAlongZ{0, kWidth, 0, kHeight, kSlotX - mm(100), kSlotX + mm(100)},
           {{kSlotZ - half, kSlotZ + half, mm(400), mm(2400)}});
  scene.begin_object("rod");  // points at whoever comes along the corridor
  scene.add_box({}, {kSlotX - mm(1100), kEyeY - mm(5), kRodZ - mm(5)},
                {kSlotX - mm(100), kEyeY + mm(5), kRodZ + mm(5)});
}

}  // namespace

Scene make_gallery() {
  Scene scene;
  add_corridor(scene);
  add_cube(scene);
  add_poles(scene);
  add_wires(scene);
  add_single_triangles(scene);
  add_plates(scene);
  add_louvre(scene);
  add_ring(scene);
  add_fan(scene);
  add_nasty(scene);
  add_slot(scene);
  return scene;
}

}  // namespace camway::make_scenes
