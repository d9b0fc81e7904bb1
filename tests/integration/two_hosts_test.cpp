// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

constexpr char kThisHostOnly[] = "udpm://239.255.76.67:7667?ttl=0";
constexpr char kBothHosts[] = "udpm://239.255.76.67:7667?ttl=1";

/// Joins this network namespace with that of process $0 by a cable, and routes multicast over it on
/// both ends.
constexpr char kJoin[] = R"(
  over_there() { nsenter --net="/proc/$0/ns/net" "$@"; }
  ip link add west type veth peer name east netns "$0"
  ip address add 10.77.0.1/24 dev west
  ip link set west up
  ip route replace 224.0.0.0/4 dev west
  over_there ip address add 10.77.0.2/24 dev east
  over_there ip link set lo up
  over_there ip link set east up
  over_there ip route add 224.0.0.0/4 dev east
)";

/// Makes the kernel drop a fraction of the received messages on both hosts, after reassembly.
constexpr char kLose[] = R"(
  lose() { "$@" iptables -A INPUT -p udp -m statistic --mode random --probability 0.1 -j DROP; }
  lose env
  lose nsenter --net="/proc/$0/ns/net"
)";

/// Another host, which is a network namespace that a sleeping process holds.
class TwoHostsTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    if (std::string(std::getenv("CAMWAY_NETNS")) != "private") {
      GTEST_SKIP() << "network namespaces are not allowed here";
    }
    const std::vector<std::string> hold{"/usr/bin/unshare", "--net", "sleep", "600"};
    other_ = std::make_unique<Process>(hold, file("other.log"));
    ASSERT_TRUE(eventually([&] { return network_of("self") != network_of(other_pid()); }));
    if (!run(kJoin)) GTEST_SKIP() << "two namespaces cannot be joined here: " << said_;
  }

  /// Returns the command line of a program on the other host.
  std::unique_ptr<Process> start_over_there(std::vector<std::string> command) {
    command.insert(command.begin(),
                   {"/usr/bin/nsenter", "--net=/proc/" + other_pid() + "/ns/net", "--"});
    return std::make_unique<Process>(command, file("over_there.log"));
  }

  /// Runs these lines of a shell to the end; $0 is the process that holds the other host.
  bool run(const std::string& lines) {
    const std::string path = "export PATH=\"$PATH:/usr/local/sbin:/usr/sbin:/sbin\"\n";
    Process shell({"/bin/sh", "-e", "-c", path + lines, other_pid()}, file("shell.log"));
    const bool good = shell.wait() == 0;
    said_ = shell.output();
    return good;
  }

  static std::vector<std::string> ask_for_plans(const std::string& requests) {
    return {CAMWAY_BINARY, "load",
            "--url",       kBothHosts,
            "--scene",     "office=" + scene_file("office"),
            "--request",   request_file("office-free-door"),
            "--request",   request_file("office-graze-door"),
            "--clients",   "2",
            "--requests",  requests,
            "--seconds",   "60"};
  }

  static Status status_at(const std::string& url, double timeout_s) {
    ClientOptions options;
    options.url = url;
    return Client(options).status(timeout_s).status;
  }

  std::string said_;

 private:
  std::string other_pid() const { return std::to_string(other_->pid()); }
  static std::string network_of(const std::string& process) {
    std::error_code failed;
    return std::filesystem::read_symlink("/proc/" + process + "/ns/net", failed).string();
  }

  std::unique_ptr<Process> other_;
};

TEST_F(TwoHostsTest, ADaemonHereServesTheOtherHost) {
  start_daemon({"--url", kBothHosts});
  const auto load = start_over_there(ask_for_plans("40"));
  EXPECT_EQ(load->wait(), 0) << load->output();
  EXPECT_THAT(load->output(), HasSubstr("0 wrong, 0 lost"));
}

TEST_F(TwoHostsTest, ADaemonOnTheOtherHostServesThisOne) {
  const auto daemon = start_over_there(
      {CAMWAYD_BINARY, "--url", kBothHosts, "--scene", "office=" + scene_file("office")});
  ASSERT_TRUE(
      eventually([&] { return !daemon->running() || status_at(kBothHosts, 0.5) == Status::kOk; }));
  ASSERT_TRUE(daemon->running()) << daemon->output();
  Process load(ask_for_plans("40"), file("load.log"));
  EXPECT_EQ(load.wait(), 0) << load.output();
  EXPECT_THAT(load.output(), HasSubstr("0 wrong, 0 lost"));
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
}

/// Losses in the kernel, unlike those of the relay in other tests.
TEST_F(TwoHostsTest, NothingIsLostOrWrongWhenTheKernelDropsATenth) {
  if (!run(kLose)) GTEST_SKIP() << "the kernel drops no packets here: " << said_;
  start_daemon({"--url", kBothHosts});
  const auto load = start_over_there(ask_for_plans("100"));
  EXPECT_EQ(load->wait(), 0) << load->output();
  EXPECT_THAT(load->output(), HasSubstr("0 wrong, 0 lost"));
}

TEST_F(TwoHostsTest, ADaemonForThisHostOnlyIsNotHeardOnTheOther) {
  start_daemon({"--url", kThisHostOnly});
  EXPECT_EQ(status_at(kThisHostOnly, 10.0), Status::kOk);
  const std::vector<std::string> ask{CAMWAY_BINARY, "status",      "--url",
                                     kBothHosts,    "--timeout-s", "1.5"};
  const auto unheard = start_over_there(ask);
  EXPECT_EQ(unheard->wait(), 4) << unheard->output();

  // The same request is answered if the daemon permits other hosts.
  start_daemon({"--url", kBothHosts});
  const auto heard = start_over_there(ask);
  EXPECT_EQ(heard->wait(), 0) << heard->output();
}

TEST_F(TwoHostsTest, ADaemonForThisHostOnlyDoesNotHearTheOther) {
  // Sends without waiting for an answer, which could not come back.
  const auto let_forget = [&](const std::string& scene) {
    start_over_there(
        {"/usr/bin/timeout", "1", CAMWAY_BINARY, "scene", "unload", scene, "--url", kBothHosts})
        ->wait();
  };
  const auto scenes_at = [](const std::string& url) {
    ClientOptions options = patient();
    options.url = url;
    return Client(options).list_scenes().scenes.size();
  };
  start_daemon({"--url", kThisHostOnly});
  let_forget("maze");
  EXPECT_EQ(scenes_at(kThisHostOnly), 3U);
  EXPECT_EQ(status_at(kBothHosts, 10.0), Status::kOk) << "who is here is heard, whatever his ttl";

  start_daemon({"--url", kBothHosts});
  let_forget("maze");
  EXPECT_EQ(scenes_at(kBothHosts), 2U) << "or what it says above would mean nothing";
}

TEST_F(TwoHostsTest, AClientForThisHostOnlyDoesNotHearTheOther) {
  const auto daemon = start_over_there(
      {CAMWAYD_BINARY, "--url", kBothHosts, "--scene", "office=" + scene_file("office")});
  ASSERT_TRUE(
      eventually([&] { return !daemon->running() || status_at(kBothHosts, 0.5) == Status::kOk; }));
  // Two heartbeats have come by then.
  EXPECT_EQ(status_at(kThisHostOnly, 2.5), Status::kNoDaemon);
  EXPECT_EQ(status_at(kBothHosts, 10.0), Status::kOk) << "or what it says above would mean nothing";

  // A program that also listens to other hosts keeps hearing them.
  ClientOptions other;
  other.url = kBothHosts;
  Client before(other);
  EXPECT_EQ(status_at(kThisHostOnly, 2.5), Status::kNoDaemon);
  EXPECT_EQ(before.status(10.0).status, Status::kOk);
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
}

}  // namespace
}  // namespace camway::integration
