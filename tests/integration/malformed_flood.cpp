// SPDX-License-Identifier: MIT
//
// Sends malformed messages to a running daemon on all its channels and measures the effect:
//
//   malformed_flood DAEMON_PID MESSAGES [SEED [KEY_FILE]]
//
// The messages are mutants of valid ones, valid ones of another type, parts, noise, and lengths of
// billions; each is checked before it is sent, so that none is valid. For a daemon with keys, some
// are correctly signed; the others, including valid ones, are unsigned, altered, or signed for
// another channel or with another key. After every few messages a small request is sent; the time
// until its answer shows how long the daemon was blocked. Prints the numbers. Exit code 0 if every
// request was answered within 50 ms and the daemon's memory grew by at most 1 % after the first
// tenth; 3 if not; 2 if that cannot be determined.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/wire/auth/message_auth.h"
#include "lcmtypes/wire/auth/message_keys.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/envelope.h"
#include "tests/messages/message_mutation.h"
#include "tests/messages/random_messages.h"

namespace {

using namespace camway;
using camway::testing::below;
using camway::testing::Random;
using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr double kLongestStall_ms = 50.0;
constexpr double kMostGrowth = 0.01;
/// Bytes that a receiver's socket buffer of the usual size holds.
constexpr std::size_t kBatchBytes = 60'000;
constexpr std::size_t kBatchMessages = 64;
constexpr char kClient[] = "malformed-flood";

/// A channel to which the daemon subscribes.
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
                  if constexpr (requires(Message message) { message.client_id; }) {
                    return decoded.message && wire::is_client_id(decoded.message->client_id);
                  } else {
                    return decoded.message.has_value();
                  }
                }};
  for (int i = 0; i < kSamples; ++i) {
    target.right.push_back(wire::encode(camway::testing::random_message<Message>(random)));
  }
  return target;
}

std::vector<Target> targets(Random& random) {
  const wire::Channels channels;
  return {target_of<plan_request_t>(channels.plan_request(), random),
          target_of<cancel_t>(channels.cancel(), random),
          target_of<missing_pages_t>(channels.missing_pages(), random),
          target_of<watch_t>(channels.watch(), random),
          target_of<claim_t>(channels.claim(), random),
          target_of<occupancy_request_t>(channels.occupancy_request(), random),
          target_of<cancel_t>(channels.cancel_occupancy(), random),
          target_of<scene_request_t>(channels.scene_request(), random),
          target_of<cancel_t>(channels.cancel_scene(), random),
          target_of<upload_page_t>(channels.upload(), random),
          target_of<missing_pages_t>(channels.missing_map_pages(), random)};
}

Bytes noise(std::size_t size, Random& random) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

/// Returns a message that may be invalid in one of many ways.
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
      // A valid beginning, then noise.
      const Bytes rest = noise(below(random, kMostNoise), random);
      bytes.resize(below(random, bytes.size()));
      bytes.insert(bytes.end(), rest.begin(), rest.end());
      return bytes;
    }
    case 4: {
      envelope_t envelope = camway::testing::random_message<envelope_t>(random);
      return wire::encode(envelope);
    }
    case 5:  // a wrong fingerprint
      bytes[below(random, sizeof(std::int64_t))] ^=
          static_cast<std::uint8_t>(1 + below(random, 255));
      return bytes;
    default:
      camway::testing::mutate(bytes, random);
      return bytes;
  }
}

/// Makes valid and invalid signatures.
class Signatures {
 public:
  explicit Signatures(std::shared_ptr<const wire::MessageKeys> keys)
      : right_(std::move(keys), {}), wrong_(wire::MessageKeys::from_text(kWrongKey, "").keys, {}) {}

  Bytes right(const std::string& channel, const Bytes& bytes) {
    return right_.seal(channel, bytes);
  }
  /// Signs a message wrongly in one of many ways.
  Bytes wrong(const std::string& channel, const Bytes& bytes, Random& random) {
    switch (below(random, 4)) {
      case 0:
        return bytes;
      case 1:
        return right_.seal(channel + "_", bytes);
      case 2:
        return wrong_.seal(channel, bytes);
      default: {
        const Bytes sealed = right_.seal(channel, bytes);
        Bytes altered = sealed;
        while (altered == sealed) camway::testing::mutate(altered, random);
        return altered;
      }
    }
  }

 private:
  static constexpr char kWrongKey[] =
      "2147483647 0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

  wire::MessageAuth right_;
  wire::MessageAuth wrong_;
};

/// The daemon's answers and statuses.
class Daemon {
 public:
  /// `signatures` is null for a daemon without keys; otherwise it must outlive this object.
  Daemon(int pid, Signatures* signatures)
      : memory_("/proc/" + std::to_string(pid) + "/statm"), signatures_(signatures) {
    lcm_.subscribeFunction(channels_.occupancy_response(kClient), &Daemon::take_answer, this);
    lcm_.subscribeFunction(channels_.status(), &Daemon::take_status, this);
  }

  [[nodiscard]] bool good() const { return lcm_.good() && resident_mb() > 0.0; }
  void send(const std::string& channel, const Bytes& bytes) {
    lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  }

  /// Returns the time until the answer to a request; nothing if none comes.
  std::optional<double> ping_ms() {
    occupancy_request_t question{};
    question.client_id = kClient;
    question.request_id = ++asked_;
    question.scene = "nowhere";
    const Clock::time_point begin = Clock::now();
    const std::string channel = channels_.occupancy_request();
    const Bytes bytes = wire::encode(question);
    send(channel, signatures_ != nullptr ? signatures_->right(channel, bytes) : bytes);
    constexpr std::chrono::seconds kPatience(5);
    while (answered_ < asked_) {
      if (Clock::now() - begin > kPatience) return std::nullopt;
      lcm_.handleTimeout(10);
    }
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }

  /// Returns the number of messages that the daemon could not read or did not trust, from the next
  /// status; -1 if there is none.
  std::int64_t dropped() {
    dropped_ = -1;
    const Clock::time_point begin = Clock::now();
    while (dropped_ < 0 && Clock::now() - begin < std::chrono::seconds(5)) lcm_.handleTimeout(10);
    return dropped_;
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
  /// Returns the payload of an envelope, whoever signed it.
  template <class Message>
  static std::optional<Message> read(const lcm::ReceiveBuffer* buffer) {
    const std::optional<Bytes> bytes = wire::payload_unchecked(
        {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    return bytes ? wire::decode<Message>(*bytes).message : std::nullopt;
  }
  static void take_answer(const lcm::ReceiveBuffer* buffer, const std::string&, Daemon* self) {
    const auto answer = read<occupancy_response_t>(buffer);
    if (answer) self->answered_ = std::max(self->answered_, answer->request_id);
  }
  static void take_status(const lcm::ReceiveBuffer* buffer, const std::string&, Daemon* self) {
    const auto status = read<status_t>(buffer);
    if (!status) return;
    self->dropped_ = status->malformed_messages + status->unsigned_messages +
                     status->broken_envelopes + status->unknown_key_messages +
                     status->altered_messages;
  }

  const std::string memory_;
  Signatures* const signatures_;
  const wire::Channels channels_{};
  lcm::LCM lcm_;
  std::int64_t asked_ = 0;
  std::int64_t answered_ = 0;
  std::int64_t dropped_ = -1;
};

struct Outcome {
  std::vector<double> stalls_ms;
  std::int64_t unanswered = 0;
  double warm_mb = 0.0;  ///< the daemon's memory after the first tenth
};

/// Returns a message that the daemon has to drop.
Bytes message_for(const Target& target, const std::vector<Target>& all, Signatures* signatures,
                  Random& random) {
  Bytes bytes = attempt(all, target, random);
  if (signatures == nullptr) {
    while (target.is_right(bytes)) bytes = attempt(all, target, random);
    return bytes;
  }
  if (below(random, 4) == 0) bytes = target.right[below(random, target.right.size())];
  const bool may_be_believed = !target.is_right(bytes) && below(random, 3) == 0;
  return may_be_believed ? signatures->right(target.channel, bytes)
                         : signatures->wrong(target.channel, bytes, random);
}

/// Sends a few messages; returns how many.
std::int64_t send_batch(const std::vector<Target>& all, std::int64_t most, Daemon& daemon,
                        Signatures* signatures, Random& random) {
  std::int64_t sent = 0;
  std::size_t room = kBatchBytes;
  while (sent < std::min<std::int64_t>(most, kBatchMessages)) {
    const Target& target = all[below(random, all.size())];
    const Bytes bytes = message_for(target, all, signatures, random);
    if (sent > 0 && bytes.size() > room) break;
    room -= std::min(room, bytes.size());
    daemon.send(target.channel, bytes);
    ++sent;
  }
  return sent;
}

Outcome flood(Daemon& daemon, std::int64_t messages, Signatures* signatures, Random& random) {
  const std::vector<Target> all = targets(random);
  Outcome outcome;
  for (std::int64_t sent = 0; sent < messages;) {
    sent += send_batch(all, messages - sent, daemon, signatures, random);
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
    std::fprintf(stderr, "usage: malformed_flood DAEMON_PID MESSAGES [SEED [KEY_FILE]]\n");
    return 2;
  }
  std::optional<Signatures> with_keys;
  if (argc > 4) {
    wire::MessageKeys::ReadResult keys = wire::MessageKeys::from_file(argv[4]);
    if (!keys.keys) {
      std::fprintf(stderr, "malformed_flood: %s\n", keys.error.c_str());
      return 2;
    }
    with_keys.emplace(std::move(keys.keys));
  }
  Signatures* const signatures = with_keys ? &*with_keys : nullptr;
  Daemon daemon(std::atoi(argv[1]), signatures);
  const std::int64_t messages = std::atoll(argv[2]);
  Random random(argc > 3 ? static_cast<std::uint64_t>(std::atoll(argv[3]))
                         : camway::testing::kSeed);
  const std::int64_t counted_before = daemon.good() ? daemon.dropped() : -1;
  if (counted_before < 0 || !daemon.ping_ms()) {
    std::fprintf(stderr, "malformed_flood: there is no daemon to be heard\n");
    return 2;
  }
  const double first_mb = daemon.resident_mb();
  const Clock::time_point begin = Clock::now();
  const Outcome outcome = flood(daemon, messages, signatures, random);
  const double took_s = std::chrono::duration<double>(Clock::now() - begin).count();
  const std::int64_t counted = daemon.dropped() - counted_before;
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
