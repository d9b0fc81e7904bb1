// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/camway/replay/session.h"
#include "tools/camway/replay/verdict.h"

namespace camway::tools {

/// Scenes by their names in the requests.
using Scenes = std::map<std::string, std::shared_ptr<const scene::Snapshot>>;

/// A recorded request that was planned again, and the verdict on its answer.
struct ReplayedRequest : Judgement {
  planning::PlanResult result;
  bool scene_changed = false;  ///< whether the recorded answer is of a scene with other triangles
};

struct ReplayOptions {
  unsigned threads = 1;
  /// Largest distance of paths that count as equal, if status and number of keyframes are equal; 0:
  /// the bits must be the same. [Limit: 0 <= value] [Units: metres]
  double tolerance_m = 0.0;
};

/// Returns the names of scenes that requests of `session` need and that `scenes` lacks, in order. A
/// request that the daemon answered with an unknown scene needs none.
std::vector<std::string> missing_scenes(const Session& session, const Scenes& scenes);

/// Plans every request again, on `options.threads` threads. Element i belongs to request i. The
/// result except for timing is the same for any number of threads, unless a deadline is reached.
/// Requires that `missing_scenes` is empty.
std::vector<ReplayedRequest> replay(const Session& session, const Scenes& scenes,
                                    const ReplayOptions& options);

enum class Times { kShown, kHidden };

/// Returns the report: a table with a line for each request, the messages left out, and the
/// verdict.
std::string report(const Session& session, const std::vector<ReplayedRequest>& replayed,
                   Times times);

std::size_t count(const std::vector<ReplayedRequest>& replayed, Verdict verdict);

}  // namespace camway::tools
