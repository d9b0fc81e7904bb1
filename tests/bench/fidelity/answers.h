// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "daemon/motion/path/path.h"
#include "daemon/motion/spline/cubic_path.h"
#include "daemon/planning/request/options.h"
#include "tests/bench/fidelity/shot.h"
#include "tests/bench/peers/ompl_peer.h"

namespace camway::bench {

/// A path that one way of correction found for a shot.
struct Answer {
  std::string status;            ///< of an answer; "solved" or "gave up" of a peer
  double time_s = 0.0;           ///< processor time of the whole plan
  motion::Path path = {};        ///< empty if there is none
  motion::CubicPath cubic = {};  ///< the same path with the reference of the path as interpolated
  std::size_t inserted = 0;      ///< keyframes beside the given ones
  /// Certified clearance; nothing if the path is not proved free. [Units: metres]
  std::optional<double> clearance_m = {};

  /// Whether the path is proved free.
  [[nodiscard]] bool is_proved() const { return clearance_m.has_value(); }
};

/// Plans a shot with these options.
Answer planned(const Shot& shot, const planning::PlanOptions& options);

/// Answers of OMPL (`OmplPeer`: RRTConnect, then simplification), whose ways are polylines of
/// waypoints: C² splines through them, as a request with these keyframes has. Between keyframes,
/// the times of waypoints are derived as those of keyframes are, and scaled to the time that there
/// is.
struct OmplAnswers {
  Answer spline;  ///< through the waypoints of the simplified way
  /// Through these, and further ones on the straight motions between keyframes where the spline
  /// collides: twice as many as before, until the spline is proved free or `kMostDoublings` are
  /// reached.
  Answer dense;
};
inline constexpr int kMostDoublings = 6;

/// Requires `ompl` for the scene and the camera of the shot.
OmplAnswers by_ompl(const Shot& shot, const OmplPeer& ompl);

}  // namespace camway::bench
