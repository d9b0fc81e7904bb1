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

class RequestKind {
 public:
  explicit RequestKind(const Request& request) : request_(request) {}

  [[nodiscard]] bool has_operation(std::initializer_list<std::int8_t> operations) const {
    return std::ranges::count(operations, request_.operation) > 0;
  }
  /// Returns whether the request puts an object of one of these kinds.
  [[nodiscard]] bool puts(std::initializer_list<std::int8_t> kinds) const {
    return has_operation({Request::PUT}) && std::ranges::count(kinds, request_.kind) > 0;
  }
  [[nodiscard]] bool has_mesh_file() const {
    return has_operation({Request::LOAD}) || puts({Request::MESH});
  }

 private:
  const Request& request_;
};

/// Returns the addresses of the members that count.
std::vector<const void*> used_members(const Request& r) {
  const RequestKind kind(r);
  std::vector<const void*> used = {&r.client_id, &r.request_id, &r.utime,
                                   &r.operation, &r.scene,      &r.deadline_s};
  const auto add = [&](bool do_count, std::initializer_list<const void*> members) {
    if (do_count) used.insert(used.end(), members);
  };
  const bool is_scan = kind.has_operation({Request::SCAN});
  const bool is_map = kind.puts({Request::MAP});
  const bool is_posed = kind.has_operation({Request::PUT, Request::MOVE});
  add(kind.has_mesh_file() || kind.has_operation({Request::EXPORT}), {&r.file});
  add(kind.has_mesh_file() || is_scan || kind.puts({Request::POINTS}),
      {&r.upload_bytes, &r.upload_checksum, &r.upload_format});
  add(kind.has_mesh_file(), {&r.scale, &r.up});
  add(kind.has_mesh_file() || is_map, {&r.unknown});
  add(kind.puts({Request::BOX}), {&r.size_m});
  add(kind.puts({Request::SPHERE, Request::CYLINDER}), {&r.radius_m, &r.chord_error_m});
  add(kind.puts({Request::CYLINDER}), {&r.height_m});
  add(kind.has_mesh_file() || kind.puts({Request::MAP, Request::POINTS}), {&r.cell_m});
  add(is_map, {&r.hit_probability, &r.miss_probability, &r.least_probability, &r.most_probability,
               &r.max_range_m});
  add(is_posed || is_scan || kind.has_operation({Request::REMOVE}), {&r.object});
  add(kind.has_operation({Request::LOAD}), {&r.occupancy_resolution_m, &r.body_bounds});
  add(kind.has_operation({Request::PUT}), {&r.kind});
  add(is_posed || is_scan, {&r.position_m});
  add(is_posed || !is_turned(r.orientation_wxyz), {&r.orientation_wxyz});
  add(kind.has_operation({Request::LIST, Request::DESCRIBE, Request::HISTORY}), {&r.first});
  add(kind.has_operation({Request::TRIANGLES}), {&r.digest});
  add(kind.has_operation({Request::RESTORE}), {&r.revision, &r.restore_as});
  return used;
}

}  // namespace

std::string ineffective_member(const scene_request_t& request) {
  const bool is_known = request.operation >= Request::LOAD &&
                        request.operation <= Request::TRIANGLES && request.kind >= Request::MESH &&
                        request.kind <= Request::MAP;
  if (!is_known) return {};
  std::string ineffective;
  const auto note = [&](std::string_view name, const auto&) {
    if (ineffective.empty()) ineffective = name;
  };
  wire::visit_unused(request, used_members(request), note);
  if (ineffective.empty()) return {};
  return fmt::format("{}: does not count with this {}; leave it zero or empty", ineffective,
                     request.operation == Request::PUT ? "kind of object" : "operation");
}

}  // namespace camway::service
