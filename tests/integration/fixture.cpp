// SPDX-License-Identifier: MIT
#include "tests/integration/fixture.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <utility>

#include "tools/json/json_request.h"
#include "tools/support/client_request.h"

namespace camway::integration {

std::string scene_file(const std::string& name) {
  return std::string(CAMWAY_SCENES_FOLDER) + "/" + name + ".obj";
}

std::string request_file(const std::string& name) {
  return std::string(CAMWAY_SCENES_FOLDER) + "/requests/" + name + ".json";
}

PlanRequest request_of(const std::string& name, const std::string& scene) {
  const auto request = tools::read_as<tools::RequestFile>(request_file(name));
  EXPECT_TRUE(request) << request.error;
  return request.value ? tools::to_client_request(*request, scene) : PlanRequest{};
}

SceneMesh long_mesh(std::size_t bytes) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  while (text.size() < bytes) {
    text += "# " + std::to_string(text.size()) + std::string(80, '.') + '\n';
  }
  SceneMesh mesh;
  mesh.bytes.assign(text.begin(), text.end());
  mesh.format = "obj";
  return mesh;
}

std::string name_of_share(const ::testing::TestParamInfo<double>& share) {
  return std::to_string(std::lround(100.0 * share.param)) + "InAHundred";
}

std::vector<ClientLine> lines_of(const Process& client) {
  std::vector<ClientLine> lines;
  std::istringstream text(client.output());
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    ClientLine parsed;
    std::string mark;
    if (words >> mark >> parsed.request >> parsed.status >> parsed.path_hash && mark == "answer") {
      lines.push_back(std::move(parsed));
    }
  }
  return lines;
}

void IntegrationTest::SetUp() {
  const char* const network = std::getenv("CAMWAY_NETNS");
  ASSERT_NE(network, nullptr)
      << "run this through tools/scripts/netns.sh, or its LCM messages go to the "
         "machine's network";
  if (std::string(network) != "private") std::cerr << "no private network: using the machine's\n";
  const Client probe;
  ASSERT_TRUE(probe.good()) << "multicast does not work here, so nothing can be tested: "
                            << probe.error();
  std::string pattern = (std::filesystem::temp_directory_path() / "camway-XXXXXX").string();
  ASSERT_NE(::mkdtemp(pattern.data()), nullptr) << pattern;
  folder_ = pattern;
}

void IntegrationTest::TearDown() {
  stop_daemon();
  if (HasFailure()) {
    if (daemon_) std::cerr << "The daemon's log:\n" << daemon_->output();
    std::cerr << "Files are left in " << folder_ << '\n';
  }
  daemon_.reset();
  relay_.reset();
  if (!HasFailure() && !folder_.empty()) std::filesystem::remove_all(folder_);
}

void IntegrationTest::start_daemon(const std::vector<std::string>& more_arguments) {
  start_daemon_with_scenes({"office=" + scene_file("office") + ",occupancy=0.2",
                            "maze=" + scene_file("maze"), "gallery=" + scene_file("gallery")},
                           more_arguments);
}

void IntegrationTest::start_daemon_with_scenes(const std::vector<std::string>& scenes,
                                               const std::vector<std::string>& more_arguments) {
  std::vector<std::string> arguments = wrapper_;
  arguments.emplace_back(CAMWAYD_BINARY);
  for (const std::string& scene : scenes) {
    arguments.insert(arguments.end(), {"--scene", scene});
  }
  arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
  stop_daemon();  // the old one ends before the new one starts
  daemon_ =
      std::make_unique<Process>(arguments, file("daemon" + std::to_string(++daemons_) + ".log"));
  ClientOptions options;
  const auto prefix = std::find(more_arguments.begin(), more_arguments.end(), "--prefix");
  if (prefix != more_arguments.end()) options.prefix = *(prefix + 1);
  Client listener(options);
  ASSERT_TRUE(eventually([&] { return !daemon_->running() || listener.status(0.5).ok(); }));
  ASSERT_TRUE(daemon_->running()) << daemon_->output();
}

void IntegrationTest::stop_daemon() {
  if (!daemon_ || daemon_->known_to_have_ended()) return;
  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0) << daemon_->output();
}

std::unique_ptr<Process> IntegrationTest::start_client(const std::string& name,
                                                       const std::string& scene,
                                                       const std::vector<std::string>& requests) {
  std::vector<std::string> arguments{PLANNING_CLIENT_BINARY, name, scene};
  for (const std::string& request : requests) arguments.push_back(request_file(request));
  return std::make_unique<Process>(arguments, file("client-" + name + ".log"));
}

void IntegrationTest::start_bad_network(double share) {
  const std::string text = std::to_string(share);
  relay_ = std::make_unique<Process>(
      std::vector<std::string>{LOSSY_RELAY_BINARY, "7668", "7667", text, text, text, "2006"},
      file("relay.log"));
  ASSERT_TRUE(eventually([&] { return relay_->output().find("relaying") != std::string::npos; }))
      << relay_->output();
}

ClientOptions IntegrationTest::patient_far_away() {
  ClientOptions options = patient();
  options.url = kFarAwayUrl;
  return options;
}

ClientOptions IntegrationTest::patient() {
  ClientOptions options;
  options.retries = 1000;  // the deadline is what ends it
  options.deadline_s = std::chrono::duration<double>(kPatience).count();
  return options;
}

}  // namespace camway::integration
