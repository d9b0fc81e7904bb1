// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/client/c/answered_twice.h"
#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"
#include "tests/support/random.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::AnsweredTwice;
using testing_support::CRequest;

using CFrameTest = testing_support::ClientTest;

constexpr std::size_t kKeyframes = 3;

void fill(testing::Random& random, double* numbers, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) numbers[i] = random.uniform(-10.0, 10.0);
}

/// Adds keyframes and a frame of random numbers.
void add_frame(plan_response_t& answer) {
  testing::Random random(11);
  answer.has_frame = 1;
  fill(random, answer.frame.reference_wxyz, 4);
  for (path_end_t* const end : {&answer.frame.begin, &answer.frame.end}) {
    fill(random, end->velocity_m_per_s, 3);
    fill(random, end->image_rate_per_s, 4);
  }
  answer.keyframes.resize(kKeyframes);
  for (std::size_t i = 0; i < kKeyframes; ++i) {
    answer.keyframes[i].time_s = static_cast<double>(i);
    answer.keyframes[i].orientation_wxyz[0] = 1.0;
    fill(random, answer.keyframes[i].image, 4);
  }
}

TEST_F(CFrameTest, IsThatOfTheClientOfCxx) {
  // The members are in the same order, so all are compared at once.
  static_assert(sizeof(camway_path_frame) == sizeof(PathFrame));
  const AnsweredTwice answer(add_frame);
  ASSERT_TRUE(answer.in_cxx().frame);
  camway_path_frame frame;
  ASSERT_EQ(camway_answer_frame(answer.in_c(), &frame), CAMWAY_OK) << camway_last_error();
  EXPECT_EQ(std::memcmp(&frame, &*answer.in_cxx().frame, sizeof frame), 0);

  std::vector<double> images(4 * kKeyframes + 4, 7.0);
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_images(answer.in_c(), images.data(), 1, &count), CAMWAY_OK);
  EXPECT_EQ(count, kKeyframes);
  EXPECT_EQ(images[4], 7.0) << "beyond the capacity";
  ASSERT_EQ(camway_answer_images(answer.in_c(), images.data(), kKeyframes + 1, &count), CAMWAY_OK);
  EXPECT_EQ(images[4 * kKeyframes], 7.0) << "beyond the keyframes";
  for (std::size_t i = 0; i < kKeyframes; ++i) {
    const std::array<double, 4>& expected = answer.in_cxx().keyframes[i].image;
    EXPECT_EQ(std::memcmp(&images[4 * i], expected.data(), sizeof expected), 0) << i;
  }
}

TEST_F(CFrameTest, GoesBackToTheDaemonAsItCame) {
  AnsweredTwice answer(add_frame);
  plan_response_t came{};
  add_frame(came);
  camway_path_frame frame;
  ASSERT_EQ(camway_answer_frame(answer.in_c(), &frame), CAMWAY_OK) << camway_last_error();
  double images[4 * kKeyframes];
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_images(answer.in_c(), images, kKeyframes, &count), CAMWAY_OK);
  CRequest request;  // an edited one: the last keyframe was taken out
  request.untimed = 0;
  request.frame = &frame;
  request.images = images;
  const plan_request_t sent = answer.sent(request);
  ASSERT_EQ(sent.num_keyframes, 2);
  EXPECT_EQ(sent.has_frame, 1);
  EXPECT_EQ(std::memcmp(&sent.frame, &came.frame, sizeof came.frame), 0);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(std::memcmp(sent.keyframes[i].image, came.keyframes[i].image, 4 * sizeof(double)), 0);
  }
}

TEST_F(CFrameTest, IsRefusedWhereThereIsNone) {
  const AnsweredTwice answer([](plan_response_t& plain) { plain.keyframes.resize(kKeyframes); });
  camway_path_frame frame;
  EXPECT_EQ(camway_answer_frame(answer.in_c(), &frame), CAMWAY_INVALID);
  EXPECT_THAT(camway_last_error(), HasSubstr("no frame"));
  double images[4 * kKeyframes];
  std::fill(images, images + 4 * kKeyframes, 7.0);
  std::size_t count = 0;
  EXPECT_EQ(camway_answer_images(answer.in_c(), images, kKeyframes, &count), CAMWAY_OK);
  EXPECT_EQ(count, kKeyframes);
  for (const double number : images) EXPECT_EQ(number, 0.0);

  EXPECT_EQ(camway_answer_frame(answer.in_c(), nullptr), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_answer_images(answer.in_c(), nullptr, 1, &count), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_answer_images(answer.in_c(), images, 1, nullptr), CAMWAY_BAD_ARGUMENT);
}

}  // namespace
}  // namespace camway
