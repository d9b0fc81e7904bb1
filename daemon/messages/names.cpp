// SPDX-License-Identifier: MIT
#include "daemon/messages/names.h"

#include <array>
#include <string>
#include <utility>

namespace camway::service {
namespace {

using Name = std::pair<std::string_view, std::string_view>;

/// Members, without indices, that have another name on the wire, where nothing begins with
/// "options.".
constexpr std::array<Name, 18> kNames{{
    {"camera.fov_x", "camera.fov_x_rad"},
    {"camera.fov_y", "camera.fov_y_rad"},
    {"camera.near", "camera.near_m"},
    {"body.center", "body.center_m"},
    {"body.size", "body.size_m"},
    {"body.radius", "body.radius_m"},
    {"body.points", "body.points_m"},
    {"body.pieces", "body.piece_sizes"},
    {"body.vertices", "body.points_m"},
    {"clearance", "clearance_m"},
    {"default_speed", "default_speed_m_per_s"},
    {"orientation.target", "orientation.target_m"},
    {"orientation.cone", "orientation.cone_rad"},
    {"orientation.max_turn", "orientation.max_turn_rad"},
    {"limits.speed", "limits.speed_m_per_s"},
    {"limits.acceleration", "limits.acceleration_m_per_s2"},
    {"limits.turn_rate", "limits.turn_rate_rad_per_s"},
    {"limits.retime", "limits.may_retime"},
}};

/// Members of a keyframe, which follow its index.
constexpr std::array<Name, 3> kKeyframeNames{{
    {".position", ".position_m"},
    {".orientation", ".orientation_wxyz"},
    {".time", ".time_s"},
}};

constexpr std::string_view kGroup = "options.";
constexpr std::string_view kPieces = "body.pieces[";

/// On the wire a point of a piece stands in the list of all points.
std::string point_of_piece(std::string_view indices) {
  const std::size_t end = indices.find(']');
  return "body.points_m (point " + std::string(indices.substr(end + 2, indices.size() - end - 3)) +
         " of piece " + std::string(indices.substr(0, end)) + ")";
}

std::string spelled(std::string_view path) {
  if (path.starts_with(kGroup)) path.remove_prefix(kGroup.size());
  if (path.starts_with(kPieces) && path.find("][") != std::string_view::npos) {
    return point_of_piece(path.substr(kPieces.size()));
  }
  const std::size_t index = path.find('[');
  for (const auto& [name, wire_name] : kNames) {
    if (path.substr(0, index) == name) {
      return std::string(wire_name) +
             std::string(index == std::string_view::npos ? "" : path.substr(index));
    }
  }
  for (const auto& [name, wire_name] : kKeyframeNames) {
    if (path.starts_with("keyframes[") && path.ends_with(name)) {
      return std::string(path.substr(0, path.size() - name.size())) + std::string(wire_name);
    }
  }
  return std::string(path);
}

}  // namespace

planning::FieldSpelling wire_spelling(const plan_request_t& wire) {
  return [corrects_nothing = wire.correct_nothing != 0](std::string_view path) -> std::string {
    if (corrects_nothing && path == "options.max_inserted_keyframes") return "correct_nothing";
    return spelled(path);
  };
}

}  // namespace camway::service
