// SPDX-License-Identifier: MIT
#include "daemon/service/occupancy/occupancy_answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "daemon/messages/text.h"
#include "daemon/scene/mirror/scene_mirror.h"
#include "lcmtypes/wire/layout.h"

namespace camway::service {
namespace {

using geometry::Vec3;
using Numbers = std::vector<double>;

Vec3 vec3(const Numbers& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

bool finite(const Numbers& numbers, std::size_t count) {
  return std::all_of(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(count),
                     [](double number) { return std::isfinite(number); });
}

/// Each returns an error about one element, or an empty text.
std::string_view point_fault(const Numbers& point) {
  return finite(point, 3) ? "" : "is not finite";
}

std::string_view box_fault(const Numbers& box) {
  if (!finite(box, 6)) return "is not finite";
  const bool ordered = box[0] <= box[3] && box[1] <= box[4] && box[2] <= box[5];
  return ordered ? "" : "has a minimum above its maximum";
}

std::string_view sphere_fault(const Numbers& sphere) {
  if (!finite(sphere, 3)) return "has a center that is not finite";
  return sphere[3] >= 0.0 ? "" : "has a radius that is not at least 0";
}

std::string_view ray_fault(const Numbers& ray) {
  if (!finite(ray, 6)) return "has an origin or direction that is not finite";
  if (vec3(ray, 3).isZero(0.0)) return "has no direction";
  return ray[6] >= 0.0 ? "" : "has a range that is not at least 0";
}

std::string_view distance_fault(const Numbers& distance) {
  if (!finite(distance, 3)) return "has a point that is not finite";
  return distance[3] >= 0.0 ? "" : "has a distance of interest that is not at least 0";
}

std::string_view sphere_path_fault(const Numbers& path) {
  if (!finite(path, 6)) return "has an end that is not finite";
  if (!std::isfinite((vec3(path, 3) - vec3(path, 0)).stableNorm())) return "is too long";
  return path[6] >= 0.0 ? "" : "has a radius that is not at least 0";
}

template <class Rule>
std::string list_fault(std::string_view name, const std::vector<Numbers>& list, const Rule& rule) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string_view reason = rule(list[i]);
    if (!reason.empty()) return fmt::format("{}[{}]: {}", name, i, reason);
  }
  return {};
}

/// Answers the queries of a list in turn, until the deadline strikes. Returns how many were
/// answered.
template <class Answer, class Ask>
std::int32_t answer_list(const std::vector<Numbers>& queries, std::vector<Answer>& answers,
                         const base::Deadline& deadline, const Ask& ask) {
  answers.reserve(queries.size());
  for (const Numbers& query : queries) {
    if (deadline.passed()) break;
    answers.push_back(static_cast<Answer>(ask(query)));
  }
  return static_cast<std::int32_t>(answers.size());
}

/// On the wire -1 means that nothing was found.
double wire_distance(const std::optional<double>& distance_m) { return distance_m.value_or(-1.0); }

void answer_on(const scene::SceneMirror& map, const occupancy_request_t& request,
               const base::Deadline& deadline, occupancy_response_t& answer) {
  const auto at = [&](const auto& queries, auto& answers, const auto& ask) {
    return answer_list(queries, answers, deadline, ask);
  };
  answer.num_points = at(request.points_m, answer.points_occupied,
                         [&](const Numbers& q) { return map.occupied_at(vec3(q, 0)); });
  answer.num_boxes = at(request.boxes_m, answer.boxes_occupied, [&](const Numbers& q) {
    return map.occupied_in_box(geometry::Box(vec3(q, 0), vec3(q, 3)));
  });
  answer.num_spheres = at(request.spheres_m, answer.spheres_occupied, [&](const Numbers& q) {
    return map.occupied_in_sphere(vec3(q, 0), q[3]);
  });
  answer.num_rays = at(request.rays_m, answer.rays_hit_m, [&](const Numbers& q) {
    return wire_distance(map.ray_hit_m(vec3(q, 0), vec3(q, 3), q[6]));
  });
  answer.num_distances = at(request.distances_m, answer.distances_m, [&](const Numbers& q) {
    return wire_distance(map.distance_m(vec3(q, 0), q[3]));
  });
  answer.num_sphere_paths =
      at(request.sphere_paths_m, answer.sphere_paths_hit_m, [&](const Numbers& q) {
        return wire_distance(map.sphere_path_hit_m(vec3(q, 0), vec3(q, 3), q[6]));
      });
}

}  // namespace

std::string batch_fault(const occupancy_request_t& request) {
  for (const std::string& fault :
       {list_fault("points_m", request.points_m, point_fault),
        list_fault("boxes_m", request.boxes_m, box_fault),
        list_fault("spheres_m", request.spheres_m, sphere_fault),
        list_fault("rays_m", request.rays_m, ray_fault),
        list_fault("distances_m", request.distances_m, distance_fault),
        list_fault("sphere_paths_m", request.sphere_paths_m, sphere_path_fault)}) {
    if (!fault.empty()) return fault;
  }
  return {};
}

occupancy_response_t answer_batch(const scene::Snapshot& snapshot,
                                  const occupancy_request_t& request,
                                  const base::Deadline& deadline) {
  const auto refused = [&](std::int32_t status, std::string_view message) {
    occupancy_response_t answer = plain_occupancy_answer(request, status, message);
    answer.scene_revision = static_cast<std::int64_t>(snapshot.revision);
    if (snapshot.occupancy) answer.resolution_m = snapshot.occupancy->resolution_m();
    return answer;
  };
  if (!snapshot.occupancy) {
    return refused(occupancy_response_t::STATUS_NO_MAP,
                   "the scene was loaded without an occupancy resolution");
  }
  if (const std::string fault = batch_fault(request); !fault.empty()) {
    return refused(occupancy_response_t::STATUS_INVALID, fault);
  }
  occupancy_response_t answer = refused(occupancy_response_t::STATUS_OK, "");
  answer_on(*snapshot.occupancy, request, deadline, answer);
  if (queries_of(answer) == queries_of(request)) return answer;
  return refused(occupancy_response_t::STATUS_TIMEOUT,
                 fmt::format("the deadline passed after {} of {} queries; ask less at once, or "
                             "allow more time with deadline_s (up to occupancy.max_deadline_s)",
                             queries_of(answer), queries_of(request)));
}

occupancy_response_t plain_occupancy_answer(const occupancy_request_t& request, std::int32_t status,
                                            std::string_view message) {
  occupancy_response_t answer{};
  answer.client_id = request.client_id;
  answer.request_id = request.request_id;
  answer.status = status;
  answer.message = messages::clipped(message, wire::kMaxTextBytes);
  answer.scene = request.scene;
  return answer;
}

}  // namespace camway::service
