// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/sentences.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "daemon/planning/stages/keyframe_faults.h"
#include "tests/support/random.h"

namespace camway::planning {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A lower bound must remain one when it is rounded.
TEST(Sentences, LowerBoundsAreRoundedDown) {
  EXPECT_EQ(rounded_down(0.0042799), "0.00427");
  EXPECT_EQ(rounded_down(0.31299999), "0.312");
  EXPECT_EQ(rounded_down(99.999), "99.9");
  EXPECT_EQ(rounded_down(100.0), "100");
  EXPECT_EQ(rounded_down(0.0), "0");
  EXPECT_EQ(rounded_down(-1.0), "0");
  testing::Random random(11);
  std::uniform_real_distribution<double> exponent(-9.0, 2.0);
  for (int i = 0; i < 10'000; ++i) {
    const double value = std::pow(10.0, exponent(random));
    const double shown = std::stod(rounded_down(value));
    EXPECT_LE(shown, value);
    EXPECT_GT(shown, 0.98 * value) << "three digits";
  }
}

TEST(Sentences, NamesWhatWasTriedByWhatItWasFor) {
  EXPECT_EQ(effort_text({14, 1, 20000, 3000}),
            "14 directions to move or turn in, 1 changed path, 20000 places on a way round, 3000 "
            "poses on a way round that turns");
  EXPECT_EQ(effort_text({}), "");
}

TEST(Sentences, NamesKeyframesWithoutAWayOut) {
  using correction::ShutIn;
  EXPECT_EQ(note_of_shut_in({}, false), "");
  const ShutIn complete{1, {geometry::Vec3(0, 0, 0), geometry::Vec3(1, 2, 3)}, 0.0, true};
  const ShutIn cut_off{2, complete.region_W, 0.0, false};
  const std::string of_complete =
      "; keyframe 1 seems shut in: no way out of a region of 1 x 2 x 3 m about it was found";
  const std::string of_cut_off = "; no search found a way out of the place where keyframe 2 is";
  EXPECT_EQ(note_of_shut_in({complete}, false), of_complete);
  EXPECT_EQ(note_of_shut_in({cut_off}, false), of_cut_off);
  EXPECT_EQ(note_of_shut_in({complete, cut_off}, false), of_complete + of_cut_off);
  EXPECT_EQ(note_of_shut_in(std::vector<ShutIn>(6, cut_off), false),
            "; no search found a way out of the places where keyframes 2, 2, 2, 2, 2 and 1 more "
            "are");
}

TEST(Sentences, SaysWhyThereIsNoPath) {
  Infeasibility proof{2, 0, {3}};
  EXPECT_EQ(why_infeasible(proof, false),
            "no path exists: keyframe 2 is inside a closed surface of 1 triangle of the scene, "
            "keyframe 0 outside");
  correction::CageBox& cage = proof.cage.emplace();
  cage.box = geometry::Box(geometry::Vec3(0, 0, 0), geometry::Vec3(1, 2, 3.5));
  cage.shortest_chord_m = 0.123;
  EXPECT_EQ(why_infeasible(proof, false),
            "no path exists: keyframe 2 is inside a box of 1 x 2 x 3.5 m about (0.5, 1, 1.75) "
            "without holes, keyframe 0 outside");
  cage.widest_hole_m = 0.0849;
  EXPECT_THAT(why_infeasible(proof, false),
              HasSubstr("whose holes (0.0849 m at most) are too narrow for the camera's near "
                        "quadrilateral (0.123 m), keyframe 0"));
  EXPECT_THAT(why_infeasible(proof, true), HasSubstr("(0.123 m at its smallest)"));
}

TEST(NoteOfMethod, TellsThatKeyframeInsertionCorrectsCamerasAlone) {
  PlanRequest request;
  request.options.method = Method::kKeyframeInsertion;
  EXPECT_EQ(note_of_method(request), "");
  request.body = motion::Camera{1.2, 0.9, 0.1};
  EXPECT_EQ(note_of_method(request), "") << "a camera, too";
  request.body = motion::SphereShape{geometry::Vec3::Zero(), 0.5};
  EXPECT_THAT(note_of_method(request), HasSubstr("corrects paths of cameras alone"));
}

TEST(NoteOfTolerance, TellsTheSizeOfAnyBody) {
  PlanRequest request;
  const auto note_of = [&](double near_m) {
    return note_of_tolerance(request, motion::Body(motion::Camera{1.2, 0.9, near_m}));
  };
  EXPECT_EQ(note_of(0.1), "");
  EXPECT_THAT(note_of(0.001), HasSubstr("the body is 0.0014 m large"));
  EXPECT_THAT(note_of(1e-200), HasSubstr("the body is 1.4e-200 m large"))
      << "its square is no double";
  EXPECT_THAT(note_of(1e-320), HasSubstr("the body is 1.4e-320 m large"));
}

TEST(WhyRefused, CountsTheFaultsThatAreKnown) {
  const std::vector<KeyframeFault> few(3);
  const std::vector<KeyframeFault> many(kMostKeyframeFaults);
  const PlanRequest request;
  EXPECT_THAT(why_refused(few, request, 0.0, false, true), HasSubstr("; 3 keyframes are at fault"));
  EXPECT_THAT(why_refused(few, request, 0.0, true, false), HasSubstr("; at least 3 keyframes are"));
  EXPECT_THAT(why_refused(few, request, 0.002, false, true),
              HasSubstr("is nearer to the scene than the 0.002 m of error of its smooth surfaces"));
  EXPECT_THAT(why_refused(many, request, 0.0, false, true),
              HasSubstr("; at least 100 keyframes are"));
}

TEST(WhyRefused, SaysWhichAnswersHaveFreeKeyframes) {
  const std::vector<KeyframeFault> faults(1);
  PlanRequest request;
  EXPECT_THAT(why_refused(faults, request, 0.0, false, true), Not(HasSubstr("certified")));
  request.frame.emplace();
  EXPECT_THAT(why_refused(faults, request, 0.0, false, true),
              HasSubstr("; note: keyframes of an answer are surely free only if its path is "
                        "certified"));
}

}  // namespace
}  // namespace camway::planning
