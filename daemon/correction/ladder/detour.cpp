// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/detour.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/correction/ladder/follow_guide.h"
#include "daemon/correction/narrow/corridor.h"
#include "daemon/correction/narrow/kept_guide.h"
#include "daemon/correction/narrow/threaded_guide.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/guide.h"
#include "daemon/correction/path/leg_poses.h"
#include "daemon/correction/path/orientation_rule.h"
#include "daemon/correction/search/ball_escape.h"
#include "daemon/correction/search/cell_search.h"
#include "daemon/correction/search/kept_cell_way.h"
#include "daemon/correction/search/lattice_ways.h"
#include "daemon/correction/search/other_side.h"
#include "daemon/correction/search/shorter_way.h"
#include "daemon/correction/search/small_ball_way.h"
#include "daemon/correction/search/tree_search.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved.
constexpr double kTreeMargin = 0.01;  // of motions beyond the clearance, share of the ball's radius
constexpr double kTreeReach = 2.0;    // of samples beside the way, in radii of the ball
constexpr std::array<double, 2> kBallShares = {0.04, 0.15};  // shares of the ball's radius
constexpr std::size_t kMostCells = 2'000'000;  // some 50 bytes each at most, for ways between rooms
constexpr std::size_t kFewCells = kCellsBeforeNarrow;  // in place of a lattice that costs as much
constexpr int kFewSamples = 300;                       // of trees that turn little or not at all
constexpr double kSmallTurn_rad = 0.35;                // limit of the turns of the former
constexpr std::size_t kMostBodyCells = 40'000;         // of ways on which the body does not turn
constexpr std::size_t kBodyCells = 20'000;             // of those that may replace a way with turns
constexpr double kHardlyTurned_rad = 0.02;  // a body turned by less can keep its orientation
constexpr double kFarTurn_rad = 0.7;        // from there on, a way without turns is searched longer
/// A way that turns replaces one that does not if it costs less than this share: relaxation may
/// change both costs, and a turn changes what is seen.
constexpr double kTurnShare = 0.7;
/// A way without turns that costs no more, for each second, is not compared with others.
constexpr double kCheap_rad = 0.08;
constexpr int kLegsAsInterpolated = 16;   // what lattices keep to, where there is a choice
constexpr int kPosesAsInterpolated = 64;  // steps in time; the tree search has no time of its own

class Detour {
 public:
  Detour(const Problem& problem, base::Budget& budget, FreeSpace& space, std::uint64_t seed,
         const ProofsOfNoWay& proofs, const base::Deadline& deadline)
      : problem_(problem),
        budget_(budget),
        space_(space),
        seed_(seed),
        proofs_(proofs),
        deadline_(deadline),
        radius_m_(space.ball_radius_m()),
        from_(signed_pose_at(problem.path, problem.leg_begin_s())),
        to_(signed_pose_at(problem.path, problem.leg_end_s())),
        has_center_(space.body().is_near(space.center_C(), kBallShares.front() * radius_m_)) {}

  DetourResult run(Search search) {
    switch (search) {
      case Search::kQuick:
        result_.candidate = with_ball(Lattices::kCoarse);
        break;
      case Search::kWithRoom:
        result_.candidate = with_ball(Lattices::kAllButFinest);
        break;
      case Search::kNarrow:
        result_.candidate = through_narrow_places();
        break;
    }
    return std::move(result_);
  }

 private:
  using Draw = std::function<std::optional<Candidate>(const LatticeResult& way)>;

  // A way, and the path along it.
  struct DrawnWay {
    LatticeResult way;
    Candidate path;
  };

  // Detours with room for every orientation: the cheapest one of several ways.
  std::optional<Candidate> with_ball(Lattices lattices) {
    const std::optional<SignedPose> begin = ball_escape(space_, from_, radius_m_);
    const std::optional<SignedPose> end = ball_escape(space_, to_, radius_m_);
    if (!begin || !end) return std::nullopt;
    const BallMotion ball{
        .radius_m = radius_m_, .from_W = center_W(*begin), .to_W = center_W(*end)};
    about_W_ = centers_as_interpolated();
    const Draw draw = [&](const LatticeResult& way) {
      // Any orientation fits in the ball, so the path keeps its own.
      return followed(oriented(problem_, space_, way.way_W, *begin, *end), Turning::kAsPath);
    };
    // A narrow place is found sooner by the way of a small ball than by a fine lattice.
    std::optional<Candidate> threaded;
    const bool has_escaped = begin->position != from_.position || end->position != to_.position;
    const auto is_done = [&] {
      threaded = along_small_ball(kBallShares.front(), kFewCells);
      // The pocket is no proof, and other corrections may follow: it only ends this search.
      const bool is_complete = has_complete_pocket();
      if (is_complete) result_.pocket.reset();
      const bool is_shut_in = is_complete && !has_escaped;
      return threaded || is_shut_in || (!deadline_.passed() && proofs_.is_caged());
    };
    std::optional<DrawnWay> best;
    const auto use = [&](const LatticeResult& way) { return draw_way(way, draw, best); };
    search_ways(ball, lattices, {use, proofs_.is_separated, is_done});
    if (!best) return threaded;
    take_if_cheaper(on_finer_lattice(ball, best->way, draw), *best);
    take_if_cheaper(on_another_side(ball, best->way, draw), *best);
    return std::move(best->path);
  }

  [[nodiscard]] bool has_complete_pocket() const {
    return result_.pocket && result_.pocket->is_complete;
  }

  // Draws a path along `way`; returns false if none is free.
  static bool draw_way(const LatticeResult& way, const Draw& draw, std::optional<DrawnWay>& drawn) {
    std::optional<Candidate> path = draw(way);
    if (path) drawn = DrawnWay{way, *std::move(path)};
    return drawn.has_value();
  }

  void take_if_cheaper(std::optional<DrawnWay> other, DrawnWay& best) const {
    if (other && cost(other->path) < cost(best.path)) best = *std::move(other);
  }

  // A much shorter way than `first`, where that is long.
  std::optional<DrawnWay> on_finer_lattice(const BallMotion& ball, const LatticeResult& first,
                                           const Draw& draw) {
    std::optional<DrawnWay> shorter;
    const std::optional<BallMotion> limited = shorter_way(ball, first);
    if (!limited) return std::nullopt;
    const auto use = [&](const LatticeResult& way) { return draw_way(way, draw, shorter); };
    search_ways(*limited, Lattices::kCoarse, {.use = use});
    return shorter;
  }

  // A way that avoids the apex of `first`; nothing if it leads much farther off.
  std::optional<DrawnWay> on_another_side(const BallMotion& ball, const LatticeResult& first,
                                          const Draw& draw) {
    const OtherSide other_side(first, about_W_);
    std::optional<DrawnWay> second;
    const auto use = [&](const LatticeResult& way) {
      return other_side.is_too_far(way) || draw_way(way, draw, second);
    };
    search_ways(other_side.limited(ball), Lattices::kCoarse, {.use = use});
    return second;
  }

  void search_ways(const BallMotion& ball, Lattices lattices, const LatticeWayUse& use) {
    count_points(for_each_lattice_way(space_, ball, lattices, about_W_, use, deadline_));
  }

  [[nodiscard]] double cost(const Candidate& candidate) const {
    return closeness_cost(candidate.path, problem_.original, space_.closeness());
  }

  // Detours where the ball does not fit: narrow passages and trees along the way of a smaller ball.
  // The smallest ball comes first: if it has no way, the others have none.
  std::optional<Candidate> through_narrow_places() {
    for (const double share : kBallShares) {
      if (deadline_.passed()) return std::nullopt;
      std::optional<Candidate> found = along_small_ball(share, kMostCells);
      if (found || has_complete_pocket()) return found;
      if (small_way_W_.empty()) break;
      found = followed(tree_way(space_, from_, to_, tree_about(small_way_W_), deadline_), space_);
      if (found) return turned_less(*std::move(found));
    }
    if (std::optional<Candidate> found = between_ways_out()) return found;
    // The finest lattice comes last: detours that need it mostly are narrow as well.
    return with_ball(Lattices::kFinest);
  }

  // A detour between the ways out of the narrow places in which the body is at its ends; nothing if
  // it is in none.
  std::optional<Candidate> between_ways_out() {
    if (space_.may_turn() && is_limited(space_.policy())) return std::nullopt;
    const std::optional<Guide> out = way_out_from(from_);
    const std::optional<Guide> back = out ? way_out_from(to_) : std::nullopt;
    if (!back || out->size() + back->size() == 2) return std::nullopt;
    const SignedPose& from = out->back();
    const SignedPose& to = back->back();
    const CellResult ball =
        small_ball_way(space_, from, to, kBallShares.front(), kMostCells, deadline_);
    count_points(ball.cells);
    if (ball.way_W.empty()) return std::nullopt;
    TreeOptions trees = tree_about(ball.way_W);
    TreeResult found = threaded_guide(space_, ball.way_W, from, to, trees, deadline_);
    if (found.guide.empty()) found = tree_way(space_, from, to, trees, deadline_);
    if (found.guide.empty()) return std::nullopt;
    found.guide.insert(found.guide.begin(), out->begin(), out->end() - 1);
    found.guide.insert(found.guide.end(), back->rbegin() + 1, back->rend());
    return followed(found, space_);
  }

  [[nodiscard]] std::optional<Guide> way_out_from(const SignedPose& end) {
    if (!has_center_) {
      if (auto found = way_out(space_, end, RoomTest::kBall, deadline_)) return found;
    }
    return way_out(space_, end, RoomTest::kGap, deadline_);
  }

  // A detour through the narrow places on the way of a small ball, without turns if that does not
  // cost more. Keeps that way, and the pocket that shuts in one end of the smallest ball.
  std::optional<Candidate> along_small_ball(double share, std::size_t max_cells) {
    CellResult ball = way_of_small_ball(share, max_cells);
    if (share == kBallShares.front()) result_.pocket = std::move(ball.pocket);
    small_way_W_ = std::move(ball.way_W);
    if (small_way_W_.empty()) return std::nullopt;
    std::optional<Candidate> kept = along_way_with_turns(0.0);
    if (!space_.may_turn()) return kept ? std::move(kept) : along_cells_of_body();
    if (kept && is_cheap(*kept)) return kept;
    std::optional<Candidate> turned = along_threaded();
    if (!turned) return kept;
    if (kept) return cost(*turned) < kTurnShare * cost(*kept) ? std::move(turned) : std::move(kept);
    std::optional<Candidate> less = along_way_with_turns(kSmallTurn_rad);
    if (less && cost(*less) < cost(*turned)) return less;
    return turned_less(*std::move(turned));
  }

  // A detour through the narrow places by motions that fit. Where turns are limited, and nothing
  // else, a guide is searched as if they were not: the path that follows it may obey the limit.
  std::optional<Candidate> along_threaded() {
    const TreeOptions trees = tree_about(small_way_W_);
    const OrientationPolicy& policy = space_.policy();
    if (!is_limited(policy) || policy.rule != OrientationRule::kFree) {
      return followed(threaded_guide(space_, small_way_W_, from_, to_, trees, deadline_), space_);
    }
    FreeSpace any_turn(space_.query(), OrientationPolicy(), space_.closeness());
    const TreeResult tree = threaded_guide(any_turn, small_way_W_, from_, to_, trees, deadline_);
    if (std::optional<Candidate> found = followed(tree, space_)) return found;
    // Relaxed, a path turns less than its guide, on whose way it would break the limit.
    std::optional<Candidate> relaxed = followed(tree.guide, Turning::kAsGuide, any_turn);
    if (relaxed && obeys_policy(relaxed->path)) return relaxed;
    return std::nullopt;
  }

  [[nodiscard]] bool obeys_policy(const motion::CubicPath& path) const {
    return !first_breach(space_.policy(), path, problem_.original, path.begin_s(), path.end_s());
  }

  // The path, or one on which the body does not turn, if it turns far.
  Candidate turned_less(Candidate turned) {
    if (largest_turn_rad(problem_, turned.path, kPosesAsInterpolated) <= kFarTurn_rad)
      return turned;
    std::optional<Candidate> kept = along_cells_of_body();
    const bool is_worse = !kept || cost(turned) < kTurnShare * cost(*kept);
    return is_worse ? std::move(turned) : *std::move(kept);
  }

  std::optional<Candidate> followed(const Guide& guide, Turning turning) {
    return followed(guide, turning, space_);
  }
  std::optional<Candidate> followed(const Guide& guide, Turning turning, FreeSpace& space) {
    Followed found = follow(problem_, guide, turning, budget_, space, deadline_);
    result_.effort.paths += found.paths;
    return std::move(found.candidate);
  }
  std::optional<Candidate> followed(const TreeResult& tree, FreeSpace& space) {
    result_.effort.tree_samples += tree.samples;
    return followed(tree.guide, space.may_turn() ? Turning::kAsGuide : Turning::kAsPath, space);
  }

  // A detour along the way of the small ball on which the body turns by no more than `most_rad`, if
  // few samples find one: trees with more freedom turn the body as they like.
  std::optional<Candidate> along_way_with_turns(double most_rad) {
    OrientationPolicy policy = space_.policy();
    policy.max_turn_rad = std::min(policy.max_turn_rad, most_rad);
    FreeSpace space(space_.query(), policy, space_.closeness());
    TreeOptions trees = tree_about(small_way_W_);
    std::optional<Candidate> found;
    if (!space.may_turn()) {
      const std::optional<Guide> kept = kept_guide(space, small_way_W_, from_, to_,
                                                   trees.interpolated, trees.margin_m, deadline_);
      if (kept) found = followed(*kept, Turning::kAsPath);
    }
    trees.max_samples = kFewSamples;
    if (!found) found = followed(tree_way(space, from_, to_, trees, deadline_), space);
    return found;
  }

  // A detour on which the body does not turn, where the path hardly turns it either.
  std::optional<Candidate> along_cells_of_body() {
    if (std::exchange(has_searched_body_, true)) return std::nullopt;
    const std::vector<motion::Pose> poses = poses_as_interpolated(problem_, kPosesAsInterpolated);
    const bool turns = std::ranges::any_of(poses, [&](const motion::Pose& pose) {
      return pose.orientation.angularDistance(poses.front().orientation) > kHardlyTurned_rad;
    });
    if (turns) return std::nullopt;
    const std::size_t most = space_.may_turn() ? kBodyCells : kMostBodyCells;
    const KeptWay way = kept_cell_way(space_, from_, to_, most, deadline_);
    count_points(way.cells);
    if (way.guide.empty()) return std::nullopt;
    return followed(shortened(way.guide, space_, 0.0), Turning::kAsPath);
  }

  [[nodiscard]] bool is_cheap(const Candidate& candidate) const {
    return cost(candidate) <= kCheap_rad * (problem_.leg_end_s() - problem_.leg_begin_s());
  }

  [[nodiscard]] TreeOptions tree_about(std::vector<Vec3> way_W) const {
    TreeOptions options;
    options.margin_m = kTreeMargin * radius_m_;
    options.about_W = std::move(way_W);
    options.reach_m = kTreeReach * radius_m_;
    options.seed = seed_;
    options.largest_turn_rad =
        std::min(options.largest_turn_rad, kAimedShare * space_.policy().max_turn_rad);
    options.interpolated = poses_as_interpolated(problem_, kPosesAsInterpolated);
    return options;
  }

  [[nodiscard]] std::vector<Vec3> centers_as_interpolated() const {
    std::vector<Vec3> centers_W;
    for (const motion::Pose& pose : poses_as_interpolated(problem_, kLegsAsInterpolated)) {
      centers_W.push_back(space_.center_W(pose));
    }
    return centers_W;
  }

  CellResult way_of_small_ball(double share, std::size_t max_cells) {
    CellResult found = small_ball_way(space_, from_, to_, share, max_cells, deadline_);
    count_points(found.cells);
    // A ball about a point beside the body, such as the centre of a ring, may be shut in where the
    // body is not.
    if (!has_center_) found.pocket.reset();
    return found;
  }

  void count_points(std::size_t points) {
    result_.effort.lattice_points += static_cast<std::int32_t>(points);
  }

  [[nodiscard]] Vec3 center_W(const SignedPose& pose) const {
    return space_.center_W(motion::unsigned_pose(pose));
  }

  const Problem& problem_;
  base::Budget& budget_;
  FreeSpace& space_;
  const std::uint64_t seed_;
  const ProofsOfNoWay& proofs_;
  const base::Deadline& deadline_;
  const double radius_m_;
  const SignedPose from_;
  const SignedPose to_;
  const bool has_center_;          ///< whether the centre of the ball about the body is in the body
  std::vector<Vec3> about_W_;      ///< the path as interpolated, which ways should follow
  std::vector<Vec3> small_way_W_;  ///< way of the small ball that was searched last
  bool has_searched_body_ = false;  ///< whether the cells of the body were searched
  DetourResult result_;
};

}  // namespace

DetourResult go_round(const Problem& problem, Search search, base::Budget& budget, FreeSpace& space,
                      std::uint64_t seed, const ProofsOfNoWay& proofs,
                      const base::Deadline& deadline) {
  return Detour(problem, budget, space, seed, proofs, deadline).run(search);
}

}  // namespace camway::correction
