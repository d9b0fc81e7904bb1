// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "daemon/motion/spline/bump.h"
#include "tests/bench/fidelity/changed_ranges.h"
#include "tests/bench/fidelity/goal.h"
#include "tests/bench/fidelity/shot.h"
#include "tests/support/random.h"

namespace camway::bench {

/// A random search that lowers the cost of a part of a path by a goal and keeps it proved free.
/// Slow, and independent of how planning relaxes corrections: it knows nothing of contacts, forms
/// or margins.
///
/// A step adds a few bumps to the path. Their spacing is drawn from several scales, so that a long
/// change takes no more steps than a short one. Their coefficients are proportional to one random
/// vector, and cancel at keyframes. A step is taken if the cost falls and the path is proved free,
/// and is then repeated as long as that helps. Step sizes adapt by the rule of Rechenberg
/// (1973, "Evolutionsstrategie"), each scale and kind of step by itself. Its deviation: the rates
/// aim at a success in every fifth step at the least.
///
/// Deterministic up to the number of steps, which processor time limits. Not thread-safe.
class LocalSearch {
 public:
  /// Refers to `shot`, `goal` and `space`, which must outlive it. Changes `start` within `range`
  /// alone. `space`: of the shot, with the clearance that the search keeps. Requires `start` to be
  /// proved free there.
  LocalSearch(const Shot& shot, const Goal& goal, const correction::FreeSpace& space,
              const motion::CubicPath& start, const TimeRange& range, std::uint64_t seed);

  /// Searches for `seconds` of processor time.
  void run(double seconds);

  /// The whole path.
  [[nodiscard]] motion::CubicPath path() const;
  [[nodiscard]] double cost() const { return cost_; }  ///< of the pieces that meet the range

 private:
  enum Kind : std::size_t { kMove, kTurn, kBoth, kBack, kKinds };
  /// Knots at one spacing, and the size of steps of each kind, as shares of `height_m_`.
  struct Scale {
    motion::KnotRow knots;
    std::array<double, kKinds> steps;
  };

  void make_scales(const std::vector<double>& knots_s);
  void step();
  [[nodiscard]] Kind any_kind();
  [[nodiscard]] motion::CubicPoint direction(Kind kind, double time_s);
  [[nodiscard]] std::optional<motion::BumpRow> row(const Scale& scale);
  [[nodiscard]] std::vector<double> cancelling(const motion::KnotRow& knots, int first, int count);
  [[nodiscard]] std::vector<double> keyframes_within(double begin_s, double end_s) const;
  bool try_row(const motion::BumpRow& row);

  const Shot& shot_;
  const Goal& goal_;
  const correction::FreeSpace& space_;
  motion::CubicPath whole_;
  motion::CubicPath part_;  ///< the pieces that meet the range
  std::vector<double> keyframes_s_;
  std::vector<Scale> scales_;
  testing::Random random_;
  int least_first_ = 0;  ///< least index of a bump, and the greatest from the last knot on
  int most_beyond_ = 0;
  double height_m_ = 0.0;  ///< largest offset at the start, or the goal's if that is larger
  double cost_ = 0.0;
};

}  // namespace camway::bench
