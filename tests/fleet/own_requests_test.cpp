// SPDX-License-Identifier: MIT
//
// The requests of scenes/requests, planned by a fleet and by one process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/messages/plan.h"
#include "daemon/scene/import/import.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/fleet/test_fleet.h"
#include "tests/messages/request_on_wire.h"
#include "tests/service/running_service.h"
#include "tests/support/watched_scenes.h"
#include "tools/json/json_document.h"
#include "tools/json/json_request.h"

namespace camway::fleet {
namespace {

namespace fs = std::filesystem;

using planning::WatchedPath;

constexpr double kAmple_s = 600.0;

std::shared_ptr<const scene::Snapshot> scene_of(const std::string& name) {
  const std::string file = std::string(CAMWAY_SCENES_FOLDER) + "/" + name + ".obj";
  scene::ImportResult imported = scene::import_mesh(file, {});
  EXPECT_TRUE(imported.mesh) << imported.error;
  return scene::make_snapshot(name, *std::move(imported.mesh)).snapshot;
}

/// Returns the requests of our own, on the scenes that their names begin with.
std::vector<plan_request_t> own_requests() {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(std::string(CAMWAY_SCENES_FOLDER) + "/requests")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<plan_request_t> requests;
  for (const fs::path& file : files) {
    const auto request = tools::read_as<tools::RequestFile>(file.string());
    EXPECT_TRUE(request) << request.error;
    if (!request || request->body_file) continue;
    planning::PlanRequest wanted = *request;
    wanted.options.deadline_s = kAmple_s;
    plan_request_t wire =
        messages::to_wire(wanted, {"client", static_cast<std::int64_t>(requests.size() + 1), 0});
    const std::string name = file.stem().string();
    wire.scene = name.substr(0, name.find('-'));
    wire.deadline_s = 0.0;
    wire.watch_lease_s = 10.0;
    requests.push_back(std::move(wire));
  }
  return requests;
}

template <class Value>
bool is_same(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof(Value)) == 0;
}

void expect_same(const std::shared_ptr<const WatchedPath>& a,
                 const std::shared_ptr<const WatchedPath>& b) {
  ASSERT_EQ(a == nullptr, b == nullptr);
  if (!a) return;
  const auto& segments = a->path().segments();
  ASSERT_EQ(segments.size(), b->path().segments().size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const motion::Segment& other = b->path().segments()[i];
    EXPECT_TRUE(is_same(segments[i].t0_s, other.t0_s) && is_same(segments[i].t1_s, other.t1_s) &&
                is_same(segments[i].position, other.position) &&
                is_same(segments[i].orientation, other.orientation))
        << "segment " << i;
  }
  EXPECT_EQ(a->body().triangles_C().size(), b->body().triangles_C().size());
  for (std::size_t i = 0; i < a->body().triangles_C().size(); ++i) {
    EXPECT_TRUE(is_same(a->body().triangles_C()[i], b->body().triangles_C()[i]));
  }
  EXPECT_EQ(a->body().radius_m(), b->body().radius_m());
  EXPECT_EQ(a->body().ball_radius_m(), b->body().ball_radius_m());
  EXPECT_EQ(a->body().slack_m(), b->body().slack_m());
  EXPECT_TRUE(is_same(a->detect(), b->detect()));
  EXPECT_TRUE(is_same(a->bounds(), b->bounds()));
  EXPECT_EQ(a->memory_bytes(), b->memory_bytes());
}

// Few requests end with a smaller near distance, or repaired keyframes, so the results are made up.
TEST(WatchedPart, HasTheNearScaleAndTheFreePoses) {
  testing::Random random(20261130);
  const planning::PlanRequest request = testing::random_path_request(4, random);
  planning::PlanResult result = testing::echo_result(request);
  result.certificate.certified = true;
  result.near_scale = 0.6;
  result.collisions = {{0.25, 0.5, {}}};
  const motion::Pose free{request.keyframes[1].pose.position + random.in_cube(0.1),
                          random.rotation()};
  result.keyframe_faults = {{1, 0.1, free}, {2, 0.1, std::nullopt}};
  const plan_response_t wire = messages::to_wire(result, {{"client", 1, 0}, "room", 1, "digest"});
  const auto part = messages::watched_part_of(wire, request.keyframes.size());
  ASSERT_TRUE(part) << part.error;
  const auto shared = [](std::optional<WatchedPath> path) {
    return path ? std::make_shared<const WatchedPath>(*std::move(path)) : nullptr;
  };
  const auto of = [&](const planning::PlanResult& from) {
    return std::pair{shared(WatchedPath::of(request, from)),
                     shared(WatchedPath::as_interpolated(request, from))};
  };
  const auto mine = of(result);
  const auto read = of(*part);
  ASSERT_TRUE(mine.first && mine.second);
  expect_same(mine.first, read.first);
  expect_same(mine.second, read.second);
}

TEST(OwnRequests, AFleetOfThreeGivesTheAnswersAndWatchedPathsOfOneProcess) {
  testing::MemoryNetwork network;
  std::deque<testing::TestPlanner> planners;
  testing::TestFront front(network, "front");
  for (const char* id : {"a", "b", "c"}) planners.emplace_back(network, id);
  for (const char* name : {"gallery", "maze", "office"}) {
    const auto scene = scene_of(name);
    front.follow(scene);
    for (testing::TestPlanner& planner : planners) planner.follow(scene);
  }
  for (testing::TestPlanner& planner : planners) planner.start();
  ASSERT_TRUE(front.wait_for_slots(3));
  const std::vector<plan_request_t> requests = own_requests();
  ASSERT_GT(requests.size(), 30U);
  int watched = 0;
  int interpolated = 0;
  for (const plan_request_t& request : requests) {
    SCOPED_TRACE(request.scene + " " + std::to_string(request.request_id));
    const auto scene = front.scenes.find(request.scene);
    const auto deadline = base::Deadline::after_s(kAmple_s);
    const service::Answered remote = front.answerer->answer(scene, request, deadline);
    const service::Answered local = front.here.answer(scene, request, deadline);
    EXPECT_EQ(testing::timeless(remote.wire), testing::timeless(local.wire));
    EXPECT_EQ(remote.proved_in, scene);
    expect_same(remote.path, local.path);
    expect_same(remote.interpolated, local.interpolated);
    watched += remote.path ? 1 : 0;
    interpolated += remote.interpolated ? 1 : 0;
  }
  EXPECT_GT(watched, 20);
  EXPECT_GT(interpolated, 5);
  EXPECT_EQ(front.counts().planned_here, 0);
  int calls = 0;
  for (const testing::TestPlanner& planner : planners) calls += planner.held.calls();
  EXPECT_EQ(calls, static_cast<int>(requests.size()));
}

}  // namespace
}  // namespace camway::fleet
