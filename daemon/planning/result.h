// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/collision/interval.h"
#include "daemon/motion/keyframe.h"
#include "daemon/motion/path.h"

namespace camway::planning {

enum class Status {
  kOk,             ///< the path is proved free of collision; see the certificate
  kPartial,        ///< a path, but with the remaining collisions listed
  kInfeasible,     ///< no path exists, and that was proved
  kTimeout,        ///< the deadline came first; the best path so far with its remaining collisions
  kInvalid,        ///< the request cannot be planned; the message says which part of it
  kUnknownScene,   ///< no such scene
  kInternalError,  ///< our fault
};

std::string_view to_string(Status status);
std::optional<Status> status_from_string(std::string_view text);

/// What is proved about the returned segments, exactly as sent.
struct Certificate {
  bool certified = false;
  double clearance_lower_bound_m = 0.0;
};

/// Wall-clock milliseconds. The only part of a result that may differ between two runs.
struct Timing {
  double load_scene_ms = 0.0;
  double motion_ms = 0.0;
  double detect_ms = 0.0;
  double correct_ms = 0.0;
  double certify_ms = 0.0;
  double total_ms = 0.0;  ///< planning alone, scene loading apart
};

/// What the witness of a collision is called, for people.
struct WitnessNames {
  std::string object;   ///< of the scene; empty if it has no name
  std::string feature;  ///< of the body, as `motion::Body::feature_name`

  bool operator==(const WitnessNames&) const = default;
};

struct PlanResult {
  Status status = Status::kInternalError;
  std::string message;                  ///< one sentence for a person
  std::optional<std::size_t> keyframe;  ///< index of the keyframe at fault, for kInvalid
  motion::Path path;
  std::vector<motion::Keyframe> keyframes;  ///< given and inserted ones, with their times
  std::vector<collision::CollisionInterval> collisions;            ///< before correction
  std::vector<collision::CollisionInterval> remaining_collisions;  ///< of `path`
  /// Names for the witnesses of the two lists above, one for each interval, empty strings where it
  /// has no witness; see `name_witnesses`. In a result that was read back from a file or the wire,
  /// the name of a feature stands here alone, and its number is 0.
  std::vector<WitnessNames> collision_names;
  std::vector<WitnessNames> remaining_names;
  Certificate certificate;
  Timing timing;
};

}  // namespace camway::planning
