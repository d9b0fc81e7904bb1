// SPDX-License-Identifier: MIT
// A relay that makes a bad network between clients and a daemon:
//
//   lossy_relay CLIENTS_PORT DAEMON_PORT LOSS DUPLICATES REORDERED SEED
//
// joins LCM's multicast group at the two ports and passes each datagram from one to the other. It
// loses, duplicates or delays these fractions of them; later datagrams overtake a delayed one. A
// message of Camway's is one datagram. Prints `relaying` when it is ready. Runs until it is killed.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

constexpr char kGroup[] = "239.255.76.67";
/// Size of the receive buffer to ask for; the kernel limits it.
constexpr int kReceiveBytes = 4 << 20;
constexpr std::size_t kMaxDatagramBytes = 65'536;

sockaddr_in address(in_addr_t host, int port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr.s_addr = host;
  result.sin_port = htons(static_cast<std::uint16_t>(port));
  return result;
}

template <class Value>
bool set(int socket, int level, int option, const Value& value) {
  return ::setsockopt(socket, level, option, &value, sizeof value) == 0;
}

/// Returns a socket that receives the group's messages at a port; negative on failure.
int listen_at(int port) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in group = address(::inet_addr(kGroup), port);
  const ip_mreq membership{group.sin_addr, {INADDR_ANY}};
  set(socket, SOL_SOCKET, SO_RCVBUF, kReceiveBytes);
  const bool good = set(socket, SOL_SOCKET, SO_REUSEADDR, 1) &&
                    ::bind(socket, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0 &&
                    set(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership);
  return good ? socket : -1;
}

/// Returns a socket for sending on this host only, and its own `port`; negative on failure.
int open_mouth(in_port_t& port) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own = address(INADDR_ANY, 0);
  socklen_t size = sizeof own;
  const bool good = set(socket, IPPROTO_IP, IP_MULTICAST_TTL, 0) &&
                    ::bind(socket, reinterpret_cast<const sockaddr*>(&own), size) == 0 &&
                    ::getsockname(socket, reinterpret_cast<sockaddr*>(&own), &size) == 0;
  port = own.sin_port;
  return good ? socket : -1;
}

struct Shares {
  double loss;
  double duplicates;
  double reordered;
};

/// One direction of the relay.
class Relay {
 public:
  Relay(int mouth, int to_port, const Shares& shares, std::uint64_t seed)
      : mouth_(mouth), to_(address(::inet_addr(kGroup), to_port)), shares_(shares), random_(seed) {}

  void pass_on(Bytes datagram) {
    if (happens(shares_.loss)) return;
    if (happens(shares_.duplicates)) send(datagram);
    if (happens(shares_.reordered)) {
      const auto later = Clock::now() + std::chrono::milliseconds(1 + random_() % 20);
      held_.emplace(later, std::move(datagram));
    } else {
      send(datagram);
    }
  }

  void release_held() {
    while (!held_.empty() && held_.begin()->first <= Clock::now()) {
      send(held_.begin()->second);
      held_.erase(held_.begin());
    }
  }

 private:
  void send(const Bytes& datagram) const {
    ::sendto(mouth_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
             sizeof to_);
  }
  bool happens(double share) { return std::bernoulli_distribution(share)(random_); }

  int mouth_;
  sockaddr_in to_;
  Shares shares_;
  std::mt19937_64 random_;
  std::multimap<Clock::time_point, Bytes> held_;
};

/// Relays a datagram that waits at `ear`, unless the relay sent it itself, from port `own_port`.
void take(int ear, in_port_t own_port, Relay& relay) {
  Bytes datagram(kMaxDatagramBytes);
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const ssize_t length = ::recvfrom(ear, datagram.data(), datagram.size(), 0,
                                    reinterpret_cast<sockaddr*>(&from), &size);
  if (length < 0 || from.sin_port == own_port) return;
  datagram.resize(static_cast<std::size_t>(length));
  relay.pass_on(std::move(datagram));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  const int clients_port = std::atoi(argv[1]);
  const int daemon_port = std::atoi(argv[2]);
  const Shares shares{std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])};
  const std::uint64_t seed = std::strtoull(argv[6], nullptr, 10);
  in_port_t own_port = 0;
  const int mouth = open_mouth(own_port);
  std::array<pollfd, 2> ears{pollfd{listen_at(clients_port), POLLIN, 0},
                             pollfd{listen_at(daemon_port), POLLIN, 0}};
  if (mouth < 0 || ears[0].fd < 0 || ears[1].fd < 0) {
    std::cerr << "the multicast group cannot be joined\n";
    return 1;
  }
  Relay there(mouth, daemon_port, shares, seed);
  Relay back(mouth, clients_port, shares, seed + 1);
  std::cout << "relaying, seed " << seed << std::endl;
  while (::poll(ears.data(), ears.size(), 1) >= 0) {
    if ((ears[0].revents & POLLIN) != 0) take(ears[0].fd, own_port, there);
    if ((ears[1].revents & POLLIN) != 0) take(ears[1].fd, own_port, back);
    there.release_held();
    back.release_held();
  }
  return 1;
}
