// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/local_search.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/LU>

#include "daemon/correction/path/candidate.h"
#include "tests/bench/measure.h"

namespace camway::bench {

namespace {

using motion::BumpRow;
using motion::CubicPath;
using motion::CubicPoint;
using motion::KnotRow;

constexpr int kFinestKnots = 64;     // in the range
constexpr int kFewestKnots = 4;      // of the coarsest scale
constexpr double kApart = 0.3;       // of the finest spacing: between a knot and a joint
constexpr int kMostBumps = 6;        // of a step
constexpr double kFirstStep = 0.1;   // share of the height
constexpr double kLeastStep = 1e-5;  // share of the height
constexpr double kGrowth = 1.5;      // of a step after a success; its fourth root after a failure
constexpr double kTurnsEquallyFar = 0.25;  // an image turns by a quarter of the rotation's angle

/// Times between `begin_s` and `end_s`: the joints of `path`, and others in between.
std::vector<double> fine_knots_s(const CubicPath& path, double begin_s, double end_s) {
  std::vector<double> knots_s = {begin_s};
  for (const motion::CubicPiece& piece : path.pieces) {
    if (begin_s < piece.t1_s && piece.t1_s < end_s) knots_s.push_back(piece.t1_s);
  }
  knots_s.push_back(end_s);
  const std::vector<double> joints_s = knots_s;
  const double spacing_s = (end_s - begin_s) / kFinestKnots;
  for (int i = 1; i < kFinestKnots; ++i) {
    const double time_s = begin_s + i * spacing_s;
    const auto near = std::ranges::lower_bound(joints_s, time_s - kApart * spacing_s);
    if (near != joints_s.end() && *near < time_s + kApart * spacing_s) continue;
    knots_s.push_back(time_s);
  }
  std::ranges::sort(knots_s);
  return knots_s;
}

/// About `count` steps, with knots from `fine_s`.
KnotRow coarse_row(const std::vector<double>& fine_s, std::size_t count) {
  std::vector<double> knots_s;
  for (std::size_t i = 0; i <= count; ++i) {
    knots_s.push_back(fine_s[i * (fine_s.size() - 1) / count]);
  }
  return KnotRow::at(knots_s, nullptr);
}

BumpRow times(const BumpRow& row, double factor) {
  BumpRow larger = row;
  for (CubicPoint& bump : larger.bumps) {
    bump.position *= factor;
    bump.image *= factor;
  }
  return larger;
}

CubicPoint difference(const CubicPoint& a, const CubicPoint& b) {
  return {a.position - b.position, a.image - b.image};
}

}  // namespace

LocalSearch::LocalSearch(const Shot& shot, const Goal& goal, const correction::FreeSpace& space,
                         const CubicPath& start, const TimeRange& range, std::uint64_t seed)
    : shot_(shot),
      goal_(goal),
      space_(space),
      whole_(start),
      part_(start.around(range.begin_s, range.end_s)),
      random_(seed),
      least_first_(range.begin_s <= start.begin_s() ? -1 : 2),
      most_beyond_(range.end_s >= start.end_s() ? 1 : -2),
      height_m_(goal.least_height_m) {
  for (const motion::Keyframe& keyframe : shot.plan().keyframes) {
    keyframes_s_.push_back(keyframe.time_s);
  }
  const std::vector<double> knots_s = fine_knots_s(start, range.begin_s, range.end_s);
  for (const double time_s : knots_s) {
    const CubicPoint offset = difference(start.at(time_s), shot.interpolated().at(time_s));
    const double turn_m = shot.closeness().turn_lever_m * offset.image.norm() / kTurnsEquallyFar;
    height_m_ = std::max(height_m_, offset.position.norm() + turn_m);
  }
  make_scales(knots_s);
  cost_ = goal.cost(part_);
}

void LocalSearch::make_scales(const std::vector<double>& knots_s) {
  for (std::size_t steps = knots_s.size() - 1; steps >= kFewestKnots; steps /= 2) {
    Scale& scale = scales_.emplace_back(Scale{coarse_row(knots_s, steps), {}});
    scale.steps.fill(kFirstStep);
  }
}

CubicPath LocalSearch::path() const {
  CubicPath path = whole_;
  path.replace(part_);
  return path;
}

void LocalSearch::run(double seconds) {
  const double end_s = thread_seconds() + seconds;
  while (thread_seconds() < end_s) step();
}

void LocalSearch::step() {
  Scale& scale =
      scales_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(scales_.size()) - 1))];
  std::optional<BumpRow> proposed = row(scale);
  if (!proposed) return;
  const Kind kind = any_kind();
  const double peak_s = 0.5 * (proposed->begin_s() + proposed->end_s());
  const CubicPoint along = direction(kind, peak_s);
  double& size = scale.steps[kind];
  const double share = size * random_.normal();
  for (CubicPoint& bump : proposed->bumps) {
    const double coefficient = bump.position.x();
    bump = {coefficient * share * along.position, coefficient * share * along.image};
  }
  if (!try_row(*proposed)) {
    size = std::max(kLeastStep, size * std::pow(kGrowth, -0.25));
    return;
  }
  size = std::min(1.0, size * kGrowth);
  for (double factor = 2.0; try_row(times(*proposed, factor)); factor *= 2.0) {
  }
}

LocalSearch::Kind LocalSearch::any_kind() {
  if (goal_.may_turn) return static_cast<Kind>(random_.integer(0, kKinds - 1));
  return random_.chance(0.5) ? kMove : kBack;
}

/// A vector of about the length `height_m_`.
CubicPoint LocalSearch::direction(Kind kind, double time_s) {
  const double turn = kTurnsEquallyFar / shot_.closeness().turn_lever_m;
  CubicPoint along;
  if (kind == kBack) {
    along = difference(part_.at(time_s), shot_.interpolated().at(time_s));
    if (!goal_.may_turn) along.image.setZero();
    return along;
  }
  if (kind != kTurn) along.position = random_.normal_vector(height_m_);
  if (kind != kMove) {
    const double size = turn * height_m_;
    along.image << size * random_.normal(), random_.normal_vector(size);
  }
  return along;
}

/// Bumps at a random place, with coefficients that cancel at keyframes, each as the x of a
/// position; nothing if there are none at that place.
std::optional<BumpRow> LocalSearch::row(const Scale& scale) {
  const KnotRow& knots = scale.knots;
  const int last = knots.count + most_beyond_;
  const int first = random_.integer(least_first_, last);
  for (int count = 1; count <= kMostBumps && first + count - 1 <= last; ++count) {
    const double begin_s = knots.knot_s(first - 2);
    const double end_s = knots.knot_s(first + count + 1);
    if (static_cast<int>(keyframes_within(begin_s, end_s).size()) >= count) continue;
    BumpRow row{knots, first, {}};
    for (const double coefficient : cancelling(knots, first, count)) {
      row.bumps.push_back({{coefficient, 0.0, 0.0}, geometry::Vec4::Zero()});
    }
    return row;
  }
  return std::nullopt;
}

std::vector<double> LocalSearch::keyframes_within(double begin_s, double end_s) const {
  const auto first = std::ranges::upper_bound(keyframes_s_, begin_s);
  const auto last = std::ranges::lower_bound(keyframes_s_, end_s);
  return first < last ? std::vector<double>(first, last) : std::vector<double>{};
}

/// Coefficients, the largest of size 1, of `count` bumps whose sum is 0 at each keyframe.
std::vector<double> LocalSearch::cancelling(const KnotRow& knots, int first, int count) {
  const std::vector<double> times_s =
      keyframes_within(knots.knot_s(first - 2), knots.knot_s(first + count + 1));
  if (times_s.empty()) return std::vector<double>(static_cast<std::size_t>(count), 1.0);
  Eigen::MatrixXd values(times_s.size(), count);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      const double time_s = times_s[static_cast<std::size_t>(i)];
      values(i, k) = knots.bump(first + static_cast<int>(k)).value(time_s);
    }
  }
  const Eigen::MatrixXd kernel = Eigen::FullPivLU<Eigen::MatrixXd>(values).kernel();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count);
  for (Eigen::Index k = 0; k < kernel.cols(); ++k) sum += random_.normal() * kernel.col(k);
  sum /= sum.cwiseAbs().maxCoeff();
  return {sum.begin(), sum.end()};
}

bool LocalSearch::try_row(const BumpRow& row) {
  correction::Problem problem;
  problem.path = part_.around(row.begin_s(), row.end_s());
  const double begin_s = problem.path.begin_s();
  const double end_s = problem.path.end_s();
  problem.original = shot_.interpolated().around(begin_s, end_s);
  const double before = goal_.cost(problem.path);
  const double after = goal_.cost(motion::with_bumps(problem.path, std::span(&row, 1)));
  if (!(after < before)) return false;
  problem.keyframes_s = keyframes_within(begin_s, end_s);
  problem.has_path_begin = begin_s == whole_.begin_s();
  problem.has_path_end = end_s == whole_.end_s();
  if (problem.has_path_begin) problem.keyframes_s.insert(problem.keyframes_s.begin(), begin_s);
  if (problem.has_path_end) problem.keyframes_s.push_back(end_s);
  problem.interval = {row.begin_s(), row.end_s()};
  const correction::Attempt tried =
      correction::attempt(problem, {row}, space_, base::Deadline::never());
  if (!tried.candidate) return false;
  part_.replace(tried.candidate->path);
  cost_ += after - before;
  return true;
}

}  // namespace camway::bench
