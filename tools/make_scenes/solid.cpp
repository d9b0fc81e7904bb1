// SPDX-License-Identifier: MIT
#include "tools/make_scenes/solid.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <cstdlib>

namespace camway::make_scenes {
namespace {

/// Returns the nearest integer to a / b, with halves rounded away from zero. Requires b > 0.
std::int64_t divide_rounded(std::int64_t a, std::int64_t b) {
  return a >= 0 ? (2 * a + b) / (2 * b) : -((-2 * a + b) / (2 * b));
}

/// A panel with openings: normal along `axis`, `u` along the next axis and `v` along the one after
/// (cyclically), so that (u, v, axis) is right-handed.
struct Panel {
  std::size_t axis;
  Um n0, n1, u0, u1, v0, v1;

  [[nodiscard]] Point at(Um n, Um u, Um v) const {
    Point p{};
    p[axis] = n;
    p[(axis + 1) % 3] = u;
    p[(axis + 2) % 3] = v;
    return p;
  }
};

std::vector<Um> cuts(Um low, Um high, const std::vector<Opening>& openings, bool along_u) {
  std::vector<Um> result{low, high};
  for (const Opening& o : openings) {
    for (const Um cut : {along_u ? o.u0 : o.v0, along_u ? o.u1 : o.v1}) {
      if (cut > low && cut < high) result.push_back(cut);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// The cells of a panel between all cuts; some are open.
class PanelCells {
 public:
  PanelCells(const Panel& panel, const std::vector<Opening>& openings)
      : panel_(panel),
        openings_(openings),
        u_(cuts(panel.u0, panel.u1, openings, true)),
        v_(cuts(panel.v0, panel.v1, openings, false)) {}

  void add_to(Scene& scene) const {
    for (std::size_t i = 0; i + 1 < u_.size(); ++i) {
      for (std::size_t j = 0; j + 1 < v_.size(); ++j) {
        if (solid(i, j)) add_cell(scene, i, j);
      }
    }
  }

 private:
  /// Returns whether a cell is solid. `i` and `j` may be -1 as an unsigned number: the outside is
  /// not.
  [[nodiscard]] bool solid(std::size_t i, std::size_t j) const {
    if (i >= u_.size() - 1 || j >= v_.size() - 1) return false;
    return std::none_of(openings_.begin(), openings_.end(), [&](const Opening& o) {
      return u_[i] >= o.u0 && u_[i + 1] <= o.u1 && v_[j] >= o.v0 && v_[j + 1] <= o.v1;
    });
  }

  void add_cell(Scene& scene, std::size_t i, std::size_t j) const {
    const Um u0 = u_[i];
    const Um u1 = u_[i + 1];
    const Um v0 = v_[j];
    const Um v1 = v_[j + 1];
    const auto p = [&](Um n, Um u, Um v) { return panel_.at(n, u, v); };
    const Um n0 = panel_.n0;
    const Um n1 = panel_.n1;
    scene.add_quad(p(n1, u0, v0), p(n1, u1, v0), p(n1, u1, v1), p(n1, u0, v1));
    scene.add_quad(p(n0, u0, v0), p(n0, u0, v1), p(n0, u1, v1), p(n0, u1, v0));
    if (!solid(i - 1, j)) {
      scene.add_quad(p(n0, u0, v0), p(n1, u0, v0), p(n1, u0, v1), p(n0, u0, v1));
    }
    if (!solid(i + 1, j)) {
      scene.add_quad(p(n0, u1, v0), p(n0, u1, v1), p(n1, u1, v1), p(n1, u1, v0));
    }
    if (!solid(i, j - 1)) {
      scene.add_quad(p(n0, u0, v0), p(n0, u1, v0), p(n1, u1, v0), p(n1, u0, v0));
    }
    if (!solid(i, j + 1)) {
      scene.add_quad(p(n0, u0, v1), p(n1, u0, v1), p(n1, u1, v1), p(n0, u1, v1));
    }
  }

  const Panel& panel_;
  const std::vector<Opening>& openings_;
  std::vector<Um> u_;
  std::vector<Um> v_;
};

std::vector<Opening> swapped(const std::vector<Opening>& openings) {
  std::vector<Opening> result;
  for (const Opening& o : openings) result.push_back({o.v0, o.v1, o.u0, o.u1});
  return result;
}

std::string coordinates(const Point& p) {
  return ' ' + metres(p[0]) + ' ' + metres(p[1]) + ' ' + metres(p[2]);
}

}  // namespace

std::string metres(Um value) {
  char text[40];
  const std::int64_t magnitude = std::abs(value);
  std::snprintf(text, sizeof text, "%s%lld.%06lld", value < 0 ? "-" : "",
                static_cast<long long>(magnitude / 1'000'000),
                static_cast<long long>(magnitude % 1'000'000));
  return text;
}

Turn compose(const Turn& first, const Turn& second) {
  return {first.cosine * second.cosine - first.sine * second.sine,
          first.cosine * second.sine + first.sine * second.cosine,
          first.denominator * second.denominator};
}

Point Placement::operator()(const Point& p) const {
  const std::int64_t x = turn.cosine * p[0] + turn.sine * p[2];
  const std::int64_t z = -turn.sine * p[0] + turn.cosine * p[2];
  return {origin[0] + divide_rounded(x, turn.denominator), origin[1] + p[1],
          origin[2] + divide_rounded(z, turn.denominator)};
}

Point on_circle(Um radius, int index) {
  // cos(k * 15 degrees) in millionths.
  constexpr std::array<std::int64_t, 7> kCosines{1'000'000, 965'926, 866'025, 707'107,
                                                 500'000,   258'819, 0};
  const auto cosine = [&](int k) {
    const int folded = k % 24 > 12 ? 24 - k % 24 : k % 24;  // 0 .. 12, 12 is 180 degrees
    return folded <= 6 ? kCosines[static_cast<std::size_t>(folded)]
                       : -kCosines[static_cast<std::size_t>(12 - folded)];
  };
  return {divide_rounded(radius * cosine(index), 1'000'000), 0,
          -divide_rounded(radius * cosine(index + 18), 1'000'000)};
}

void Scene::begin_object(const std::string& name) { objects_.push_back({name, triangles_.size()}); }

void Scene::add_triangle(const Point& a, const Point& b, const Point& c) {
  assert(!objects_.empty());
  triangles_.push_back({a, b, c});
}

void Scene::add_quad(const Point& a, const Point& b, const Point& c, const Point& d) {
  add_triangle(a, b, c);
  add_triangle(a, c, d);
}

void Scene::add_box(const Placement& placement, const Point& low, const Point& high) {
  const auto p = [&](int x, int y, int z) {
    return placement(
        {x != 0 ? high[0] : low[0], y != 0 ? high[1] : low[1], z != 0 ? high[2] : low[2]});
  };
  add_quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
  add_quad(p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
  add_quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
  add_quad(p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0));
  add_quad(p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0));
  add_quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
}

void Scene::add_prism(const Placement& placement, const Point& base, Um radius, Um height,
                      int sides) {
  assert(24 % sides == 0);
  const auto p = [&](int k, Um y) {
    const Point ring = on_circle(radius, k * (24 / sides) % 24);
    return placement({base[0] + ring[0], base[1] + y, base[2] + ring[2]});
  };
  const Point bottom = placement(base);
  const Point top = placement({base[0], base[1] + height, base[2]});
  for (int k = 0; k < sides; ++k) {
    add_quad(p(k, 0), p(k + 1, 0), p(k + 1, height), p(k, height));
    add_triangle(bottom, p(k + 1, 0), p(k, 0));
    add_triangle(top, p(k, height), p(k + 1, height));
  }
}

std::vector<Scene::Part> Scene::parts() const {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const std::size_t end =
        i + 1 < objects_.size() ? objects_[i + 1].first_triangle : triangles_.size();
    Part part{objects_[i].name, {}, {}};
    std::map<Point, std::size_t> index;
    for (std::size_t t = objects_[i].first_triangle; t < end; ++t) {
      std::array<std::size_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [entry, is_new] = index.try_emplace(triangles_[t][k], index.size());
        if (is_new) part.vertices.push_back(triangles_[t][k]);
        corners[k] = entry->second;
      }
      part.triangles.push_back(corners);
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

std::string Scene::obj(const std::string& title) const {
  std::string text = "# " + title + "\n# metres, y up; made by tools/make_scenes, do not edit\n";
  std::size_t written = 0;
  for (const Part& part : parts()) {
    text += "o " + part.name + '\n';
    for (const Point& p : part.vertices) text += "v" + coordinates(p) + '\n';
    for (const auto& corners : part.triangles) {
      text += 'f';
      for (const std::size_t corner : corners) text += ' ' + std::to_string(written + corner + 1);
      text += '\n';
    }
    written += part.vertices.size();
  }
  return text;
}

std::string Scene::unigrafix(const std::string& title) const {
  std::string text = "{ " + title + "\n  metres, y up; made by tools/make_scenes, do not edit }\n";
  for (const Part& part : parts()) {
    text += "def " + part.name + ";\n";
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      text += "v v" + std::to_string(i) + coordinates(part.vertices[i]) + ";\n";
    }
    for (const auto& corners : part.triangles) {
      text += "f (";
      for (std::size_t k = 0; k < 3; ++k) text += (k > 0 ? " v" : "v") + std::to_string(corners[k]);
      text += ");\n";
    }
    text += "end;\ni (" + part.name + ");\n";
  }
  return text;
}

void add_wall(Scene& scene, const WallAlongX& w, const std::vector<Opening>& openings) {
  PanelCells({2, w.z0, w.z1, w.x0, w.x1, w.y0, w.y1}, openings).add_to(scene);
}

void add_wall(Scene& scene, const WallAlongZ& w, const std::vector<Opening>& openings) {
  const std::vector<Opening> yz = swapped(openings);
  const Panel panel{0, w.x0, w.x1, w.y0, w.y1, w.z0, w.z1};
  PanelCells(panel, yz).add_to(scene);
}

void add_slab(Scene& scene, const Slab& s, const std::vector<Opening>& openings) {
  const std::vector<Opening> zx = swapped(openings);
  const Panel panel{1, s.y0, s.y1, s.z0, s.z1, s.x0, s.x1};
  PanelCells(panel, zx).add_to(scene);
}

std::int64_t Dice::below(std::int64_t count) {
  state_ += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  z ^= z >> 31U;
  return static_cast<std::int64_t>(z % static_cast<std::uint64_t>(count));
}

}  // namespace camway::make_scenes
