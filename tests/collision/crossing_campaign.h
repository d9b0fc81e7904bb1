// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/collision/detect.h"
#include "tests/collision/crossing_cases.h"

namespace camway::testing {

/// Returns the collision intervals of a path. The campaign, the analytic family and the benchmarks
/// call detection here only.
std::vector<collision::CollisionInterval> certified_intervals(
    const collision::Obstacles& obstacles, const motion::Path& path, const motion::Camera& camera,
    const collision::DetectOptions& options);

/// Returns the certified clearance of a whole path.
double certified_clearance_m(const collision::Obstacles& obstacles, const motion::Path& path,
                             const motion::Camera& camera);

/// The results of the cases of one family.
struct CrossingTally {
  std::uint64_t cases = 0;
  std::uint64_t redrawn = 0;
  /// Known instants of collision outside of all intervals, which were certified free by mistake.
  /// For free cases: known instants at which the camera is nearer than a required clearance.
  std::uint64_t misses = 0;
  /// Paths reported as colliding whose clearance exceeds the tolerance.
  std::uint64_t false_alarms = 0;
  /// Clearances above the known upper bound of the true one: false certificates.
  std::uint64_t clearance_above_truth = 0;
  /// Clearances below `kLeastClearanceShare` of the known lower bound.
  std::uint64_t clearance_too_low = 0;

  [[nodiscard]] bool faultless() const;
  CrossingTally& operator+=(const CrossingTally& other);
};

/// Least fraction of the true clearance that the certified one must have.
inline constexpr double kLeastClearanceShare = 0.8;

struct CampaignResult {
  std::array<CrossingTally, kCrossingFamilies> families;
  std::vector<std::uint64_t> faults;  ///< indices of the first cases with a fault, in order

  [[nodiscard]] CrossingTally total() const;
};

/// Least ratio of clearance to path size for which the clearance is computed. The number of probes
/// grows with the inverse of the ratio; below this, only detection runs.
inline constexpr double kLeastClearanceAsked = 1e-3;

/// Runs one case.
CrossingTally run_crossing_case(const CrossingCase& c);

/// Runs cases `first` to `first + count - 1`. The result does not depend on `threads`.
CampaignResult run_crossing_campaign(std::uint64_t seed, std::uint64_t first, std::uint64_t count,
                                     unsigned threads);

}  // namespace camway::testing
