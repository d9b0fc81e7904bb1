// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/ladder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "daemon/correction/ladder/detour.h"
#include "daemon/correction/ladder/nudge.h"
#include "daemon/correction/smoothing/objective_cost.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

using collision::CollisionInterval;
using motion::CubicPath;

class Ladder {
 public:
  Ladder(const scene::WholeMesh& mesh, FreeSpace& space,
         const std::vector<motion::Keyframe>& keyframes, const CubicPath& path,
         const std::vector<CollisionInterval>& collisions, const LadderOptions& options,
         const base::Deadline& deadline)
      : mesh_(mesh),
        space_(space),
        options_(options),
        whole_deadline_(deadline),
        deadline_(deadline),
        original_(path) {
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
      keyframes_s_.push_back(keyframes[i].time_s);
      poses_.push_back(keyframes[i].pose);
      if (keyframes[i].is_repaired) continue;
      as_asked_.push_back(i);
      poses_as_asked_.push_back(keyframes[i].pose);
    }
    result_.path = path;
    leave_time_for_the_rest();
    for (const CollisionInterval& interval : collisions) split_at_keyframes(interval);
    is_beyond_limit_.resize(open_.size());
    for (const CollisionInterval& interval : open_) gaps_.push_back(gap_of(interval));
    const auto gaps_hit = static_cast<int>(std::set(gaps_.begin(), gaps_.end()).size());
    improvement_ = {Objective::kClosest, kStepsAGap * gaps_hit};
    pursuit_ = {options.objective, kPursuitStepsAGap * gaps_hit, false};
    pursuit_.worth = kPursuitWorth;
  }

  LadderResult run() && {
    if (options_.max_inserted_keyframes == 0) return std::move(result_);
    if (correct()) {
      polish();
      pull_to_reference();
      if (options_.objective != Objective::kClosest) pursue_objective();
      measure_corrections();
      if (!beyond_limit_s_.empty()) {
        result_.needed_keyframes = inserted_s_.size() + beyond_limit_s_.size();
      }
    }
    result_.inserted_s.assign(inserted_s_.begin(), inserted_s_.end());
    return std::move(result_);
  }

 private:
  // Returns false if it was proved that there is no path.
  bool correct() {
    correct_all(Search::kWithRoom);
    if (result_.separation) return false;
    if (any_without_way() && !deadline_.passed()) {
      prove_infeasible();
      if (result_.separation || result_.cage) return false;
      if (space_.may_turn()) correct_all(Search::kTurning);
    }
    result_.timed_out = any_open() && deadline_.passed();
    return true;
  }

  // Nearby collisions form one interval, which may contain keyframes.
  void split_at_keyframes(CollisionInterval interval) {
    auto next = std::ranges::upper_bound(keyframes_s_, interval.t_begin_s);
    for (; next != keyframes_s_.end() && *next < interval.t_end_s; ++next) {
      CollisionInterval before = interval;
      before.t_end_s = *next;
      open_.push_back(before);
      interval.t_begin_s = *next;
    }
    open_.push_back(interval);
    while (result_.corrections.size() < open_.size()) {
      result_.corrections.push_back({open_[result_.corrections.size()]});
    }
  }

  [[nodiscard]] std::size_t gap_of(const CollisionInterval& interval) const {
    const double middle_s = 0.5 * (interval.t_begin_s + interval.t_end_s);
    const auto next = std::ranges::upper_bound(keyframes_s_, middle_s);
    const auto index = static_cast<std::size_t>(next - keyframes_s_.begin());
    return std::clamp<std::size_t>(index, 1, keyframes_s_.size() - 1) - 1;
  }

  [[nodiscard]] Problem problem(std::size_t index) {
    Problem problem = problem_of_gap(gaps_[index]);
    problem.effort = &result_.corrections[index].tried;
    problem.interval = open_[index];
    std::erase(problem.foreign_collisions, open_[index]);
    return problem;
  }

  [[nodiscard]] Problem problem_of_gap(std::size_t gap) const {
    const std::size_t first = gap == 0 ? 0 : gap - 1;
    const std::size_t last = std::min(gap + 2, keyframes_s_.size() - 1);
    Problem problem;
    problem.path = result_.path.around(keyframes_s_[first], keyframes_s_[last]);
    problem.original = original_.around(keyframes_s_[first], keyframes_s_[last]);
    problem.keyframes_s.assign(keyframes_s_.begin() + static_cast<std::ptrdiff_t>(first),
                               keyframes_s_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    problem.gap = gap - first;
    problem.has_path_begin = first == 0;
    problem.has_path_end = last + 1 == keyframes_s_.size();
    problem.interval = {keyframes_s_[gap], keyframes_s_[gap + 1]};
    problem.places = places_for(problem);
    // Skip the collisions outside of the part: there may be thousands.
    auto next =
        std::ranges::lower_bound(open_, problem.path.begin_s(), {}, &CollisionInterval::t_end_s);
    for (; next != open_.end() && next->t_begin_s <= problem.path.end_s(); ++next) {
      if (is_open(static_cast<std::size_t>(next - open_.begin())))
        problem.foreign_collisions.push_back(*next);
    }
    return problem;
  }

  // Knots coincide with joints of the path or keep away from them.
  [[nodiscard]] std::shared_ptr<const motion::KnotPlaces> places_for(const Problem& problem) const {
    motion::KnotPlaces places{options_.origin, {problem.path.begin_s()}, 0.0};
    double size_m = 0.0;
    for (const motion::CubicPiece& piece : problem.path.pieces) {
      places.taken_s.push_back(piece.t1_s);
      size_m = std::max(size_m, piece.position[3].cwiseAbs().maxCoeff());
    }
    const double gap_s = problem.gap_end_s() - problem.gap_begin_s();
    const double chord_m = (problem.path.at(problem.gap_end_s()).position -
                            problem.path.at(problem.gap_begin_s()).position)
                               .norm();
    // If the camera only turns, corrections move it by about its own size.
    places.same_s = motion::least_piece_s(gap_s, std::max(chord_m, space_.ball_radius_m()), size_m);
    return std::make_shared<const motion::KnotPlaces>(std::move(places));
  }

  [[nodiscard]] bool is_open(std::size_t index) const {
    return result_.corrections[index].rung == Rung::kNone;
  }

  void prove_infeasible() {
    if (is_separated() || deadline_.passed() || !space_.body().is_camera()) return;
    result_.cage = cage_of_camera(*surfaces_, smallest_share(), poses_as_asked_);
    if (result_.cage) name_keyframes(*result_.cage);
    // It proves nothing of the request, but spares a search that finds no way.
    const bool is_same = options_.max_shrink == 0.0 && poses_as_asked_.size() == poses_.size();
    if (!result_.cage && !is_same) cage_at_this_size_ = cage_of_camera(*surfaces_, 1.0, poses_);
  }

  // Whether a cage is proved to separate the two keyframes of an interval, for this camera.
  [[nodiscard]] bool is_caged_off(std::size_t gap) const {
    if (!cage_at_this_size_) return false;
    const CageBox& cage = cage_at_this_size_->box;
    const auto is_inside = [&](std::size_t keyframe) {
      return cage.box.contains(cage.orientation.conjugate() * middle_W(keyframe));
    };
    return is_inside(gap) != is_inside(gap + 1);
  }

  [[nodiscard]] double smallest_share() const { return 1.0 - options_.max_shrink; }

  // Whether a closed surface separates keyframes. Computed once.
  bool is_separated() {
    if (!surfaces_) {
      surfaces_ = find_closed_surfaces(*mesh_);
      find_separation_of_body(*surfaces_, smallest_share());
    }
    return result_.separation.has_value();
  }

  void find_separation_of_body(const ClosedSurfaces& surfaces, double smallest) {
    // The proof needs a point of the body; the eye is none.
    const geometry::Triangle& part = space_.body().triangles_C().front();
    const geometry::Vec3 point_C = (part[0] + part[1] + part[2]) / 3.0;
    result_.separation =
        find_separation(*mesh_, surfaces, points_W(poses_as_asked_, point_C), kPointRounding_m);
    if (result_.separation && smallest < 1.0) {
      const auto way_W = [&](std::size_t keyframe) {
        const motion::Pose& pose = poses_as_asked_[keyframe];
        return geometry::LineSegment{placed(pose, point_C), placed(pose, smallest * point_C)};
      };
      if (!keeps_clear(*result_.separation, *mesh_, way_W(result_.separation->inside),
                       way_W(result_.separation->outside), kPointRounding_m)) {
        result_.separation.reset();
      }
    }
    if (result_.separation) name_keyframes(*result_.separation);
  }

  // Translates indices among the keyframes that the proof used into indices of all keyframes.
  template <class Proof>
  void name_keyframes(Proof& proof) const {
    proof.inside = as_asked_[proof.inside];
    proof.outside = as_asked_[proof.outside];
  }

  // The near quadrilateral is a rectangle parallel to two axes of the camera frame.
  [[nodiscard]] std::optional<Cage> cage_of_camera(const ClosedSurfaces& surfaces, double smallest,
                                                   const std::vector<motion::Pose>& poses) const {
    geometry::Box rectangle_C;
    for (const geometry::Triangle& part : space_.body().triangles_C()) {
      rectangle_C.extend(geometry::bounds(part));
    }
    const geometry::Vec3 center_C = rectangle_C.center();
    const double side_m = rectangle_C.sizes().head<2>().minCoeff();
    return find_cage(*mesh_, surfaces, points_W(poses, center_C), smallest * side_m,
                     kPointRounding_m + (1.0 - smallest) * center_C.norm());
  }

  static std::vector<geometry::Vec3> points_W(const std::vector<motion::Pose>& poses,
                                              const geometry::Vec3& point_C) {
    std::vector<geometry::Vec3> points_W;
    for (const motion::Pose& pose : poses) points_W.push_back(placed(pose, point_C));
    return points_W;
  }

  static geometry::Vec3 placed(const motion::Pose& pose, const geometry::Vec3& point_C) {
    return pose.position + pose.orientation * point_C;
  }

  [[nodiscard]] bool any_open() const {
    return std::ranges::any_of(result_.corrections, [](const Correction& correction) {
      return correction.rung == Rung::kNone;
    });
  }

  // Whether a collision is open for another reason than the limit of keyframes.
  [[nodiscard]] bool any_without_way() const {
    for (std::size_t i = 0; i < open_.size(); ++i) {
      if (is_open(i) && !is_beyond_limit_[i]) return true;
    }
    return false;
  }

  void correct_all(Search search) {
    std::vector<bool> has_no_way(keyframes_s_.size(), false);  // between a keyframe and the next
    for (std::size_t i = 0; i < open_.size() && !deadline_.passed(); ++i) {
      if (!is_open(i) || is_beyond_limit_[i]) continue;
      if (result_.separation) return;
      if (search == Search::kWithRoom && (nudge_away(i) || is_beyond_limit_[i])) continue;
      const std::size_t gap = gaps_[i];
      // A detour replaces the whole interval between keyframes: do not search it twice.
      if (is_shut_off(gap) || is_caged_off(gap)) has_no_way[gap] = true;
      if (!has_no_way[gap]) has_no_way[gap] = !replace_gap(i, search);
    }
  }

  // Whether an earlier search found that one end is shut in and cannot reach the other.
  [[nodiscard]] bool is_shut_off(std::size_t gap) const {
    return std::ranges::any_of(result_.shut_in, [&](const ShutIn& known) {
      return (known.keyframe == gap && !known.may_hold(middle_W(gap + 1))) ||
             (known.keyframe == gap + 1 && !known.may_hold(middle_W(gap)));
    });
  }

  void add_shut_in(std::size_t keyframe, const Pocket& pocket) {
    const auto same = std::ranges::find(result_.shut_in, keyframe, &ShutIn::keyframe);
    if (same != result_.shut_in.end()) return;
    result_.shut_in.push_back({keyframe, pocket.reached_W, pocket.unsure_m});
  }

  [[nodiscard]] geometry::Vec3 middle_W(std::size_t keyframe) const {
    return space_.center_W(original_.pose(keyframes_s_[keyframe]));
  }

  bool nudge_away(std::size_t index) {
    const Problem problem = this->problem(index);
    if (accept(index, Rung::kMove, nudge(problem, NudgeKind::kMove, space_, deadline_)))
      return true;
    if (!space_.may_turn() || is_beyond_limit_[index]) return false;
    return accept(index, Rung::kTurn, nudge(problem, NudgeKind::kTurn, space_, deadline_));
  }

  // A detour replaces everything between the two keyframes.
  bool replace_gap(std::size_t index, Search search) {
    Problem problem = this->problem(index);
    const auto [first, last] = std::equal_range(gaps_.begin(), gaps_.end(), gaps_[index]);
    std::vector<std::size_t> same_gap;
    for (auto gap = first; gap != last; ++gap) {
      const auto i = static_cast<std::size_t>(gap - gaps_.begin());
      if (is_open(i)) same_gap.push_back(i);
    }
    std::erase_if(problem.foreign_collisions, [&](const CollisionInterval& other) {
      return std::ranges::any_of(same_gap, [&](std::size_t i) { return open_[i] == other; });
    });
    Effort effort;
    problem.effort = &effort;
    std::optional<Pocket> pocket;
    problem.pocket = &pocket;
    const std::optional<Candidate> found = go_round(
        problem, search, improvement_, space_, options_.seed, [this] { return is_separated(); },
        deadline_);
    if (pocket) add_shut_in(gaps_[index] + (pocket->is_at_end ? 1 : 0), *pocket);
    for (const std::size_t i : same_gap) result_.corrections[i].tried += effort;
    if (!accept(index, Rung::kGoRound, found)) {
      for (const std::size_t i : same_gap) is_beyond_limit_[i] = is_beyond_limit_[index];
      return false;
    }
    for (const std::size_t i : same_gap) {
      const CollisionInterval interval = result_.corrections[i].interval;
      result_.corrections[i] = result_.corrections[index];
      result_.corrections[i].interval = interval;
    }
    return true;
  }

  // Relaxes every corrected interval again, now that its neighbours are final, and once more where
  // a neighbour changed.
  void polish() {
    std::vector<bool> needs_polish = corrected_gaps();
    for (int round = 0; round < kPolishingRounds; ++round) {
      for (std::size_t gap = 0; gap < needs_polish.size() && !deadline_.passed(); ++gap) {
        if (!needs_polish[gap]) continue;
        const std::optional<Candidate> better =
            polished(problem_of_gap(gap), kPolishedKnots, improvement_, space_, deadline_);
        if (better && take(*better)) {
          for (const motion::BumpRow& row : better->rows) {
            mark_gaps(row.begin_s(), row.end_s(), needs_polish);
            widen_corrections(gap, row);
          }
        }
        needs_polish[gap] = false;
      }
    }
  }

  [[nodiscard]] std::vector<bool> corrected_gaps() const {
    std::vector<bool> gaps(keyframes_s_.size() - 1);
    for (const Correction& correction : result_.corrections) {
      if (correction.rung != Rung::kNone) mark_gaps(correction.t_begin_s, correction.t_end_s, gaps);
    }
    return gaps;
  }

  // Relaxation of detours favours smoothness. Intervals that ended far from the interpolated path
  // are pulled closer in a few more steps, the farthest first; most paths have none.
  void pull_to_reference() {
    struct FarGap {
      double deviation_m;
      std::size_t gap;
    };
    std::vector<FarGap> far;
    const std::vector<bool> gaps = corrected_gaps();
    for (std::size_t gap = 0; gap < gaps.size() && !deadline_.passed(); ++gap) {
      if (!gaps[gap]) continue;
      const Problem problem = problem_of_gap(gap);
      const CubicPath part = problem.path.around(problem.gap_begin_s(), problem.gap_end_s());
      const double deviation_m = cost(Objective::kClosest, part, problem).value;
      if (deviation_m > kFarFromReference * space_.ball_radius_m())
        far.push_back({deviation_m, gap});
    }
    std::ranges::stable_sort(far, std::greater(), &FarGap::deviation_m);
    for (const FarGap& place : far) {
      if (!deadline_.passed()) pull_to_reference(place.gap);
    }
  }

  void pull_to_reference(std::size_t gap) {
    const Problem problem = problem_of_gap(gap);
    const std::optional<Candidate> other = polished(problem, kPullKnots, pull_, space_, deadline_);
    if (!other) return;
    if (bending_energy(other->path) > kMostBending * bending_energy(problem.path)) return;
    take_if_better(gap, Objective::kClosest, *other, problem);
  }

  // Every objective starts from the closest path and accepts only what is better by its own
  // measure, so no objective ends with less of it than another.
  void pursue_objective() {
    const std::vector<bool> gaps = corrected_gaps();
    for (const int knots : kPursuitKnots) {
      for (std::size_t gap = 0; gap < gaps.size() && !deadline_.passed(); ++gap) {
        if (gaps[gap]) pursue_objective(gap, knots);
      }
    }
  }

  void pursue_objective(std::size_t gap, int knots) {
    const Problem problem = problem_of_gap(gap);
    const std::optional<Candidate> other = polished(problem, knots, pursuit_, space_, deadline_);
    if (other) take_if_better(gap, options_.objective, *other, problem);
  }

  [[nodiscard]] ObjectiveCost cost(Objective objective, const CubicPath& path,
                                   const Problem& problem) {
    return objective_cost(objective, path, problem.original, space_, deadline_);
  }

  void take_if_better(std::size_t gap, Objective objective, const Candidate& other,
                      const Problem& problem) {
    if (!is_better(cost(objective, other.path, problem), cost(objective, problem.path, problem)))
      return;
    if (!take(other)) return;
    for (const motion::BumpRow& row : other.rows) widen_corrections(gap, row);
  }

  // Extends the corrections of this interval, and those that reach into it, by the range of the
  // row.
  void widen_corrections(std::size_t gap, const motion::BumpRow& row) {
    for (Correction& correction : result_.corrections) {
      const bool is_here =
          correction.t_begin_s < keyframes_s_[gap + 1] && correction.t_end_s > keyframes_s_[gap];
      if (correction.rung == Rung::kNone || !is_here) continue;
      correction.t_begin_s =
          std::max(original_.begin_s(), std::min(correction.t_begin_s, row.begin_s()));
      correction.t_end_s = std::min(original_.end_s(), std::max(correction.t_end_s, row.end_s()));
    }
  }

  // Marks the intervals between keyframes that overlap the time range in more than an end.
  void mark_gaps(double begin_s, double end_s, std::vector<bool>& gaps) const {
    const auto after_begin = std::ranges::upper_bound(keyframes_s_, begin_s);
    auto gap = static_cast<std::size_t>(after_begin - keyframes_s_.begin());
    for (gap -= gap > 0 ? 1 : 0; gap < gaps.size() && keyframes_s_[gap] < end_s; ++gap)
      gaps[gap] = true;
  }

  bool accept(std::size_t index, Rung rung, const std::optional<Candidate>& candidate) {
    if (!candidate) return false;
    if (!take(*candidate)) {
      is_beyond_limit_[index] = true;
      for (const motion::BumpRow& row : candidate->rows) add_keyframes(row, beyond_limit_s_);
      return false;
    }
    Correction& correction = result_.corrections[index];
    correction.rung = rung;
    correction.tried = {};
    correction.t_begin_s = original_.end_s();
    correction.t_end_s = original_.begin_s();
    for (const motion::BumpRow& row : candidate->rows) {
      correction.t_begin_s = std::min(correction.t_begin_s, row.begin_s());
      correction.t_end_s = std::max(correction.t_end_s, row.end_s());
    }
    correction.t_begin_s = std::max(correction.t_begin_s, original_.begin_s());
    correction.t_end_s = std::min(correction.t_end_s, original_.end_s());
    report();
    return true;
  }

  void report() const {
    const auto open = std::ranges::count(result_.corrections, Rung::kNone, &Correction::rung);
    deadline_.report_collisions(open_.size(), open_.size() - static_cast<std::size_t>(open));
  }

  // Replaces part of the path by the candidate, unless that would exceed the limit of keyframes.
  bool take(const Candidate& candidate) {
    std::vector<double> inserted_s;
    for (const motion::BumpRow& row : candidate.rows) add_keyframes(row, inserted_s);
    std::erase_if(inserted_s, [this](double time_s) { return inserted_s_.contains(time_s); });
    const std::set<double> fresh_s(inserted_s.begin(), inserted_s.end());
    const auto most = static_cast<std::size_t>(options_.max_inserted_keyframes);
    if (inserted_s_.size() + fresh_s.size() > most) return false;
    inserted_s_.insert(fresh_s.begin(), fresh_s.end());
    result_.path.replace(candidate.path);
    leave_time_for_the_rest();
    return true;
  }

  // The time reserved grows with the number of pieces.
  void leave_time_for_the_rest() {
    const auto pieces = static_cast<double>(result_.path.pieces.size());
    deadline_ = whole_deadline_.sooner_by_s(options_.rest_s_per_piece * pieces);
  }

  // A bump counts as an inserted keyframe at its peak, unless a keyframe is there already, the peak
  // is off the path, or the bump moves the body by less than the collision tolerance.
  void add_keyframes(const motion::BumpRow& row, std::vector<double>& times_s) const {
    const double near_s = 0.5 * row.knots.spacing_s();
    for (std::size_t i = 0; i < row.bumps.size(); ++i) {
      const double peak_s = row.knots.knot_s(row.first + static_cast<int>(i));
      const auto next = std::ranges::lower_bound(keyframes_s_, peak_s - near_s);
      const bool is_there = next != keyframes_s_.end() && *next <= peak_s + near_s;
      const bool is_on_path = original_.begin_s() < peak_s && peak_s < original_.end_s();
      const motion::CubicPoint& bump = row.bumps[i];
      const double moved_m =
          bump.position.norm() + 4.0 * space_.body().radius_m() * bump.image.norm();
      if (moved_m < options_.detect.tolerance_m) continue;
      if (is_on_path && !is_there) times_s.push_back(peak_s);
    }
  }

  // Corrections of one interval often have the same time range.
  void measure_corrections() {
    std::map<std::pair<double, double>, const Correction*> measured;
    for (Correction& correction : result_.corrections) {
      if (correction.rung == Rung::kNone) continue;
      const auto [same, is_new] =
          measured.try_emplace({correction.t_begin_s, correction.t_end_s}, &correction);
      if (is_new) measure(correction);
      correction.moved_m = same->second->moved_m;
      correction.turned_rad = same->second->turned_rad;
    }
  }

  // Measures the final path, piece by piece.
  void measure(Correction& correction) const {
    constexpr int kSamples = 6;  // of a piece
    const CubicPath changed = result_.path.around(correction.t_begin_s, correction.t_end_s);
    for (const motion::CubicPiece& piece : changed.pieces) {
      const double begin_s = std::max(piece.t0_s, correction.t_begin_s);
      const double end_s = std::min(piece.t1_s, correction.t_end_s);
      for (int i = 0; i <= kSamples; ++i) {
        const double time_s = std::lerp(begin_s, end_s, static_cast<double>(i) / kSamples);
        const motion::Pose now = changed.pose(time_s);
        const motion::Pose before = original_.pose(time_s);
        correction.moved_m = std::max(correction.moved_m, (now.position - before.position).norm());
        correction.turned_rad =
            std::max(correction.turned_rad, now.orientation.angularDistance(before.orientation));
      }
    }
  }

  static constexpr int kPolishingRounds = 2;
  static constexpr int kStepsAGap = 12;  ///< steps of relaxation per interval with a collision
  static constexpr int kPolishedKnots = 12;
  static constexpr double kFarFromReference =
      3.0;  ///< distance from the original, in radii of the ball
  static constexpr double kPullSpread = 0.25;
  static constexpr int kPullKnots = 16;
  static constexpr int kPullSteps = 24;  ///< for the whole path
  /// Largest growth of bending energy for coming closer.
  static constexpr double kMostBending = 1.5;
  static constexpr int kPursuitStepsAGap = 40;
  static constexpr double kPursuitWorth = 0.03;
  static constexpr std::array<int, 3> kPursuitKnots = {12, 24, 48};
  /// How far the answer's path may be from a keyframe when a client checks it, and so the point of
  /// the body: surfaces nearer than this prove nothing.
  static constexpr double kPointRounding_m = 1e-6;

  const scene::WholeMesh& mesh_;
  FreeSpace& space_;
  const LadderOptions& options_;
  const base::Deadline& whole_deadline_;
  base::Deadline deadline_;  ///< deadline of corrections
  const CubicPath& original_;
  std::vector<double> keyframes_s_;
  /// Indices of the keyframes that proofs use: repaired keyframes prove nothing about the request.
  std::vector<std::size_t> as_asked_;
  std::vector<motion::Pose> poses_as_asked_;  ///< poses of these keyframes
  std::vector<motion::Pose> poses_;           ///< poses of all keyframes, repaired ones included
  std::vector<CollisionInterval> open_;       ///< one per `result_.corrections`, in order of time
  std::vector<std::size_t> gaps_;             ///< the interval between keyframes of each
  /// Whether the correction found for a collision exceeds the limit of keyframes, and the times of
  /// all such keyframes.
  std::vector<bool> is_beyond_limit_;
  std::vector<double> beyond_limit_s_;
  std::set<double> inserted_s_;  ///< times of the inserted keyframes
  Improvement improvement_;
  Improvement pull_{Objective::kClosest, kPullSteps, true, kPullSpread};
  Improvement pursuit_;                     ///< budget for an objective other than the closest path
  std::optional<ClosedSurfaces> surfaces_;  ///< closed surfaces of the scene, once computed
  /// Proof that there is no path but for a smaller camera, or other keyframes.
  std::optional<Cage> cage_at_this_size_;
  LadderResult result_;
};

}  // namespace

LadderResult correct_by_ladder(const scene::WholeMesh& mesh, const collision::Obstacles& obstacles,
                               const motion::Body& body,
                               const std::vector<motion::Keyframe>& keyframes,
                               const CubicPath& path,
                               const std::vector<CollisionInterval>& collisions,
                               const LadderOptions& options, const base::Deadline& deadline) {
  FreeSpace space(obstacles, body, options.detect, options.orientation);
  return Ladder(mesh, space, keyframes, path, collisions, options, deadline).run();
}

}  // namespace camway::correction
