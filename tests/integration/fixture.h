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

/// Tests with real processes in the network of tools/scripts/netns.sh. Fails with a message if that
/// network does not carry LCM.
class IntegrationTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Returns a path in this test's own folder, which is removed if the test passes.
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// Start the daemon with the committed scenes, or with `scenes`, and wait until it is heard.
  void start_daemon(const std::vector<std::string>& more_arguments = {});
  void start_daemon_with_scenes(const std::vector<std::string>& scenes,
                                const std::vector<std::string>& more_arguments = {});
  /// Sets a command that starts later daemons. It must replace itself by the daemon (`exec`).
  void run_daemons_by(std::vector<std::string> command) { wrapper_ = std::move(command); }
  Process& daemon() { return *daemon_; }
  /// Ends the daemon if the test has not ended it, and fails unless its exit is clean: a sanitizer
  /// reports its findings by the exit code. Runs at the end of every test.
  void stop_daemon();

  /// Starts a process that plans the requests of these files, in turn, on one scene. For its output
  /// see planning_client.cpp.
  std::unique_ptr<Process> start_client(const std::string& name, const std::string& scene,
                                        const std::vector<std::string>& requests);

  /// Returns options for clients that retry for the time of `kPatience`.
  static ClientOptions patient();

  /// Starts a relay to a second, bad network. In each direction it drops this fraction of the
  /// messages, duplicates as many, and delays as many so that others overtake them.
  void start_bad_network(double share);
  /// Returns options for clients on the bad network.
  static ClientOptions patient_far_away();
  static constexpr char kFarAwayUrl[] = "udpm://239.255.76.67:7668?ttl=0";

 private:
  std::filesystem::path folder_;
  std::vector<std::string> wrapper_;
  std::unique_ptr<Process> relay_;
  std::unique_ptr<Process> daemon_;
  int daemons_ = 0;
};

/// Fractions of messages that bad networks of tests lose, and the names of tests with them.
inline constexpr double kBadShares[] = {0.0, 0.01, 0.1, 0.3};
std::string name_of_share(const ::testing::TestParamInfo<double>& share);

/// Return the paths of committed files: `scenes/office.obj`,
/// `scenes/requests/office-free-door.json`.
std::string scene_file(const std::string& name);
std::string request_file(const std::string& name);

/// Returns the request of a file, for a daemon that holds its scene under the name `scene`.
PlanRequest request_of(const std::string& name, const std::string& scene);

/// Returns a mesh of one triangle in a file of about this size or a little more, whose pages all
/// differ.
SceneMesh long_mesh(std::size_t bytes);

/// A line that a planning client printed.
struct ClientLine {
  std::string request;
  std::string status;
  std::string path_hash;  ///< hash of all bits of the path
};
std::vector<ClientLine> lines_of(const Process& client);

}  // namespace camway::integration
