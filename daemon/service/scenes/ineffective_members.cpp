// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/ineffective_members.h"

#include <camway/members.h>
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace camway::service {
namespace {

using Request = scene_request_t;

/// The identity counts as not set.
bool is_turned(const double (&wxyz)[4]) {
  return wxyz[1] != 0.0 || wxyz[2] != 0.0 || wxyz[3] != 0.0;
}

class Counting {
 public:
  explicit Counting(const Request& request) : request_(request) {}

  [[nodiscard]] bool in(std::initializer_list<std::int8_t> operations) const {
    return std::ranges::count(operations, request_.operation) > 0;
  }
  /// Returns whether the request puts an object of one of these kinds.
  [[nodiscard]] bool of(std::initializer_list<std::int8_t> kinds) const {
    return in({Request::PUT}) && std::ranges::count(kinds, request_.kind) > 0;
  }
  [[nodiscard]] bool of_mesh() const { return in({Request::LOAD}) || of({Request::MESH}); }

 private:
  const Request& request_;
};

/// Returns the addresses of the members that count.
std::vector<const void*> used_members(const Request& r) {
  const Counting counts(r);
  std::vector<const void*> used = {&r.client_id, &r.request_id, &r.utime,
                                   &r.operation, &r.scene,      &r.deadline_s};
  const auto add = [&](bool do_count, std::initializer_list<const void*> members) {
    if (do_count) used.insert(used.end(), members);
  };
  const bool is_scan = counts.in({Request::SCAN});
  const bool is_map = counts.of({Request::MAP});
  const bool is_posed = counts.in({Request::PUT, Request::MOVE});
  add(counts.of_mesh() || counts.in({Request::EXPORT}), {&r.file});
  add(counts.of_mesh() || is_scan || counts.of({Request::POINTS}),
      {&r.upload_bytes, &r.upload_checksum, &r.upload_format});
  add(counts.of_mesh(), {&r.scale, &r.up});
  add(counts.of_mesh() || is_map, {&r.unknown});
  add(counts.of({Request::BOX}), {&r.size_m});
  add(counts.of({Request::SPHERE, Request::CYLINDER}), {&r.radius_m, &r.chord_error_m});
  add(counts.of({Request::CYLINDER}), {&r.height_m});
  add(counts.of_mesh() || counts.of({Request::MAP, Request::POINTS}), {&r.cell_m});
  add(is_map, {&r.hit_probability, &r.miss_probability, &r.least_probability, &r.most_probability,
               &r.max_range_m});
  add(is_posed || is_scan || counts.in({Request::REMOVE}), {&r.object});
  add(counts.in({Request::LOAD}), {&r.occupancy_resolution_m, &r.body_bounds});
  add(counts.in({Request::PUT}), {&r.kind});
  add(is_posed || is_scan, {&r.position_m});
  add(is_posed || !is_turned(r.orientation_wxyz), {&r.orientation_wxyz});
  add(counts.in({Request::LIST, Request::DESCRIBE, Request::HISTORY}), {&r.first});
  add(counts.in({Request::TRIANGLES}), {&r.digest});
  add(counts.in({Request::RESTORE}), {&r.revision, &r.restore_as});
  return used;
}

}  // namespace

std::string ineffective_member(const scene_request_t& request) {
  const bool is_known = request.operation >= Request::LOAD &&
                        request.operation <= Request::TRIANGLES && request.kind >= Request::MESH &&
                        request.kind <= Request::MAP;
  if (!is_known) return {};
  std::string idle;
  const auto note = [&](std::string_view name, const auto&) {
    if (idle.empty()) idle = name;
  };
  wire::visit_unused(request, used_members(request), note);
  if (idle.empty()) return {};
  return fmt::format("{}: does not count with this {}; leave it zero or empty", idle,
                     request.operation == Request::PUT ? "kind of object" : "operation");
}

}  // namespace camway::service
