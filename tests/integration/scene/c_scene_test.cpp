// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

constexpr double kWait_s = 30.0;

/// A program in C that maps by scans, watches a path and takes events on its own thread.
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

  camway_client* client_ = nullptr;
  camway_event_queue* queue_ = nullptr;
  std::int64_t first_revision_ = 0;
};

TEST_F(CInterfaceTest, AScanBreaksAPathAndIsTakenBack) {
  const camway_keyframe keyframes[] = {{0.0, {1, 2, 4}, {1, 0, 0, 0}},
                                       {4.0, {8, 2, 4}, {1, 0, 0, 0}}};
  camway_plan_request request;
  camway_plan_request_init(&request, sizeof request);
  request.scene = "room";
  request.keyframes = keyframes;
  request.num_keyframes = 2;
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
