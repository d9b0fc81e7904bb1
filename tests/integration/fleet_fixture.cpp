// SPDX-License-Identifier: MIT
#include "tests/integration/fleet_fixture.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <iostream>
#include <utility>

namespace camway::integration {

void FleetTest::TearDown() {
  for (auto* const processes : {&planners_, &fronts_}) {
    for (auto& [name, process] : *processes) {
      if (process->known_to_have_ended()) continue;
      process->signal(SIGCONT);
      process->signal(SIGTERM);
      EXPECT_EQ(process->wait(), 0) << name << ":\n" << process->output();
    }
  }
  if (HasFailure()) {
    for (auto* const processes : {&planners_, &fronts_}) {
      for (auto& [name, process] : *processes) {
        std::cerr << "The log of " << name << ":\n" << process->output();
      }
    }
  }
  IntegrationTest::TearDown();
}

ClientOptions FleetTest::of_prefix(const std::string& prefix) {
  ClientOptions options = patient();
  options.prefix = prefix;
  return options;
}

void FleetTest::start_front(const std::string& prefix, const std::vector<std::string>& more) {
  const std::string configuration = file("front-" + prefix + ".toml");
  write_file(configuration, "[fleet]\n" + settings_);
  std::vector<std::string> arguments{CAMWAYD_BINARY,
                                     "--config",
                                     configuration,
                                     "--role",
                                     "front",
                                     "--fleet",
                                     servers_,
                                     "--prefix",
                                     prefix,
                                     "--scene",
                                     "office=" + scene_file("office")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  fronts_[prefix] = std::make_unique<Process>(
      arguments, file("front-" + prefix + std::to_string(++started_) + ".log"));
  Client listener(of_prefix(prefix));
  ASSERT_TRUE(eventually([&] { return !front(prefix).running() || listener.status(0.5).ok(); }));
  ASSERT_TRUE(front(prefix).running()) << front(prefix).output();
}

Process& FleetTest::start_planner(const std::string& id, const std::string& server,
                                  const std::vector<std::string>& wrapper) {
  const std::string configuration = file(id + ".toml");
  write_file(configuration, "[fleet]\nid = \"" + id + "\"\n" + settings_);
  std::vector<std::string> arguments = wrapper;
  arguments.insert(arguments.end(), {CAMWAYD_BINARY, "--config", configuration, "--role", "planner",
                                     "--fleet", server, "--workers", "1"});
  planners_[id] = std::make_unique<Process>(
      arguments, file("planner-" + id + std::to_string(++started_) + ".log"));
  return *planners_[id];
}

void FleetTest::start_planners(int number) {
  for (int i = 1; i <= number; ++i) start_planner("p" + std::to_string(i));
  await_planners(static_cast<std::size_t>(number));
}

void FleetTest::await_planners(std::size_t number, const std::string& prefix) {
  Client client(of_prefix(prefix));
  const auto is_ready = [](const FleetPlanner& planner) {
    return !planner.is_behind && planner.silent_s < 1.0;
  };
  ASSERT_TRUE(eventually([&] {
    const DaemonStatus status = client.status(5.0);
    return static_cast<std::size_t>(std::ranges::count_if(status.planners, is_ready)) == number;
  }));
}

std::string bits_of(const PlanResponse& answer) {
  std::string bits = std::to_string(static_cast<int>(answer.status)) + answer.message + '\n' +
                     answer.scene_digest + '\n';
  static_assert(sizeof(Segment) == 42 * sizeof(double), "no padding to compare");
  const std::vector<Segment>& segments = answer.path.segments();
  const std::size_t begin = bits.size();
  bits.resize(begin + segments.size() * sizeof(Segment));
  if (!segments.empty()) {
    std::memcpy(bits.data() + begin, segments.data(), segments.size() * sizeof(Segment));
  }
  return bits;
}

}  // namespace camway::integration
