// SPDX-License-Identifier: MIT
#include "client/messages/plan_faults.h"

#include "client/messages/text.h"
#include "lcmtypes/wire/layout.h"

namespace camway {
namespace {

constexpr std::size_t kMaxKeyframes = 100'000;  // as in plan_request_t.lcm

std::optional<std::string> fault_in_count(const std::string& field, std::size_t count,
                                          std::size_t most) {
  if (count <= most) return std::nullopt;
  return field + ": there are " + std::to_string(count) + ", at most " + std::to_string(most) +
         " are allowed";
}

/// Returns the fault of a keyframe whose time is set or not set unlike that of keyframe 0.
std::optional<std::string> fault_in_times(const PlanRequest& request) {
  const bool has_times = !request.keyframes.empty() && request.keyframes.front().time_s.has_value();
  for (std::size_t i = 0; i < request.keyframes.size(); ++i) {
    if (request.keyframes[i].time_s.has_value() == has_times) continue;
    return "keyframes[" + std::to_string(i) + "].time_s: " +
           (has_times ? "is not set, that of keyframe 0 is" : "is set, that of keyframe 0 is not") +
           "; all keyframes have a time, or none has";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> fault_in_form(const PlanRequest& request) {
  const Body& body = request.body;
  std::size_t points = 0;
  for (const auto& piece : body.pieces_m) points += piece.size();
  for (auto& fault :
       {fault_in_text("scene", request.scene, wire::kMaxSceneNameBytes),
        fault_in_text("method", request.method, wire::kMaxMethodBytes),
        // An empty piece has a size on the wire all the same.
        fault_in_count("body.pieces_m", body.pieces_m.size(), wire::kMaxBodyPoints),
        fault_in_count("points in body.pieces_m", points, wire::kMaxBodyPoints),
        fault_in_count("body.vertices_m", body.vertices_m.size(), wire::kMaxBodyVertices),
        fault_in_count("body.triangles", body.triangles.size(), wire::kMaxBodyTriangles),
        fault_in_count("keyframes", request.keyframes.size(), kMaxKeyframes),
        fault_in_times(request)}) {
    if (fault) return fault;
  }
  return std::nullopt;
}

}  // namespace camway
