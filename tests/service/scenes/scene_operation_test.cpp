// SPDX-License-Identifier: MIT
//
// Changes of a process that has not read yet what another one has made of a scene.
#include "daemon/service/scenes/scene_operation.h"

#include <gtest/gtest.h>

#include <functional>
#include <mutex>
#include <string>

namespace camway::service {
namespace {

/// A journal that keeps nothing, and brings what others have made when it is asked to catch up.
class LateJournal : public scene::SceneJournal {
 public:
  std::function<void()> arrive;
  int asked = 0;

  scene::Keeping keep_scene(const scene::Snapshot&, std::uint64_t,
                            const scene::ChangeNote&) override {
    return {};
  }
  scene::Keeping keep_changes(const scene::Snapshot&, const scene::Snapshot&,
                              const scene::SceneChanges&, const scene::ChangeNote&,
                              std::uint64_t) override {
    return {};
  }
  scene::Keeping keep_removal(const scene::Snapshot&, const std::string&) override { return {}; }
  bool await_other(const std::string&, std::uint64_t) override { return false; }
  bool catch_up() override {
    ++asked;
    if (arrive) arrive();
    return static_cast<bool>(arrive);
  }
};

class LateSceneTest : public ::testing::Test {
 protected:
  scene_response_t answer_to(std::int8_t operation, const std::string& object = "") {
    scene_request_t request{};
    request.client_id = "client";
    request.request_id = ++requests_;
    request.operation = operation;
    request.scene = "yard";
    request.object = object;
    request.kind = scene_request_t::BOX;
    for (double& side : request.size_m) side = 1.0;
    last_ = request;
    return again();
  }
  scene_response_t again() { return execute(last_, nullptr, context_).answer; }
  void put_yard() { scenes_.put(scene::assemble("yard", 1, {}, {})); }

  SceneRules rules_;
  LateJournal journal_;
  scene::SceneStore scenes_{{}, &journal_};
  std::mutex writing_;
  OperationContext context_{rules_, scenes_, writing_, {}};
  scene_request_t last_{};
  std::int64_t requests_ = 0;
};

TEST_F(LateSceneTest, ASceneThatAnotherProcessHasJustMadeIsKnown) {
  journal_.arrive = [&] {
    if (!scenes_.find("yard")) put_yard();
  };
  EXPECT_EQ(answer_to(scene_request_t::PUT, "crate").status, scene_response_t::STATUS_OK);
  EXPECT_EQ(journal_.asked, 1);
  EXPECT_EQ(answer_to(scene_request_t::PUT, "crate").status, scene_response_t::STATUS_OK);
  EXPECT_EQ(journal_.asked, 1) << "only what is refused costs a look";
}

TEST_F(LateSceneTest, SoIsAnObject) {
  put_yard();
  ASSERT_EQ(answer_to(scene_request_t::MOVE, "crate").status, scene_response_t::STATUS_INVALID);
  ASSERT_EQ(journal_.asked, 1);
  journal_.arrive = [&] {
    journal_.arrive = nullptr;
    ASSERT_EQ(answer_to(scene_request_t::PUT, "crate").status, scene_response_t::STATUS_OK);
    journal_.arrive = [] {};
  };
  scene_request_t move{};
  move.client_id = "client";
  move.request_id = 1000;
  move.operation = scene_request_t::MOVE;
  move.scene = "yard";
  move.object = "crate";
  EXPECT_EQ(execute(move, nullptr, context_).answer.status, scene_response_t::STATUS_OK);
}

TEST_F(LateSceneTest, WhatIsUnknownToAllIsRefusedOnce) {
  journal_.arrive = [] {};
  EXPECT_EQ(answer_to(scene_request_t::UNLOAD).status, scene_response_t::STATUS_UNKNOWN_SCENE);
  EXPECT_EQ(journal_.asked, 1);
}

TEST_F(LateSceneTest, AQueryIsAnsweredAtOnce) {
  journal_.arrive = [&] { put_yard(); };
  EXPECT_EQ(answer_to(scene_request_t::DESCRIBE).status, scene_response_t::STATUS_UNKNOWN_SCENE);
  EXPECT_EQ(journal_.asked, 0);
}

TEST_F(LateSceneTest, ASceneIsUnloadedOnceByARequest) {
  put_yard();
  EXPECT_EQ(answer_to(scene_request_t::UNLOAD).status, scene_response_t::STATUS_OK);
  EXPECT_EQ(again().status, scene_response_t::STATUS_OK) << "as it was answered before";
  put_yard();
  EXPECT_EQ(again().status, scene_response_t::STATUS_OK);
  EXPECT_TRUE(scenes_.find("yard")) << "another one than the one that was unloaded";
  EXPECT_EQ(answer_to(scene_request_t::UNLOAD).status, scene_response_t::STATUS_OK);
  EXPECT_FALSE(scenes_.find("yard"));
  EXPECT_EQ(answer_to(scene_request_t::UNLOAD).status, scene_response_t::STATUS_UNKNOWN_SCENE);
}

}  // namespace
}  // namespace camway::service
