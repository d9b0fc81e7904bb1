// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/planning/plan.h"
#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/integration/fixture.h"
#include "tools/camway/load/load_tally.h"
#include "tools/json/json_request.h"

namespace camway::integration {
namespace {

/// Ways through the office, each of which the crate stands in now and then.
constexpr std::array<const char*, 4> kRequests{"office-free-door", "office-graze-door",
                                               "office-free-corridor", "office-graze-column"};
constexpr std::array<double, 3> kCrateSize_m{0.4, 0.4, 0.4};

/// The scene as this process builds it, revision by revision.
class Expected {
 public:
  Expected() : office_(scene::load_snapshot("office", scene_file("office")).snapshot) {}

  /// Puts the crate there, or moves it; `revision` is the daemon's number of the result.
  void put_crate(const std::array<double, 3>& position_m, std::int64_t revision) {
    std::string fault;
    const geometry::Vec3 position(position_m.data());
    const auto placement = scene::Placement::make(position, geometry::Quat::Identity(), fault);
    const geometry::Vec3 size(kCrateSize_m.data());
    scene::Mesh mesh = *scene::box_mesh(size);
    scene::ImportReport report = scene::report_of(mesh, "box");
    const auto source = scene::make_source(scene::ObjectKind::kBox, std::move(mesh),
                                           std::move(report), office_->options);
    const scene::SnapshotResult next =
        scene::changed(*office_, {scene::SceneChange::Kind::kPut, "crate", source, placement},
                       static_cast<std::uint64_t>(revision));
    ASSERT_TRUE(next.snapshot) << next.error;
    revisions_[revision] = next.snapshot;
  }
  /// Adds a revision with the scene as in the file.
  void load(std::int64_t revision) { revisions_[revision] = office_; }

  const scene::Snapshot* at(std::int64_t revision) const {
    const auto found = revisions_.find(revision);
    return found == revisions_.end() ? nullptr : found->second.get();
  }

 private:
  std::shared_ptr<const scene::Snapshot> office_;  ///< the scene as in the file
  std::map<std::int64_t, std::shared_ptr<const scene::Snapshot>> revisions_;
};

class SceneRaceTest : public IntegrationTest {};

TEST_F(SceneRaceTest, AHundredAnswersHoldForTheRevisionsThatTheyNameWhileTheSceneChanges) {
  const std::string folder = std::filesystem::path(scene_file("office")).parent_path();
  start_daemon_with_scenes(
      {}, {"--workers", "2", "--queue", "200", "--client-queue", "100", "--scene-roots", folder});
  Expected expected;
  Client painter(patient());
  SceneMesh office;
  office.file = "office.obj";
  const auto change = [&](int i) {
    // In the way from the door, in the corridor, beside the column, and in no way.
    const std::array<std::array<double, 3>, 4> places{
        {{9.75, 1.5, 7.3}, {14.0, 1.6, 10.0}, {16.0, 1.6, 16.5}, {0.0, 50.0, 0.0}}};
    Pose pose;
    pose.position_m = places.at(static_cast<std::size_t>(i) % places.size());
    if (i % 7 == 0) {
      const SceneAnswer loaded = painter.load_scene("office", office);
      ASSERT_TRUE(loaded.ok()) << loaded.error;
      expected.load(loaded.scene.revision);
    }
    const SceneAnswer put =
        i % 7 == 0 ? painter.put_object("office", "crate", SceneBox{kCrateSize_m}, pose)
                   : painter.move_object("office", "crate", pose);
    ASSERT_TRUE(put.ok()) << put.error;
    expected.put_crate(pose.position_m, put.scene.revision);
  };
  ASSERT_NO_FATAL_FAILURE(change(0));

  Client planner(patient());
  std::vector<std::pair<std::string, PendingPlan>> pending;
  for (int i = 0; i < 100; ++i) {
    const std::string name = kRequests.at(static_cast<std::size_t>(i) % kRequests.size());
    pending.emplace_back(name, planner.plan_async(request_of(name, "office")));
    if (i % 5 == 4) {
      ASSERT_NO_FATAL_FAILURE(change(1 + i / 5));
    }
  }

  std::set<std::int64_t> revisions;
  std::map<std::pair<std::string, std::int64_t>, planning::PlanResult> results;
  for (auto& [name, plan] : pending) {
    const PlanResponse answer = plan.answer.get();
    SCOPED_TRACE(name + " in revision " + std::to_string(answer.scene_revision));
    const scene::Snapshot* const snapshot = expected.at(answer.scene_revision);
    ASSERT_NE(snapshot, nullptr) << answer.error;
    EXPECT_EQ(answer.scene_digest, snapshot->digest);
    auto result = results.find({name, answer.scene_revision});
    if (result == results.end()) {
      const auto request = tools::read_as<tools::RequestFile>(request_file(name));
      ASSERT_TRUE(request) << request.error;
      result =
          results
              .emplace(std::pair(name, answer.scene_revision), planning::plan(*snapshot, *request))
              .first;
    }
    EXPECT_TRUE(tools::is_expected(result->second, answer)) << answer.error;
    revisions.insert(answer.scene_revision);
  }
  EXPECT_GE(revisions.size(), 5U) << "or nothing was tested";
}

}  // namespace
}  // namespace camway::integration
