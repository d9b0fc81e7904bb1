// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tools/camway/replay/replay_scenes.h"
#include "tools/camway/replay/session.h"
#include "tools/camway/replay/verdict.h"

namespace camway::tools {

/// A recorded request that was planned again, and the verdict on its answer.
struct ReplayedRequest : Judgement {
  planning::PlanResult result;
  std::string scene_digest;    ///< of the scene that it was planned in; empty if there was none
  bool scene_changed = false;  ///< whether the recorded answer is of a scene with other triangles
};

struct ReplayOptions {
  unsigned threads = 1;
  /// Largest distance of paths that count as equal, if status and number of keyframes are equal; 0:
  /// the bits must be the same. [Limit: 0 <= value] [Units: metres]
  double tolerance_m = 0.0;
};

/// Plans every request again, on `options.threads` threads. Element i belongs to request i. The
/// result except for timing is the same for any number of threads, unless a deadline is reached.
/// A request whose scene cannot be rebuilt is not planned and not compared; its note says why.
std::vector<ReplayedRequest> replay(const Session& session, ReplayScenes& scenes,
                                    const ReplayOptions& options);

enum class Times { kShown, kHidden };

/// Returns the report: a table with a line for each request, the messages left out, and the
/// verdict.
std::string report(const Session& session, const std::vector<ReplayedRequest>& replayed,
                   Times times);

std::size_t count(const std::vector<ReplayedRequest>& replayed, Verdict verdict);

}  // namespace camway::tools
