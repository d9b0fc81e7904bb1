// SPDX-License-Identifier: MIT
#include "daemon/process/warning_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/scene/log/durable_scenes.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "tests/scene/log/memory_log.h"
#include "tests/support/captured_log.h"

namespace camway::process {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(WarningJournal, TellsTheOperatorOfChangesThatCannotBeKept) {
  const testing::CapturedLog log;
  testing::MemoryLog scene_log;
  scene::DurableScenes scenes(scene_log);
  WarningJournal journal(scenes, log.log());
  scene::SceneStore store({}, &journal);
  EXPECT_EQ(store.put(scene::assemble("room", 1, {}, {})).error, "");
  EXPECT_THAT(log.text(), Not(HasSubstr("room")));

  scene_log.fault = scene::AppendFault::kFull;
  EXPECT_EQ(store.put(scene::assemble("attic", 1, {}, {})).fault, scene::StoreFault::kFull);
  EXPECT_THAT(log.text(), HasSubstr("a change of a scene cannot be kept, and is not made"));
  EXPECT_THAT(log.text(), HasSubstr("scene=attic"));
  EXPECT_THAT(log.text(), HasSubstr("no disk"));
}

}  // namespace
}  // namespace camway::process
