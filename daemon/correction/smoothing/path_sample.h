// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/smoothing/contact_bounds.h"
#include "daemon/correction/smoothing/contact_rows.h"
#include "daemon/correction/smoothing/smoothing_form.h"

namespace camway::correction {

/// A time at which a relaxation checks that the body is free.
struct PathSample {
  StackedPoint path;          ///< the path before the relaxation
  Terms terms;                ///< the change of the path in terms of the variables
  double floor_m = 0.0;       ///< least gap that a step must leave
  motion::Pose interpolated;  ///< reference of the orientation policy
  double rule_floor = 0.0;    ///< least room of the orientation policy that a step must leave
  /// The last place with a known gap. The gap is queried again only after the body has moved by as
  /// much.
  StackedPoint known;
  double known_gap_m = 0.0;
  std::vector<std::uint32_t> contacts;  ///< obstacles that the body may meet, the latest last
  std::vector<Contact> rows;            ///< their constraints at the current path
  bool has_rows = false;                ///< whether `rows` is up to date

  /// The place of the sample for these variables.
  [[nodiscard]] StackedPoint at(const StackedPoints& variables) const {
    return path + combined(terms, variables);
  }
};

/// Result of checking samples at new places.
struct SampleCheck {
  bool is_free = true;         ///< all keep their least gaps and meet the orientation policy
  bool found_contact = false;  ///< a sample has a new contact
  bool breaks_rule = false;    ///< a sample violates the orientation policy
  bool is_squeezed = false;    ///< a sample collides between contacts that face each other

  SampleCheck& operator+=(const SampleCheck& other) {
    is_free = is_free && other.is_free;
    found_contact = found_contact || other.found_contact;
    breaks_rule = breaks_rule || other.breaks_rule;
    is_squeezed = is_squeezed || other.is_squeezed;
    return *this;
  }
};

/// Makes and checks the samples of a relaxation of one problem.
/// Not thread-safe.
class SampleProbe {
 public:
  /// Refers to `problem` and `space`, which must outlive it. `lever_m`: the lever arm of
  /// `StackedPoint`. `horizon_m`: the largest gap that is measured.
  SampleProbe(const Problem& problem, FreeSpace& space, double lever_m, double horizon_m);

  /// Returns a sample of the path at a time; nothing outside of the problem's path, in a foreign
  /// collision, or where the variables change nothing.
  [[nodiscard]] std::optional<PathSample> sample_at(double time_s, const FreeCoefficients& free,
                                                    const StackedPoints& variables);

  /// Measures the gap of the body at `there`, which becomes the known place.
  void measure(PathSample& sample, const StackedPoint& there);

  /// Checks whether the sample is free at `there`. Queries the scene only if the known gap does not
  /// decide. Adds a contact for an obstacle in the way.
  SampleCheck check(PathSample& sample, const StackedPoint& there);

  /// Brings the rows of the contacts of `sample` up to date for its place `there`. Rows that remain
  /// keep their multipliers. `may_turn`: as in `StackedPlace`. `beyond_m` is added to
  /// the horizon.
  void update_rows(PathSample& sample, const StackedPoint& there, bool may_turn, double beyond_m);

 private:
  [[nodiscard]] motion::Pose pose(const StackedPoint& point) const;
  [[nodiscard]] bool meets_rule(const PathSample& sample, const StackedPoint& there) const;
  [[nodiscard]] bool in_foreign_collision(double time_s) const;
  double gap_m(PathSample& sample, const StackedPoint& there, SampleCheck& check);

  const Problem& problem_;
  FreeSpace& space_;
  const double lever_m_;
  const double horizon_m_;
  std::vector<ContactRow> rows_;  ///< buffer
};

}  // namespace camway::correction
