// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/client/c/answered_twice.h"
#include "tests/client/client_fixture.h"

namespace camway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing_support::AnsweredTwice;

using CProofTest = testing_support::ClientTest;

/// Makes an answer a proof by a closed surface.
void prove_by_surface(plan_response_t& answer) {
  answer.segments.clear();
  answer.status = plan_response_t::STATUS_INFEASIBLE;
  answer.message = "keyframe 4 is inside";
  answer.has_infeasibility = 1;
  answer.keyframe_inside = 4;
  answer.keyframe_outside = 9;
  answer.proof_triangles = {2, 3, 5, 8};
}

/// Makes an answer a proof by a cage, whose numbers all differ.
void prove_by_cage(plan_response_t& answer) {
  prove_by_surface(answer);
  answer.has_cage = 1;
  double next = 0.5;
  for (double& part : answer.proof_cage.orientation_wxyz) part = next += 1.0;
  for (double& part : answer.proof_cage.min_m) part = next += 1.0;
  for (double& part : answer.proof_cage.max_m) part = next += 1.0;
  answer.proof_cage.widest_hole_m = next + 1.0;
  answer.proof_cage.shortest_chord_m = next + 2.0;
}

/// Returns the triangles of a proof; the test expects that there are at most eight.
std::vector<std::int32_t> triangles_of(const camway_answer* answer) {
  std::vector<std::int32_t> triangles(8);
  std::size_t count = 0;
  EXPECT_EQ(camway_answer_proof_triangles(answer, triangles.data(), triangles.size(), &count),
            CAMWAY_OK);
  triangles.resize(count);
  return triangles;
}

TEST_F(CProofTest, BySurfaceHasItsKeyframesTrianglesAndMessage) {
  const AnsweredTwice answer(prove_by_surface);
  ASSERT_EQ(answer.in_cxx().status, Status::kInfeasible);
  camway_infeasibility found;
  ASSERT_EQ(camway_answer_infeasibility(answer.in_c(), &found, sizeof found), CAMWAY_OK)
      << camway_last_error();
  EXPECT_EQ(found.struct_size, sizeof found);
  EXPECT_EQ(found.proof, CAMWAY_PROOF_SURFACE);
  EXPECT_EQ(found.keyframe_inside, 4);
  EXPECT_EQ(found.keyframe_outside, 9);
  const camway_cage none{};
  EXPECT_EQ(std::memcmp(&found.cage, &none, sizeof none), 0);
  EXPECT_THAT(triangles_of(answer.in_c()), ElementsAre(2, 3, 5, 8));
  EXPECT_STREQ(camway_answer_message(answer.in_c()), "keyframe 4 is inside");
}

TEST_F(CProofTest, ByCageIsThatOfTheClientOfCxx) {
  const AnsweredTwice answer(prove_by_cage);
  ASSERT_TRUE(answer.in_cxx().infeasibility && answer.in_cxx().infeasibility->cage);
  camway_infeasibility found;
  ASSERT_EQ(camway_answer_infeasibility(answer.in_c(), &found, sizeof found), CAMWAY_OK)
      << camway_last_error();
  EXPECT_EQ(found.proof, CAMWAY_PROOF_CAGE);
  EXPECT_EQ(found.keyframe_inside, 4);
  // The members are in the same order, so all are compared at once.
  static_assert(sizeof found.cage == sizeof(Cage));
  EXPECT_EQ(std::memcmp(&found.cage, &*answer.in_cxx().infeasibility->cage, sizeof(Cage)), 0);
  EXPECT_EQ(found.cage.shortest_chord_m, found.cage.widest_hole_m + 1.0);
  EXPECT_THAT(triangles_of(answer.in_c()), ElementsAre(2, 3, 5, 8));
}

TEST_F(CProofTest, IsRefusedWhereThereIsNone) {
  const AnsweredTwice answer([](plan_response_t&) {});
  camway_infeasibility found;
  EXPECT_EQ(camway_answer_infeasibility(answer.in_c(), &found, sizeof found), CAMWAY_INVALID);
  EXPECT_THAT(camway_last_error(), HasSubstr("no proof"));
  EXPECT_TRUE(triangles_of(answer.in_c()).empty());
  std::size_t count = 0;
  EXPECT_EQ(camway_answer_proof_triangles(answer.in_c(), nullptr, 0, nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_answer_proof_triangles(answer.in_c(), nullptr, 1, &count), CAMWAY_BAD_ARGUMENT);
}

}  // namespace
}  // namespace camway
