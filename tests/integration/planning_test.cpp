// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

class PlanningTest : public IntegrationTest {};

TEST_F(PlanningTest, AnswersSeveralClientsOnSeveralScenesAtOnce) {
  start_daemon();
  const std::vector<std::string> office{"office-free-corridor", "office-free-door",
                                        "office-graze-door", "office-impossible-safe"};
  std::vector<std::unique_ptr<Process>> clients;
  clients.push_back(start_client("a", "office", office));
  clients.push_back(start_client("b", "office", office));
  clients.push_back(start_client("c", "maze", {"maze-free-cells", "maze-graze-corners"}));
  clients.push_back(start_client("d", "gallery", {"gallery-free-aisle", "gallery-free-ring"}));
  for (auto& client : clients) EXPECT_EQ(client->wait(), 0) << client->output();

  for (const auto& client : clients) {
    for (const ClientLine& line : lines_of(*client)) {
      SCOPED_TRACE(client->output());
      const auto is_of = [&](const char* kind) {
        return line.request.find(kind) != std::string::npos;
      };
      EXPECT_TRUE(line.status == "ok" || !is_of("-free-"));
      EXPECT_TRUE(line.status != "ok" || !is_of("-impossible-"));
    }
  }
  // Every client gets the same path, with the same bits, for the same request.
  const std::vector<ClientLine> a = lines_of(*clients[0]);
  const std::vector<ClientLine> b = lines_of(*clients[1]);
  ASSERT_EQ(a.size(), office.size());
  ASSERT_EQ(b.size(), office.size());
  for (std::size_t i = 0; i < office.size(); ++i) {
    EXPECT_EQ(a[i].status, b[i].status) << office[i];
    EXPECT_EQ(a[i].path_hash, b[i].path_hash) << office[i];
  }
  EXPECT_NE(a[0].path_hash, a[1].path_hash);  // the hash tells paths apart
}

TEST_F(PlanningTest, AnswerDoesNotDependOnTheNumberOfWorkers) {
  const std::vector<std::string> requests{"office-free-atrium", "office-graze-slalom",
                                          "office-free-stairs"};
  std::set<std::vector<std::string>> outcomes;
  for (const std::string workers : {"1", "3"}) {
    start_daemon({"--workers", workers});
    std::vector<std::string> outcome;
    std::vector<std::unique_ptr<Process>> clients;
    for (const std::string& request : requests) {
      clients.push_back(start_client(request, "office", {request}));
    }
    for (auto& client : clients) {
      ASSERT_EQ(client->wait(), 0) << client->output();
      for (const ClientLine& line : lines_of(*client)) {
        outcome.push_back(line.status + " " + line.path_hash);
      }
    }
    EXPECT_EQ(outcome.size(), requests.size());
    outcomes.insert(outcome);
  }
  EXPECT_EQ(outcomes.size(), 1u);
}

TEST_F(PlanningTest, HeartbeatListsTheScenes) {
  start_daemon();
  Client client;
  const DaemonStatus status = client.status();
  ASSERT_TRUE(status.ok()) << status.error;
  EXPECT_EQ(status.total_scenes, 3);
  ASSERT_EQ(status.scenes.size(), 3u);
  EXPECT_EQ(status.scenes[0].name, "gallery");
  EXPECT_EQ(status.scenes[1].name, "maze");
  EXPECT_EQ(status.scenes[2].name, "office");
  EXPECT_GT(status.scenes[2].num_triangles, 10'000);
  EXPECT_EQ(status.scenes[2].occupancy_resolution_m, 0.2);
  EXPECT_EQ(status.scenes[1].occupancy_resolution_m, 0.0);
  EXPECT_GE(status.scenes[2].bounds_max_m[0] - status.scenes[2].bounds_min_m[0], 30.0);
}

TEST_F(PlanningTest, PathPassesThroughEveryGivenKeyframe) {
  start_daemon();
  Client client(patient());
  const PlanRequest request = request_of("office-free-timed", "office");
  const PlanResponse response = client.plan(request);
  ASSERT_TRUE(response.ok()) << response.error;
  std::size_t given = 0;
  for (const PathKeyframe& keyframe : response.keyframes) {
    if (keyframe.inserted) continue;
    ASSERT_LT(given, request.keyframes.size());
    EXPECT_EQ(keyframe.time_s, request.keyframes[given].time_s);
    // Control points at joins are the keyframes' own numbers, up to a few roundings of metres.
    const Pose pose = response.path.pose(keyframe.time_s);
    double dot = 0.0;
    for (std::size_t d = 0; d < 3; ++d) {
      EXPECT_NEAR(pose.position_m[d], request.keyframes[given].position_m[d], 1e-12);
    }
    for (std::size_t d = 0; d < 4; ++d) {
      dot += pose.orientation_wxyz[d] * request.keyframes[given].orientation_wxyz[d];
    }
    // The files hold 12 decimals, so their quaternions are of unit length to 1e-12 only.
    EXPECT_NEAR(std::abs(dot), 1.0, 1e-11);
    ++given;
  }
  EXPECT_EQ(given, request.keyframes.size());
}

TEST_F(PlanningTest, LongRequestsAndAnswersTravelInPages) {
  start_daemon();
  // Back and forth along the free part between the keyframes of a request that is a line.
  PlanRequest request = request_of("office-free-straight", "office");
  ASSERT_EQ(request.keyframes.size(), 2u);
  const std::vector<Keyframe> ends = request.keyframes;
  request.keyframes.clear();
  constexpr int kKeyframes = 3000;
  constexpr int kSwing = 100;
  for (int i = 0; i < kKeyframes; ++i) {
    const int phase = i % (2 * kSwing);
    const double share = double(phase < kSwing ? phase : 2 * kSwing - phase) / kSwing;
    Keyframe keyframe = ends[0];
    for (std::size_t d = 0; d < 3; ++d) {
      keyframe.position_m[d] += share * (ends[1].position_m[d] - ends[0].position_m[d]);
    }
    keyframe.time_s = i;
    request.keyframes.push_back(keyframe);
  }
  request.deadline_s = 30.0;
  Client client(patient());
  const PlanResponse response = client.plan(request);
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.keyframes.size(), std::size_t(kKeyframes));
  EXPECT_GE(response.path.segments().size(), std::size_t(kKeyframes - 1));
  EXPECT_EQ(response.path.end(), double(kKeyframes - 1));
}

TEST_F(PlanningTest, RequestsAreCalledOffInTheQueueAndInPlanning) {
  start_daemon({"--workers", "1"});
  Client client(patient());
  PlanRequest request = request_of("office-wall-tour", "office");
  std::vector<PendingPlan> plans;
  for (int i = 0; i < 20; ++i) {
    request.seed = i + 1;
    plans.push_back(client.plan_async(request));
  }
  for (const PendingPlan& plan : plans) client.cancel(plan.request_id);
  int cancelled = 0;
  for (PendingPlan& plan : plans) {
    const PlanResponse response = plan.answer.get();
    if (response.status == Status::kCancelled) ++cancelled;
    EXPECT_TRUE(response.status == Status::kCancelled || !response.path.empty()) << response.error;
  }
  // Some requests may be finished before the daemon receives the cancel.
  EXPECT_GE(cancelled, 10);
  EXPECT_TRUE(client.plan(request_of("office-free-door", "office")).ok());
}

TEST_F(PlanningTest, OptionsOfCorrectionArriveAndAnswersSayWhatWasDone) {
  start_daemon();
  Client client(patient());
  PlanRequest request = request_of("office-graze-column", "office");
  request.objective = Objective::kShortest;
  request.seed = 5;
  request.viewing_distance_m = 2.5;
  const PlanResponse response = client.plan(request);
  ASSERT_TRUE(response.ok()) << response.error;
  EXPECT_EQ(response.viewing_distance_m, 2.5);
  ASSERT_FALSE(response.collisions.empty());
  ASSERT_EQ(response.corrections.size(), response.collisions.size());
  for (std::size_t i = 0; i < response.corrections.size(); ++i) {
    EXPECT_EQ(response.corrections[i].t_begin_s, response.collisions[i].t_begin_s);
    EXPECT_NE(response.corrections[i].method, Correction::Method::kNone);
    EXPECT_LE(response.corrections[i].changed_t_begin_s, response.collisions[i].t_begin_s);
  }
  ASSERT_TRUE(response.measures_before);
  ASSERT_TRUE(response.measures);
  EXPECT_GT(response.measures->length_m, 0.0);
  EXPECT_LT(response.measures_before->largest_deviation_m, 1e-9) << "of itself, but for rounding";
  EXPECT_GT(response.measures->largest_deviation_m, 1e-3);
  EXPECT_FALSE(response.infeasibility);
}

TEST_F(PlanningTest, SameIdGetsTheSameAnswerWithoutPlanningAgain) {
  start_daemon();
  Client client(patient());
  PlanRequest request = request_of("office-free-door", "office");
  request.request_id = 77;
  const PlanResponse first = client.plan(request);
  ASSERT_TRUE(first.ok()) << first.error;
  const PlanResponse again = client.plan(request);
  ASSERT_TRUE(again.ok()) << again.error;
  EXPECT_EQ(first.timing.total_ms, again.timing.total_ms);  // of the one time that it was planned
  EXPECT_TRUE(eventually([&] { return client.status().repeated_requests >= 1; }));

  request.keyframes[0].position_m[0] += 0.01;
  const PlanResponse other = client.plan(request);
  EXPECT_EQ(other.status, Status::kInvalid);
  EXPECT_THAT(other.error, HasSubstr("77"));
}

// The largest body comes in some sixty pages.
TEST_F(PlanningTest, PlansWithTheLargestBody) {
  start_daemon();
  Client client(patient());
  PlanRequest request = request_of("office-free-corridor", "office");
  constexpr int kAround = 500;
  constexpr int kAcross = 100;
  std::vector<Body::Point> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
  const auto at = [](int i, int j) { return i % kAround * kAcross + j % kAcross; };
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const double a = 2.0 * M_PI * i / kAround;
      const double b = 2.0 * M_PI * j / kAcross;
      const double radius = 0.05 + 0.01 * std::cos(b);
      vertices.push_back({radius * std::cos(a), radius * std::sin(a), 0.01 * std::sin(b)});
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  request.body = Body::solid_mesh(vertices, triangles);
  const PlanResponse response = client.plan(request);
  ASSERT_TRUE(response.ok()) << response.error << response.message;
  EXPECT_TRUE(response.certified);

  request.body.triangles.pop_back();
  const PlanResponse refused = client.plan(request);
  EXPECT_FALSE(refused.ok());
  EXPECT_THAT(refused.message,
              HasSubstr("body.triangles: are no closed surface: the edge between"));
}

}  // namespace
}  // namespace camway::integration
