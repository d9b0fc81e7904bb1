// SPDX-License-Identifier: MIT
// A bad network between clients and a daemon:
//
//   lossy_relay CLIENTS_URL DAEMON_URL LOSS DUPLICATES REORDERED SEED
//
// passes each message on with these shares of them lost, sent twice, or held back for a while, so
// that later ones overtake it. Prints `relaying` when it does. Ends when it is killed.
#include <poll.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

namespace {

using Clock = std::chrono::steady_clock;

/// What clients publish; all else is the daemon's.
constexpr char kFromClients[] =
    ".*_(PLAN_REQUEST|OCCUPANCY_REQUEST|SCENE_REQUEST|UPLOAD|CANCEL|MISSING_PAGES|WATCH)";
constexpr char kFromDaemon[] =
    ".*_((PLAN_RESPONSE|PLAN_PROGRESS|MISSING_PAGES|OCCUPANCY_RESPONSE|SCENE_RESPONSE|UPLOAD_"
    "STATUS|"
    "WATCH_REPORT)_.*|STATUS|ERROR)";

struct Shares {
  double loss;
  double duplicates;
  double reordered;
};

/// One direction.
class Relay {
 public:
  Relay(lcm::LCM& from, lcm::LCM& to, const char* channels, const Shares& shares,
        std::uint64_t seed)
      : to_(to), shares_(shares), random_(seed) {
    from.subscribe(channels, &Relay::take, this)->setQueueCapacity(10'000);
  }

  void release_held() {
    while (!held_.empty() && held_.begin()->first <= Clock::now()) {
      held_.begin()->second();
      held_.erase(held_.begin());
    }
  }

 private:
  void take(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (happens(shares_.loss)) return;
    const auto* const begin = static_cast<const std::uint8_t*>(buffer->data);
    const std::vector<std::uint8_t> bytes(begin, begin + buffer->data_size);
    const auto send = [this, channel, bytes] {
      to_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    };
    if (happens(shares_.duplicates)) send();
    if (happens(shares_.reordered)) {
      held_.emplace(Clock::now() + std::chrono::milliseconds(1 + random_() % 20), send);
    } else {
      send();
    }
  }

  bool happens(double share) { return std::bernoulli_distribution(share)(random_); }

  lcm::LCM& to_;
  Shares shares_;
  std::mt19937_64 random_;
  std::multimap<Clock::time_point, std::function<void()>> held_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  lcm::LCM clients(argv[1]);
  lcm::LCM daemon(argv[2]);
  if (!clients.good() || !daemon.good()) return 1;
  const Shares shares{std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])};
  const std::uint64_t seed = std::strtoull(argv[6], nullptr, 10);
  Relay there(clients, daemon, kFromClients, shares, seed);
  Relay back(daemon, clients, kFromDaemon, shares, seed + 1);
  std::array<pollfd, 2> inputs{pollfd{clients.getFileno(), POLLIN, 0},
                               pollfd{daemon.getFileno(), POLLIN, 0}};
  std::cout << "relaying" << std::endl;
  while (::poll(inputs.data(), inputs.size(), 1) >= 0) {
    if ((inputs[0].revents & POLLIN) != 0) clients.handle();
    if ((inputs[1].revents & POLLIN) != 0) daemon.handle();
    there.release_held();
    back.release_held();
  }
  return 1;
}
