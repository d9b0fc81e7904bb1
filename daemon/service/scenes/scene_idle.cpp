// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_idle.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <vector>

namespace camway::service {
namespace {

using Request = scene_request_t;

struct Member {
  std::string_view name;
  bool is_set;
  bool counts;
};

template <std::size_t kCount>
bool is_set(const double (&numbers)[kCount]) {
  return std::any_of(std::begin(numbers), std::end(numbers), [](double v) { return v != 0.0; });
}

bool is_set(const bounds_t& bounds) {
  const auto holds = [](std::int8_t flag) { return flag != 0; };
  return std::any_of(std::begin(bounds.has_min), std::end(bounds.has_min), holds) ||
         std::any_of(std::begin(bounds.has_max), std::end(bounds.has_max), holds) ||
         is_set(bounds.min_m) || is_set(bounds.max_m);
}

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

/// Returns the members that describe the content of the object.
std::vector<Member> members_of_content(const Request& r, const Counting& counts) {
  const bool has_upload =
      counts.of_mesh() || counts.in({Request::SCAN}) || counts.of({Request::POINTS});
  const bool is_round = counts.of({Request::SPHERE, Request::CYLINDER});
  const bool is_map = counts.of({Request::MAP});
  return {
      {"file", !r.file.empty(), counts.of_mesh() || counts.in({Request::EXPORT})},
      {"upload_bytes", r.upload_bytes != 0, has_upload},
      {"upload_checksum", r.upload_checksum != 0, has_upload},
      {"upload_format", !r.upload_format.empty(), has_upload},
      {"scale", r.scale != 0.0, counts.of_mesh()},
      {"up", r.up != 0, counts.of_mesh()},
      {"unknown", r.unknown != 0, counts.of_mesh() || is_map},
      {"size_m", is_set(r.size_m), counts.of({Request::BOX})},
      {"radius_m", r.radius_m != 0.0, is_round},
      {"height_m", r.height_m != 0.0, counts.of({Request::CYLINDER})},
      {"chord_error_m", r.chord_error_m != 0.0, is_round},
      {"cell_m", r.cell_m != 0.0, is_map || counts.of({Request::POINTS})},
      {"hit_probability", r.hit_probability != 0.0, is_map},
      {"miss_probability", r.miss_probability != 0.0, is_map},
      {"least_probability", r.least_probability != 0.0, is_map},
      {"most_probability", r.most_probability != 0.0, is_map},
      {"max_range_m", r.max_range_m != 0.0, is_map},
  };
}

std::vector<Member> members(const Request& r) {
  const Counting counts(r);
  const bool restores = counts.in({Request::RESTORE});
  const bool is_posed = counts.in({Request::PUT, Request::MOVE});
  std::vector<Member> list = members_of_content(r, counts);
  const Member others[] = {
      {"object", !r.object.empty(),
       counts.in({Request::PUT, Request::MOVE, Request::REMOVE, Request::SCAN})},
      {"occupancy_resolution_m", r.occupancy_resolution_m != 0.0, counts.in({Request::LOAD})},
      {"body_bounds", is_set(r.body_bounds), counts.in({Request::LOAD})},
      {"kind", r.kind != 0, counts.in({Request::PUT})},
      {"position_m", is_set(r.position_m), is_posed || counts.in({Request::SCAN})},
      {"orientation_wxyz", is_turned(r.orientation_wxyz), is_posed},
      {"first", r.first != 0, counts.in({Request::LIST, Request::DESCRIBE, Request::HISTORY})},
      {"revision", r.revision != 0, restores},
      {"restore_as", !r.restore_as.empty(), restores},
  };
  list.insert(list.end(), std::begin(others), std::end(others));
  return list;
}

}  // namespace

std::string idle_member(const scene_request_t& request) {
  const bool is_known = request.operation >= Request::LOAD &&
                        request.operation <= Request::RESTORE && request.kind >= Request::MESH &&
                        request.kind <= Request::MAP;
  if (!is_known) return {};
  for (const Member& member : members(request)) {
    if (!member.is_set || member.counts) continue;
    return fmt::format("{}: does not count with this {}; leave it zero or empty", member.name,
                       request.operation == Request::PUT ? "kind of object" : "operation");
  }
  return {};
}

}  // namespace camway::service
