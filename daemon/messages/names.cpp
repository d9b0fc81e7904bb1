// SPDX-License-Identifier: MIT
#include "daemon/messages/names.h"

#include <array>
#include <string>
#include <utility>

namespace camway::messages {
namespace {

using Name = std::pair<std::string_view, std::string_view>;

/// Members of the body, without indices, that have another name on the wire.
constexpr std::array<Name, 5> kBodyNames{{
    {"body.center", "body.center_m"},
    {"body.size", "body.size_m"},
    {"body.points", "body.points_m"},
    {"body.pieces", "body.piece_sizes"},
    {"body.vertices", "body.points_m"},
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
  if (path.starts_with(kPieces) && path.find("][") != std::string_view::npos) {
    return point_of_piece(path.substr(kPieces.size()));
  }
  const std::size_t index = path.find('[');
  for (const auto& [name, wire_name] : kBodyNames) {
    if (path.substr(0, index) == name) {
      return std::string(wire_name) +
             std::string(index == std::string_view::npos ? "" : path.substr(index));
    }
  }
  if (path == "frame.reference") return "frame.reference_wxyz";
  for (const auto& [name, wire_name] : kKeyframeNames) {
    if (path.starts_with("keyframes[") && path.ends_with(name)) {
      return std::string(path.substr(0, path.size() - name.size())) + std::string(wire_name);
    }
  }
  const std::string full = planning::spell(path, planning::Spelling::kWire);
  return full.starts_with(kGroup) ? full.substr(kGroup.size()) : full;
}

}  // namespace

planning::FieldSpelling wire_spelling(const plan_request_t& wire) {
  return [corrects_nothing = wire.correct_nothing != 0](std::string_view path) -> std::string {
    if (corrects_nothing && path == "options.max_inserted_keyframes") return "correct_nothing";
    return spelled(path);
  };
}

}  // namespace camway::messages
