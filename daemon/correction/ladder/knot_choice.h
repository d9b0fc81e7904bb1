// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/motion/spline/cubic_path.h"

namespace camway::correction {

/// Chooses the knots on which a changed part of a path may be drawn again. A list of knots is
/// *valid* if one row of bumps on it can keep every keyframe within: no two keyframes are
/// neighbours, none is next to an end of the list, and there are at least five knots. The knots
/// of the interpolated path cost no keyframe, so lists keep them. All times are in seconds,
/// increasing.
class KnotChoice {
 public:
  /// `problem`: as `CorrectedPath::restored` returns it for `part`.
  KnotChoice(const Problem& problem, const ChangedPart& part);

  [[nodiscard]] bool is_valid(const std::vector<double>& knots_s) const;

  /// Returns the knots of `path` in the part, and further times that make the list valid. If the
  /// part reaches an end of the whole path, the list goes on beyond it, so that the slope there is
  /// free.
  [[nodiscard]] std::vector<double> knots_of(const motion::CubicPath& path) const;

  /// Returns `knots_s` with one knot more on either side, a step away, where there is room for half
  /// a step up to `begin_s` and `end_s`; and what else a valid list needs.
  [[nodiscard]] std::vector<double> extended(const std::vector<double>& knots_s, double begin_s,
                                             double end_s) const;

  /// Returns `knots_s`, on which `path` was drawn, without the steps at either end in which the
  /// change of the position is negligible; and what else a valid list needs. Returns `knots_s` if
  /// the part turns the body.
  [[nodiscard]] std::vector<double> trimmed(const std::vector<double>& knots_s,
                                            const motion::CubicPath& path) const;

  /// Returns `knots_s`, on which `path` was drawn, cut at the outermost keyframes beyond which the
  /// change of the position is small; and what else a valid list needs. Returns `knots_s` if the
  /// part turns the body.
  [[nodiscard]] std::vector<double> cut_at_keyframes(const std::vector<double>& knots_s,
                                                     const motion::CubicPath& path) const;

  /// Returns the indices of knots each of which may be removed, no two of them neighbours. Those
  /// come first whose removal changes the positions of `path` least, judged by the jump of the
  /// third derivative (knot removal, Lyche & Mørken 1987).
  [[nodiscard]] std::vector<std::size_t> removable(const std::vector<double>& knots_s,
                                                   const motion::CubicPath& path) const;

 private:
  [[nodiscard]] bool is_keyframe(double time_s) const;
  [[nodiscard]] bool is_interpolated_knot(double time_s) const;
  [[nodiscard]] bool is_valid_without(const std::vector<double>& knots_s, std::size_t i) const;
  [[nodiscard]] std::vector<double> completed(const std::vector<double>& knots_s) const;
  [[nodiscard]] std::vector<double> with_beyond(std::vector<double> knots_s) const;
  /// Returns the largest change of the position in each step between knots. [Units: metres]
  [[nodiscard]] std::vector<double> changes_m(const std::vector<double>& knots_s,
                                              const motion::CubicPath& path) const;
  [[nodiscard]] std::vector<double> kept(const std::vector<double>& knots_s, std::size_t first,
                                         std::size_t last) const;
  [[nodiscard]] std::vector<double> within(const std::vector<double>& knots_s) const;

  const Problem& problem_;
  const ChangedPart part_;
  std::vector<double> interpolated_knots_s_;  ///< knots of the interpolated path
};

}  // namespace camway::correction
