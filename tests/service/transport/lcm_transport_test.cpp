// SPDX-License-Identifier: MIT
#include "daemon/service/transport/lcm_transport.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace camway::service {
namespace {

using namespace std::chrono_literals;

constexpr char kInMemory[] = "memq://";
const std::vector<std::uint8_t> kMessage{1, 2, 3, 0, 255};

std::unique_ptr<Transport> in_memory() {
  auto opened = open_lcm_transport(kInMemory);
  EXPECT_TRUE(opened) << opened.error;
  return *std::move(opened);
}

TEST(LcmTransport, CarriesBytes) {
  const std::unique_ptr<Transport> transport = in_memory();
  std::vector<std::vector<std::uint8_t>> got;
  ASSERT_TRUE(transport->subscribe(
      "A", 10, [&](auto message) { got.emplace_back(message.begin(), message.end()); }));
  ASSERT_TRUE(transport->publish("A", kMessage));
  ASSERT_TRUE(transport->publish("B", kMessage));
  ASSERT_TRUE(transport->publish("A", {}));
  while (got.size() < 2) ASSERT_TRUE(transport->poll(10s));
  EXPECT_EQ(got, (std::vector<std::vector<std::uint8_t>>{kMessage, {}}));
}

TEST(LcmTransport, WaitsNoLongerThanAsked) {
  const std::unique_ptr<Transport> transport = in_memory();
  ASSERT_TRUE(transport->subscribe("A", 10, [](auto) { FAIL(); }));
  EXPECT_TRUE(transport->poll(1ms));
}

TEST(LcmTransport, WakesFromAnotherThread) {
  const std::unique_ptr<Transport> transport = in_memory();
  const auto begin = std::chrono::steady_clock::now();
  std::thread waker([&] { transport->wake(); });
  EXPECT_TRUE(transport->poll(20s));
  waker.join();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 20s);
}

TEST(LcmTransport, AWakeBeforeTheWaitCounts) {
  const std::unique_ptr<Transport> transport = in_memory();
  transport->wake();
  transport->wake();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(transport->poll(20s));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 20s);
  EXPECT_TRUE(transport->poll(1ms)) << "both wakes are used up";
}

// After an exception inside lcm_handle LCM cannot handle any more messages.
TEST(LcmTransport, SurvivesAHandlerThatThrows) {
  const std::unique_ptr<Transport> transport = in_memory();
  int calls = 0;
  ASSERT_TRUE(transport->subscribe("A", 10, [&](auto) {
    if (++calls == 1) throw std::runtime_error("first");
  }));
  ASSERT_TRUE(transport->publish("A", kMessage));
  ASSERT_TRUE(transport->publish("A", kMessage));
  while (calls < 2) ASSERT_TRUE(transport->poll(10s));
  EXPECT_EQ(calls, 2);
}

TEST(LcmTransport, SaysWhatToDoWhenItCannotOpen) {
  const auto opened = open_lcm_transport("nonsense://");
  EXPECT_FALSE(opened);
  EXPECT_NE(opened.error.find("nonsense://"), std::string::npos) << opened.error;
  EXPECT_NE(opened.error.find("ip route add 224.0.0.0/4 dev lo"), std::string::npos);
}

}  // namespace
}  // namespace camway::service
