// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "daemon/planning/plan.h"
#include "daemon/record/recorder.h"
#include "daemon/record/recording_journal.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "lcmtypes/wire/pages.h"
#include "tests/support/captured_log.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {

/// Records a small session into a folder: a wall, a request and its answer, a box that is put and
/// moved, with a request after each. Returns the log.
inline std::filesystem::path record_wall(const std::filesystem::path& folder) {
  const testing::CapturedLog log;
  record::RecordOptions options;
  options.folder = folder;
  auto recorder = record::Recorder::open(options, {"build", {}}, log.log());
  EXPECT_TRUE(recorder) << recorder.error;
  record::RecordingJournal journal(nullptr, **recorder);
  scene::SceneStore store({}, &journal);
  store.put(scene::make_snapshot("wall", wall_mesh()).snapshot);
  const auto plan = [&](std::int64_t id) {
    const auto scene = store.find("wall");
    const planning::PlanRequest request = simple_request({{1, 0, 1}, {1, 0, -1}});
    for (const wire::Bytes& page :
         wire::encode_pages(messages::to_wire(request, {"client", id, 0}))) {
      (*recorder)->message("CAMWAY_PLAN_REQUEST", page);
    }
    const messages::AnswerHeader header{
        {"client", id, 0}, "wall", static_cast<std::int64_t>(scene->revision), scene->digest};
    for (const wire::Bytes& page :
         wire::encode_pages(messages::to_wire(planning::plan(*scene, request), header))) {
      (*recorder)->message("CAMWAY_PLAN_RESPONSE_client", page);
    }
  };
  plan(1);
  scene::Mesh mesh = *scene::box_mesh({0.2, 0.2, 0.2});
  scene::ImportReport report = scene::report_of(mesh, "box");
  const auto source =
      scene::make_source(scene::ObjectKind::kBox, std::move(mesh), std::move(report), {});
  std::string fault;
  store.change("wall", {scene::SceneChange::Kind::kPut, "box", source,
                        scene::Placement::make({1.5, 0, 0}, geometry::Quat::Identity(), fault)});
  plan(2);
  store.change("wall", {scene::SceneChange::Kind::kMove, "box", nullptr,
                        scene::Placement::make({-1.5, 0, 0}, geometry::Quat::Identity(), fault)});
  plan(3);
  (*recorder)->finish();
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == record::kLogEnding) return entry.path();
  }
  ADD_FAILURE() << "no log";
  return {};
}

}  // namespace camway::tools
