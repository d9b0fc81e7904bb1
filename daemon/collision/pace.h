// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/collision/probe.h"

namespace camway::collision {

/// Chooses how far the next look along a path should reach: about as far as the gap to the scene
/// will be there, as it develops from look to look. Only the number of looks depends on it, nothing
/// that is proved.
class Pace {
 public:
  /// The reach to aim at after a look; what was free is behind.
  double next_reach_m(const Look& seen);

  /// A stretch was passed without a look at the gap.
  void pass(double reach_m);

 private:
  struct Sight {
    double at_m;  ///< motion from the beginning, counted in reaches
    double gap_m;
  };

  double here_m_ = 0.0;
  std::optional<Sight> before_;
};

}  // namespace camway::collision
