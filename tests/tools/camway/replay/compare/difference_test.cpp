// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/difference.h"

#include <camway/members.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <type_traits>

#include "daemon/messages/plan.h"
#include "daemon/motion/spline/interpolate.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/path_fault.h"
#include "tests/messages/plan_samples.h"

namespace camway::tools {
namespace {

constexpr motion::Camera kCamera{1.2, 0.9, 0.1};

motion::Body body() { return motion::Body(kCamera); }

planning::PlanResult result_through(const std::vector<motion::Keyframe>& keyframes) {
  planning::PlanResult result;
  result.status = planning::Status::kOk;
  result.keyframes = keyframes;
  result.path = motion::interpolate(keyframes);
  return result;
}

Difference difference_between(const planning::PlanResult& then, const planning::PlanResult& now,
                              const motion::Body& body) {
  return difference_of(messages::to_wire(then, {}), messages::to_wire(now, {}), {body, 2.0});
}

std::vector<motion::Keyframe> three_keyframes() {
  std::vector<motion::Keyframe> keyframes(3);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    keyframes[i].time_s = static_cast<double>(i);
    keyframes[i].pose.position = {static_cast<double>(i * i), 0.5 * static_cast<double>(i), 1.0};
  }
  return keyframes;
}

TEST(Difference, FindsNothingBetweenEqualBits) {
  const planning::PlanResult result = result_through(three_keyframes());
  planning::PlanResult other = result;
  other.message = "in other words";
  other.timing.total_ms = 5;
  const Difference difference = difference_between(result, other, body());
  EXPECT_EQ(difference.path_m, 0.0);
  EXPECT_EQ(difference.member, "");
}

TEST(Difference, MeasuresAShiftedPath) {
  const planning::PlanResult a = result_through(three_keyframes());
  std::vector<motion::Keyframe> shifted = three_keyframes();
  for (motion::Keyframe& keyframe : shifted) keyframe.pose.position.z() += 0.25;
  const Difference difference = difference_between(a, result_through(shifted), body());
  // Interpolation is affine: the whole path moves by the same vector, up to rounding at metre
  // scale.
  EXPECT_NEAR(difference.path_m, 0.25, 1e-14);
  EXPECT_EQ(difference.member, "keyframes[0].position[2]");
}

TEST(Difference, MeasuresATurnByTheCorners) {
  const planning::PlanResult a = result_through(three_keyframes());
  std::vector<motion::Keyframe> turned = three_keyframes();
  const double angle_rad = 0.1;
  for (motion::Keyframe& keyframe : turned) {
    keyframe.pose.orientation = Eigen::AngleAxisd(angle_rad, geometry::Vec3::UnitZ());
  }
  // In a rotation about the viewing axis a corner moves on a circle through the corners of the near
  // quadrilateral.
  const motion::Corners corners = motion::near_corners_C(kCamera);
  const double expected_m = 2 * corners[0].head<2>().norm() * std::sin(angle_rad / 2);
  EXPECT_NEAR(difference_between(a, result_through(turned), body()).path_m, expected_m, 1e-13);
}

TEST(Difference, SeesTheLastBitOfOneControlPoint) {
  const planning::PlanResult a = result_through(three_keyframes());
  planning::PlanResult b = a;
  std::vector<motion::Segment> segments(a.path.segments().begin(), a.path.segments().end());
  double& coordinate = segments[1].position[2].x();
  coordinate = std::nextafter(coordinate, 10.0);
  b.path = motion::Path(segments);
  const Difference difference = difference_between(a, b, body());
  EXPECT_GT(difference.path_m, 0.0);
  EXPECT_LT(difference.path_m, 1e-14);
  EXPECT_EQ(difference.member, "segments[1].position[2][0]");
}

TEST(Difference, IsInfiniteWhereThereIsNoCommonTime) {
  const planning::PlanResult a = result_through(three_keyframes());
  planning::PlanResult none = a;
  none.path = {};
  EXPECT_TRUE(std::isinf(difference_between(a, none, body()).path_m));
  std::vector<motion::Keyframe> longer = three_keyframes();
  longer.back().time_s += 1.0;
  EXPECT_TRUE(std::isinf(difference_between(a, result_through(longer), body()).path_m));
  EXPECT_EQ(difference_between(none, none, body()).path_m, 0.0);
}

TEST(Difference, NamesWhatDiffersFirst) {
  const planning::PlanResult a = result_through(three_keyframes());
  planning::PlanResult b = a;
  b.remaining_collisions = {{0.25, 0.5}};
  EXPECT_EQ(difference_between(a, b, body()).member, "remaining_collisions");
  b.status = planning::Status::kPartial;
  EXPECT_EQ(difference_between(a, b, body()).member, "remaining_collisions");
  b = a;
  b.status = planning::Status::kPartial;
  EXPECT_EQ(difference_between(a, b, body()).what(), "status ok -> partial");
  b = a;
  b.certificate.clearance_lower_bound_m = 0.5;
  EXPECT_EQ(difference_between(a, b, body()).member, "certificate.clearance_lower_bound");
  b = a;
  b.keyframes[1].origin = motion::KeyframeOrigin::kInserted;
  EXPECT_EQ(difference_between(a, b, body()).what(), "keyframes 3 -> 2") << "of the given ones";
  b = a;
  b.collisions = {{0.5, 0.5}};
  planning::PlanResult c = b;
  c.collisions = {{0.5, std::nextafter(0.5, 1.0)}};
  EXPECT_EQ(difference_between(b, c, body()).member, "collisions[0].t_end");
}

TEST(Difference, SeesAnotherWitness) {
  planning::PlanResult a = result_through(three_keyframes());
  a.collisions = {{0.25, 0.5, collision::Witness{0.375, 7, 2, 0.01, {1, 2, 3}}}};
  a.collision_names = {{"table", "edge 1"}};
  planning::PlanResult b = a;
  b.collisions[0].witness->feature = 0;
  EXPECT_EQ(difference_between(a, b, body()).member, "") << "answers hold the name alone";
  b.collision_names[0].feature = "edge 2";
  EXPECT_EQ(difference_between(a, b, body()).member, "collisions[0].witness.feature");
  b = a;
  b.collisions[0].witness->point_W.z() = 3.5;
  EXPECT_EQ(difference_between(a, b, body()).member, "collisions[0].witness.point[2]");
  b.collisions[0].witness.reset();
  EXPECT_EQ(difference_between(a, b, body()).member, "collisions[0].witness");
}

/// Returns an answer with a value in each member that corrections and proofs have.
planning::PlanResult result_with_all() {
  planning::PlanResult result = result_through(three_keyframes());
  result.corrections.resize(1);
  result.corrections[0].interval = {0.25, 0.5, collision::Witness{}};
  result.measures = motion::PathMeasures{};
  result.measures_before = motion::PathMeasures{};
  result.viewing_distance_m = 4.5;
  result.keyframe_faults.resize(1);
  result.infeasibility = planning::Infeasibility{0, 1, {2, 3}, correction::CageBox{}};
  result.infeasibility->cage->box = geometry::Box(geometry::Vec3::Zero(), geometry::Vec3::Ones());
  return result;
}

TEST(Difference, SeesWhatCorrectionDid) {
  const planning::PlanResult a = result_with_all();
  const auto difference_after = [&](const auto& edit) {
    planning::PlanResult b = a;
    edit(b);
    return difference_between(a, b, body()).member;
  };
  using Result = planning::PlanResult;
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].interval.witness.reset(); }), "")
      << "it stands with the collision";
  EXPECT_EQ(difference_after([](Result& b) { b.corrections.clear(); }), "corrections");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].interval.t_end_s = 0.75; }),
            "corrections[0].t_end");
  EXPECT_EQ(difference_after(
                [](Result& b) { b.corrections[0].kind = correction::CorrectionKind::kTurn; }),
            "corrections[0].kind");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].t_begin_s = -0.0; }),
            "corrections[0].changed[0]");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].t_end_s = 1.0; }),
            "corrections[0].changed[1]");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].moved_m = 1.0; }),
            "corrections[0].moved_m");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].turned_rad = 1.0; }),
            "corrections[0].turned_deg");
  EXPECT_EQ(difference_after([](Result& b) { b.measures->length_m = 1.0; }),
            "measures.after.length_m");
  EXPECT_EQ(difference_after([](Result& b) { b.measures_before.reset(); }), "measures.before");
  EXPECT_EQ(difference_after([](Result& b) { b.bounds.min_W.y() = 0.5; }), "bounds.has_min[1]");
  EXPECT_EQ(difference_after([](Result& b) { b.viewing_distance_m = 2.5; }), "viewing_distance_m");
  EXPECT_EQ(difference_after([](Result& b) { b.viewing_distance_m.reset(); }), "")
      << "files of earlier versions do not tell it";
  EXPECT_EQ(difference_after([](Result& b) { b.near_scale = 0.5; }), "near_scale");
  EXPECT_EQ(difference_after([](Result& b) { b.time_scale = 2.0; }), "time_scale");
  EXPECT_EQ(difference_after([](Result& b) { b.slowed.resize(1); }), "slowed");
  EXPECT_EQ(difference_after([](Result& b) { b.keyframe_faults[0].depth_m = 1.0; }),
            "keyframe_faults[0].depth_m");
  EXPECT_EQ(difference_after([](Result& b) { b.keyframe_faults[0].free_pose.emplace(); }),
            "keyframe_faults[0].free_pose");
  EXPECT_EQ(difference_after([](Result& b) { b.infeasibility->triangles[1] = 4; }),
            "infeasibility.triangles[1]");
  EXPECT_EQ(difference_after([](Result& b) { b.infeasibility.reset(); }), "infeasibility");
}

TEST(Difference, NamesTheFirstStageThatDiffers) {
  const planning::PlanResult a = result_with_all();
  const auto after = [&](const auto& edit) {
    planning::PlanResult b = a;
    edit(b);
    const Difference difference = difference_between(a, b, body());
    return fmt::format("{}: {}", base::name_of(difference.stage), difference.what());
  };
  using Result = planning::PlanResult;
  const auto correct_otherwise = [](Result& b) {
    b.corrections[0].kind = correction::CorrectionKind::kMove;
    b.remaining_collisions = {{0.25, 0.5}};
    b.measures->length_m = 2.0;
    b.status = planning::Status::kPartial;
  };
  EXPECT_EQ(after(correct_otherwise), "correction: corrections[0].kind none -> move");
  EXPECT_EQ(after([&](Result& b) {
              correct_otherwise(b);
              b.collisions = {{0.25, 0.5}};
            }),
            "collisions: collisions 0 -> 1");
  EXPECT_EQ(after([&](Result& b) {
              correct_otherwise(b);
              b.keyframes[1].pose.position.y() = 7.0;
            }),
            "interpolation: keyframes[1].position[1] 0.5 -> 7");
  EXPECT_EQ(after([&](Result& b) {
              correct_otherwise(b);
              b.status = planning::Status::kInvalid;
            }),
            "request: status ok -> invalid");
  EXPECT_EQ(after([](Result& b) { b.measures_before->length_m = 1.0; }),
            "interpolation: measures.before.length_m 0 -> 1");
  EXPECT_EQ(after([](Result& b) { b.measures_before->clearance_lower_bound_m = 1.0; }),
            "proof: measures.before.clearance_lower_bound_m 0 -> 1");
  EXPECT_EQ(after([](Result& b) { b.measures->largest_turn_rate_rad_per_s = std::numbers::pi; }),
            "measures: measures.after.largest_turn_rate_deg_per_s 0 -> 180");
  EXPECT_EQ(after([](Result& b) { b.viewing_distance_m = 2.5; }),
            "correction: viewing_distance_m 4.5 -> 2.5");
  EXPECT_EQ(after([](Result& b) { b.certificate.certified = true; }),
            "proof: certificate.certified false -> true");
  EXPECT_EQ(after([](Result& b) { b.keyframe = 3; }), "answer: keyframe none -> 3");
  EXPECT_EQ(after([](Result& b) { b.infeasibility.reset(); }),
            "proof: infeasibility present -> absent");
}

// The times of a slowed path follow from its slowing, not from the stages before.
TEST(Difference, SaysThatOnlyTheSlowingDiffers) {
  planning::PlanResult a = result_with_all();
  a.collisions = {{0.25, 0.5}};
  a.collision_names.resize(1);
  planning::PlanResult b = a;
  b.time_scale = 2.0;
  for (motion::Keyframe& keyframe : b.keyframes) keyframe.time_s *= 2.0;
  b.collisions[0].t_end_s = 1.0;
  b.corrections[0].t_end_s = 1.0;
  EXPECT_EQ(difference_between(a, b, body()).what(), "time_scale 1 -> 2");
  b.time_scale = 1.0;
  EXPECT_EQ(difference_between(a, b, body()).member, "keyframes[1].time");
  // Slowed alike, but elsewhere.
  a.time_scale = b.time_scale = 2.0;
  const Difference elsewhere = difference_between(a, b, body());
  EXPECT_EQ(elsewhere.stage, Stage::kTiming);
  EXPECT_EQ(elsewhere.member, "keyframes[1].time");
}

/// Calls `visit(path, number)` for each number and text of a message.
template <class Member, class Visit>
void visit_leaves(const std::string& path, Member& member, const Visit& visit) {
  if constexpr (wire::Described<Member>) {
    wire::for_each_member<Member>([&](const auto& described) {
      visit_leaves(fmt::format("{}.{}", path, described.name), member.*described.member, visit);
    });
  } else if constexpr (std::is_same_v<Member, std::string> || std::is_arithmetic_v<Member>) {
    visit(path, member);
  } else {
    for (auto& element : member) visit_leaves(path, element, visit);
  }
}

/// Changes the leaf number `index` of a message. Returns its path; empty if there is none.
std::string change_leaf(plan_response_t& message, std::size_t index) {
  std::string changed;
  std::size_t at = 0;
  visit_leaves("", message, [&](const std::string& path, auto& leaf) {
    if (at++ != index) return;
    changed = path;
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(leaf)>, std::string>) {
      leaf += "x";
    } else {
      leaf = leaf == 0 ? 1 : 0;
    }
  });
  return changed;
}

/// Whether a member tells how the answer was found, to whom it goes, or of which scene it is, or is
/// not told where it is 0, to which it is changed.
bool is_left_out(const std::string& path) {
  if (path == ".viewing_distance_m") return true;
  for (const char* part : {"_ms", ".message", "tried", "deadline_reached", ".utime", ".client_id",
                           ".request_id", ".daemon_start", ".page", ".num_", ".scene"}) {
    if (path.find(part) != std::string::npos) return true;
  }
  return false;
}

/// Returns the message of the result that a message has, without what is left out.
std::vector<std::uint8_t> content_of(const plan_response_t& message) {
  planning::PlanResult result = result_of(message);
  result.path = {};
  return wire::encode(messages::to_wire(result, {}));
}

// Each change of one member is seen, whichever it is, if the member means anything.
TEST(Difference, SeesEachChangedMember) {
  testing::Random random(testing::kSeed);
  const plan_response_t a = messages::to_wire(testing::sample_result(2, random), {});
  const std::vector<std::uint8_t> content = content_of(a);
  std::size_t seen = 0;
  for (std::size_t i = 0;; ++i) {
    plan_response_t b = a;
    const std::string path = change_leaf(b, i);
    if (path.empty()) break;
    const bool is_path = path.find(".segments") != std::string::npos;
    if (is_left_out(path) || (!is_path && content_of(b) == content)) continue;
    if (!wire::path_fault(b.segments).empty()) continue;
    EXPECT_FALSE(difference_of(a, b, {body(), 2.0}).has_same_bits()) << path;
    ++seen;
  }
  EXPECT_GT(seen, 300U);
}

// Whatever differs, it is seen from both sides alike.
TEST(Difference, IsTheSameFromBothSides) {
  testing::Random random(testing::kSeed);
  for (int trial = 0; trial < 60; ++trial) {
    const plan_response_t a = messages::to_wire(testing::sample_result(3, random), {});
    const plan_response_t b = messages::to_wire(testing::sample_result(3, random), {});
    ASSERT_TRUE(difference_of(a, a, {body(), 2.0}).has_same_bits());
    const Difference there = difference_of(a, b, {body(), 2.0});
    const Difference back = difference_of(b, a, {body(), 2.0});
    ASSERT_FALSE(there.has_same_bits()) << trial;
    EXPECT_EQ(there.stage, back.stage) << trial;
    EXPECT_EQ(there.member, back.member) << trial;
    EXPECT_EQ(there.then, back.now) << trial;
    EXPECT_EQ(there.path_m, back.path_m) << trial;
  }
}

// A log may hold any answer whose bytes can be read.
TEST(Difference, TakesAnyMessage) {
  testing::Random random(testing::kSeed);
  for (int trial = 0; trial < 300; ++trial) {
    auto a = testing::random_message<plan_response_t>(random);
    auto b = testing::random_message<plan_response_t>(random);
    for (plan_response_t* each : {&a, &b}) {
      if (!wire::path_fault(each->segments).empty()) each->segments.clear();
    }
    b.status = a.status;
    difference_of(a, b, {body(), 2.0});
  }
}

TEST(Difference, ShiftIsTheTurnAndTheMoveAtTheViewingDistance) {
  const planning::PlanResult a = result_through(three_keyframes());
  std::vector<motion::Keyframe> moved = three_keyframes();
  for (motion::Keyframe& keyframe : moved) keyframe.pose.position.z() += 0.5;
  EXPECT_NEAR(difference_between(a, result_through(moved), body()).shift_rad, 0.25, 1e-12);
  std::vector<motion::Keyframe> turned = three_keyframes();
  for (motion::Keyframe& keyframe : turned) {
    keyframe.pose.orientation = Eigen::AngleAxisd(0.125, geometry::Vec3::UnitY());
  }
  EXPECT_NEAR(difference_between(a, result_through(turned), body()).shift_rad, 0.125, 1e-12);
}

TEST(Difference, SeesAnotherCage) {
  const planning::PlanResult a = result_with_all();
  const auto cage_difference_after = [&](const auto& edit) {
    planning::PlanResult b = a;
    edit(b.infeasibility->cage);
    return difference_between(a, b, body()).member;
  };
  using Cage = std::optional<correction::CageBox>;
  const std::string cage = "infeasibility.cage";
  EXPECT_EQ(cage_difference_after([](Cage&) {}), "");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its.reset(); }), cage);
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->box.max().y() = 2.0; }), cage + ".max[1]");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->box.min().z() = -0.0; }), cage + ".min[2]");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->orientation.x() = 1.0; }),
            cage + ".orientation[1]");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->widest_hole_m = 1.0; }),
            cage + ".widest_hole_m");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->shortest_chord_m = 1.0; }),
            cage + ".shortest_chord_m");
}

TEST(Difference, MeasuresATurnByTheCornersOfAnyBody) {
  const planning::PlanResult a = result_through(three_keyframes());
  std::vector<motion::Keyframe> turned = three_keyframes();
  for (motion::Keyframe& keyframe : turned) {
    keyframe.pose.orientation = Eigen::AngleAxisd(std::numbers::pi, geometry::Vec3::UnitZ());
  }
  const auto rod = motion::Body::make(motion::ConvexShape{{{{2, 0, 0}, {0, 0, 5}}}});
  ASSERT_TRUE(rod) << rod.error;
  EXPECT_NEAR(difference_between(a, result_through(turned), *rod).path_m, 4.0, 1e-13);
}

}  // namespace
}  // namespace camway::tools
