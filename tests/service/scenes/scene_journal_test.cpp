// SPDX-License-Identifier: MIT
//
// Changes of scenes that cannot be kept.
#include "daemon/scene/snapshot/scene_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "daemon/service/scenes/scene_service.h"
#include "tests/service/running_service.h"

namespace camway::service {
namespace {

using ::testing::HasSubstr;
using testing::RunningService;

/// A journal that cannot keep changes while `is_broken`.
class BrokenJournal : public scene::SceneJournal {
 public:
  std::atomic<bool> is_broken = false;

  scene::Keeping keep_scene(const scene::Snapshot&, std::uint64_t,
                            const scene::ChangeNote&) override {
    return keeping();
  }
  scene::Keeping keep_changes(const scene::Snapshot&, const scene::Snapshot&,
                              const scene::SceneChanges&, const scene::ChangeNote&,
                              std::uint64_t) override {
    return keeping();
  }
  scene::Keeping keep_removal(const scene::Snapshot&, const std::string&) override {
    return keeping();
  }
  bool await_other(const std::string&, std::uint64_t) override { return false; }
  bool catch_up() override { return false; }

 private:
  [[nodiscard]] scene::Keeping keeping() const {
    if (!is_broken) return {};
    return {scene::KeepFault::kBroken, "no disk. The change may still take effect"};
  }
};

TEST(SceneServiceWithAJournal, ARequestThatWasNotKeptIsTriedAgainWhenItIsRepeated) {
  BrokenJournal journal;
  RunningService running({}, testing::echo_result, {}, {}, &journal);
  scene_request_t request{};
  request.client_id = "tester";
  request.request_id = 1;
  request.operation = scene_request_t::PUT;
  request.scene = "room";
  request.object = "crate";
  request.kind = scene_request_t::BOX;
  for (double& side : request.size_m) side = 1.0;
  const std::string answers = running.channels.scene_response(request.client_id);
  const auto ask = [&](std::size_t before) {
    running.send_on(running.channels.scene_request(), wire::encode(request));
    const auto bytes = running.transport.message_on(answers, before);
    return bytes ? *wire::decode<scene_response_t>(*bytes).message : scene_response_t{};
  };
  journal.is_broken = true;
  const scene_response_t refused = ask(0);
  EXPECT_EQ(refused.status, scene_response_t::STATUS_INTERNAL_ERROR);
  EXPECT_THAT(refused.message, HasSubstr("The change may still take effect"));
  journal.is_broken = false;
  EXPECT_EQ(ask(1).status, scene_response_t::STATUS_OK);
  EXPECT_TRUE(running.scenes.find("room")->find("crate"));
}

}  // namespace
}  // namespace camway::service
