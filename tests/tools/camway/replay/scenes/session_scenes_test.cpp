// SPDX-License-Identifier: MIT
#include "tools/camway/replay/scenes/session_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tools/camway/replay/recorded_wall.h"

namespace camway::tools {
namespace {

/// In a fleet, changes of other fronts may be recorded after later ones of this front.
TEST(SessionScenes, AnyOrderOfChangesGivesTheSameRevisions) {
  const TemporaryFolder folder;
  const std::filesystem::path log = record_wall(folder.file("recorded"));
  Session session = read_session(log, "CAMWAY");
  const auto revision = [](const RecordedUpdate& update) {
    return update.change.update.entry.revision;
  };
  ASSERT_GE(session.updates.size(), 3U);
  std::ranges::sort(session.updates, {}, revision);
  do {
    SessionScenes scenes(session, blob_folders_of({log}));
    for (const RecordedRequest& request : session.requests) {
      const FoundScene found = scenes.snapshot_of(request);
      ASSERT_TRUE(found.snapshot) << found.why_not;
      EXPECT_EQ(found.snapshot->digest, request.answer->scene_digest);
    }
  } while (std::ranges::next_permutation(session.updates, {}, revision).found);
}

}  // namespace
}  // namespace camway::tools
