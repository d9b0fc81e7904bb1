// SPDX-License-Identifier: MIT
#include "daemon/correction/path/candidate.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "daemon/collision/detect.h"
#include "daemon/collision/probe.h"
#include "daemon/correction/path/orientation_rule.h"
#include "daemon/motion/path/stretch.h"

namespace camway::correction {

using collision::CollisionInterval;

namespace {

// A keyframe is kept if the bumps cancel there up to the rounding of a few sums, relative to the
// position there and the largest coefficient of a bump.
constexpr double kCancelled = 64.0 * std::numeric_limits<double>::epsilon();

// Steps to the end of a collision, as a share of what was changed. Chosen by measurement.
constexpr double kStepToEnd = 1.0 / 200.0;

struct Span {
  double begin_s;
  double end_s;
};

/// The time range of the problem's path that `rows` change. Nothing if there are no rows, or if
/// they reach beyond the problem's part of the path.
std::optional<Span> span_of(const std::vector<motion::BumpRow>& rows, const Problem& problem) {
  if (rows.empty()) return std::nullopt;
  Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const motion::BumpRow& row : rows) {
    span.begin_s = std::min(span.begin_s, row.begin_s());
    span.end_s = std::max(span.end_s, row.end_s());
  }
  const double first_s = problem.path.begin_s();
  const double last_s = problem.path.end_s();
  if (span.begin_s < first_s && !problem.has_path_begin) return std::nullopt;
  if (span.end_s > last_s && !problem.has_path_end) return std::nullopt;
  return Span{std::max(span.begin_s, first_s), std::min(span.end_s, last_s)};
}

/// Whether `path` meets the keyframes as the problem's own path does; also removes the rounding
/// there.
bool keeps_keyframes(motion::CubicPath& path, const std::vector<motion::BumpRow>& rows,
                     const Problem& problem) {
  motion::CubicPoint largest;
  for (const motion::BumpRow& row : rows) {
    for (const motion::CubicPoint& bump : row.bumps) {
      largest.position = largest.position.cwiseMax(bump.position.cwiseAbs());
      largest.image = largest.image.cwiseMax(bump.image.cwiseAbs());
    }
  }
  for (const double time_s : problem.keyframes_s) {
    const motion::CubicPoint kept = problem.path.at(time_s);
    const motion::CubicPoint now = path.at(time_s);
    const double size_m = kept.position.norm() + largest.position.norm();
    const double image_size = kept.image.norm() + largest.image.norm();
    if (!((now.position - kept.position).norm() <= kCancelled * size_m)) return false;
    if (!((now.image - kept.image).norm() <= kCancelled * image_size)) return false;
    for (motion::CubicPiece& piece : path.pieces) {
      if (piece.t1_s == time_s) {
        piece.position[3] = kept.position;
        piece.image[3] = kept.image;
      } else if (piece.t0_s == time_s) {
        piece.position[0] = kept.position;
        piece.image[0] = kept.image;
      }
    }
  }
  return true;
}

/// Returns a time range in which the orientation policy is not met or not shown to be met.
std::optional<CollisionInterval> breach_of_rule(const Candidate& candidate, const Span& changed,
                                                const Problem& problem, const FreeSpace& space) {
  if (!space.may_turn() && turns(candidate.rows)) {
    return CollisionInterval{changed.begin_s, changed.end_s};
  }
  return first_breach(space.policy(), candidate.path, problem.original, changed.begin_s,
                      changed.end_s);
}

/// About the end of a collision: the first sample behind it at which the body is free.
double end_of_collision_s(const CollisionInterval& found, const Span& changed,
                          const Candidate& candidate, const FreeSpace& space,
                          const base::Deadline& deadline) {
  const collision::Query& query = space.query();
  collision::Probe probe(query.obstacles, query.body, query.options.clearance_m);
  const double step_s = kStepToEnd * (changed.end_s - changed.begin_s);
  double time_s = found.t_end_s;
  while (time_s < changed.end_s && !deadline.passed() &&
         !probe.is_free(candidate.path.pose(time_s))) {
    time_s += step_s;
  }
  return std::max(found.t_end_s, std::min(time_s, changed.end_s));
}

/// Returns the path with `rows`, and the range that they change; nothing if they do not fit, or if
/// a keyframe would move.
std::optional<std::pair<Candidate, Span>> with_rows(const Problem& problem,
                                                    std::vector<motion::BumpRow> rows) {
  // Rows without bumps change nothing, and end before they begin.
  std::erase_if(rows, [](const motion::BumpRow& row) { return row.bumps.empty(); });
  const std::optional<Span> changed = span_of(rows, problem);
  const bool all_fit =
      std::ranges::all_of(rows, [](const motion::BumpRow& row) { return row.knots.fits(); });
  if (!changed || !all_fit) return std::nullopt;
  Candidate candidate{motion::with_bumps(problem.path, rows), std::move(rows)};
  if (!keeps_keyframes(candidate.path, candidate.rows, problem)) return std::nullopt;
  return std::pair{std::move(candidate), *changed};
}

/// Does what `new_collision` does, for the clearance of `query`.
std::optional<CollisionInterval> new_collision_of(const collision::Query& query,
                                                  const motion::CubicPath& path, const Span& span,
                                                  const Problem& problem,
                                                  const base::Deadline& deadline) {
  const motion::Path segments = path.around(span.begin_s, span.end_s).path();
  const auto search = [&](double from_s, double to_s) -> std::optional<CollisionInterval> {
    if (!(from_s < to_s)) return std::nullopt;
    const collision::FirstCollision found =
        collision::any_collision(query, segments, from_s, to_s, deadline);
    if (!found.decided) return CollisionInterval{from_s, to_s};
    return found.interval;
  };
  double from_s = span.begin_s;
  for (const CollisionInterval& other : problem.foreign_collisions) {
    if (other.t_end_s <= from_s) continue;
    if (other.t_begin_s >= span.end_s) break;
    if (auto found = search(from_s, other.t_begin_s)) return found;
    from_s = other.t_end_s;
  }
  return search(from_s, span.end_s);
}

/// Returns a collision in the range that was changed or that has to become free: rows may reach
/// less far than the problem's interval. The middle of the interval is checked first: there a
/// collision is the likeliest to remain.
std::optional<CollisionInterval> collision_in(const Span& changed, const Candidate& candidate,
                                              const Problem& problem, const FreeSpace& space,
                                              const base::Deadline& deadline) {
  const CollisionInterval& interval = problem.interval;
  const double begin_s = std::min(changed.begin_s, interval.t_begin_s);
  const double end_s = std::max(changed.end_s, interval.t_end_s);
  const double middle_s = 0.5 * (interval.t_begin_s + interval.t_end_s);
  std::optional<CollisionInterval> found =
      new_collision(candidate.path, middle_s, end_s, problem, space, deadline);
  if (found) return found;
  return new_collision(candidate.path, begin_s, middle_s, problem, space, deadline);
}

}  // namespace

bool turns(std::span<const motion::BumpRow> rows) {
  return std::ranges::any_of(rows, [](const motion::BumpRow& row) {
    return std::ranges::any_of(
        row.bumps, [](const motion::CubicPoint& bump) { return !bump.image.isZero(0.0); });
  });
}

std::optional<CollisionInterval> new_collision(const motion::CubicPath& path, double t_begin_s,
                                               double t_end_s, const Problem& problem,
                                               const FreeSpace& space,
                                               const base::Deadline& deadline) {
  return new_collision_of(space.query(), path, {t_begin_s, t_end_s}, problem, deadline);
}

std::optional<CollisionInterval> tight_place(const Candidate& candidate, double gap_m,
                                             const Problem& problem, const FreeSpace& space,
                                             const base::Deadline& deadline) {
  const std::optional<Span> changed = span_of(candidate.rows, problem);
  if (!changed) return std::nullopt;
  collision::Query query = space.query();
  query.options.clearance_m += gap_m;
  return new_collision_of(query, candidate.path, *changed, problem, deadline);
}

std::optional<Candidate> free_candidate(const Problem& problem, std::vector<motion::BumpRow> rows,
                                        const FreeSpace& space, const base::Deadline& deadline) {
  std::optional<std::pair<Candidate, Span>> made = with_rows(problem, std::move(rows));
  if (!made) return std::nullopt;
  const auto& [candidate, changed] = *made;
  if (breach_of_rule(candidate, changed, problem, space)) return std::nullopt;
  if (collision_in(changed, candidate, problem, space, deadline)) return std::nullopt;
  return std::move(made->first);
}

Attempt attempt(const Problem& problem, std::vector<motion::BumpRow> rows, const FreeSpace& space,
                const base::Deadline& deadline) {
  std::optional<std::pair<Candidate, Span>> made = with_rows(problem, std::move(rows));
  if (!made) return {std::nullopt, problem.interval};
  const auto& [candidate, changed] = *made;
  if (auto breach = breach_of_rule(candidate, changed, problem, space)) {
    return {std::nullopt, std::move(breach)};
  }
  std::optional<CollisionInterval> found =
      collision_in(changed, candidate, problem, space, deadline);
  if (!found) return {std::move(made->first), std::nullopt};
  found->t_end_s = end_of_collision_s(*found, changed, candidate, space, deadline);
  return {std::nullopt, std::move(found)};
}

}  // namespace camway::correction
