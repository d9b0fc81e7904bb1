// SPDX-License-Identifier: MIT
//
// Sends malformed messages to a running daemon, on all its channels, and measures how it bears
// them:
//
//   malformed_flood DAEMON_PID MESSAGES [SEED]
//
// Mutants of right messages, right ones of another type, pieces, noise, lengths of billions; each
// is looked at before it is sent, so that none is right. After every few a small question is asked:
// the time until its answer is how long the daemon stood still for others. Prints the numbers. Exit
// code 0 if every question was answered within 50 ms and, after the first tenth, the daemon's
// memory grew by no more than 1 %; 3 if not; 2 if it cannot be said.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/wire_check.h"
#include "tests/service/message_mutation.h"
#include "tests/service/random_messages.h"

namespace {

using namespace camway;
using testing::below;
using testing::Random;
using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr double kLongestStall_ms = 50.0;
constexpr double kMostGrowth = 0.01;
/// What a receiver's socket buffer of the usual size holds.
constexpr std::size_t kBatchBytes = 60'000;
constexpr std::size_t kBatchMessages = 64;
constexpr char kClient[] = "malformed-flood";

/// A channel that the daemon listens to.
struct Target {
  std::string channel;
  std::vector<Bytes> right;  ///< messages of its type
  bool (*is_right)(std::span<const std::uint8_t>);
};

template <class Message>
Target target_of(const std::string& channel, Random& random) {
  constexpr int kSamples = 200;
  Target target{channel, {}, [](std::span<const std::uint8_t> bytes) {
                  const auto decoded = wire::decode<Message>(bytes);
                  return decoded.message && wire::is_client_id(decoded.message->client_id);
                }};
  for (int i = 0; i < kSamples; ++i) {
    target.right.push_back(wire::encode(testing::random_message<Message>(random)));
  }
  return target;
}

std::vector<Target> targets(Random& random) {
  const wire::Channels channels;
  return {target_of<plan_request_t>(channels.plan_request(), random),
          target_of<cancel_t>(channels.cancel(), random),
          target_of<missing_pages_t>(channels.missing_pages(), random),
          target_of<watch_t>(channels.watch(), random),
          target_of<occupancy_request_t>(channels.occupancy_request(), random),
          target_of<scene_request_t>(channels.scene_request(), random),
          target_of<upload_page_t>(channels.upload(), random),
          target_of<missing_pages_t>(channels.missing_map_pages(), random)};
}

Bytes noise(std::size_t size, Random& random) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

/// Something that may be wrong in one of many ways.
Bytes attempt(const std::vector<Target>& all, const Target& target, Random& random) {
  constexpr std::size_t kMostNoise = 2000;
  Bytes bytes = target.right[below(random, target.right.size())];
  switch (below(random, 8)) {
    case 0:
      return noise(below(random, kMostNoise), random);
    case 1:  // of another type
      return all[below(random, all.size())].right[below(random, target.right.size())];
    case 2:
      bytes.resize(below(random, bytes.size()));
      return bytes;
    case 3: {
      // A right beginning, then noise.
      const Bytes rest = noise(below(random, kMostNoise), random);
      bytes.resize(below(random, bytes.size()));
      bytes.insert(bytes.end(), rest.begin(), rest.end());
      return bytes;
    }
    case 4: {
      envelope_t envelope = testing::random_message<envelope_t>(random);
      return wire::encode(envelope);
    }
    case 5:  // a wrong fingerprint
      bytes[below(random, sizeof(std::int64_t))] ^=
          static_cast<std::uint8_t>(1 + below(random, 255));
      return bytes;
    default:
      testing::mutate(bytes, random);
      return bytes;
  }
}

/// What is heard of the daemon.
class Daemon {
 public:
  explicit Daemon(int pid) : memory_("/proc/" + std::to_string(pid) + "/statm") {
    lcm_.subscribeFunction(channels_.occupancy_response(kClient), &Daemon::take_answer, this);
    lcm_.subscribeFunction(channels_.status(), &Daemon::take_status, this);
  }

  [[nodiscard]] bool good() const { return lcm_.good() && resident_mb() > 0.0; }
  void send(const std::string& channel, const Bytes& bytes) {
    lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  }

  /// How long the answer to a question took; nothing if it does not come.
  std::optional<double> ping_ms() {
    occupancy_request_t question{};
    question.client_id = kClient;
    question.request_id = ++asked_;
    question.scene = "nowhere";
    const Clock::time_point begin = Clock::now();
    send(channels_.occupancy_request(), wire::encode(question));
    constexpr std::chrono::seconds kPatience(5);
    while (answered_ < asked_) {
      if (Clock::now() - begin > kPatience) return std::nullopt;
      lcm_.handleTimeout(10);
    }
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }

  /// As the next status has it; -1 if there is none.
  std::int64_t malformed() {
    malformed_ = -1;
    const Clock::time_point begin = Clock::now();
    while (malformed_ < 0 && Clock::now() - begin < std::chrono::seconds(5)) lcm_.handleTimeout(10);
    return malformed_;
  }

  [[nodiscard]] double resident_mb() const {
    constexpr double kPagesPerMb = 256.0;
    std::ifstream file(memory_);
    double total = 0.0;
    double resident = 0.0;
    file >> total >> resident;
    return resident / kPagesPerMb;
  }

 private:
  static void take_answer(const lcm::ReceiveBuffer* buffer, const std::string&, Daemon* self) {
    const auto decoded = wire::decode<occupancy_response_t>(
        {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    if (decoded.message) self->answered_ = std::max(self->answered_, decoded.message->request_id);
  }
  static void take_status(const lcm::ReceiveBuffer* buffer, const std::string&, Daemon* self) {
    const auto decoded =
        wire::decode<status_t>({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    if (decoded.message) self->malformed_ = decoded.message->malformed_messages;
  }

  const std::string memory_;
  const wire::Channels channels_;
  lcm::LCM lcm_;
  std::int64_t asked_ = 0;
  std::int64_t answered_ = 0;
  std::int64_t malformed_ = -1;
};

struct Outcome {
  std::vector<double> stalls_ms;
  std::int64_t unanswered = 0;
  double warm_mb = 0.0;  ///< the daemon's memory after the first tenth
};

/// Sends a few messages; returns how many.
std::int64_t send_batch(const std::vector<Target>& all, std::int64_t most, Daemon& daemon,
                        Random& random) {
  std::int64_t sent = 0;
  std::size_t room = kBatchBytes;
  while (sent < std::min<std::int64_t>(most, kBatchMessages)) {
    const Target& target = all[below(random, all.size())];
    const Bytes bytes = attempt(all, target, random);
    if (target.is_right(bytes)) continue;
    if (sent > 0 && bytes.size() > room) break;
    room -= std::min(room, bytes.size());
    daemon.send(target.channel, bytes);
    ++sent;
  }
  return sent;
}

Outcome flood(Daemon& daemon, std::int64_t messages, Random& random) {
  const std::vector<Target> all = targets(random);
  Outcome outcome;
  for (std::int64_t sent = 0; sent < messages;) {
    sent += send_batch(all, messages - sent, daemon, random);
    if (const std::optional<double> took_ms = daemon.ping_ms()) {
      outcome.stalls_ms.push_back(*took_ms);
    } else {
      ++outcome.unanswered;
    }
    if (outcome.warm_mb == 0.0 && sent >= messages / 10) outcome.warm_mb = daemon.resident_mb();
  }
  std::sort(outcome.stalls_ms.begin(), outcome.stalls_ms.end());
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: malformed_flood DAEMON_PID MESSAGES [SEED]\n");
    return 2;
  }
  Daemon daemon(std::atoi(argv[1]));
  const std::int64_t messages = std::atoll(argv[2]);
  Random random(argc > 3 ? static_cast<std::uint64_t>(std::atoll(argv[3])) : testing::kSeed);
  const std::int64_t counted_before = daemon.good() ? daemon.malformed() : -1;
  if (counted_before < 0 || !daemon.ping_ms()) {
    std::fprintf(stderr, "malformed_flood: there is no daemon to be heard\n");
    return 2;
  }
  const double first_mb = daemon.resident_mb();
  const Clock::time_point begin = Clock::now();
  const Outcome outcome = flood(daemon, messages, random);
  const double took_s = std::chrono::duration<double>(Clock::now() - begin).count();
  const std::int64_t counted = daemon.malformed() - counted_before;
  const double last_mb = daemon.resident_mb();
  const auto quantile = [&](double share) {
    const std::vector<double>& all = outcome.stalls_ms;
    return all.empty() ? 0.0
                       : all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  const double growth = last_mb / std::max(outcome.warm_mb, 1.0) - 1.0;
  std::printf(
      "%lld malformed messages in %.1f s, %lld counted by the daemon\n"
      "%zu questions between them, ms: p50 %.3f  p99 %.3f  max %.3f; %lld unanswered\n"
      "memory of the daemon: %.1f MB at first, %.1f MB after a tenth, %.1f MB at last (%+.2f %%)\n",
      static_cast<long long>(messages), took_s, static_cast<long long>(counted),
      outcome.stalls_ms.size(), quantile(0.5), quantile(0.99), quantile(1.0),
      static_cast<long long>(outcome.unanswered), first_mb, outcome.warm_mb, last_mb,
      100.0 * growth);
  const bool bore_it =
      outcome.unanswered == 0 && quantile(1.0) <= kLongestStall_ms && growth <= kMostGrowth;
  return bore_it && counted > 0 ? 0 : 3;
}
