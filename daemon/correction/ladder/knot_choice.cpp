// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/knot_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace camway::correction {

namespace {

using motion::CubicPath;
using motion::CubicPiece;

// Chosen by measurement; none changes what is proved.
constexpr std::size_t kFewestKnots = 5;  // one bump
constexpr int kBeyondEnd = 3;            // knots beyond an end of the whole path
constexpr double kLeastExtension = 0.5;  // in steps
constexpr double kNegligible = 0.003;    // share of the largest change of the position
constexpr double kSmallEnd = 0.3;        // the same
constexpr int kTimesAStep = 4;           // at which changes are measured

geometry::Vec3 third_derivative(const CubicPath& path, double time_s) {
  const auto later = std::ranges::upper_bound(path.pieces, time_s, {}, &CubicPiece::t0_s);
  if (later == path.pieces.begin()) return geometry::Vec3::Zero();
  const CubicPiece& piece = *std::prev(later);
  if (time_s > piece.t1_s) return geometry::Vec3::Zero();
  const auto& p = piece.position;
  return 6.0 / std::pow(piece.t1_s - piece.t0_s, 3.0) * (p[3] - p[0] + 3.0 * (p[1] - p[2]));
}

/// The steps before and after a knot. Beyond an end, the path goes on as without the row, and the
/// step is that on the other side.
std::pair<double, double> steps_about(const std::vector<double>& knots_s, std::size_t i) {
  const std::size_t last = knots_s.size() - 1;
  const double before_s = i > 0 ? knots_s[i] - knots_s[i - 1] : knots_s[1] - knots_s[0];
  const double after_s = i < last ? knots_s[i + 1] - knots_s[i] : before_s;
  return {before_s, after_s};
}

/// Size of the jump of the third derivative at a knot.
double jump_at(const std::vector<double>& knots_s, std::size_t i, const CubicPath& path) {
  const auto [before_s, after_s] = steps_about(knots_s, i);
  const geometry::Vec3 before = third_derivative(path, knots_s[i] - 0.5 * before_s);
  const geometry::Vec3 after = third_derivative(path, knots_s[i] + 0.5 * after_s);
  return (after - before).norm();
}

/// About the largest offset that the removal of a knot causes, up to a factor.
double harm_of(const std::vector<double>& knots_s, std::size_t i, const CubicPath& path) {
  const auto [before_s, after_s] = steps_about(knots_s, i);
  const bool is_end = i == 0 || i + 1 == knots_s.size();
  const double reach_s = is_end ? before_s : before_s * after_s / (before_s + after_s);
  return jump_at(knots_s, i, path) * std::pow(reach_s, 3.0);
}

}  // namespace

KnotChoice::KnotChoice(const Problem& problem, const ChangedPart& part)
    : problem_(problem), part_(part) {
  for (const CubicPiece& piece : problem.path.pieces) interpolated_knots_s_.push_back(piece.t0_s);
  interpolated_knots_s_.push_back(problem.path.end_s());
}

bool KnotChoice::is_keyframe(double time_s) const {
  return std::ranges::binary_search(problem_.keyframes_s, time_s);
}

bool KnotChoice::is_interpolated_knot(double time_s) const {
  return std::ranges::binary_search(interpolated_knots_s_, time_s);
}

bool KnotChoice::is_valid(const std::vector<double>& knots_s) const {
  const std::size_t count = knots_s.size();
  if (count < kFewestKnots) return false;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    if (!is_keyframe(knots_s[i])) continue;
    if (i == 1 || i + 2 == count || is_keyframe(knots_s[i + 1])) return false;
  }
  return true;
}

// Knots two away may become neighbours of the ends or of one another: only those are looked at.
bool KnotChoice::is_valid_without(const std::vector<double>& knots_s, std::size_t i) const {
  if (knots_s.size() <= kFewestKnots) return false;
  const std::size_t first = i > 4 ? i - 4 : 0;
  const std::size_t last = std::min(i + 4, knots_s.size() - 1);
  std::vector<double> near_s(knots_s.begin() + static_cast<std::ptrdiff_t>(first),
                             knots_s.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  near_s.erase(near_s.begin() + static_cast<std::ptrdiff_t>(i - first));
  for (std::size_t k = 0; k < near_s.size(); ++k) {
    if (!is_keyframe(near_s[k])) continue;
    const std::size_t before = first + k;
    const std::size_t after = knots_s.size() - 2 - before;
    const bool follows = k > 0 && is_keyframe(near_s[k - 1]);
    if (follows || before == 1 || after == 1) return false;
  }
  return true;
}

std::vector<double> KnotChoice::knots_of(const CubicPath& path) const {
  std::vector<double> knots_s;
  for (const CubicPiece& piece : path.pieces) {
    if (part_.begin_s <= piece.t0_s && piece.t0_s <= part_.end_s) knots_s.push_back(piece.t0_s);
  }
  if (path.end_s() <= part_.end_s) knots_s.push_back(path.end_s());
  if (knots_s.size() < 2) return {};
  return completed(with_beyond(std::move(knots_s)));
}

std::vector<double> KnotChoice::with_beyond(std::vector<double> knots_s) const {
  const double first_s = knots_s[1] - knots_s[0];
  const double last_s = knots_s.back() - knots_s[knots_s.size() - 2];
  if (problem_.has_path_begin && knots_s.front() == problem_.path.begin_s()) {
    for (int i = 0; i < kBeyondEnd; ++i) knots_s.insert(knots_s.begin(), knots_s.front() - first_s);
  }
  if (problem_.has_path_end && knots_s.back() == problem_.path.end_s()) {
    for (int i = 0; i < kBeyondEnd; ++i) knots_s.push_back(knots_s.back() + last_s);
  }
  return knots_s;
}

std::vector<double> KnotChoice::within(const std::vector<double>& knots_s) const {
  std::vector<double> inner_s;
  for (const double knot_s : knots_s) {
    if (interpolated_knots_s_.front() <= knot_s && knot_s <= interpolated_knots_s_.back())
      inner_s.push_back(knot_s);
  }
  return inner_s;
}

std::vector<double> KnotChoice::completed(const std::vector<double>& knots_s) const {
  std::vector<double> result;
  for (std::size_t i = 0; i < knots_s.size(); ++i) {
    const bool is_after = i > 0 && is_keyframe(knots_s[i - 1]);
    const bool is_here = is_keyframe(knots_s[i]);
    const bool is_alone = (is_after && (is_here || i + 1 == knots_s.size())) || (is_here && i == 1);
    if (is_alone) result.push_back(0.5 * (knots_s[i - 1] + knots_s[i]));
    result.push_back(knots_s[i]);
  }
  return result;
}

std::vector<double> KnotChoice::extended(const std::vector<double>& all_s, double begin_s,
                                         double end_s) const {
  std::vector<double> knots_s = within(all_s);
  const double first_s = knots_s[1] - knots_s[0];
  const double last_s = knots_s.back() - knots_s[knots_s.size() - 2];
  if (knots_s.front() - begin_s >= kLeastExtension * first_s) {
    knots_s.insert(knots_s.begin(), std::max(begin_s, knots_s.front() - first_s));
  }
  if (end_s - knots_s.back() >= kLeastExtension * last_s) {
    knots_s.push_back(std::min(end_s, knots_s.back() + last_s));
  }
  // No knot moves: what was drawn on the old knots can be drawn on the new ones exactly.
  for (const double known_s : interpolated_knots_s_) {
    if (known_s <= knots_s.front() || known_s >= knots_s.back()) continue;
    const auto next = std::ranges::lower_bound(knots_s, known_s);
    if (*next != known_s) knots_s.insert(next, known_s);
  }
  return completed(with_beyond(std::move(knots_s)));
}

std::vector<double> KnotChoice::changes_m(const std::vector<double>& knots_s,
                                          const CubicPath& path) const {
  std::vector<double> changes_m;
  for (std::size_t i = 0; i + 1 < knots_s.size(); ++i) {
    double most_m = 0.0;
    for (int k = 0; k <= kTimesAStep; ++k) {
      const double place = static_cast<double>(k) / kTimesAStep;
      const double time_s = std::lerp(knots_s[i], knots_s[i + 1], place);
      const geometry::Vec3 change = path.at(time_s).position - problem_.path.at(time_s).position;
      most_m = std::max(most_m, change.norm());
    }
    changes_m.push_back(most_m);
  }
  return changes_m;
}

// The knots from `first` to `last`, and what else a valid list needs; nothing if there is none.
std::vector<double> KnotChoice::kept(const std::vector<double>& knots_s, std::size_t first,
                                     std::size_t last) const {
  if (last <= first) return {};
  std::vector<double> list_s =
      completed(with_beyond({knots_s.begin() + static_cast<std::ptrdiff_t>(first),
                             knots_s.begin() + static_cast<std::ptrdiff_t>(last) + 1}));
  if (!is_valid(list_s)) list_s.clear();
  return list_s;
}

std::vector<double> KnotChoice::trimmed(const std::vector<double>& all_s,
                                        const CubicPath& path) const {
  if (part_.turns) return all_s;
  const std::vector<double> knots_s = within(all_s);
  const std::vector<double> changes_m = this->changes_m(knots_s, path);
  const double least_m = kNegligible * *std::ranges::max_element(changes_m);
  std::size_t first = 0;
  std::size_t last = changes_m.size();
  while (first < last && changes_m[first] <= least_m) ++first;
  while (last > first && changes_m[last - 1] <= least_m) --last;
  std::vector<double> list_s = kept(knots_s, first, last);
  return list_s.empty() ? all_s : list_s;
}

std::vector<double> KnotChoice::cut_at_keyframes(const std::vector<double>& all_s,
                                                 const CubicPath& path) const {
  if (part_.turns) return all_s;
  const std::vector<double> knots_s = within(all_s);
  const std::vector<double> changes_m = this->changes_m(knots_s, path);
  const double small_m = kSmallEnd * *std::ranges::max_element(changes_m);
  std::size_t first = 0;
  for (std::size_t i = 0; i < changes_m.size() && changes_m[i] <= small_m; ++i) {
    if (is_keyframe(knots_s[i + 1])) first = i + 1;
  }
  std::size_t last = changes_m.size();
  for (std::size_t i = last; i-- > first && changes_m[i] <= small_m;) {
    if (is_keyframe(knots_s[i])) last = i;
  }
  std::vector<double> list_s = kept(knots_s, first, last);
  return list_s.empty() ? all_s : list_s;
}

std::vector<std::size_t> KnotChoice::removable(const std::vector<double>& knots_s,
                                               const CubicPath& path) const {
  std::vector<std::pair<double, std::size_t>> by_harm;
  for (std::size_t i = 0; i < knots_s.size(); ++i) {
    const bool is_inside =
        interpolated_knots_s_.front() < knots_s[i] && knots_s[i] < interpolated_knots_s_.back();
    if (!is_inside || is_interpolated_knot(knots_s[i])) continue;
    if (is_valid_without(knots_s, i)) by_harm.emplace_back(harm_of(knots_s, i, path), i);
  }
  std::ranges::sort(by_harm);
  std::vector<bool> stays(knots_s.size() + 1, false);
  std::vector<std::size_t> removable;
  for (const auto& [harm, i] : by_harm) {
    if (stays[i]) continue;
    removable.push_back(i);
    if (i > 0) stays[i - 1] = true;
    stays[i + 1] = true;
  }
  return removable;
}

}  // namespace camway::correction
