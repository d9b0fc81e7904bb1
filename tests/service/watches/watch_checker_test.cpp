// SPDX-License-Identifier: MIT
#include "daemon/service/watches/watch_checker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <random>

#include "daemon/planning/plan.h"
#include "daemon/planning/stages/path_check.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/watched_scenes.h"

namespace camway::service {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;
using planning::WatchedPath;
using scene::SceneChange;
using testing::at;
using testing::box_source;
using testing::random_path_request;

/// The verdicts of a checker so far.
class Told {
 public:
  using Collisions = std::vector<collision::CollisionInterval>;

  WatchChecker::Report take() {
    return [this](WatchChecker::News news) {
      const std::lock_guard lock(mutex_);
      for (WatchChecker::Verdict& verdict : news.verdicts) {
        collisions_[verdict.id] = std::move(verdict.collisions);
      }
      if (news.is_last) revision_ = news.revision;
      changed_.notify_all();
    };
  }

  /// Waits until all paths of the scene are checked at `revision`, and `paths` have a verdict.
  bool wait_for(std::uint64_t revision, std::size_t paths) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(60),
                             [&] { return revision_ == revision && collisions_.size() == paths; });
  }

  Collisions of(WatchChecker::Id id) {
    const std::lock_guard lock(mutex_);
    return collisions_.at(id);
  }

 private:
  std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  std::map<WatchChecker::Id, Collisions> collisions_;
  std::uint64_t revision_ = 0;
};

class WatchCheckerTest : public ::testing::Test {
 protected:
  WatchCheckerTest() { store_.put(scene::assemble("room", 1, {}, {})); }

  void change(SceneChange::Kind kind, const std::string& object, const Vec3& size_m = Vec3::Ones(),
              const scene::Placement& placement = {}) {
    const auto source = kind == SceneChange::Kind::kPut ? box_source(size_m) : nullptr;
    store_.change("room", {kind, object, source, placement});
  }

  /// Watches the path of a random request, if there is one.
  bool watch_random(WatchChecker& checker, WatchChecker::Id id) {
    const auto snapshot = store_.find("room");
    const planning::PlanRequest request = random_path_request(4, random_);
    auto path = WatchedPath::of(request, planning::plan(*snapshot, request));
    if (!path) return false;
    paths_[id] = std::make_shared<const WatchedPath>(std::move(*path));
    checker.watch(id, "room", paths_[id], snapshot);
    return true;
  }

  [[nodiscard]] std::uint64_t revision() const { return store_.find("room")->revision; }

  testing::Random random_{9107};
  scene::SceneStore store_;
  std::map<WatchChecker::Id, std::shared_ptr<const WatchedPath>> paths_;
  Told told_;
};

TEST_F(WatchCheckerTest, KnowsWhatCheckingFromScratchSaysAfterAnyChanges) {
  WatchChecker checker(store_, told_.take());
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  std::uniform_real_distribution<double> size(0.1, 2.0);
  while (paths_.size() < 40) watch_random(checker, paths_.size());
  int broken = 0;
  int mended = 0;
  std::map<WatchChecker::Id, bool> was_free;
  for (int round = 0; round < 60; ++round) {
    for (int i = round % 3; i >= 0; --i) {
      const std::string name(1, static_cast<char>('a' + random_() % 6));
      const auto kind = static_cast<SceneChange::Kind>(random_() % 3);
      change(kind, name, {size(random_), size(random_), size(random_)},
             at({place(random_), place(random_), place(random_)}, random_.rotation()));
    }
    ASSERT_TRUE(told_.wait_for(revision(), paths_.size()));
    const auto now = store_.find("room");
    for (const auto& [id, path] : paths_) {
      const auto truth = path->collisions(collision::Obstacles(*now), Deadline::never());
      const auto said = told_.of(id);
      ASSERT_EQ(said.empty(), truth.empty()) << "path " << id << " in round " << round;
      if (!truth.empty()) {
        // The tolerance of interval ends is in metres; each path takes some seconds for metres.
        EXPECT_NEAR(said.front().t_begin_s, truth.front().t_begin_s, 0.01);
        EXPECT_NEAR(said.back().t_end_s, truth.back().t_end_s, 0.01);
      }
      const bool is_free = truth.empty();
      broken += was_free[id] && !is_free;
      mended += !was_free[id] && is_free;
      was_free[id] = is_free;
    }
  }
  EXPECT_GT(broken, 20);
  EXPECT_GT(mended, 20);
}

TEST_F(WatchCheckerTest, APathThatIsLeftLateIsBroughtToTheNewestRevision) {
  WatchChecker checker(store_, told_.take());
  const auto before = store_.find("room");
  const planning::PlanRequest request = random_path_request(4, random_);
  const auto path = std::make_shared<const WatchedPath>(
      *WatchedPath::of(request, planning::plan(*before, request)));
  change(SceneChange::Kind::kPut, "a", Vec3::Ones(), at(request.keyframes[1].pose.position));
  checker.watch(1, "room", path, before);
  ASSERT_TRUE(told_.wait_for(revision(), 1));
  EXPECT_FALSE(told_.of(1).empty());
}

TEST_F(WatchCheckerTest, ASceneThatIsGoneLeavesNothingProved) {
  WatchChecker checker(store_, told_.take());
  ASSERT_TRUE(watch_random(checker, 1));
  ASSERT_TRUE(told_.wait_for(revision(), 1));
  EXPECT_TRUE(told_.of(1).empty());
  store_.remove("room");
  ASSERT_TRUE(told_.wait_for(0, 1));
  EXPECT_EQ(told_.of(1), (std::vector{paths_[1]->everywhere()}));
  store_.put(scene::assemble("room", 1, {}, {}));
  ASSERT_TRUE(told_.wait_for(revision(), 1));
  EXPECT_TRUE(told_.of(1).empty());
}

TEST_F(WatchCheckerTest, EndsWhileScenesChange) {
  int watched = 0;
  std::atomic<int> told_too_late = 0;
  for (int round = 0; round < 20; ++round) {
    const auto is_over = std::make_shared<std::atomic<bool>>(false);
    {
      WatchChecker checker(store_, [is_over, &told_too_late](const WatchChecker::News&) {
        told_too_late += *is_over ? 1 : 0;
      });
      watched += watch_random(checker, 1) ? 1 : 0;
      change(SceneChange::Kind::kPut, "a", Vec3::Ones(), at({0, 0, 0}));
      checker.forget(1, "room");
      change(SceneChange::Kind::kRemove, "a");
    }
    *is_over = true;
  }
  EXPECT_GT(watched, 10);
  EXPECT_EQ(told_too_late, 0);
}

}  // namespace
}  // namespace camway::service
