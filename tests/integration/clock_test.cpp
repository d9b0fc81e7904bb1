// SPDX-License-Identifier: MIT
#include <camway/authentication.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/wire/channels.h"
#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

constexpr long kDay_s = 86'400;
constexpr long kTwentyYears_s = 20 * 365 * kDay_s;

/// A daemon whose wall clock jumps, beside clients whose clock does not.
class ClockTest : public IntegrationTest {
 protected:
  void SetUp() override {
#ifdef CAMWAY_JUMPING_CLOCK
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    set_clock(0);
    run_daemons_by({"/usr/bin/env", std::string("LD_PRELOAD=") + CAMWAY_JUMPING_CLOCK,
                    "CAMWAY_CLOCK_OFFSET=" + file("offset")});
#else
    GTEST_SKIP()
        << "the clock of these tests is a library that is loaded before all others, where a "
           "sanitizer's has to be";
#endif
  }

  /// Sets how far the daemon's clock is ahead of the local one.
  void set_clock(long ahead_s) const { write_file(file("offset"), std::to_string(ahead_s)); }

  std::string doctor_says() const {
    Process doctor({CAMWAY_BINARY, "doctor"}, file("doctor.log"));
    doctor.wait();
    return doctor.output();
  }
};

TEST_F(ClockTest, AJumpChangesNothingForRequestsAndLeases) {
  start_daemon();
  const std::string office = "office=" + scene_file("office");
  Process load({CAMWAY_BINARY, "load", "--scene", office, "--request",
                request_file("office-free-door"), "--clients", "2", "--seconds", "3"},
               file("load.log"));
  std::atomic<int> lost = 0;
  std::atomic<int> broken = 0;
  Client client(patient());  // after what its handler uses, so that it ends before
  const PlanRequest request = request_of("office-free-door", "office");
  client.watch(request, [&](const WatchEvent& event) {
    lost += event.kind == WatchEvent::Kind::kLost ? 1 : 0;
    broken += event.kind == WatchEvent::Kind::kBroken ? 1 : 0;
  });
  ASSERT_TRUE(eventually([&] { return client.status().watched_paths == 1; }));
  for (const long ahead_s : {kDay_s, -kDay_s, kTwentyYears_s, 0L}) {
    set_clock(ahead_s);
    const PlanResponse answer = client.plan(request);
    EXPECT_TRUE(answer.ok()) << answer.error;
    if (ahead_s == kDay_s) {
      EXPECT_THAT(doctor_says(), HasSubstr("ahead of ours")) << "or it did not jump";
    }
    const DaemonStatus status = client.status();
    ASSERT_TRUE(status.ok()) << status.error;
    EXPECT_LT(status.uptime_s, 300.0);
    EXPECT_EQ(status.watched_paths, 1) << "leases are not of the wall clock";
  }
  EXPECT_EQ(load.wait(), 0) << load.output();
  EXPECT_THAT(load.output(), HasSubstr("0 wrong, 0 lost"));
  EXPECT_EQ(lost, 0);
  client.unload_scene("office");
  EXPECT_TRUE(eventually([&] { return broken > 0; }));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t number = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++number;
  }
  return number;
}

TEST_F(ClockTest, AJumpNeitherFloodsTheLogNorSilencesIt) {
  constexpr double kLines_per_s = 2.0;
  constexpr double kBurst = 5.0;
  std::ofstream(file("camwayd.toml"))
      << "[log]\nlines_per_s = " << kLines_per_s << "\nburst_lines = " << kBurst
      << "\n[status]\nperiod_s = 0.05\n[[scene]]\nname = \"maze\"\nfile = \"" << scene_file("maze")
      << "\"\n";
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  lcm::LCM lcm;
  std::int64_t sent = 0;
  const auto say_nonsense = [&](int messages) {
    const std::array<std::uint8_t, 10> nonsense{};
    for (int i = 0; i < messages; ++i, ++sent) {
      lcm.publish(wire::Channels{}.cancel(), nonsense.data(), nonsense.size());
    }
    return eventually([&] { return Client().status().malformed_messages >= sent; });
  };
  const auto lines_with = [&](const std::string& part) { return count(daemon().output(), part); };

  const auto begin = std::chrono::steady_clock::now();
  for (const long ahead_s : {0L, kDay_s, kTwentyYears_s, 0L, kTwentyYears_s}) {
    set_clock(ahead_s);
    ASSERT_TRUE(say_nonsense(20));
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LE(static_cast<double>(lines_with("malformed message")),
            kBurst + kLines_per_s * took.count());
  set_clock(-kTwentyYears_s);
  ASSERT_TRUE(say_nonsense(20));
  const std::size_t before = lines_with("lines left out kind=malformed");
  EXPECT_TRUE(eventually([&] { return lines_with("lines left out kind=malformed") > before; }));
}

class SignedClockTest : public ClockTest {
 protected:
  void start_daemon_with_key() {
    std::ofstream(file("keys")) << "1 " << std::string(64, '1') << '\n';
    ASSERT_EQ(chmod(file("keys").c_str(), 0600), 0);
    std::ofstream(file("camwayd.toml"))
        << "[auth]\nkey_file = \"" << file("keys") << "\"\n[[scene]]\nname = \"office\"\nfile = \""
        << scene_file("office") << "\"\n";
    start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  }

  /// Returns whether the daemon answers a signed request within this time.
  bool is_answered(double deadline_s) const {
    ClientOptions options = patient();
    options.deadline_s = deadline_s;
    options.authentication = authentication_from(file("keys")).authentication;
    PlanRequest request = request_of("office-free-door", "office");
    request.deadline_s = 0.5;
    return Client(options).plan(request).ok();
  }

  static bool eventually_counted(std::int64_t DaemonStatus::*counter, std::int64_t least) {
    return eventually([&] { return Client().status().*counter >= least; });
  }
};

TEST_F(SignedClockTest, AJumpOfOneClockKeepsMessagesOutAndNoReplayIn) {
  start_daemon_with_key();
  // An attacker on the network records a request.
  lcm::LCM lcm;
  std::vector<std::uint8_t> recorded;
  const std::string channel = wire::Channels{}.plan_request();
  lcm.subscribeFunction(
      channel,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<std::uint8_t>* copy) {
        const auto* const data = static_cast<const std::uint8_t*>(buffer->data);
        copy->assign(data, data + buffer->data_size);
      },
      &recorded);
  ASSERT_TRUE(is_answered(60.0));
  ASSERT_TRUE(eventually([&] { return lcm.handleTimeout(100) > 0 && !recorded.empty(); }));

  for (const long ahead_s : {kDay_s, -kDay_s}) {
    set_clock(ahead_s);
    const std::int64_t before = Client().status().stale_messages;
    EXPECT_FALSE(is_answered(1.0)) << ahead_s;
    EXPECT_TRUE(eventually_counted(&DaemonStatus::stale_messages, before + 1)) << ahead_s;
  }
  // The clocks agree again, and the recorded message is within the window.
  set_clock(0);
  EXPECT_TRUE(is_answered(60.0)) << "without a new start";
  lcm.publish(channel, recorded.data(), static_cast<unsigned>(recorded.size()));
  EXPECT_TRUE(eventually_counted(&DaemonStatus::replayed_messages, 1));
}

TEST_F(SignedClockTest, AClockThatIsSetBackBeforeTheStartNeedsANewOne) {
  set_clock(kDay_s);
  start_daemon_with_key();
  set_clock(0);
  EXPECT_FALSE(is_answered(1.0)) << "what came before its start it does not remember";
  EXPECT_TRUE(eventually_counted(&DaemonStatus::stale_messages, 1));
  start_daemon_with_key();
  EXPECT_TRUE(is_answered(60.0));
}

}  // namespace
}  // namespace camway::integration
