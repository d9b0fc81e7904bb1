// SPDX-License-Identifier: MIT
#include "tools/drawing/floor_section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace camway::draw {
namespace {

using geometry::Triangle;
using geometry::Vec3;

/// Coordinates as the key of ordered maps. Meshes repeat a shared vertex with the same bits, so
/// exact comparison finds it.
using Key2 = std::array<double, 2>;
using Key3 = std::array<double, 3>;
Key2 key(const PlanPoint& p) { return {p.x(), p.y()}; }
Key3 key(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

using PlanSegment = std::array<PlanPoint, 2>;

/// Returns the point where an edge passes `height_m`, the same bits for both directions of the
/// edge.
PlanPoint crossing(const Vec3& p, const Vec3& q, SceneUp up, double height_m) {
  const bool ordered = key(p) < key(q);
  const Vec3& a = ordered ? p : q;
  const Vec3& b = ordered ? q : p;
  const double ha = height_of(a, up);
  const double s = (height_m - ha) / (height_of(b, up) - ha);
  return to_plan(a + s * (b - a), up);
}

std::optional<PlanSegment> cut(const Triangle& triangle, SceneUp up, double height_m) {
  std::vector<PlanPoint> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& a = triangle[i];
    const Vec3& b = triangle[(i + 1) % 3];
    // A vertex at the height itself counts as above, so that chains do not break there.
    if ((height_of(a, up) < height_m) != (height_of(b, up) < height_m)) {
      points.push_back(crossing(a, b, up, height_m));
    }
  }
  if (points.size() != 2 || points[0] == points[1]) return std::nullopt;
  return PlanSegment{points[0], points[1]};
}

/// Joins segments end to end.
std::vector<SectionLine> chain(const std::vector<PlanSegment>& segments) {
  std::map<Key2, std::vector<std::size_t>> at;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    for (const PlanPoint& end : segments[i]) at[key(end)].push_back(i);
  }
  std::vector<bool> used(segments.size(), false);
  const auto next_unused = [&](const PlanPoint& end) -> std::optional<std::size_t> {
    for (const std::size_t i : at[key(end)]) {
      if (!used[i]) return i;
    }
    return std::nullopt;
  };
  std::vector<SectionLine> lines;
  for (std::size_t first = 0; first < segments.size(); ++first) {
    if (used[first]) continue;
    used[first] = true;
    SectionLine line{{segments[first][0], segments[first][1]}, false};
    while (const std::optional<std::size_t> i = next_unused(line.points.back())) {
      used[*i] = true;
      const PlanSegment& s = segments[*i];
      line.points.push_back(s[0] == line.points.back() ? s[1] : s[0]);
    }
    line.closed = line.points.size() > 2 && line.points.front() == line.points.back();
    lines.push_back(std::move(line));
  }
  return lines;
}

Vec3 normal_of(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

Vec3 up_vector(SceneUp up) { return up == SceneUp::kY ? Vec3::UnitY() : Vec3::UnitZ(); }

double top_of(const Triangle& t, SceneUp up) {
  return std::max({height_of(t[0], up), height_of(t[1], up), height_of(t[2], up)});
}

/// Returns the borders of some triangles, and their creases sharper than 25 degrees.
std::vector<PlanSegment> feature_edges(const std::vector<Triangle>& triangles, SceneUp up) {
  constexpr double kCrease = 0.906;
  constexpr double kShort_m = 1e-3;
  struct Edge {
    Vec3 first_normal;
    int count = 0;
    bool crease = false;
  };
  std::map<std::pair<Key3, Key3>, Edge> edges;
  for (const Triangle& triangle : triangles) {
    const Vec3 normal = normal_of(triangle).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      std::pair<Key3, Key3> ends{key(triangle[i]), key(triangle[(i + 1) % 3])};
      if (ends.second < ends.first) std::swap(ends.first, ends.second);
      Edge& edge = edges[ends];
      if (edge.count++ == 0) {
        edge.first_normal = normal;
      } else if (std::abs(edge.first_normal.dot(normal)) < kCrease) {
        edge.crease = true;
      }
    }
  }
  std::vector<PlanSegment> result;
  for (const auto& [ends, edge] : edges) {
    if (edge.count > 1 && !edge.crease) continue;
    const PlanPoint a = to_plan(Vec3(ends.first[0], ends.first[1], ends.first[2]), up);
    const PlanPoint b = to_plan(Vec3(ends.second[0], ends.second[1], ends.second[2]), up);
    if ((b - a).norm() > kShort_m) result.push_back({a, b});
  }
  return result;
}

void collect_below(const scene::Mesh& mesh, SceneUp up, FloorSection& section) {
  constexpr double kAboveFloor_m = 0.02;
  constexpr double kSeenFromAbove = 0.2;  // cosine of the slope
  std::vector<Triangle> below;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    const double top = top_of(triangle, up);
    if (top > section.floor_m + kAboveFloor_m && top < section.height_m) below.push_back(triangle);
  }
  std::stable_sort(below.begin(), below.end(), [up](const Triangle& a, const Triangle& b) {
    return top_of(a, up) < top_of(b, up);
  });
  for (const Triangle& t : below) {
    const Vec3 normal = normal_of(t);
    if (std::abs(normal.dot(up_vector(up))) > kSeenFromAbove * normal.norm()) {
      section.tops.push_back({to_plan(t[0], up), to_plan(t[1], up), to_plan(t[2], up)});
    }
  }
  section.outlines = feature_edges(below, up);
}

/// Whether the outline has the point inside: a ray to the right crosses it an odd number of times.
bool has_inside(const SectionLine& outline, const PlanPoint& point) {
  bool is_inside = false;
  for (std::size_t i = 1; i < outline.points.size(); ++i) {
    const PlanPoint& a = outline.points[i - 1];
    const PlanPoint& b = outline.points[i];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double share = (point.y() - a.y()) / (b.y() - a.y());
    if (point.x() < std::lerp(a.x(), b.x(), share)) is_inside = !is_inside;
  }
  return is_inside;
}

double area_m2(const SectionLine& outline) {
  double twice_m2 = 0.0;
  for (std::size_t i = 1; i < outline.points.size(); ++i) {
    const PlanPoint& a = outline.points[i - 1];
    const PlanPoint& b = outline.points[i];
    twice_m2 += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(0.5 * twice_m2);
}

}  // namespace

PlanPoint to_plan(const Vec3& p_W, SceneUp up) {
  return up == SceneUp::kY ? PlanPoint(p_W.x(), p_W.z()) : PlanPoint(p_W.x(), -p_W.y());
}

double height_of(const Vec3& p_W, SceneUp up) { return up == SceneUp::kY ? p_W.y() : p_W.z(); }

double find_floor_m(const scene::Mesh& mesh, SceneUp up, double height_m) {
  constexpr double kBin_m = 0.05;  // of level
  constexpr double kReach_m = 4.0;
  constexpr double kTooNear_m = 0.3;
  constexpr double kLevel = 0.99;                          // cosine of the slope
  constexpr double kNearlyAsMuch = 0.8;                    // of the largest area
  std::map<std::int64_t, std::pair<double, double>> bins;  // area, highest level
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    const double level_m = top_of(triangle, up);
    if (level_m > height_m - kTooNear_m || level_m < height_m - kReach_m) continue;
    const Vec3 normal = normal_of(triangle);
    if (!(std::abs(normal.dot(up_vector(up))) > kLevel * normal.norm())) continue;
    const auto bin = static_cast<std::int64_t>(std::floor((height_m - level_m) / kBin_m));
    const auto [entry, is_new] = bins.try_emplace(bin, 0.0, level_m);
    entry->second.first += 0.5 * normal.norm();
    entry->second.second = std::max(entry->second.second, level_m);
  }
  double largest = 0.0;
  for (const auto& [bin, content] : bins) largest = std::max(largest, content.first);
  for (const auto& [bin, content] : bins) {  // from the highest level down
    if (content.first >= kNearlyAsMuch * largest) return content.second;
  }
  return height_m - 2.0;
}

FloorSection cut_floor(const scene::Mesh& mesh, SceneUp up, double height_m,
                       std::optional<double> floor_m) {
  FloorSection section;
  section.height_m = height_m;
  section.floor_m = floor_m ? *floor_m : find_floor_m(mesh, up, height_m);
  std::vector<scene::MeshObject> objects = mesh.objects;
  if (objects.empty())
    objects.push_back({"", 0, static_cast<std::uint32_t>(mesh.triangles.size())});
  for (const scene::MeshObject& object : objects) {
    std::vector<PlanSegment> segments;
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
      const std::optional<PlanSegment> segment =
          cut(mesh.triangle(object.first_triangle + i), up, height_m);
      if (segment) segments.push_back(*segment);
    }
    if (!segments.empty()) section.cut.push_back(chain(segments));
  }
  collect_below(mesh, up, section);
  return section;
}

void open_room_about(std::span<const PlanPoint> places, FloorSection& section) {
  if (places.empty()) return;
  for (std::vector<SectionLine>& object : section.cut) {
    std::vector<SectionLine*> around;
    for (SectionLine& line : object) {
      const auto is_around = [&](const PlanPoint& place) { return has_inside(line, place); };
      if (line.closed && std::ranges::all_of(places, is_around)) around.push_back(&line);
    }
    if (around.size() % 2 == 0) continue;
    (*std::ranges::max_element(around, {}, [](const SectionLine* line) {
      return area_m2(*line);
    }))->closed = false;
  }
}

}  // namespace camway::draw
