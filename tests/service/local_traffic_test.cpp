// SPDX-License-Identifier: MIT
#include "daemon/service/local_traffic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace camway::service {
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

/// A UDP socket on the loopback.
class LoopbackSocket {
 public:
  LoopbackSocket() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address_;
    EXPECT_EQ(::bind(socket_, address(), size), 0);
    EXPECT_EQ(::getsockname(socket_, address(), &size), 0);
  }
  ~LoopbackSocket() { ::close(socket_); }
  LoopbackSocket(const LoopbackSocket&) = delete;
  LoopbackSocket& operator=(const LoopbackSocket&) = delete;

  [[nodiscard]] int port() const { return ntohs(address_.sin_port); }
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

/// Two hosts are needed to see what is dropped: tests/integration/two_hosts_test.cpp.
TEST(LocalTraffic, HearsThisHost) {
  LoopbackSocket socket;
  ASSERT_TRUE(socket.hears_itself());
  EXPECT_EQ(hear_this_host_only(socket.port()), "");
  EXPECT_TRUE(socket.hears_itself());
}

TEST(LocalTraffic, SaysThatThereIsNoSuchSocket) {
  int port = 0;
  { port = LoopbackSocket().port(); }
  EXPECT_THAT(hear_this_host_only(port), testing::HasSubstr("no socket is bound to UDP port"));
}

}  // namespace
}  // namespace camway::service
