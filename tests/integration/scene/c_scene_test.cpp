// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

constexpr double kWait_s = 30.0;

/// A program in C that maps by scans, watches a path and takes events on its own thread; edits
/// answers and plans them again; and asks why there is no path.
class CInterfaceTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    std::ofstream(file("floor.obj")) << "v 0 0 0\nv 9 0 0\nv 9 0 9\nv 0 0 9\nf 1 3 2\nf 1 4 3\n";
    start_daemon_with_scenes({"room=" + file("floor.obj") + ",occupancy=0.125"});
    const std::string url = patient().url;
    camway_client_options options;
    camway_client_options_init(&options, sizeof options);
    options.url = url.c_str();
    ASSERT_EQ(camway_client_create(&options, &client_), CAMWAY_OK) << camway_last_error();
    ASSERT_EQ(camway_event_queue_create(&queue_), CAMWAY_OK);
  }
  void TearDown() override {
    camway_client_free(client_);
    camway_event_queue_free(queue_);
    IntegrationTest::TearDown();
  }

  bool is_occupied(const double (&point_m)[3]) {
    std::uint8_t occupied = 2;
    EXPECT_EQ(camway_occupancy_points(client_, "room", point_m, 1, &occupied), CAMWAY_OK)
        << camway_last_error();
    return occupied != 0;
  }
  /// Takes the next event, which the test expects.
  camway_watch_event next() {
    camway_watch_event event{};
    EXPECT_EQ(camway_event_queue_next(queue_, kWait_s, &event, sizeof event), CAMWAY_OK)
        << camway_last_error();
    return event;
  }
  std::vector<std::string> operations() {
    camway_scene_answer* history = nullptr;
    EXPECT_EQ(camway_scene_history(client_, "room", &history), CAMWAY_OK) << camway_last_error();
    std::size_t count = 0;
    EXPECT_EQ(camway_scene_answer_num_revisions(history, &count), CAMWAY_OK);
    std::vector<std::string> found(count);
    for (std::size_t i = 0; i < count; ++i) {
      camway_scene_revision revision;
      EXPECT_EQ(camway_scene_answer_revision_at(history, i, &revision, sizeof revision), CAMWAY_OK);
      if (i == 0) first_revision_ = revision.revision;
      found[i] = revision.operation;
    }
    camway_scene_answer_free(history);
    return found;
  }

  /// Puts a box into the room.
  void put_box(const char* name, const double (&size_m)[3], const camway_pose& place) {
    EXPECT_EQ(camway_scene_put_box(client_, "room", name, size_m, &place, nullptr), CAMWAY_OK)
        << camway_last_error();
  }

  camway_client* client_ = nullptr;
  camway_event_queue* queue_ = nullptr;
  std::int64_t first_revision_ = 0;
};

constexpr camway_keyframe kAcross[] = {{0.0, {1, 2, 4}, {1, 0, 0, 0}},
                                       {4.0, {8, 2, 4}, {1, 0, 0, 0}}};

/// A request for a path through the room.
camway_plan_request across() {
  camway_plan_request request;
  camway_plan_request_init(&request, sizeof request);
  request.scene = "room";
  request.keyframes = kAcross;
  request.num_keyframes = 2;
  return request;
}

/// The keyframes, images and frame of an answer, for planning again.
struct Copied {
  explicit Copied(const camway_answer* answer) {
    std::size_t count = 0;
    EXPECT_EQ(camway_answer_keyframes(answer, nullptr, 0, &count), CAMWAY_OK);
    std::vector<camway_path_keyframe> had(count);
    EXPECT_EQ(camway_answer_keyframes(answer, had.data(), count, &count), CAMWAY_OK);
    for (const camway_path_keyframe& from : had) {
      camway_keyframe& keyframe = keyframes.emplace_back();
      keyframe.time_s = from.time_s;
      std::copy_n(from.position_m, 3, keyframe.position_m);
      std::copy_n(from.orientation_wxyz, 4, keyframe.orientation_wxyz);
    }
    images.resize(4 * count);
    EXPECT_EQ(camway_answer_images(answer, images.data(), count, &count), CAMWAY_OK);
    EXPECT_EQ(camway_answer_frame(answer, &frame), CAMWAY_OK) << camway_last_error();
  }
  camway_plan_request request(const camway_plan_request& before) const {
    camway_plan_request request = before;
    request.keyframes = keyframes.data();
    request.num_keyframes = keyframes.size();
    request.images = images.data();
    request.frame = &frame;
    return request;
  }

  std::vector<camway_keyframe> keyframes;
  std::vector<double> images;
  camway_path_frame frame;
};

/// Returns the position and the orientation of an answer's path at a time.
std::array<double, 7> pose_at(const camway_answer* answer, double time_s) {
  std::array<double, 7> pose{};
  EXPECT_EQ(camway_answer_poses(answer, &time_s, 1, pose.data(), pose.data() + 3), CAMWAY_OK);
  return pose;
}

/// Returns the largest difference of a number in the poses of two answers at the same time.
double largest_difference(const camway_answer* left, const camway_answer* right) {
  double largest = 0.0;
  for (double time_s = 0.0; time_s <= 4.0; time_s += 0.03125) {
    const std::array<double, 7> poses[2] = {pose_at(left, time_s), pose_at(right, time_s)};
    for (std::size_t i = 0; i < 7; ++i) {
      largest = std::max(largest, std::abs(poses[0][i] - poses[1][i]));
    }
  }
  return largest;
}

TEST_F(CInterfaceTest, AnAnswerIsPlannedAgainByItsFrame) {
  put_box("post", {0.2, 4.0, 0.2}, {{4.5, 2.0, 3.9}, {1, 0, 0, 0}});
  camway_plan_request request = across();
  request.bounds_max_m[1] = 2.5;
  camway_answer* answer = nullptr;
  ASSERT_EQ(camway_plan(client_, &request, kWait_s, &answer), CAMWAY_OK) << camway_last_error();
  double min_m[3];
  double max_m[3];
  ASSERT_EQ(camway_answer_bounds(answer, min_m, max_m), CAMWAY_OK);
  EXPECT_EQ(max_m[1], 2.5);
  EXPECT_EQ(min_m[1], -std::numeric_limits<double>::infinity());
  camway_plan_timing timing;
  ASSERT_EQ(camway_answer_timing(answer, &timing, sizeof timing), CAMWAY_OK);
  EXPECT_GT(timing.correct_ms, 0.0);
  EXPECT_GE(timing.total_ms, timing.correct_ms);

  const Copied copied(answer);
  const camway_plan_request same = copied.request(request);
  camway_answer* again = nullptr;
  ASSERT_EQ(camway_plan(client_, &same, kWait_s, &again), CAMWAY_OK) << camway_last_error();
  camway_answer_summary summary;
  ASSERT_EQ(camway_answer_summarize(again, &summary, sizeof summary), CAMWAY_OK);
  EXPECT_EQ(summary.corrected, 0);
  EXPECT_LE(largest_difference(answer, again), 1e-9) << "docs/requests.md promises that";
  camway_answer_free(again);

  // Without the frame the path is another one.
  camway_plan_request frameless = same;
  frameless.frame = nullptr;
  frameless.images = nullptr;
  frameless.max_inserted_keyframes = 0;
  camway_plan(client_, &frameless, kWait_s, &again);
  EXPECT_GT(largest_difference(answer, again), 1e-6);
  camway_answer_free(again);
  camway_answer_free(answer);
}

TEST_F(CInterfaceTest, TheSlowedPartsMakeThePathLonger) {
  camway_plan_request request = across();
  request.max_speed_m_per_s = 1.0;
  request.may_retime = 1;
  camway_answer* answer = nullptr;
  ASSERT_EQ(camway_plan(client_, &request, kWait_s, &answer), CAMWAY_OK) << camway_last_error();
  camway_answer_summary summary;
  ASSERT_EQ(camway_answer_summarize(answer, &summary, sizeof summary), CAMWAY_OK);
  EXPECT_GE(summary.end_s, 7.0) << "7 m at 1 m/s";
  std::vector<camway_slowed_stretch> slowed(64);
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_slowed(answer, slowed.data(), slowed.size(), &count), CAMWAY_OK);
  ASSERT_GT(count, 0u);
  ASSERT_LE(count, slowed.size());
  // Elsewhere times are only shifted.
  double longer_s = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    longer_s += slowed[i].t_end_s - slowed[i].t_begin_s;
    longer_s -= slowed[i].given_t_end_s - slowed[i].given_t_begin_s;
  }
  EXPECT_NEAR(summary.end_s - 4.0, longer_s, 1e-6);
  EXPECT_NEAR(summary.time_scale, summary.end_s / 4.0, 1e-9);
  camway_path_frame frame;
  EXPECT_EQ(camway_answer_frame(answer, &frame), CAMWAY_INVALID) << "a slowed path has none";
  camway_answer_free(answer);
}

TEST_F(CInterfaceTest, AKeyframeThatIsShutInIsProvedToBe) {
  put_box("cell", {2.0, 2.0, 2.0}, {{8, 2, 4}, {1, 0, 0, 0}});
  const camway_plan_request request = across();
  camway_answer* answer = nullptr;
  ASSERT_EQ(camway_plan(client_, &request, kWait_s, &answer), CAMWAY_INFEASIBLE)
      << camway_last_error();
  camway_infeasibility found;
  ASSERT_EQ(camway_answer_infeasibility(answer, &found, sizeof found), CAMWAY_OK)
      << camway_last_error();
  EXPECT_EQ(found.proof, CAMWAY_PROOF_SURFACE);
  EXPECT_EQ(found.keyframe_inside, 1);
  EXPECT_EQ(found.keyframe_outside, 0);
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_proof_triangles(answer, nullptr, 0, &count), CAMWAY_OK);
  EXPECT_EQ(count, 12u) << "those of the box";
  EXPECT_STRNE(camway_answer_message(answer), "");
  camway_answer_free(answer);
}

TEST_F(CInterfaceTest, AScanBreaksAPathAndIsTakenBack) {
  const camway_plan_request request = across();
  std::int64_t watch = 0;
  ASSERT_EQ(camway_watch_start_polled(client_, &request, queue_, &watch), CAMWAY_OK);
  EXPECT_EQ(next().kind, CAMWAY_EVENT_ANSWER);

  camway_scan_map map;
  camway_scan_map_init(&map, sizeof map);
  map.resolution_m = 0.125;
  ASSERT_EQ(camway_scene_put_scan_map(client_, "room", "map", &map, nullptr, nullptr), CAMWAY_OK)
      << camway_last_error();
  // The near quadrilateral is 0.1 m before the eye.
  const double seen_m[3] = {4.5, 2.0, 3.9};
  const double sensor_m[3] = {4.5, 8.0, 3.9};
  EXPECT_FALSE(is_occupied(seen_m));
  ASSERT_EQ(camway_scene_insert_scan(client_, "room", "map", seen_m, 1, sensor_m, nullptr),
            CAMWAY_OK)
      << camway_last_error();
  EXPECT_TRUE(is_occupied(seen_m));
  const camway_watch_event broken = next();
  ASSERT_EQ(broken.kind, CAMWAY_EVENT_BROKEN);
  ASSERT_GT(broken.num_broken, 0u);
  EXPECT_NEAR(broken.broken[0].t_begin_s, 2.0, 0.2);
  const camway_watch_event corrected = next();
  ASSERT_EQ(corrected.kind, CAMWAY_EVENT_ANSWER);
  camway_path_measures measures;
  ASSERT_EQ(camway_answer_measures(corrected.answer, &measures, sizeof measures), CAMWAY_OK);
  EXPECT_GT(measures.largest_deviation_m + measures.largest_shift_rad, 0.0);
  camway_answer_summary summary;
  ASSERT_EQ(camway_answer_summarize(corrected.answer, &summary, sizeof summary), CAMWAY_OK);
  EXPECT_GE(summary.viewing_distance_m, 1.0) << "the least that is taken from a scene";
  camway_correction correction;
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_corrections(corrected.answer, &correction, 1, &count), CAMWAY_OK);
  EXPECT_GE(count, 1u);
  EXPECT_NE(correction.method, CAMWAY_CORRECTION_NONE);

  EXPECT_EQ(operations(), (std::vector<std::string>{"load", "put", "scan"}));
  ASSERT_EQ(camway_scene_restore(client_, "room", first_revision_, nullptr, nullptr), CAMWAY_OK)
      << camway_last_error();
  EXPECT_FALSE(is_occupied(seen_m));
  ASSERT_EQ(camway_scene_put_points(client_, "room", "dust", seen_m, 1, 0.1, nullptr, nullptr),
            CAMWAY_OK)
      << camway_last_error();
  EXPECT_TRUE(is_occupied(seen_m));
  EXPECT_EQ(camway_watch_end(client_, watch, kWait_s), CAMWAY_OK);
}

}  // namespace
}  // namespace camway::integration
