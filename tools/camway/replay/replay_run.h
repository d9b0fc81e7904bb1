// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/planning/result/result.h"
#include "tools/camway/replay/compare/comparison.h"
#include "tools/camway/replay/scenes/replay_scenes.h"
#include "tools/camway/replay/session.h"

namespace camway::tools {

/// A recorded request that was planned again.
struct ReplayedRequest {
  ComparedRequest compared;
  planning::PlanResult result;
};

struct ReplayOptions {
  unsigned threads = 1;
  Thresholds thresholds;
  /// Deadlines of requests that are shorter are this long, so that a slow machine gives the same
  /// answers. [Limit: 0 <= value] [Units: seconds]
  double least_deadline_s = 0.0;
};

/// Plans a request again and compares. A request whose scene cannot be rebuilt is not planned and
/// not compared; its note says why. `recorded` must outlive the result.
/// Thread-safe.
ReplayedRequest replay_one(const RecordedRequest& recorded, ReplayScenes& scenes,
                           const ReplayOptions& options);

/// Adds to the reason of a verdict on an answer that was cut short which option of this command
/// prevents that.
void name_remedy(Judgement& judgement);

/// Plans every request again, on `options.threads` threads. Element i belongs to request i. The
/// result except for timing is the same for any number of threads, unless a deadline is reached.
std::vector<ReplayedRequest> replay(const Session& session, ReplayScenes& scenes,
                                    const ReplayOptions& options);

}  // namespace camway::tools
