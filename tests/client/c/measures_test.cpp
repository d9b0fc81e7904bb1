// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/client/c/answered_twice.h"
#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::answer_pages;
using testing_support::AnsweredTwice;
using testing_support::CClient;
using testing_support::CRequest;
using testing_support::encode_all;
using testing_support::FakeDaemon;
using testing_support::quick;
using testing_support::small_request;

using CMeasuresTest = testing_support::ClientTest;

/// Measures whose members all differ.
path_measures_t measures_from(double first) {
  path_measures_t measures{};
  measures.length_m = first;
  measures.largest_deviation_m = first + 1;
  measures.largest_shift_rad = first + 2;
  measures.mean_shift_rad = first + 3;
  measures.bending_energy_m2_per_s3 = first + 4;
  measures.largest_speed_m_per_s = first + 5;
  measures.largest_acceleration_m_per_s2 = first + 6;
  measures.largest_turn_rate_rad_per_s = first + 7;
  measures.largest_turn_acceleration_rad_per_s2 = first + 8;
  measures.clearance_lower_bound_m = first + 9;
  return measures;
}

std::vector<testing_support::Bytes> corrected(const plan_request_t& asked) {
  std::vector<plan_response_t> pages = answer_pages(asked, 2, 2);
  pages[0].has_measures = pages[0].has_measures_before = 1;
  pages[0].measures = measures_from(100);
  pages[0].measures_before = measures_from(200);
  pages[0].viewing_distance_m = 4.0625;
  for (int i = 0; i < 5; ++i) {
    correction_t correction{};
    correction.method = static_cast<std::int8_t>(i);
    correction.t_begin_s = i + 0.125;
    correction.t_end_s = i + 0.25;
    correction.changed_t_begin_s = i + 0.0625;
    correction.changed_t_end_s = i + 0.5;
    correction.moved_m = i + 10;
    correction.turned_rad = i + 0.75;
    correction.largest_shift_rad = i + 0.3;
    correction.mean_shift_rad = i + 0.1;
    pages[0].corrections.push_back(correction);
  }
  pages[0].num_corrections = 5;
  return encode_all(pages);
}

TEST_F(CMeasuresTest, AreThoseOfTheClientOfCxx) {
  FakeDaemon daemon;
  daemon.on_plan = corrected;
  daemon.start();
  const PlanResponse expected = Client(quick()).plan(small_request());
  ASSERT_TRUE(expected.ok()) << expected.error;
  CClient client;
  const CRequest request;
  camway_answer* answer = nullptr;
  ASSERT_EQ(camway_plan(client.get(), &request, 10.0, &answer), CAMWAY_OK) << camway_last_error();
  camway_path_measures measures;
  ASSERT_EQ(camway_answer_measures(answer, &measures, sizeof measures), CAMWAY_OK);
  EXPECT_EQ(measures.struct_size, sizeof measures);
  EXPECT_EQ(measures.length_m, 100);
  // The members are in the same order, so all are compared at once.
  static_assert(sizeof measures == sizeof(PathMeasures) + 2 * sizeof(std::uint32_t));
  EXPECT_EQ(std::memcmp(&measures.length_m, &*expected.measures, sizeof(PathMeasures)), 0);
  ASSERT_EQ(camway_answer_measures_before(answer, &measures, sizeof measures), CAMWAY_OK);
  EXPECT_EQ(std::memcmp(&measures.length_m, &*expected.measures_before, sizeof(PathMeasures)), 0);
  camway_answer_summary summary;
  ASSERT_EQ(camway_answer_summarize(answer, &summary, sizeof summary), CAMWAY_OK);
  EXPECT_EQ(expected.viewing_distance_m, 4.0625);
  EXPECT_EQ(summary.viewing_distance_m, expected.viewing_distance_m);

  std::vector<camway_correction> corrections(5);
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_corrections(answer, corrections.data(), 5, &count), CAMWAY_OK);
  ASSERT_EQ(count, expected.corrections.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Correction& wanted = expected.corrections[i];
    EXPECT_EQ(corrections[i].method, static_cast<int>(wanted.method));
    EXPECT_EQ(corrections[i].t_begin_s, wanted.t_begin_s);
    EXPECT_EQ(corrections[i].t_end_s, wanted.t_end_s);
    EXPECT_EQ(corrections[i].changed_t_begin_s, wanted.changed_t_begin_s);
    EXPECT_EQ(corrections[i].changed_t_end_s, wanted.changed_t_end_s);
    EXPECT_EQ(corrections[i].moved_m, wanted.moved_m);
    EXPECT_EQ(corrections[i].turned_rad, wanted.turned_rad);
    EXPECT_EQ(corrections[i].largest_shift_rad, wanted.largest_shift_rad);
    EXPECT_EQ(corrections[i].mean_shift_rad, wanted.mean_shift_rad);
  }
  camway_answer_free(answer);
}

/// Slows an answer in three places.
void slow_down(plan_response_t& answer) {
  answer.time_scale = 1.75;
  for (int i = 0; i < 3; ++i) {
    slowed_stretch_t stretch{};
    stretch.t_begin_s = 2 * i + 0.25;
    stretch.t_end_s = 2 * i + 1.25;
    stretch.given_t_begin_s = i + 0.125;
    stretch.given_t_end_s = i + 0.625;
    answer.slowed.push_back(stretch);
  }
}

TEST_F(CMeasuresTest, SlowedPartsAreThoseOfTheClientOfCxx) {
  const AnsweredTwice answer(slow_down);
  ASSERT_EQ(answer.in_cxx().slowed.size(), 3u);
  camway_slowed_stretch slowed[4] = {};
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_slowed(answer.in_c(), slowed, 2, &count), CAMWAY_OK);
  EXPECT_EQ(count, 3u);
  EXPECT_EQ(slowed[2].t_end_s, 0.0) << "beyond the capacity";
  ASSERT_EQ(camway_answer_slowed(answer.in_c(), slowed, 4, &count), CAMWAY_OK);
  // The members are in the same order, so all are compared at once.
  static_assert(sizeof slowed[0] == sizeof(SlowedStretch));
  EXPECT_EQ(std::memcmp(slowed, answer.in_cxx().slowed.data(), 3 * sizeof slowed[0]), 0);
  EXPECT_EQ(slowed[2].given_t_end_s, 2.625);
  camway_answer_summary summary;
  ASSERT_EQ(camway_answer_summarize(answer.in_c(), &summary, sizeof summary), CAMWAY_OK);
  EXPECT_EQ(summary.time_scale, 1.75);
}

TEST_F(CMeasuresTest, TheClearanceProfileIsThatOfTheClientOfCxx) {
  const AnsweredTwice answer([](plan_response_t& profiled) {
    for (int i = 0; i < 3; ++i) {
      clearance_stretch_t stretch{};
      stretch.t_begin_s = i;
      stretch.t_end_s = i + 1;
      stretch.clearance_m = 0.125 * i;
      profiled.clearance_profile.push_back(stretch);
    }
    profiled.num_clearance_stretches = 3;
  });
  ASSERT_EQ(answer.in_cxx().clearance_profile.size(), 3u);
  camway_clearance_stretch stretches[3] = {};
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_clearance_profile(answer.in_c(), stretches, 3, &count), CAMWAY_OK);
  EXPECT_EQ(count, 3u);
  // The members are in the same order, so all are compared at once.
  static_assert(sizeof stretches[0] == sizeof(ClearanceStretch));
  EXPECT_EQ(std::memcmp(stretches, answer.in_cxx().clearance_profile.data(), sizeof stretches), 0);
  EXPECT_EQ(stretches[2].clearance_m, 0.25);
}

TEST_F(CMeasuresTest, TimingIsThatOfTheClientOfCxx) {
  const AnsweredTwice answer([](plan_response_t& timed) {
    timed.motion_ms = 1.25;
    timed.detect_ms = 2.25;
    timed.correct_ms = 3.25;
    timed.certify_ms = 4.25;
    timed.total_ms = 11.5;
  });
  camway_plan_timing timing;
  ASSERT_EQ(camway_answer_timing(answer.in_c(), &timing, sizeof timing), CAMWAY_OK);
  EXPECT_EQ(timing.struct_size, sizeof timing);
  EXPECT_EQ(timing.motion_ms, 1.25);
  EXPECT_EQ(timing.total_ms, 11.5);
  static_assert(sizeof timing == sizeof(PlanTiming) + 2 * sizeof(std::uint32_t));
  EXPECT_EQ(std::memcmp(&timing.motion_ms, &answer.in_cxx().timing, sizeof(PlanTiming)), 0);
}

TEST_F(CMeasuresTest, AreRefusedWhereThereAreNone) {
  FakeDaemon daemon;
  daemon.on_plan = [](const plan_request_t& asked) {
    return encode_all(answer_pages(asked, 2, 2));
  };
  daemon.start();
  CClient client;
  const CRequest request;
  camway_answer* answer = nullptr;
  ASSERT_EQ(camway_plan(client.get(), &request, 10.0, &answer), CAMWAY_OK) << camway_last_error();
  camway_path_measures measures;
  EXPECT_EQ(camway_answer_measures(answer, &measures, sizeof measures), CAMWAY_INVALID);
  EXPECT_THAT(camway_last_error(), HasSubstr("no such measures"));
  EXPECT_EQ(camway_answer_measures_before(answer, &measures, sizeof measures), CAMWAY_INVALID);
  camway_answer_summary summary;
  ASSERT_EQ(camway_answer_summarize(answer, &summary, sizeof summary), CAMWAY_OK);
  EXPECT_EQ(summary.viewing_distance_m, 0.0);
  std::size_t count = 7;
  EXPECT_EQ(camway_answer_corrections(answer, nullptr, 0, &count), CAMWAY_OK);
  EXPECT_EQ(count, 0u);
  count = 7;
  EXPECT_EQ(camway_answer_slowed(answer, nullptr, 0, &count), CAMWAY_OK);
  EXPECT_EQ(count, 0u);
  camway_answer_free(answer);
}

}  // namespace
}  // namespace camway
