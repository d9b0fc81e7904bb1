// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "daemon/planning/plan.h"
#include "daemon/planning/result/witness_names.h"
#include "daemon/record/recorder.h"
#include "daemon/record/recording_journal.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "lcmtypes/wire/pages.h"
#include "tests/support/captured_log.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {

/// Records a session in the scene `wall` into a folder, as a daemon does.
class WallRecording {
 public:
  explicit WallRecording(std::filesystem::path folder, const record::RecordLimits& limits = {})
      : folder_(std::move(folder)) {
    record::RecordOptions options;
    options.folder = folder_;
    options.limits = limits;
    auto opened = record::Recorder::open(options, {"build", {}}, log_.log());
    EXPECT_TRUE(opened) << opened.error;
    recorder_ = *std::move(opened);
    journal_ = std::make_unique<record::RecordingJournal>(nullptr, *recorder_);
    store_ = std::make_unique<scene::SceneStore>(scene::SceneStoreLimits(), journal_.get());
    store_->put(scene::make_snapshot("wall", wall_mesh()).snapshot);
  }

  /// Plans a path beside the wall, and records the request and the answer.
  void plan(std::int64_t id, const std::string& client = "client") {
    const auto scene = store_->find("wall");
    const planning::PlanRequest request = simple_request({{1, 0, 1}, {1, 0, -1}});
    for (const wire::Bytes& page :
         wire::encode_pages(messages::to_wire(request, {client, id, 0}))) {
      recorder_->message("CAMWAY_PLAN_REQUEST", page);
    }
    const messages::AnswerHeader header{
        {client, id, 0}, "wall", static_cast<std::int64_t>(scene->revision), scene->digest};
    planning::PlanResult result = planning::plan(*scene, request);
    planning::name_witnesses(scene->mesh, request, result);
    for (const wire::Bytes& page : wire::encode_pages(messages::to_wire(result, header))) {
      recorder_->message("CAMWAY_PLAN_RESPONSE_" + client, page);
    }
  }

  /// Puts a cube of this size with its middle on the X axis.
  void put(const std::string& object, double size_m, double x_m) {
    scene::Mesh mesh = *scene::box_mesh({size_m, size_m, size_m});
    scene::ImportReport report = scene::report_of(mesh, "box");
    change({scene::SceneChange::Kind::kPut, object,
            scene::make_source(scene::ObjectKind::kBox, std::move(mesh), std::move(report), {}),
            at(x_m)});
  }
  void move(const std::string& object, double x_m) {
    change({scene::SceneChange::Kind::kMove, object, nullptr, at(x_m)});
  }
  void remove(const std::string& object) {
    change({scene::SceneChange::Kind::kRemove, object, nullptr, {}});
  }

  /// Ends the recording. Returns its last log.
  std::filesystem::path finish() {
    recorder_->finish();
    std::filesystem::path last;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      if (entry.path().extension() == record::kLogEnding) last = std::max(last, entry.path());
    }
    EXPECT_FALSE(last.empty()) << "no log";
    return last;
  }

 private:
  static scene::Placement at(double x_m) {
    std::string fault;
    return scene::Placement::make({x_m, 0, 0}, geometry::Quat::Identity(), fault);
  }
  void change(scene::SceneChange change) {
    EXPECT_TRUE(store_->change("wall", std::move(change)).snapshot);
  }

  std::filesystem::path folder_;
  testing::CapturedLog log_;
  std::unique_ptr<record::Recorder> recorder_;
  std::unique_ptr<record::RecordingJournal> journal_;
  std::unique_ptr<scene::SceneStore> store_;
};

/// Records a small session into a folder: a wall, a request and its answer, a box that is put and
/// moved, with a request after each. Returns the log.
inline std::filesystem::path record_wall(const std::filesystem::path& folder) {
  WallRecording recording(folder);
  recording.plan(1);
  recording.put("box", 0.2, 1.5);
  recording.plan(2);
  recording.move("box", -1.5);
  recording.plan(3);
  return recording.finish();
}

}  // namespace camway::tools
