// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/detour.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/correction/path/guide.h"
#include "daemon/correction/path/orientation_rule.h"
#include "daemon/correction/search/cell_search.h"
#include "daemon/correction/search/lattice_search.h"
#include "daemon/correction/search/narrow_passage.h"
#include "daemon/correction/search/tree_search.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved.
constexpr std::array<int, 4> kCoarse = {8, 12, 16, 32};  // numbers of knots
constexpr std::array<int, 4> kFine = {8, 16, 32, 64};
constexpr int kMostRefinements = 40;  // finer rows of bumps
constexpr int kFinest = 2048;
constexpr std::array<double, 2> kMargins = {0.25, 0.02};  // shares of the ball's radius
constexpr double kLeastMargin = 0.02;
constexpr std::array<double, 2> kBallShares = {0.04, 0.15};  // shares of the ball's radius
constexpr double kSmallestCell = 0.02;
constexpr std::size_t kMostCells = 2'000'000;  // some 50 bytes each at most
constexpr int kLegsAsInterpolated = 16;        // what lattices keep to, where there is a choice
constexpr int kPosesAsInterpolated = 64;  // steps in time; the tree search has no time of its own
constexpr int kJoiningSamples = 1000;     // samples of trees between narrow places
constexpr double kLongestStep = 3.0;      // between poses of a guide, in radii of the ball

/// A lattice to be searched.
struct Level {
  double spacing;  ///< relative to the coarse one
  std::size_t max_points;
  bool is_wide;  ///< reaches further than those before it, for ways that are long
};
constexpr std::array<Level, 6> kLevels = {{{1.0, 4000, false},
                                           {0.5, 16000, false},
                                           {2.0, 8000, true},
                                           {1.0, 60000, true},
                                           {0.25, 60000, false},
                                           {0.125, 120000, false}}};
constexpr int kOftenRunOut = 2;  // lattices in a row from which on wider ones are searched
constexpr std::size_t kFirstCostlyLevel = 2;
constexpr std::size_t kFinestLevel = kLevels.size() - 1;

class Detour {
 public:
  Detour(const Problem& problem, Improvement& improvement, FreeSpace& space, std::uint64_t seed,
         const std::function<bool()>& is_hopeless, const collision::Deadline& deadline)
      : problem_(problem),
        improvement_(improvement),
        space_(space),
        seed_(seed),
        is_hopeless_(is_hopeless),
        deadline_(deadline),
        radius_m_(space.ball_radius_m()),
        from_(signed_pose_at(problem.path, problem.gap_begin_s())),
        to_(signed_pose_at(problem.path, problem.gap_end_s())) {
    for (const motion::Pose& pose : poses_as_interpolated(kLegsAsInterpolated))
      about_W_.push_back(space_.center_W(pose));
  }

  std::optional<Candidate> run(Search search) {
    if (search == Search::kTurning) return with_turns();
    return with_ball(0, space_.may_turn() ? kFinestLevel - 1 : kFinestLevel);
  }

 private:
  std::optional<Candidate> follow(const Guide& guide, Turning turning) {
    if (guide.empty()) return std::nullopt;
    turning_ = turning;
    // A lattice guide keeps away from the scene; a shortened one turns around corners.
    for (const int count : kCoarse) {
      if (std::optional<Candidate> found = drawn(guide, count)) return found;
    }
    const Guide fine = divided(guide);
    for (const double margin : kMargins) {
      const Guide direct = shortened(fine, space_, margin * radius_m_);
      for (const int count : kFine) {
        if (deadline_.passed()) return std::nullopt;
        if (std::optional<Candidate> found = drawn(direct, count)) return found;
      }
      if (std::optional<Candidate> found = refined(direct)) return found;
    }
    return std::nullopt;
  }

  // Adds finer rows of bumps only where the coarse row collides.
  std::optional<Candidate> refined(const Guide& guide) {
    motion::KnotRow knots = problem_.knots(kFine.back());
    if (!knots.fits()) return std::nullopt;
    const TimedGuide timed(problem_.path, guide, knots.begin_s, knots.end_s, space_);
    const std::optional<Offsets> offsets = offsets_on(problem_.path, timed, knots);
    if (!offsets) return std::nullopt;
    std::vector<motion::BumpRow> rows = {bumps_for(*offsets, Ends::kFixed)};
    for (int i = 0; i < kMostRefinements && !deadline_.passed(); ++i) {
      Attempt tried = attempt(problem_, rows, space_, deadline_);
      if (tried.candidate) return std::move(tried.candidate);
      const double at_s = 0.5 * (tried.collision->t_begin_s + tried.collision->t_end_s);
      knots.count = 2 * finest_at(rows, at_s);
      if (knots.count > kFinest || !knots.fits()) return std::nullopt;
      const std::optional<Offsets> rest =
          offsets_on(motion::with_bumps(problem_.path, rows), timed, knots);
      if (!rest) return std::nullopt;
      rows.push_back(part_of(*rest, *tried.collision));
      if (rows.back().bumps.empty()) return std::nullopt;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Offsets> offsets_on(const motion::CubicPath& path,
                                                  const TimedGuide& timed,
                                                  const motion::KnotRow& knots) const {
    return offsets_to(path, problem_.original, timed, knots, turning_, space_);
  }

  [[nodiscard]] static int finest_at(const std::vector<motion::BumpRow>& rows, double time_s) {
    int finest = kFine.back();
    for (const motion::BumpRow& row : rows) {
      if (row.begin_s() < time_s && time_s < row.end_s())
        finest = std::max(finest, row.knots.count);
    }
    return finest;
  }

  [[nodiscard]] static motion::BumpRow part_of(const Offsets& offsets,
                                               const collision::CollisionInterval& about) {
    const motion::KnotRow& knots = offsets.knots;
    const auto knot_before = [&](double time_s) {
      return static_cast<int>(std::floor((time_s - knots.begin_s) / knots.spacing_s()));
    };
    motion::BumpRow row{knots, std::max(2, knot_before(about.t_begin_s) - 2), {}};
    const int last = std::min(knots.count - 2, knot_before(about.t_end_s) + 3);
    for (int k = row.first; k <= last; ++k) row.bumps.push_back(offsets(k));
    return row;
  }

  std::optional<Candidate> drawn(const Guide& guide, int count) {
    const motion::KnotRow knots = problem_.knots(count);
    if (!knots.fits()) return std::nullopt;
    const TimedGuide timed(problem_.path, guide, knots.begin_s, knots.end_s, space_);
    const std::optional<Offsets> offsets = offsets_on(problem_.path, timed, knots);
    if (!offsets) return std::nullopt;
    for (const Ends ends : {Ends::kFree, Ends::kFixed}) {
      std::optional<Candidate> found = tried(*offsets, ends);
      if (found) return improved(*offsets, ends, std::move(*found));
    }
    return std::nullopt;
  }

  // Halves the number of knots while the path stays free, which makes it smoother, then relaxes it.
  Candidate improved(Offsets offsets, Ends ends, Candidate found) {
    while (offsets.knots.count % 2 == 0 && offsets.knots.count >= 2 * kCoarse.front()) {
      Offsets half = with_every_other_knot(offsets);
      std::optional<Candidate> coarser = tried(half, ends);
      if (!coarser) break;
      offsets = std::move(half);
      found = std::move(*coarser);
    }
    return relaxed(problem_, {std::move(offsets), std::move(found)}, ends, improvement_, space_,
                   deadline_)
        .candidate;
  }

  static Offsets with_every_other_knot(const Offsets& offsets) {
    Offsets half{offsets.knots, offsets.first / 2, {}};
    half.knots.count /= 2;
    for (int k = half.first; 2 * k <= offsets.last(); ++k) half.at.push_back(offsets(2 * k));
    return half;
  }

  std::optional<Candidate> tried(const Offsets& offsets, Ends ends) {
    return attempt(problem_, {bumps_for(offsets, ends)}, space_, deadline_).candidate;
  }

  // Detours with room for every orientation. The finest lattice comes last: detours that need it
  // mostly need turning as well.
  std::optional<Candidate> with_ball(std::size_t first_level, std::size_t last_level) {
    const std::optional<SignedPose> begin = escape(from_, radius_m_);
    const std::optional<SignedPose> end = escape(to_, radius_m_);
    if (!begin || !end) return std::nullopt;
    // Any orientation fits in the ball. With an orientation policy take the path's own.
    const Turning turning = is_limited(space_.policy()) ? Turning::kAsPath : Turning::kAsGuide;
    std::optional<Candidate> candidate;
    for_each_way({radius_m_, center_W(*begin), center_W(*end)}, first_level, last_level,
                 [&](const std::vector<Vec3>& way_W) {
                   candidate = follow(oriented(way_W, *begin, *end), turning);
                   return candidate.has_value();
                 });
    return candidate;
  }

  // Detours on which the body must turn: narrow passages and trees along the way of a smaller ball.
  // The smallest ball comes first: if it has no way, the others have none.
  std::optional<Candidate> with_turns() {
    for (const double share : kBallShares) {
      if (deadline_.passed()) return std::nullopt;
      const CellResult ball = cells_for_ball(share * radius_m_);
      if (ball.pocket && share == kBallShares.front()) {
        if (problem_.pocket != nullptr) *problem_.pocket = ball.pocket;
        return std::nullopt;
      }
      const std::vector<Vec3>& way_W = ball.way_W;
      if (way_W.empty()) break;
      if (auto found = follow(threaded(way_W), Turning::kAsGuide)) return found;
      const Guide guide = tree_way(space_, from_, to_, tree_about(way_W), deadline_);
      if (auto found = follow(guide, Turning::kAsGuide)) return found;
    }
    return with_ball(kFinestLevel, kFinestLevel);
  }

  [[nodiscard]] TreeOptions tree_about(std::vector<Vec3> way_W) const {
    TreeOptions options;
    options.margin_m = 0.5 * kLeastMargin * radius_m_;
    options.about_W = std::move(way_W);
    options.reach_m = 2.0 * radius_m_;
    options.seed = seed_;
    options.largest_turn_rad =
        std::min(options.largest_turn_rad, kAimedShare * space_.policy().max_turn_rad);
    options.interpolated = poses_as_interpolated(kPosesAsInterpolated);
    options.effort = problem_.effort;
    return options;
  }

  /// A guide by straight motions through the narrow places of `way_W`, and by trees between them.
  /// Empty if none was found.
  Guide threaded(const std::vector<Vec3>& way_W) {
    const std::vector<NarrowPassage> passages =
        narrow_passages(space_, way_W, from_, to_, 0.5 * kLeastMargin * radius_m_, deadline_);
    if (passages.empty()) return {};
    Guide guide = {from_};
    std::size_t begin = 0;
    for (const NarrowPassage& passage : passages) {
      if (!joined(guide, passage.before, way_W, begin, passage.first)) return {};
      guide.push_back(passage.after);
      begin = passage.last;
    }
    return joined(guide, to_, way_W, begin, way_W.size() - 1) ? guide : Guide{};
  }

  /// Extends the guide from its end to `pose`, along a part of `way_W`. Returns whether that
  /// succeeded.
  bool joined(Guide& guide, const SignedPose& pose, const std::vector<Vec3>& way_W,
              std::size_t first, std::size_t last) {
    std::vector<Vec3> about_W = {center_W(guide.back())};
    for (std::size_t i = first; i <= last; ++i) about_W.push_back(way_W[i]);
    about_W.push_back(center_W(pose));
    TreeOptions options = tree_about(std::move(about_W));
    options.max_samples = kJoiningSamples;
    const Guide part = tree_way(space_, guide.back(), pose, options, deadline_);
    if (part.empty()) return false;
    guide.insert(guide.end(), part.begin() + 1, part.end());
    return true;
  }

  [[nodiscard]] std::vector<motion::Pose> poses_as_interpolated(int steps) const {
    std::vector<motion::Pose> poses;
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      poses.push_back(
          problem_.original.pose(std::lerp(problem_.gap_begin_s(), problem_.gap_end_s(), share)));
    }
    return poses;
  }

  CellResult cells_for_ball(double ball_radius_m) {
    const std::optional<SignedPose> begin = escape(from_, ball_radius_m);
    const std::optional<SignedPose> end = escape(to_, ball_radius_m);
    if (!begin || !end) return {};
    const CellOptions options{ball_radius_m, kSmallestCell * radius_m_, kMostCells, radius_m_};
    CellResult found = cell_way(space_, center_W(*begin), center_W(*end), options, deadline_);
    count_points(found.cells);
    if (found.way_W.empty()) return found;
    found.way_W.insert(found.way_W.begin(), center_W(from_));
    found.way_W.push_back(center_W(to_));
    return found;
  }

  void count_points(std::size_t points) const {
    if (problem_.effort != nullptr)
      problem_.effort->lattice_points += static_cast<std::int32_t>(points);
  }

  struct Ball {
    double radius_m;
    Vec3 from_W;
    Vec3 to_W;
  };

  // Searches finer and finer lattices until `use` of a way succeeds. Where the point limit ended a
  // search, wider lattices follow, as the way may be much longer than the distance of its ends.
  template <class Use>
  void for_each_way(const Ball& ball, std::size_t first_level, std::size_t last_level,
                    const Use& use) {
    bool from_end = false;
    int times_run_out = 0;
    for (std::size_t i = first_level; i <= last_level && !deadline_.passed(); ++i) {
      const Level& level = kLevels[i];
      if (i == kFirstCostlyLevel && is_hopeless_()) return;
      if (level.is_wide && times_run_out < kOftenRunOut) continue;
      const LatticeResult found = searched(ball, level, from_end);
      if (!found.way_W.empty() && use(found.way_W)) return;
      if (level.is_wide || from_end || !found.way_W.empty() || found.exhausted) continue;
      if (++times_run_out != kOftenRunOut) continue;
      // If less is reachable from the other end, this search finds a way or ends quickly.
      const LatticeResult back = searched(ball, level, true);
      if (!back.way_W.empty() && use(back.way_W)) return;
      from_end = back.exhausted;
      if (from_end) times_run_out = 0;
    }
  }

  [[nodiscard]] LatticeResult searched(const Ball& ball, const Level& level, bool from_end) const {
    const double coarse_m = std::max(ball.radius_m, (ball.to_W - ball.from_W).norm() / 8.0);
    LatticeOptions options{ball.radius_m, level.spacing * coarse_m, level.max_points};
    // Preferring the reference path expands more nodes, and wide lattices search far from it
    // anyway.
    if (!level.is_wide) options.about_W = about_W_;
    LatticeResult found = lattice_way(space_, from_end ? ball.to_W : ball.from_W,
                                      from_end ? ball.from_W : ball.to_W, options, deadline_);
    count_points(found.points);
    if (from_end) std::ranges::reverse(found.way_W);
    return found;
  }

  [[nodiscard]] Vec3 center_W(const SignedPose& pose) const {
    return space_.center_W(motion::unsigned_pose(pose));
  }

  /// Returns a pose with the same orientation, reached by a free straight motion, at which the ball
  /// is free.
  std::optional<SignedPose> escape(const SignedPose& pose, double ball_radius_m) {
    const Vec3 middle_W = center_W(pose);
    const double comfort_m = 0.1 * radius_m_;
    if (space_.ball_gap_m(middle_W, ball_radius_m, comfort_m) > 0.0) return pose;
    for (const double share : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0}) {
      for (int code = 0; code < 27; ++code) {
        if (code == 13) continue;
        const Vec3 step =
            Vec3(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).normalized() * (share * radius_m_);
        if (!(space_.ball_gap_m(middle_W + step, ball_radius_m, comfort_m) > 0.0)) continue;
        const SignedPose there{pose.position + step, pose.orientation};
        if (!space_.first_hit(pose, there, 0.0)) return there;
      }
    }
    return std::nullopt;
  }

  /// Gives `way_W` the path's orientations at equal shares of the way and of the time.
  Guide oriented(const std::vector<Vec3>& way_W, const SignedPose& begin, const SignedPose& end) {
    double length_m = 0.0;
    for (std::size_t i = 1; i < way_W.size(); ++i) length_m += (way_W[i] - way_W[i - 1]).norm();
    Guide guide = {from_};
    double so_far_m = 0.0;
    for (std::size_t i = 0; i < way_W.size(); ++i) {
      if (i > 0) so_far_m += (way_W[i] - way_W[i - 1]).norm();
      const double share = length_m > 0.0 ? so_far_m / length_m : 0.0;
      const double time_s =
          std::lerp(problem_.gap_begin_s(), problem_.gap_end_s(), std::clamp(share, 0.0, 1.0));
      const geometry::Vec4 q = signed_pose_at(problem_.path, time_s).orientation;
      guide.push_back({space_.pose_around(way_W[i], geometry::from_wxyz(q)).position, q});
    }
    guide[1] = begin;
    guide.back() = end;
    guide.push_back(to_);
    return guide;
  }

  /// Divides long motions, so that `shortened` can skip parts of them.
  Guide divided(const Guide& guide) const {
    Guide result = {guide.front()};
    for (std::size_t i = 1; i < guide.size(); ++i) {
      const double length_m = space_.distance_m(guide[i - 1], guide[i]);
      const int parts =
          std::clamp(static_cast<int>(std::ceil(length_m / (kLongestStep * radius_m_))), 1, 64);
      for (int k = 1; k < parts; ++k) {
        result.push_back(motion::between(guide[i - 1], guide[i], static_cast<double>(k) / parts));
      }
      result.push_back(guide[i]);
    }
    return result;
  }

  const Problem& problem_;
  Improvement& improvement_;
  FreeSpace& space_;
  const std::uint64_t seed_;
  const std::function<bool()>& is_hopeless_;
  const collision::Deadline& deadline_;
  const double radius_m_;
  Turning turning_ = Turning::kAsGuide;
  const SignedPose from_;
  const SignedPose to_;
  std::vector<Vec3> about_W_;  ///< centre of the body along the interpolated path
};

}  // namespace

std::optional<Candidate> go_round(const Problem& problem, Search search, Improvement& improvement,
                                  FreeSpace& space, std::uint64_t seed,
                                  const std::function<bool()>& is_hopeless,
                                  const collision::Deadline& deadline) {
  return Detour(problem, improvement, space, seed, is_hopeless, deadline).run(search);
}

}  // namespace camway::correction
