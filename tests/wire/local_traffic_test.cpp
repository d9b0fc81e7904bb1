// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/local_traffic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <string>
#include <thread>

namespace camway::wire {
namespace {

TEST(LocalTraffic, IsWhatTheUrlSays) {
  EXPECT_EQ(port_of_local_network("udpm://239.255.76.67:7667?ttl=0"), 7667);
  EXPECT_EQ(port_of_local_network("udpm://239.255.76.67:7700?recv_buf_size=9&ttl=0"), 7700);
  EXPECT_EQ(port_of_local_network("udpm://239.255.76.67:7700"), 7700) << "LCM's default ttl";
  EXPECT_EQ(port_of_local_network("udpm://"), 7667);
  EXPECT_EQ(port_of_local_network("udpm://?ttl=0"), 7667);
  EXPECT_EQ(port_of_local_network("udpm://239.255.76.67:7667?ttl=1"), std::nullopt);
  EXPECT_EQ(port_of_local_network("udpm://239.255.76.67:7667?recv_buf_size=9&ttl=2"), std::nullopt);
  EXPECT_EQ(port_of_local_network("udpm://?ttl=257"), std::nullopt) << "to LCM it is 1";
  EXPECT_EQ(port_of_local_network("memq://"), std::nullopt);
  EXPECT_EQ(port_of_local_network("tcpq://localhost:7700"), std::nullopt);
}

/// A UDP socket on the loopback device. Several may be bound to a port, like LCM's.
class LoopbackSocket {
 public:
  explicit LoopbackSocket(int port = 0) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_port = htons(static_cast<std::uint16_t>(port));
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address_;
    const int yes = 1;
    EXPECT_EQ(::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes), 0);
    EXPECT_EQ(::bind(socket_, address(), size), 0);
    EXPECT_EQ(::getsockname(socket_, address(), &size), 0);
  }
  ~LoopbackSocket() { ::close(socket_); }
  LoopbackSocket(const LoopbackSocket&) = delete;
  LoopbackSocket& operator=(const LoopbackSocket&) = delete;

  [[nodiscard]] int port() const { return ntohs(address_.sin_port); }
  [[nodiscard]] bool is_guarded() const {
    socklen_t instructions = 0;
    // Returns the length of its filter, if it has one.
    return ::getsockopt(socket_, SOL_SOCKET, SO_GET_FILTER, nullptr, &instructions) == 0 &&
           instructions > 0;
  }
  bool hears_itself() {
    char byte = 'x';
    return ::sendto(socket_, &byte, 1, 0, address(), sizeof address_) == 1 &&
           ::recv(socket_, &byte, 1, MSG_DONTWAIT) == 1;
  }

 private:
  sockaddr* address() { return reinterpret_cast<sockaddr*>(&address_); }
  int socket_;
  sockaddr_in address_{};
};

std::string url_of(int port) { return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0"; }

/// Dropped messages take two hosts to see: tests/integration/two_hosts_test.cpp. In these tests a
/// socket stands for LCM's.
TEST(LocalTraffic, HearsThisHost) {
  int port = 0;
  { port = LoopbackSocket().port(); }
  const LocalTraffic local(url_of(port));
  LoopbackSocket socket(port);
  ASSERT_TRUE(socket.hears_itself());
  EXPECT_EQ(local.guard().fault, "");
  EXPECT_TRUE(socket.hears_itself());
  EXPECT_TRUE(socket.is_guarded());
}

TEST(LocalTraffic, LeavesSocketsOfOthersAsTheyAre) {
  LoopbackSocket before;
  LocalTraffic local(url_of(before.port()));
  EXPECT_THAT(local.guard().fault, ::testing::HasSubstr("no new socket is bound to UDP port"));
  EXPECT_FALSE(before.is_guarded());
  LoopbackSocket elsewhere;
  EXPECT_NE(local.guard().fault, "");
  EXPECT_FALSE(elsewhere.is_guarded());
}

TEST(LocalTraffic, ChangesNothingWhereTwoSocketsMayBeTheOne) {
  const LoopbackSocket before;
  const LocalTraffic local(url_of(before.port()));
  const LoopbackSocket one(before.port());
  const LoopbackSocket other(before.port());
  const LocalTraffic::Guarded guarded = local.guard();
  EXPECT_THAT(guarded.fault, ::testing::HasSubstr("another socket was bound to UDP port"));
  EXPECT_TRUE(guarded.try_again);
  EXPECT_FALSE(one.is_guarded() || other.is_guarded());
}

// Other threads open sockets at the same port and close them, so that descriptors are reused.
TEST(LocalTraffic, MeetsNoSocketThatAnotherThreadOpensMeanwhile) {
  const LoopbackSocket before;
  const std::string url = url_of(before.port());
  std::atomic<bool> is_over = false;
  std::atomic<int> guarded_of_others = 0;
  std::thread others([&] {
    for (int i = 0; !is_over; ++i) {
      std::deque<LoopbackSocket> sockets;
      for (int k = 0; k < 3; ++k) sockets.emplace_back(k == i % 3 ? 0 : before.port());
      for (const LoopbackSocket& socket : sockets) guarded_of_others += socket.is_guarded() ? 1 : 0;
    }
  });
  constexpr int kTimes = 1000;
  int alone = 0;
  for (int i = 0; i < kTimes; ++i) {
    const LocalTraffic local(url);
    const LoopbackSocket socket(before.port());
    const LocalTraffic::Guarded guarded = local.guard();
    EXPECT_EQ(socket.is_guarded(), guarded.fault.empty()) << guarded.fault;
    EXPECT_EQ(guarded.try_again, !guarded.fault.empty()) << guarded.fault;
    alone += guarded.fault.empty() ? 1 : 0;
  }
  is_over = true;
  others.join();
  EXPECT_EQ(guarded_of_others, 0) << alone << " of " << kTimes << " times it met no other";
  EXPECT_FALSE(before.is_guarded());
}

TEST(LocalTraffic, DoesNothingWhereOthersMaySpeak) {
  EXPECT_EQ(LocalTraffic("udpm://239.255.76.67:7667?ttl=1").guard().fault, "");
  EXPECT_EQ(LocalTraffic("memq://").guard().fault, "");
}

}  // namespace
}  // namespace camway::wire
