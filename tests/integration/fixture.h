// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/integration/process.h"

namespace camway::integration {

/// Tests with real processes on the network that tools/scripts/netns.sh gave them. Fails, and says
/// so, where that network does not carry LCM.
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
  /// Daemons that are started from now on are run by this command, which has to become them
  /// (`exec`).
  void run_daemons_by(std::vector<std::string> command) { wrapper_ = std::move(command); }
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

  /// Puts a bad network beside the good one, of which this share of the messages each way is lost,
  /// as many come twice, and as many come late, so that others overtake them.
  void start_bad_network(double share);
  /// Options for clients on the bad network.
  static ClientOptions patient_far_away();
  static constexpr char kFarAwayUrl[] = "udpm://239.255.76.67:7668?ttl=0";

 private:
  std::filesystem::path folder_;
  std::vector<std::string> wrapper_;
  std::unique_ptr<Process> relay_;
  std::unique_ptr<Process> daemon_;
  int daemons_ = 0;
};

/// Shares of messages that bad networks of tests lose, and what tests are called that have them.
inline constexpr double kBadShares[] = {0.0, 0.01, 0.1, 0.3};
std::string name_of_share(const testing::TestParamInfo<double>& share);

/// Committed files: `scenes/office.obj`, `scenes/requests/office-free-door.json`.
std::string scene_file(const std::string& name);
std::string request_file(const std::string& name);

/// The request of that file, for a daemon that holds its scene as `scene`.
PlanRequest request_of(const std::string& name, const std::string& scene);

/// A mesh of one triangle in a file of that length or a little more, of which no two pages are
/// alike.
SceneMesh long_mesh(std::size_t bytes);

/// One line that a planning client printed.
struct ClientLine {
  std::string request;
  std::string status;
  std::string path_hash;  ///< of all bits of the path
};
std::vector<ClientLine> lines_of(const Process& client);

}  // namespace camway::integration
