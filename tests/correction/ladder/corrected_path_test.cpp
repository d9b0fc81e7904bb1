// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/corrected_path.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "daemon/motion/spline/interpolate.h"

namespace camway::correction {
namespace {

using motion::BumpRow;
using motion::CubicPath;
using motion::KnotRow;

std::vector<motion::Keyframe> straight_keyframes() {
  std::vector<motion::Keyframe> keyframes;
  for (const double time_s : {0.0, 10.0, 20.0, 30.0}) {
    keyframes.push_back({time_s, {{time_s, 0, 0}, geometry::Quat::Identity()}});
  }
  return keyframes;
}

class CorrectedPathTest : public ::testing::Test {
 protected:
  [[nodiscard]] CorrectedPath with_limit(int most) const {
    return {interpolated_, keyframes_, {most, /*rest_s_per_piece=*/0.0}, never_};
  }

  // A candidate with one bump of this height, whose peak is at `peak_s`.
  [[nodiscard]] static Candidate bump(const CorrectedPath& corrected, double peak_s,
                                      double height_m) {
    const motion::CubicPoint peak{{0, height_m, 0}, geometry::Vec4::Zero()};
    const std::vector<BumpRow> rows = {{KnotRow::about(peak_s, 1.0, nullptr), 2, {peak}}};
    return {motion::with_bumps(corrected.path(), rows), rows};
  }

  const base::Deadline never_ = base::Deadline::never();
  const std::vector<motion::Keyframe> keyframes_ = straight_keyframes();
  const CubicPath interpolated_ = motion::interpolate_cubic(keyframes_);
};

TEST_F(CorrectedPathTest, TakesCandidatesUpToTheLimitAndCountsTheRest) {
  CorrectedPath corrected = with_limit(10);
  EXPECT_TRUE(corrected.take(bump(corrected, 5.0, 0.5)));
  EXPECT_TRUE(corrected.take(bump(corrected, 15.0, 0.5)));
  EXPECT_FALSE(corrected.needed_keyframes());
  const Candidate third = bump(corrected, 25.0, 0.5);
  const double before_m = corrected.path().at(25.0).position.y();
  EXPECT_FALSE(corrected.take(third));
  EXPECT_EQ(corrected.path().at(25.0).position.y(), before_m);
  corrected.count_refused(third);
  EXPECT_EQ(corrected.needed_keyframes(), 15u);
  EXPECT_EQ(corrected.inserted_s(), (std::vector<double>{3, 4, 5, 6, 7, 13, 14, 15, 16, 17}));
}

TEST_F(CorrectedPathTest, CountsAKnotThatIsThereAlreadyOnce) {
  CorrectedPath corrected = with_limit(5);
  EXPECT_TRUE(corrected.take(bump(corrected, 5.0, 0.5)));
  EXPECT_TRUE(corrected.take(bump(corrected, 5.0, 0.2)));
  EXPECT_FALSE(corrected.take(bump(corrected, 6.0, 0.2)));
  EXPECT_EQ(corrected.inserted_s().size(), 5u);
}

TEST_F(CorrectedPathTest, CountsNoGivenKeyframe) {
  CorrectedPath corrected = with_limit(4);
  EXPECT_TRUE(corrected.take(bump(corrected, 12.0, 0.5)));
  EXPECT_EQ(corrected.inserted_s(), (std::vector<double>{11, 12, 13, 14}));
}

TEST_F(CorrectedPathTest, RestoresBetweenKeyframesBitForBit) {
  CorrectedPath corrected = with_limit(20);
  ASSERT_TRUE(corrected.take(bump(corrected, 5.0, 0.5)));
  ASSERT_TRUE(corrected.take(bump(corrected, 15.0, 0.5)));
  const CorrectedPath both = corrected;
  corrected.restore(1, 2);
  ASSERT_EQ(corrected.changed_parts().size(), 1u);
  EXPECT_EQ(corrected.changed_parts()[0].end_s, 7.0);
  EXPECT_EQ(corrected.inserted_s(), (std::vector<double>{3, 4, 5, 6, 7}));
  for (const motion::CubicPiece& piece : interpolated_.around(10.0, 20.0).pieces) {
    const CubicPath is = corrected.path().around(piece.t0_s, piece.t1_s);
    ASSERT_EQ(is.pieces.size(), 1u);
    EXPECT_EQ(is.pieces[0].position, piece.position);
  }
  CorrectedPath copy = both;
  corrected.adopt(std::move(copy));
  EXPECT_EQ(corrected.changed_parts().size(), 2u);
  EXPECT_EQ(corrected.inserted_s(), both.inserted_s());
}

TEST_F(CorrectedPathTest, APartHasTheIntervalAndItsNeighbours) {
  const CorrectedPath corrected = with_limit(1);
  const Problem first = corrected.part_about(0, {}, 0.1);
  EXPECT_EQ(first.leg, 0u);
  EXPECT_TRUE(first.has_path_begin);
  EXPECT_FALSE(first.has_path_end);
  EXPECT_EQ(first.keyframes_s, (std::vector<double>{0.0, 10.0, 20.0}));
  const Problem middle = corrected.part_about(1, {}, 0.1);
  EXPECT_EQ(middle.leg, 1u);
  EXPECT_EQ(middle.leg_begin_s(), 10.0);
  EXPECT_EQ(middle.leg_end_s(), 20.0);
  EXPECT_EQ(middle.path.begin_s(), 0.0);
  EXPECT_EQ(middle.path.end_s(), 30.0);
}

TEST_F(CorrectedPathTest, JoinsChangesThatOverlap) {
  CorrectedPath corrected = with_limit(100);
  EXPECT_TRUE(corrected.take(bump(corrected, 15.0, 0.5)));
  EXPECT_TRUE(corrected.take(bump(corrected, 5.0, 0.5)));
  ASSERT_EQ(corrected.changed_parts().size(), 2u);
  EXPECT_EQ(corrected.changed_parts()[0].end_s, 7.0);
  EXPECT_TRUE(corrected.take(bump(corrected, 9.0, 0.5)));
  ASSERT_EQ(corrected.changed_parts().size(), 3u) << "they meet in a point";
  EXPECT_TRUE(corrected.take(bump(corrected, 8.0, 0.5)));
  ASSERT_EQ(corrected.changed_parts().size(), 2u);
  EXPECT_EQ(corrected.changed_parts()[0].end_s, 11.0);
  EXPECT_TRUE(corrected.take(bump(corrected, 12.0, 0.5)));
  ASSERT_EQ(corrected.changed_parts().size(), 1u);
  EXPECT_EQ(corrected.changed_parts()[0].begin_s, 3.0);
  EXPECT_EQ(corrected.changed_parts()[0].end_s, 17.0);
  EXPECT_FALSE(corrected.changed_parts()[0].turns);
}

TEST_F(CorrectedPathTest, RestoresOneChangedPartAndKeepsTheOthersBitForBit) {
  CorrectedPath corrected = with_limit(100);
  EXPECT_TRUE(corrected.take(bump(corrected, 3.0, 0.5)));
  EXPECT_TRUE(corrected.take(bump(corrected, 8.0, 0.4)));
  const Problem problem = corrected.restored(corrected.changed_parts()[1], {}, 0.1);
  EXPECT_EQ(problem.keyframes_s, (std::vector<double>{0.0, 10.0}));
  std::vector<double> knots_s;
  for (const motion::CubicPiece& piece : problem.path.pieces) knots_s.push_back(piece.t0_s);
  EXPECT_EQ(knots_s, (std::vector<double>{0, 1, 2, 3, 4, 5})) << "none of the second part";
  for (double time_s = 0.0; time_s <= 10.0; time_s += 0.125) {
    const CubicPath& kept = time_s <= 5.0 ? corrected.path() : interpolated_;
    const geometry::Vec3 difference = problem.path.at(time_s).position - kept.at(time_s).position;
    EXPECT_LE(difference.norm(), time_s <= 5.0 ? 0.0 : 1e-14) << time_s;
  }
  for (std::size_t i = 1; i < problem.path.pieces.size(); ++i) {
    EXPECT_EQ(problem.path.pieces[i - 1].position[3], problem.path.pieces[i].position[0]);
  }
}

TEST_F(CorrectedPathTest, WidensAPartUpToOtherPartsAndTheEndsOfThePath) {
  CorrectedPath corrected = with_limit(100);
  EXPECT_TRUE(corrected.take(bump(corrected, 3.0, 0.5)));
  EXPECT_TRUE(corrected.take(bump(corrected, 8.0, 0.5)));
  EXPECT_TRUE(corrected.take(bump(corrected, 16.0, 0.5)));
  const std::vector<ChangedPart> parts = corrected.changed_parts();  // 1-5, 6-10, 14-18
  const auto range_of = [&](std::size_t i, double share) {
    const ChangedPart wide = corrected.widened(parts[i], share);
    return std::pair(wide.begin_s, wide.end_s);
  };
  EXPECT_EQ(range_of(1, 0.125), std::pair(5.5, 10.5));
  EXPECT_EQ(range_of(1, 0.5), std::pair(5.0, 12.0));
  EXPECT_EQ(range_of(1, 3.0), std::pair(5.0, 14.0));
  EXPECT_EQ(range_of(0, 0.5), std::pair(0.0, 6.0));
  const Problem problem = corrected.restored(corrected.widened(parts[2], 0.9), {}, 0.1);
  EXPECT_EQ(problem.keyframes_s, (std::vector<double>{10.0, 20.0, 30.0}));
  for (double time_s = 10.0; time_s <= 30.0; time_s += 0.125) {
    const geometry::Vec3 difference =
        problem.path.at(time_s).position - interpolated_.at(time_s).position;
    EXPECT_LE(difference.norm(), 1e-14) << time_s;
  }
}

TEST_F(CorrectedPathTest, TakesACandidateInsteadOfAPart) {
  CorrectedPath corrected = with_limit(10);
  EXPECT_TRUE(corrected.take(bump(corrected, 5.0, 0.5)));
  EXPECT_TRUE(corrected.take(bump(corrected, 15.0, 0.4)));
  const ChangedPart part = corrected.changed_parts()[0];
  const Problem problem = corrected.restored(part, {}, 0.1);
  const motion::CubicPoint peak{{0, 0.3, 0}, geometry::Vec4::Zero()};
  const std::vector<BumpRow> rows = {{KnotRow::about(6.0, 1.0, nullptr), 2, {peak}}};
  EXPECT_TRUE(corrected.take_instead(part, {motion::with_bumps(problem.path, rows), rows}));
  EXPECT_EQ(corrected.inserted_s(), (std::vector<double>{4, 5, 6, 7, 8, 13, 14, 15, 16, 17}));
  EXPECT_DOUBLE_EQ(corrected.path().at(6.0).position.y(), 0.2);
  const std::vector<ChangedPart>& parts = corrected.changed_parts();
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].begin_s, 4.0);
  EXPECT_EQ(parts[0].end_s, 8.0);
}

TEST_F(CorrectedPathTest, RangesOfCandidatesEndWithThePath) {
  const CorrectedPath corrected = with_limit(9);
  const auto [begin_s, end_s] = corrected.range_of(bump(corrected, 15.0, 0.5));
  EXPECT_DOUBLE_EQ(begin_s, 13.0);
  EXPECT_DOUBLE_EQ(end_s, 17.0);
  EXPECT_EQ(corrected.range_of(bump(corrected, 29.0, 0.5)).second, 30.0);
}

TEST_F(CorrectedPathTest, MarksIntervalsThatOverlapInMoreThanAnEnd) {
  const CorrectedPath corrected = with_limit(1);
  std::vector<bool> legs(3);
  corrected.mark_legs(10.0, 20.0, legs);
  EXPECT_EQ(legs, (std::vector<bool>{false, true, false}));
  corrected.mark_legs(19.0, 21.0, legs);
  EXPECT_EQ(legs, (std::vector<bool>{false, true, true}));
}

}  // namespace
}  // namespace camway::correction
