// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/redraw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "daemon/collision/clearance.h"
#include "daemon/collision/detect.h"
#include "daemon/correction/path/closeness.h"
#include "daemon/correction/path/viewing_distance.h"
#include "daemon/correction/smoothing/contact_bounds.h"
#include "tests/support/gap_problems.h"
#include "tests/support/scenes.h"

namespace camway::correction {
namespace {

using base::Deadline;
using geometry::Vec3;
using motion::CubicPath;
using testing::Draw;

// Bound on the rounding of some hundred sums of coordinates and angles up to 20.
constexpr double kRedrawRounding = 1e-12;
constexpr int kDense = 40;  // knots of the corrections before they are drawn again

/// A tour over blocks, corrected by hills on many knots.
struct Case {
  scene::Mesh mesh;
  scene::SceneIndex index;
  motion::Body body{testing::small_camera()};
  std::vector<motion::Keyframe> keyframes;
  CubicPath interpolated;
  std::vector<collision::CollisionInterval> collisions;

  [[nodiscard]] collision::Query query() const { return {collision::Obstacles(index), body, {}}; }
};

/// `blocks[i]` stands in the interval i.
Case tour_over(Draw& draw, const std::vector<bool>& blocks) {
  Case c;
  double time_s = 0.0;
  Vec3 place(0, 0, 0);
  const auto stop = [&] { c.keyframes.push_back({time_s, {place, geometry::Quat::Identity()}}); };
  stop();
  for (const bool is_blocked : blocks) {
    const double length_m = draw.uniform(3.0, 6.0);
    if (is_blocked) {
      const double z = place.z() - draw.uniform(0.4, 0.6) * length_m;
      testing::add_cuboid(c.mesh, {-3, -9, z - 0.3}, {3, draw.uniform(0.0, 0.3), z + 0.3});
    }
    place.z() -= length_m;
    time_s += draw.uniform(3.0, 6.0);
    stop();
  }
  c.index = scene::SceneIndex::build(c.mesh);
  c.interpolated = motion::interpolate_cubic(c.keyframes);
  c.collisions =
      collision::detect_collisions(c.query(), c.interpolated.path(), 0.0, time_s, Deadline::never())
          .value();
  return c;
}

/// Lifts the path over the collision by a hill with a wrinkle, on many knots.
std::optional<Candidate> hill_over(Draw& draw, const Problem& problem, const FreeSpace& space) {
  Offsets offsets{problem.knots(kDense), 1, {}};
  const double height_m = draw.uniform(0.9, 1.2);
  for (int k = 1; k < kDense; ++k) {
    const double share = std::sin(std::numbers::pi * k / kDense);
    offsets.at.push_back(
        {{0.05 * draw.uniform(0.0, share), height_m * share, 0}, geometry::Vec4::Zero()});
  }
  return attempt(problem, {bumps_for(offsets, Ends::kFixed)}, space, Deadline::never()).candidate;
}

class RedrawTest : public ::testing::Test {
 protected:
  /// Corrects all collisions, but for those in the intervals `open`, and draws them again.
  void run(Draw& draw, const std::vector<bool>& blocks, const std::vector<bool>& open) {
    c_ = tour_over(draw, blocks);
    const Deadline never = Deadline::never();
    const Closeness closeness =
        closeness_of(c_.interpolated, FreeSpace(c_.query(), OrientationPolicy{}), 3.0);
    FreeSpace space(c_.query(), OrientationPolicy{}, closeness);
    CorrectedPath corrected(c_.interpolated, c_.keyframes, {1000, 0.0}, never);
    CollisionList list(c_.collisions, corrected.keyframes_s());
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::size_t leg = list[i].leg;
      if (open[leg] || !list[i].is_open()) continue;
      Problem problem = corrected.part_about(leg, {}, space.ball_radius_m());
      problem.interval = list[i].correction.interval;
      const std::optional<Candidate> hill = hill_over(draw, problem, space);
      ASSERT_TRUE(hill && corrected.take(*hill));
      const auto [begin_s, end_s] = corrected.range_of(*hill);
      list[i].correction = {list[i].correction.interval, CorrectionKind::kMove, begin_s, end_s};
    }
    const CubicPath before = corrected.path();
    inserted_before_ = corrected.inserted_s().size();
    redraw(std::vector(corrected.changed_parts()), {}, space, corrected, list);
    inserted_after_ = corrected.inserted_s().size();
    cost_before_ = closeness_cost(before, c_.interpolated, closeness);
    cost_after_ = closeness_cost(corrected.path(), c_.interpolated, closeness);
    path_ = corrected.path();
    wanted_m_ = ContactBounds(Objective::kClosest, space.ball_radius_m(), 3.0).wanted_m();
    corrections_ = list.corrections();
  }

  [[nodiscard]] std::vector<collision::CollisionInterval> collisions() const {
    return collision::detect_collisions(c_.query(), path_.path(), path_.begin_s(), path_.end_s(),
                                        Deadline::never())
        .value();
  }

  [[nodiscard]] double clearance_m() const {
    return collision::path_clearance(c_.query().obstacles, path_.path(), c_.body, Deadline::never())
        ->lower_bound_m;
  }

  Case c_;
  CubicPath path_;
  double wanted_m_ = 0.0;  ///< gap at which relaxation aims
  std::vector<Correction> corrections_;
  std::size_t inserted_before_ = 0;
  std::size_t inserted_after_ = 0;
  double cost_before_ = 0.0;
  double cost_after_ = 0.0;
};

TEST_F(RedrawTest, DrawsOnFewKnotsWhatWasDrawnOnMany) {
  Draw draw(7601);
  std::size_t blocked = 0;
  std::size_t inserted = 0;
  double clearances_m = 0.0;
  for (int i = 0; i < 12; ++i) {
    const std::vector<bool> blocks = {i % 3 != 0, i % 3 != 1, i % 3 != 2};
    run(draw, blocks, {false, false, false});
    if (HasFatalFailure()) return;
    EXPECT_TRUE(collisions().empty());
    EXPECT_LT(cost_after_, cost_before_);
    blocked += 2;
    inserted += inserted_after_;
    EXPECT_LT(inserted_after_, inserted_before_ / 4);
    clearances_m += clearance_m();
    for (const motion::Keyframe& keyframe : c_.keyframes) {
      EXPECT_EQ(path_.pose(keyframe.time_s).position, keyframe.pose.position);
    }
    EXPECT_LT((path_.path()
                   .pose(0.5 * path_.end_s())
                   .orientation.angularDistance(geometry::Quat::Identity())),
              kRedrawRounding)
        << "it turns nothing";
  }
  EXPECT_LT(inserted, 8 * blocked);
  // Before room is made, it is less than 0.4 of it.
  EXPECT_GT(clearances_m, 0.5 * 12 * wanted_m_);
}

// A part that is the whole path cannot become longer.
TEST_F(RedrawTest, RelaxesDearPartsThatAreAsLongAsTheyMayBe) {
  Draw draw(7605);
  double before = 0.0;
  double after = 0.0;
  for (int i = 0; i < 12; ++i) {
    run(draw, std::vector<bool>(4, true), std::vector<bool>(4, false));
    if (HasFatalFailure()) return;
    before += cost_before_;
    after += cost_after_;
  }
  // Without, 0.036 of the cost is left.
  EXPECT_LT(after, 0.02 * before);
}

TEST_F(RedrawTest, TellsWhatIsChangedAfterwards) {
  Draw draw(7602);
  for (int i = 0; i < 6; ++i) {
    run(draw, {true, false, true}, {false, false, false});
    if (HasFatalFailure()) return;
    for (double time_s = path_.begin_s(); time_s < path_.end_s(); time_s += 0.01) {
      const bool is_told = std::ranges::any_of(corrections_, [&](const Correction& correction) {
        return correction.t_begin_s <= time_s && time_s <= correction.t_end_s;
      });
      const double moved_m =
          (path_.at(time_s).position - c_.interpolated.at(time_s).position).norm();
      if (!is_told) {
        ASSERT_LT(moved_m, kRedrawRounding) << time_s;
      }
    }
  }
}

// A low block just touches the path where the row begins, so that a shorter row is nearer to the
// path and would collide with it.
TEST(Redraw, KeepsTheBeginningOfAPartFree) {
  Draw draw(7604);
  const double half_m = std::tan(testing::small_camera().fov_y_rad / 2.0) * 0.1;
  int redrawn = 0;
  for (int run = 0; run < 300; ++run) {
    Case c;
    const double low_z = -draw.uniform(0.9, 2.5);
    testing::add_cuboid(c.mesh, {-3, -9, low_z - 0.1},
                        {3, draw.uniform(0.001, 0.004) - half_m, low_z});
    testing::add_cuboid(c.mesh, {-3, -9, -6.2}, {3, draw.uniform(0.1, 0.3), -5.8});
    for (const double time_s : {0.0, 8.0}) {
      c.keyframes.push_back({time_s, {{0, 0, -time_s}, geometry::Quat::Identity()}});
    }
    c.index = scene::SceneIndex::build(c.mesh);
    c.interpolated = motion::interpolate_cubic(c.keyframes);
    c.collisions =
        collision::detect_collisions(c.query(), c.interpolated.path(), 0.0, 8.0, Deadline::never())
            .value();
    ASSERT_GE(c.collisions.size(), 2u);
    const Deadline never = Deadline::never();
    FreeSpace space(c.query(), OrientationPolicy{},
                    closeness_of(c.interpolated, FreeSpace(c.query(), OrientationPolicy{}), 3.0));
    CorrectedPath corrected(c.interpolated, c.keyframes, {1000, 0.0}, never);
    CollisionList list(c.collisions, corrected.keyframes_s());
    const Problem problem = corrected.part_about(0, {}, space.ball_radius_m());
    Offsets offsets{{draw.uniform(0.3, 0.7), 7.6, kDense}, 1, {}};
    for (int k = 1; k < kDense; ++k) {
      const double away = 1.5 * (offsets.knots.knot_s(k) - 6.0);
      offsets.at.push_back({{0, 0.006 + 1.2 * std::exp(-away * away), 0}, geometry::Vec4::Zero()});
    }
    const std::optional<Candidate> hills =
        attempt(problem, {bumps_for(offsets, Ends::kFixed)}, space, never).candidate;
    if (!hills) continue;  // it begins too late
    ASSERT_TRUE(corrected.take(*hills)) << run;
    const auto [begin_s, end_s] = corrected.range_of(*hills);
    for (std::size_t i = 0; i < list.size(); ++i) {
      list[i].correction = {list[i].correction.interval, CorrectionKind::kMove, begin_s, end_s};
    }
    const std::size_t before = corrected.inserted_s().size();
    redraw(std::vector(corrected.changed_parts()), {}, space, corrected, list);
    redrawn += corrected.inserted_s().size() < before ? 1 : 0;
    EXPECT_TRUE(
        collision::detect_collisions(c.query(), corrected.path().path(), 0.0, 8.0, never)->empty())
        << run;
  }
  EXPECT_GT(redrawn, 150);
}

TEST_F(RedrawTest, LeavesOpenCollisionsAsTheyAre) {
  Draw draw(7603);
  for (int i = 0; i < 6; ++i) {
    run(draw, {true, true, true}, {false, true, false});
    if (HasFatalFailure()) return;
    const std::vector<collision::CollisionInterval> left = collisions();
    ASSERT_FALSE(left.empty());
    for (const collision::CollisionInterval& interval : left) {
      EXPECT_GT(interval.t_begin_s, c_.keyframes[1].time_s);
      EXPECT_LT(interval.t_end_s, c_.keyframes[2].time_s);
    }
    const CubicPath now = path_.around(c_.keyframes[1].time_s, c_.keyframes[2].time_s);
    const CubicPath before = c_.interpolated.around(c_.keyframes[1].time_s, c_.keyframes[2].time_s);
    ASSERT_EQ(now.pieces.size(), before.pieces.size());
    for (std::size_t k = 0; k < now.pieces.size(); ++k) {
      EXPECT_EQ(now.pieces[k].position, before.pieces[k].position);
      EXPECT_EQ(now.pieces[k].image, before.pieces[k].image);
    }
  }
}

}  // namespace
}  // namespace camway::correction
