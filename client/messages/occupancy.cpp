// SPDX-License-Identifier: MIT
#include "client/messages/occupancy.h"

#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

#include "client/messages/text.h"
#include "lcmtypes/wire/layout.h"
#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

using Numbers = std::vector<double>;

/// Returns the numbers of a query in the order of its members, which is the order on the wire.
template <class Query>
Numbers numbers_of(const Query& query) {
  static_assert(std::is_trivially_copyable_v<Query> && sizeof query % sizeof(double) == 0);
  Numbers numbers(sizeof query / sizeof(double));
  std::memcpy(numbers.data(), &query, sizeof query);
  return numbers;
}

/// Distributes queries over requests. Begins the next request when one is full.
class Splitter {
 public:
  Splitter(const OccupancyBatch& batch, const std::string& client_id) {
    empty_.client_id = client_id;
    empty_.utime = wire::utime_now();
    empty_.scene = batch.scene;
    empty_.deadline_s = batch.deadline_s;
    begin_next();
  }

  /// Adds `queries` to the lists that `count` and `list` point at.
  template <class Query>
  void add(const std::vector<Query>& queries, std::int32_t occupancy_request_t::*count,
           std::vector<Numbers> occupancy_request_t::*list) {
    for (const Query& query : queries) {
      Numbers numbers = numbers_of(query);
      const std::size_t bytes = numbers.size() * sizeof(double);
      if (bytes > bytes_left_) begin_next();
      bytes_left_ -= bytes;
      occupancy_request_t& request = requests_.back();
      (request.*list).push_back(std::move(numbers));
      ++(request.*count);
    }
  }

  std::vector<occupancy_request_t> take() { return std::move(requests_); }

 private:
  void begin_next() {
    requests_.push_back(empty_);
    bytes_left_ = wire::kMaxMessageBytes - static_cast<std::size_t>(empty_.getEncodedSize());
  }

  occupancy_request_t empty_{};
  std::vector<occupancy_request_t> requests_;
  std::size_t bytes_left_ = 0;
};

bool as_many(const occupancy_request_t& request, const occupancy_response_t& response) {
  return response.num_points == request.num_points && response.num_boxes == request.num_boxes &&
         response.num_spheres == request.num_spheres && response.num_rays == request.num_rays &&
         response.num_distances == request.num_distances &&
         response.num_sphere_paths == request.num_sphere_paths;
}

void append(const std::vector<std::int8_t>& wire, std::vector<bool>& list) {
  for (const std::int8_t value : wire) list.push_back(value != 0);
}

/// Appends distances; -1 on the wire means none within range. Returns false for a non-finite
/// number.
bool append(const std::vector<double>& wire, std::vector<std::optional<double>>& list) {
  for (const double value : wire) {
    if (!std::isfinite(value)) return false;
    list.push_back(value < 0.0 ? std::nullopt : std::make_optional(value));
  }
  return true;
}

}  // namespace

std::optional<std::string> fault_in_form(const OccupancyBatch& batch) {
  return fault_in_text("scene", batch.scene, wire::kMaxSceneNameBytes);
}

std::vector<occupancy_request_t> to_requests(const OccupancyBatch& batch,
                                             const std::string& client_id) {
  using Request = occupancy_request_t;
  Splitter splitter(batch, client_id);
  splitter.add(batch.points_m, &Request::num_points, &Request::points_m);
  splitter.add(batch.boxes, &Request::num_boxes, &Request::boxes_m);
  splitter.add(batch.spheres, &Request::num_spheres, &Request::spheres_m);
  splitter.add(batch.rays, &Request::num_rays, &Request::rays_m);
  splitter.add(batch.distances, &Request::num_distances, &Request::distances_m);
  splitter.add(batch.sphere_paths, &Request::num_sphere_paths, &Request::sphere_paths_m);
  return splitter.take();
}

std::optional<std::string> append(const occupancy_request_t& request,
                                  const occupancy_response_t& response, OccupancyAnswer& answer) {
  if (!as_many(request, response)) return "there are not as many answers as questions";
  append(response.points_occupied, answer.points_occupied);
  append(response.boxes_occupied, answer.boxes_occupied);
  append(response.spheres_occupied, answer.spheres_occupied);
  if (!append(response.rays_hit_m, answer.rays_hit_m) ||
      !append(response.distances_m, answer.distances_m) ||
      !append(response.sphere_paths_hit_m, answer.sphere_paths_hit_m)) {
    return "a distance is not a finite number";
  }
  return std::nullopt;
}

}  // namespace camway
