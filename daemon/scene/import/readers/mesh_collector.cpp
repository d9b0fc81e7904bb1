// SPDX-License-Identifier: MIT
#include "daemon/scene/import/readers/mesh_collector.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/geometry/rounding.h"

namespace camway::scene::mesh_readers {
namespace {

constexpr std::size_t kLongestName = 256;

using Step = std::ptrdiff_t;

/// False for NaN.
bool is_cuttable(const Point& p) {
  return std::all_of(p.begin(), p.end(),
                     [](double x) { return std::abs(x) < geometry::kLargestCoordinate_m; });
}

}  // namespace

std::uint32_t MeshCollector::add_vertex(const Point& vertex) {
  record_.vertices.push_back(vertex);
  return static_cast<std::uint32_t>(record_.vertices.size() - 1);
}

std::uint32_t MeshCollector::vertex(std::int64_t number) const {
  const bool exists = number >= 0 && static_cast<std::uint64_t>(number) < record_.vertices.size();
  return exists ? static_cast<std::uint32_t>(number) : kNoVertex;
}

void MeshCollector::begin_object(std::string_view name) {
  end_object();
  name_ = name.substr(0, kLongestName);
}

void MeshCollector::end_object() {
  const std::size_t count = record_.triangles.size() - first_triangle_;
  if (count > 0) {
    record_.objects.push_back(
        {static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(name_.size())});
    record_.names += name_;
  }
  first_triangle_ = record_.triangles.size();
}

void MeshCollector::add_polygon(std::span<const std::uint32_t> corners) {
  if (corners.size() < 3) {
    if (!corners.empty()) add_points_and_lines(1);
    return;
  }
  if (std::find(corners.begin(), corners.end(), kNoVertex) != corners.end()) {
    record_.triangles.push_back({kNoVertex, kNoVertex, kNoVertex});
    return;
  }
  if (corners.size() == 3) {
    record_.triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  if (!take_corners(corners)) {
    const auto bad = std::find_if_not(corners_.begin(), corners_.end(), is_cuttable);
    add_fan(corners, static_cast<std::size_t>(bad - corners_.begin()));
    return;
  }
  for (const PolygonCutter::Cut& cut : cutter_.cut(corners_)) {
    record_.triangles.push_back({corners[cut[0]], corners[cut[1]], corners[cut[2]]});
  }
}

void MeshCollector::add_polygon(std::span<const std::uint32_t> corners,
                                std::span<const std::size_t> ends) {
  std::vector<std::uint32_t> kept(corners.begin(), corners.begin() + static_cast<Step>(ends[0]));
  std::vector<std::size_t> kept_ends = {kept.size()};
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (ends[i] - ends[i - 1] < 3) continue;
    kept.insert(kept.end(), corners.begin() + static_cast<Step>(ends[i - 1]),
                corners.begin() + static_cast<Step>(ends[i]));
    kept_ends.push_back(kept.size());
  }
  const std::span<const std::uint32_t> outline = corners.first(ends[0]);
  if (ends[0] < 3 || kept_ends.size() == 1) return add_polygon(outline);
  const bool can_cut = std::ranges::count(kept, kNoVertex) == 0 && take_corners(kept);
  const std::span<const PolygonCutter::Cut> cuts =
      can_cut ? cutter_.cut(corners_, kept_ends) : std::span<const PolygonCutter::Cut>();
  if (cuts.empty()) {
    filled_holes_ += kept_ends.size() - 1;
    return add_polygon(outline);
  }
  for (const PolygonCutter::Cut& cut : cuts) {
    record_.triangles.push_back({kept[cut[0]], kept[cut[1]], kept[cut[2]]});
  }
}

bool MeshCollector::take_corners(std::span<const std::uint32_t> corners) {
  corners_.clear();
  for (const std::uint32_t corner : corners) corners_.push_back(record_.vertices[corner]);
  return std::ranges::all_of(corners_, is_cuttable);
}

void MeshCollector::add_fan(std::span<const std::uint32_t> corners, std::size_t first) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    record_.triangles.push_back({corners[first], corners[(first + i) % corners.size()],
                                 corners[(first + i + 1) % corners.size()]});
  }
}

import_record::Record MeshCollector::finish(std::string_view format, double relative_rounding) {
  end_object();
  if (record_.objects.empty()) record_.objects.push_back({0, 0});
  record_.text = format;
  // Number, weight and quotient round once each; the fourth exceeds their products.
  record_.header.relative_rounding = (weighted_ ? 4.0 : 1.0) * relative_rounding;
  return std::move(record_);
}

}  // namespace camway::scene::mesh_readers
