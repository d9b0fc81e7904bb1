// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/camway/replay/compare.h"
#include "tools/camway/replay/session.h"

namespace camway::tools {

/// Scenes by the names that the requests use.
using Scenes = std::map<std::string, std::shared_ptr<const scene::Snapshot>>;

enum class Verdict {
  kAgrees,
  kDiffers,
  kNotCompared,  ///< nothing that this process could have reproduced: see `note`
};

/// One recorded request, planned again.
struct ReplayedRequest {
  planning::PlanResult result;
  Verdict verdict = Verdict::kNotCompared;
  Difference difference;
  std::string note;            ///< what differs, or why nothing was compared; empty if it agrees
  bool scene_changed = false;  ///< the recorded answer was computed on other triangles
};

struct ReplayOptions {
  unsigned threads = 1;
  /// Paths that stay this close count as equal, if status and number of keyframes are; 0: only the
  /// same bits do. [Limit: 0 <= value] [Units: metres]
  double tolerance_m = 0.0;
};

/// Names of scenes that requests of `session` need and `scenes` lacks, in order of name. Requests
/// to which the daemon answered that it does not know the scene need none.
std::vector<std::string> missing_scenes(const Session& session, const Scenes& scenes);

/// Plans every request again, on `options.threads` threads; element i belongs to request i. All but
/// timing is the same for any number of threads, unless a deadline strikes.
/// Precondition: `missing_scenes` is empty.
std::vector<ReplayedRequest> replay(const Session& session, const Scenes& scenes,
                                    const ReplayOptions& options);

enum class Times { kShown, kHidden };

/// A table with a line per request, then what was left out, then the verdict.
std::string report(const Session& session, const std::vector<ReplayedRequest>& replayed,
                   Times times);

std::size_t count(const std::vector<ReplayedRequest>& replayed, Verdict verdict);

}  // namespace camway::tools
