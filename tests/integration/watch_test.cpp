// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <deque>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;
using Kind = WatchEvent::Kind;

/// Returns a crate to block the path of `walk`.
SceneShape crate() { return SceneBox{{0.5, 0.5, 0.5}}; }

/// Returns a request from (0, 0, 0) to (4, 0, 0) in the empty scene "yard", in four seconds.
PlanRequest walk() {
  PlanRequest request;
  request.scene = "yard";
  request.keyframes.resize(2);
  request.keyframes[0].time_s = 0.0;
  request.keyframes[1].time_s = 4.0;
  request.keyframes[1].position_m = {4.0, 0.0, 0.0};
  return request;
}

Pose at(double x_m, double y_m) {
  Pose pose;
  pose.position_m = {x_m, y_m, 0.0};
  return pose;
}

/// Collects the events of a client, which may outlive it and call its handler after that.
class Events {
 public:
  [[nodiscard]] WatchHandler handler() const {
    return [kept = kept_](const WatchEvent& event) {
      const std::lock_guard lock(kept->mutex);
      kept->events.push_back(event);
    };
  }

  /// Waits for the next event of this kind at this revision, or at any if it is 0. Drops the
  /// others.
  bool wait_for(Kind kind, std::int64_t revision, WatchEvent* found = nullptr) {
    return eventually([&] {
      const std::lock_guard lock(kept_->mutex);
      while (!kept_->events.empty()) {
        const WatchEvent event = kept_->events.front();
        kept_->events.pop_front();
        if (event.kind != kind || (revision != 0 && event.scene_revision != revision)) continue;
        if (found != nullptr) *found = event;
        return true;
      }
      return false;
    });
  }

 private:
  struct Kept {
    std::mutex mutex;  ///< guards events
    std::deque<WatchEvent> events;
  };
  std::shared_ptr<Kept> kept_ = std::make_shared<Kept>();
};

class WatchTest : public IntegrationTest {
 protected:
  /// Makes the yard, puts a crate in the way of a watched path, and removes it.
  void play(Client& watcher, Client& painter, bool hears_all) {
    Events events;
    ASSERT_TRUE(painter.load_scene("yard", {}).ok());
    const std::int64_t id = watcher.watch(walk(), events.handler());
    ASSERT_TRUE(events.wait_for(Kind::kAnswer, 0));
    break_and_mend(painter, events, hears_all);
    watcher.unwatch(id);
    EXPECT_TRUE(eventually([&] { return painter.status().watched_paths == 0; }));
  }

  /// On a bad network a correction may overtake the news that the path is broken.
  void break_and_mend(Client& painter, Events& events, bool hears_all) {
    const SceneAnswer put = painter.put_object("yard", "crate", crate(), at(2.0, 0.0));
    ASSERT_TRUE(put.ok()) << put.error;
    if (hears_all) {
      WatchEvent broken;
      ASSERT_TRUE(events.wait_for(Kind::kBroken, put.scene.revision, &broken));
      ASSERT_FALSE(broken.broken.empty());
      EXPECT_LT(broken.broken.front().t_begin_s, 1.8);
      EXPECT_GT(broken.broken.back().t_end_s, 2.2);
    }
    WatchEvent corrected;
    ASSERT_TRUE(events.wait_for(Kind::kAnswer, put.scene.revision, &corrected));
    ASSERT_TRUE(corrected.answer->ok()) << corrected.answer->error;
    const PlanResponse fresh = painter.plan(walk());
    ASSERT_TRUE(fresh.ok()) << fresh.error;
    EXPECT_EQ(fresh.path.segments().size(), corrected.answer->path.segments().size());
    for (double time_s = 0.0; time_s <= 4.0; time_s += 0.1) {
      EXPECT_EQ(fresh.path.pose(time_s).position_m, corrected.answer->path.pose(time_s).position_m)
          << "a corrected path is what a fresh request gets";
    }
    ASSERT_TRUE(painter.remove_object("yard", "crate").ok());
  }
};

TEST_F(WatchTest, TellsOfAChangeAndCorrectsThePath) {
  start_daemon();
  Client watcher(patient());
  Client painter(patient());
  play(watcher, painter, /*hears_all=*/true);
}

class WatchOnABadNetworkTest : public WatchTest, public ::testing::WithParamInterface<double> {};

TEST_P(WatchOnABadNetworkTest, TellsOfAChangeAndCorrectsThePath) {
  start_daemon();
  start_bad_network(GetParam());
  Client watcher(patient_far_away());
  Client painter(patient());
  play(watcher, painter, /*hears_all=*/false);
}

INSTANTIATE_TEST_SUITE_P(Shares, WatchOnABadNetworkTest, ::testing::ValuesIn(kBadShares),
                         name_of_share);

TEST_F(WatchTest, ADaemonThatIsStartedAnewWatchesOn) {
  // A floor far below.
  std::ofstream(file("yard.obj")) << "v -9 -9 -5\nv 9 -9 -5\nv 0 9 -5\nf 1 2 3\n";
  const std::vector<std::string> scene{"yard=" + file("yard.obj")};
  start_daemon_with_scenes(scene);
  Client watcher(patient());
  Client painter(patient());
  Events events;
  watcher.watch(walk(), events.handler());
  ASSERT_TRUE(events.wait_for(Kind::kAnswer, 0));
  daemon().signal(SIGKILL);
  ASSERT_TRUE(daemon().wait());
  start_daemon_with_scenes(scene);
  ASSERT_TRUE(events.wait_for(Kind::kAnswer, 0)) << "it plans again what it does not know";
  break_and_mend(painter, events, /*hears_all=*/true);
}

TEST_F(WatchTest, TheSilenceOfADaemonIsToldLongBeforeTheLease) {
  start_daemon();
  // Messages of another daemon are no sign of life.
  Process other({CAMWAYD_BINARY, "--prefix", "OTHER", "--scene", "maze=" + scene_file("maze")},
                file("other.log"));
  Client painter(patient());
  ASSERT_TRUE(painter.load_scene("yard", {}).ok());
  ClientOptions options = patient();
  options.watch_lease_s = 10'000.0;
  Client watcher(options);
  Events events;
  watcher.watch(walk(), events.handler());
  ASSERT_TRUE(events.wait_for(Kind::kAnswer, 0));
  daemon().signal(SIGKILL);
  ASSERT_TRUE(daemon().wait());
  WatchEvent lost;
  ASSERT_TRUE(events.wait_for(Kind::kLost, 0, &lost));
  EXPECT_EQ(lost.status, Status::kNoDaemon);
  EXPECT_THAT(lost.error, HasSubstr("the daemon fell silent"));
  other.signal(SIGTERM);
  EXPECT_EQ(other.wait(), 0) << other.output();
}

TEST_F(WatchTest, ADaemonThatStoodStillIsToldToBeBack) {
  start_daemon();
  Client painter(patient());
  ASSERT_TRUE(painter.load_scene("yard", {}).ok());
  Client watcher(patient());
  Events events;
  watcher.watch(walk(), events.handler());
  ASSERT_TRUE(events.wait_for(Kind::kAnswer, 0));
  daemon().signal(SIGSTOP);
  ASSERT_TRUE(events.wait_for(Kind::kLost, 0));
  daemon().signal(SIGCONT);
  ASSERT_TRUE(events.wait_for(Kind::kWatched, 0));
}

TEST_F(WatchTest, OffersTheFirstPathBitForBitOnceItsObstacleIsGone) {
  start_daemon();
  Client watcher(patient());
  Client painter(patient());
  ASSERT_TRUE(painter.load_scene("yard", {}).ok());
  Events events;
  const std::int64_t id = watcher.watch(walk(), events.handler());
  WatchEvent first;
  ASSERT_TRUE(events.wait_for(Kind::kAnswer, 0, &first));
  const SceneAnswer put = painter.put_object("yard", "crate", crate(), at(2.0, 0.0));
  ASSERT_TRUE(put.ok()) << put.error;
  WatchEvent detour;
  ASSERT_TRUE(events.wait_for(Kind::kAnswer, put.scene.revision, &detour));
  ASSERT_TRUE(detour.answer->ok()) << detour.answer->error;
  const SceneAnswer removed = painter.remove_object("yard", "crate");
  ASSERT_TRUE(removed.ok()) << removed.error;
  WatchEvent better;
  ASSERT_TRUE(events.wait_for(Kind::kBetter, removed.scene.revision, &better));
  ASSERT_TRUE(better.answer->ok());
  EXPECT_EQ(better.answer->path.segments().size(), first.answer->path.segments().size());
  EXPECT_LT(better.answer->measures->largest_deviation_m,
            detour.answer->measures->largest_deviation_m);
  watcher.take_better(id);
  WatchEvent taken;
  ASSERT_TRUE(events.wait_for(Kind::kAnswer, removed.scene.revision, &taken));
  for (double time_s = 0.0; time_s <= 4.0; time_s += 0.1) {
    for (const WatchEvent* event : {&better, &taken}) {
      EXPECT_EQ(event->answer->path.pose(time_s).position_m,
                first.answer->path.pose(time_s).position_m);
    }
  }
  // The better path is watched now.
  const SceneAnswer back = painter.put_object("yard", "crate", crate(), at(2.0, 0.0));
  EXPECT_TRUE(events.wait_for(Kind::kBroken, back.scene.revision));
}

TEST_F(WatchTest, TheCommandEndsWhereNoDaemonIsHeard) {
  Process watch({CAMWAY_BINARY, "watch", "office", "--request", request_file("office-free-door")},
                file("watch.log"));
  EXPECT_EQ(watch.wait(), 4) << watch.output();
  EXPECT_THAT(watch.output(), HasSubstr("no daemon was heard"));
}

TEST_F(WatchTest, TheCommandPrintsWhatHappens) {
  start_daemon();
  Client painter(patient());
  Process watch({CAMWAY_BINARY, "watch", "office", "--request", request_file("office-free-door"),
                 "--count", "3", "--json"},
                file("watch.log"));
  ASSERT_TRUE(eventually([&] {
    return watch.output().find("\"event\":\"answer\"") != std::string::npos;
  })) << watch.output();
  const PlanRequest request = request_of("office-free-door", "office");
  const PlanResponse plan = painter.plan(request);
  ASSERT_TRUE(plan.ok());
  const Pose middle = plan.path.pose(0.5 * (plan.path.begin() + plan.path.end()));
  Pose place;
  place.position_m = middle.position_m;
  // In the centre of the near quadrilateral.
  const auto forward = [&](int axis) {
    const auto& q = middle.orientation_wxyz;
    const std::array<double, 3> back{2 * (q[1] * q[3] + q[0] * q[2]),
                                     2 * (q[2] * q[3] - q[0] * q[1]),
                                     1 - 2 * (q[1] * q[1] + q[2] * q[2])};
    return -back[static_cast<std::size_t>(axis)];
  };
  for (int axis = 0; axis < 3; ++axis) {
    place.position_m[static_cast<std::size_t>(axis)] += request.camera.near_m * forward(axis);
  }
  ASSERT_TRUE(painter.put_object("office", "speck", SceneBox{{0.02, 0.02, 0.02}}, place).ok());
  EXPECT_EQ(watch.wait(), 0) << watch.output();
  EXPECT_THAT(watch.output(), HasSubstr("\"event\":\"broken\""));
  EXPECT_THAT(watch.output(), HasSubstr("\"t_begin\""));
}

TEST_F(WatchTest, TheCommandEndsItsWatch) {
  start_daemon();
  Client client(patient());
  const std::vector<std::string> command{CAMWAY_BINARY, "watch", "office", "--request",
                                         request_file("office-free-door")};
  const auto is_watched = [&] { return client.status().watched_paths == 1; };
  {
    std::vector<std::string> counted = command;
    counted.insert(counted.end(), {"--count", "1"});
    Process watch(counted, file("watch.log"));
    EXPECT_EQ(watch.wait(), 0) << watch.output();
  }
  // The first heartbeat may be from before the end of the watch.
  client.status();
  EXPECT_EQ(client.status().watched_paths, 0) << "long before its lease is over";

  Process watch(command, file("watch.log"));
  ASSERT_TRUE(eventually(is_watched)) << watch.output();
  watch.signal(SIGINT);
  EXPECT_EQ(watch.wait(), 0) << watch.output();
  client.status();
  EXPECT_EQ(client.status().watched_paths, 0);
}

TEST_F(WatchTest, TheCommandSaysOnceThatThereIsNoPathToWatch) {
  start_daemon();
  Process watch({CAMWAY_BINARY, "watch", "nowhere", "--request", request_file("office-free-door")},
                file("watch.log"));
  EXPECT_EQ(watch.wait(), 2) << watch.output();
  const std::string said = watch.output();
  EXPECT_THAT(said, HasSubstr("nowhere"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST_F(WatchTest, TheCommandSaysOnceThatALimitIsInTheWay) {
  std::ofstream(file("camwayd.toml"))
      << "[watch]\npaths = 0\n[[scene]]\nname = \"office\"\nfile = \"" << scene_file("office")
      << "\"\n";
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  Process watch({CAMWAY_BINARY, "watch", "office", "--request", request_file("office-free-door"),
                 "--for-s", "3", "--json"},
                file("watch.log"));
  EXPECT_EQ(watch.wait(), 3) << watch.output();
  const std::string said = watch.output();
  EXPECT_THAT(said, HasSubstr("watch.paths"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 2) << said;
}

}  // namespace
}  // namespace camway::integration
