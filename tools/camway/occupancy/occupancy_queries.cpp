// SPDX-License-Identifier: MIT
#include "tools/camway/occupancy/occupancy_queries.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace camway::tools {
namespace {

/// Reads exactly `kCount` finite numbers separated by commas.
template <std::size_t kCount>
std::optional<std::array<double, kCount>> parse_numbers(std::string_view text) {
  std::array<double, kCount> numbers{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < kCount; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc{} || !std::isfinite(numbers[i])) return std::nullopt;
    at = next;
  }
  if (at != end) return std::nullopt;
  return numbers;
}

std::string fault(std::string_view option, std::string_view text, std::string_view reason) {
  return fmt::format("--{} {}: {}", option, text, reason);
}

template <std::size_t kCount, typename Add>
std::string parse_all(std::string_view option, const std::vector<std::string>& texts, Add add) {
  for (const std::string& text : texts) {
    const auto numbers = parse_numbers<kCount>(text);
    if (!numbers) {
      return fault(option, text,
                   fmt::format("must be {} finite numbers with commas between them", kCount));
    }
    const std::string_view reason = add(*numbers);
    if (!reason.empty()) return fault(option, text, reason);
  }
  return {};
}

std::string parse_boxes(const std::vector<std::string>& texts, OccupancyBatch& batch) {
  return parse_all<6>("box", texts, [&](const std::array<double, 6>& n) -> std::string_view {
    if (n[0] > n[3] || n[1] > n[4] || n[2] > n[5]) return "the minimum is above the maximum";
    batch.boxes.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
    return {};
  });
}

std::string parse_spheres(const std::vector<std::string>& texts, OccupancyBatch& batch) {
  return parse_all<4>("sphere", texts, [&](const std::array<double, 4>& n) -> std::string_view {
    if (n[3] < 0.0) return "the radius is negative";
    batch.spheres.push_back({{n[0], n[1], n[2]}, n[3]});
    return {};
  });
}

std::string parse_rays(const std::vector<std::string>& texts, OccupancyBatch& batch) {
  return parse_all<7>("ray", texts, [&](const std::array<double, 7>& n) -> std::string_view {
    if (n[3] == 0.0 && n[4] == 0.0 && n[5] == 0.0) return "the direction is zero";
    if (n[6] < 0.0) return "the range is negative";
    batch.rays.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6]});
    return {};
  });
}

std::string parse_distances(const std::vector<std::string>& texts, OccupancyBatch& batch) {
  return parse_all<4>("distance", texts, [&](const std::array<double, 4>& n) -> std::string_view {
    if (n[3] < 0.0) return "the largest distance is negative";
    batch.distances.push_back({{n[0], n[1], n[2]}, n[3]});
    return {};
  });
}

std::string parse_sphere_paths(const std::vector<std::string>& texts, OccupancyBatch& batch) {
  return parse_all<7>(
      "sphere-path", texts, [&](const std::array<double, 7>& n) -> std::string_view {
        if (n[6] < 0.0) return "the radius is negative";
        batch.sphere_paths.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6]});
        return {};
      });
}

geometry::Vec3 vec3(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

void describe_flags(std::string& out, std::string_view option,
                    const std::vector<std::string>& texts, const std::vector<bool>& occupied) {
  for (std::size_t i = 0; i < texts.size() && i < occupied.size(); ++i) {
    out += fmt::format("{} {}: {}\n", option, texts[i], occupied[i] ? "occupied" : "free");
  }
}

void describe_lengths(std::string& out, std::string_view option,
                      const std::vector<std::string>& texts,
                      const std::vector<std::optional<double>>& lengths_m,
                      std::string_view nothing) {
  for (std::size_t i = 0; i < texts.size() && i < lengths_m.size(); ++i) {
    out += lengths_m[i] ? fmt::format("{} {}: {} m\n", option, texts[i], *lengths_m[i])
                        : fmt::format("{} {}: {}\n", option, texts[i], nothing);
  }
}

}  // namespace

base::Result<OccupancyBatch> parse_batch(const OccupancyTexts& texts) {
  OccupancyBatch batch;
  std::string error = parse_all<3>("point", texts.points, [&](const std::array<double, 3>& n) {
    batch.points_m.push_back(n);
    return std::string_view();
  });
  if (error.empty()) error = parse_boxes(texts.boxes, batch);
  if (error.empty()) error = parse_spheres(texts.spheres, batch);
  if (error.empty()) error = parse_rays(texts.rays, batch);
  if (error.empty()) error = parse_distances(texts.distances, batch);
  if (error.empty()) error = parse_sphere_paths(texts.sphere_paths, batch);
  if (!error.empty()) return base::Failure{std::move(error)};
  return batch;
}

OccupancyAnswer answer_offline(const scene::SceneMirror& map, const OccupancyBatch& batch) {
  OccupancyAnswer answer;
  answer.status = Status::kOk;
  answer.resolution_m = map.resolution_m();
  for (const auto& point : batch.points_m) {
    answer.points_occupied.push_back(map.occupied_at(vec3(point)));
  }
  for (const OccupancyBox& box : batch.boxes) {
    answer.boxes_occupied.push_back(
        map.occupied_in_box(geometry::Box(vec3(box.min_m), vec3(box.max_m))));
  }
  for (const OccupancySphere& sphere : batch.spheres) {
    answer.spheres_occupied.push_back(
        map.occupied_in_sphere(vec3(sphere.center_m), sphere.radius_m));
  }
  for (const OccupancyRay& ray : batch.rays) {
    answer.rays_hit_m.push_back(
        map.ray_hit_m(vec3(ray.origin_m), vec3(ray.direction), ray.range_m));
  }
  for (const OccupancyDistance& distance : batch.distances) {
    answer.distances_m.push_back(map.distance_m(vec3(distance.point_m), distance.max_m));
  }
  for (const OccupancySpherePath& path : batch.sphere_paths) {
    answer.sphere_paths_hit_m.push_back(
        map.sphere_path_hit_m(vec3(path.from_m), vec3(path.to_m), path.radius_m));
  }
  return answer;
}

std::string describe(const OccupancyTexts& texts, const OccupancyAnswer& answer) {
  std::string out;
  describe_flags(out, "point", texts.points, answer.points_occupied);
  describe_flags(out, "box", texts.boxes, answer.boxes_occupied);
  describe_flags(out, "sphere", texts.spheres, answer.spheres_occupied);
  describe_lengths(out, "ray", texts.rays, answer.rays_hit_m, "nothing within range");
  describe_lengths(out, "distance", texts.distances, answer.distances_m, "nothing so near");
  describe_lengths(out, "sphere-path", texts.sphere_paths, answer.sphere_paths_hit_m,
                   "free all the way");
  return out;
}

}  // namespace camway::tools
