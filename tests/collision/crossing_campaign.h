// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/collision/detect.h"
#include "tests/collision/crossing_cases.h"

namespace camway::testing {

/// The one place where the campaign, the analytic family and the benchmarks call detection.
std::vector<collision::CollisionInterval> certified_intervals(
    const collision::Obstacles& obstacles, const motion::Path& path, const motion::Camera& camera,
    const collision::DetectOptions& options);

/// Likewise for the clearance of a whole path.
double certified_clearance_m(const collision::Obstacles& obstacles, const motion::Path& path,
                             const motion::Camera& camera);

/// What came of the cases of one family.
struct CrossingTally {
  std::uint64_t cases = 0;
  std::uint64_t redrawn = 0;
  /// A known instant of collision that is in no interval: an instant that was certified free. Of
  /// free cases: one at which the camera is nearer than a required clearance.
  std::uint64_t misses = 0;
  /// A path reported as colliding that stays away by more than the tolerance.
  std::uint64_t false_alarms = 0;
  /// A clearance above the known upper bound of the truth: a false certificate.
  std::uint64_t clearance_above_truth = 0;
  /// A clearance less than `kLeastClearanceShare` of the known lower bound.
  std::uint64_t clearance_too_low = 0;

  [[nodiscard]] bool faultless() const;
  CrossingTally& operator+=(const CrossingTally& other);
};

/// A clearance that is promised to within 20 % of the truth.
inline constexpr double kLeastClearanceShare = 0.8;

struct CampaignResult {
  std::array<CrossingTally, kCrossingFamilies> families;
  std::vector<std::uint64_t> faults;  ///< indices of the first cases with a fault, in order

  [[nodiscard]] CrossingTally total() const;
};

/// Bounding a clearance takes a number of looks that grows with the path's length in clearances;
/// where it is less than this share of the path, only detection is asked.
inline constexpr double kLeastClearanceAsked = 1e-3;

/// Runs one case.
CrossingTally run_crossing_case(const CrossingCase& c);

/// Runs cases `first` to `first + count - 1`. Depends only on the arguments but `threads`.
CampaignResult run_crossing_campaign(std::uint64_t seed, std::uint64_t first, std::uint64_t count,
                                     unsigned threads);

}  // namespace camway::testing
