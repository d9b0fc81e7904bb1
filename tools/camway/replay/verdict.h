// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "tools/camway/replay/difference.h"
#include "tools/camway/replay/session.h"

namespace camway::tools {

enum class Verdict {
  kAgrees,
  kDiffers,
  kNotCompared,  ///< there was nothing to reproduce; `note` has the reason
};

/// A verdict on the answer that a recorded request has now.
struct Judgement {
  Verdict verdict = Verdict::kNotCompared;
  Difference difference;
  std::string note;  ///< difference, or reason for no comparison; empty if it agrees
};

/// Compares the recorded answer with the answer `now`. Two answers agree if all their bits are the
/// same, or if `tolerance_m` is above 0, status and number of keyframes are equal and the paths are
/// at most `tolerance_m` apart. [Limit: 0 <= tolerance_m]
Judgement judge(const RecordedRequest& recorded, const planning::PlanResult& now,
                double tolerance_m);

}  // namespace camway::tools
