// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "daemon/nats/connection.h"
#include "daemon/scene/log/nats/nats_log.h"
#include "tests/scene/log/log_comparison.h"
#include "tests/support/nats_server.h"
#include "tests/support/sanitizer.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kNatsModelSeed = 20241126;

TEST(NatsLogModel, KeepsWhatAModelInMemoryKeeps) {
  const testing::NatsServer server;
  nats::ConnectOptions options;
  options.servers = {server.url()};
  const auto connection = nats::Connection::open(options);
  ASSERT_TRUE(connection) << connection.error;
  LogComparison comparison({kNatsModelSeed,
                            [&]() -> std::unique_ptr<SceneLog> {
                              NatsLogOptions log_options;
                              log_options.blob_grace = std::chrono::milliseconds(0);
                              auto log = NatsLog::open(**connection, log_options);
                              EXPECT_TRUE(log) << log.error;
                              if (!log) return nullptr;
                              const auto scenes = (*log)->scenes();
                              EXPECT_TRUE(scenes) << scenes.error;
                              return *std::move(log);
                            },
                            true});
  for (int i = 0; i < testing::runs(800); ++i) {
    SCOPED_TRACE("step " + std::to_string(i));
    comparison.step();
    if (i % 10 == 0) comparison.compare();
    if (::testing::Test::HasFatalFailure()) return;
  }
  comparison.reopen();
  comparison.compare();
}

}  // namespace
}  // namespace camway::scene
