// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/process.h"

namespace camway::integration {

/// Tests with real processes on the network that tools/netns.sh gave them. Fails, and says so,
/// where that network does not carry LCM.
class IntegrationTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// A file of this test's own folder, which goes when the test passed.
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// Starts the daemon with our scenes (or these), and waits until it is heard.
  void start_daemon(const std::vector<std::string>& more_arguments = {});
  void start_daemon_with_scenes(const std::vector<std::string>& scenes,
                                const std::vector<std::string>& more_arguments = {});
  Process& daemon() { return *daemon_; }
  /// Ends a daemon that no test has ended, and fails if it does not end cleanly: a sanitizer that
  /// found something in it, at any time or at the end, says so with the exit code. Every test ends
  /// with this.
  void stop_daemon();

  /// Starts a process that plans the requests of these files, in turn, on one scene. See
  /// planning_client.cpp for what it prints.
  std::unique_ptr<Process> start_client(const std::string& name, const std::string& scene,
                                        const std::vector<std::string>& requests);

  /// Options for clients here: as many retries as patience allows.
  static ClientOptions patient();

 private:
  std::filesystem::path folder_;
  std::unique_ptr<Process> daemon_;
  int daemons_ = 0;
};

/// Committed files: `scenes/office.obj`, `scenes/requests/office-free-door.json`.
std::string scene_file(const std::string& name);
std::string request_file(const std::string& name);

/// The request of that file, for a daemon that holds its scene as `scene`.
PlanRequest request_of(const std::string& name, const std::string& scene);

/// One line that a planning client printed.
struct ClientLine {
  std::string request;
  std::string status;
  std::string path_hash;  ///< of all bits of the path
};
std::vector<ClientLine> lines_of(const Process& client);

}  // namespace camway::integration
