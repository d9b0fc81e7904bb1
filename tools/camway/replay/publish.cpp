// SPDX-License-Identifier: MIT
#include "tools/camway/replay/publish.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/record/event_log.h"
#include "lcmtypes/wire/auth/message_auth.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/envelope.h"
#include "lcmtypes/wire/local_traffic.h"
#include "tools/camway/replay/signed_event.h"
#include "tools/camway/session/session_files.h"

namespace camway::tools {
namespace {

using Clock = std::chrono::steady_clock;
using Key = std::pair<std::string, std::int64_t>;

/// Sends requests and collects the ids of the answers, all on the calling thread.
class Publisher {
 public:
  /// `auth` may be null.
  Publisher(lcm::LCM& lcm, const wire::Channels& channels, wire::MessageAuth* auth)
      : lcm_(lcm), channels_(channels), auth_(auth) {
    lcm_.subscribe(channels_.plan_response(".*"), &Publisher::on_answer, this)
        ->setQueueCapacity(kQueueCapacity);
  }

  [[nodiscard]] bool is_request(const record::LogEvent& event) const {
    return event.channel == channels_.plan_request() ||
           event.channel == channels_.occupancy_request();
  }

  /// Sends an event; `id_shift` is added to the id of a planning request.
  bool send(record::LogEvent event, std::uint64_t id_shift) {
    if (event.channel == channels_.plan_request()) {
      auto decoded = wire::decode<plan_request_t>(event.data);
      if (decoded.message) {
        if (id_shift != 0) event.data = with_shifted_id(*decoded.message, id_shift);
        last_ = {decoded.message->client_id, decoded.message->request_id};
        asked_.insert(last_);
      } else if (wire::is_other_version(decoded.fault)) {
        ++other_version_;
      }
    }
    const auto publish = [&](const std::vector<std::uint8_t>& message) {
      return lcm_.publish(event.channel, message.data(),
                          static_cast<unsigned int>(message.size())) == 0;
    };
    ++sent_;
    return auth_ != nullptr ? publish(auth_->seal(event.channel, event.data)) : publish(event.data);
  }

  /// Receives answers until `time`, or until `is_enough` returns true.
  template <class IsEnough>
  void listen_until(Clock::time_point time, const IsEnough& is_enough) {
    while (Clock::now() < time && !is_enough()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - Clock::now());
      lcm_.handleTimeout(static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, kSliceMs)));
    }
  }

  /// Whether an event is a page of the planning request that was sent last.
  [[nodiscard]] bool continues_last(const record::LogEvent& event, std::uint64_t id_shift) const {
    if (event.channel != channels_.plan_request()) return false;
    const auto sender = wire::peek_sender(wire::layout_of<plan_request_t>(), event.data);
    const auto id = sender ? static_cast<std::uint64_t>(sender->request_id) + id_shift : 0;
    return sender && last_ == Key(sender->client_id, static_cast<std::int64_t>(id));
  }
  /// Whether the planning request that was sent last is answered; true if none was sent.
  [[nodiscard]] bool is_last_answered() const {
    return asked_.empty() || answered_.contains(last_);
  }
  [[nodiscard]] bool are_all_answered() const { return answered_.size() == asked_.size(); }
  [[nodiscard]] std::size_t asked_count() const { return asked_.size(); }
  [[nodiscard]] std::size_t answered_count() const { return answered_.size(); }
  [[nodiscard]] std::size_t sent_count() const { return sent_; }
  /// Number of planning requests sent that a daemon of this version cannot read.
  [[nodiscard]] std::size_t other_version_count() const { return other_version_; }

 private:
  static constexpr int kQueueCapacity = 4096;
  static constexpr std::int64_t kSliceMs = 100;

  static std::vector<std::uint8_t> with_shifted_id(plan_request_t& request, std::uint64_t shift) {
    // Unsigned numbers may overflow.
    request.request_id =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(request.request_id) + shift);
    return wire::encode(request);
  }

  void on_answer(const lcm::ReceiveBuffer* buffer, const std::string& channel) noexcept {
    const std::span bytes(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
    const auto message =
        auth_ != nullptr ? auth_->open(channel, bytes).message : wire::payload_unchecked(bytes);
    if (!message) return;
    const auto sender = wire::peek_sender(wire::layout_of<plan_response_t>(), *message);
    if (!sender) return;
    Key key(sender->client_id, sender->request_id);
    if (asked_.contains(key)) answered_.insert(std::move(key));
  }

  lcm::LCM& lcm_;
  const wire::Channels& channels_;
  wire::MessageAuth* auth_;
  std::set<Key> asked_;
  std::set<Key> answered_;
  Key last_;
  std::size_t sent_ = 0;  ///< messages
  std::size_t other_version_ = 0;
};

Clock::duration seconds(double value) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
}

/// Returns the time from `first` to the sending of the event. The times of a log are not trusted:
/// as doubles their difference cannot overflow, and the wait is limited to what a clock can hold.
Clock::duration due_after(const record::LogEvent& first, const record::LogEvent& event,
                          double speed) {
  constexpr double kLongest_s = 1e8;
  const double recorded_us = static_cast<double>(event.utime) - static_cast<double>(first.utime);
  return seconds(std::clamp(recorded_us * 1e-6 / speed, 0.0, kLongest_s));
}

/// The requests of a log, and what is wrong with it.
struct LoggedRequests {
  std::vector<record::LogEvent> events;
  std::uint64_t distrusted = 0;  ///< messages left out: their signature is missing or not good
  std::string damage;            ///< why the log could not be read to its end; else empty
};

bool is_wanted(const record::LogEvent& event, const PublishOptions& options) {
  if (!options.wanted) return true;
  const auto sender = wire::peek_sender(wire::layout_of<plan_request_t>(), event.data);
  return sender && options.wanted->contains({sender->client_id, sender->request_id});
}

/// Reads the wanted requests out of their envelopes; `keys` may be null (`open_event`).
LoggedRequests read_requests(const std::filesystem::path& log, const Publisher& publisher,
                             const PublishOptions& options, const wire::MessageKeys* keys) {
  LoggedRequests requests;
  const base::Result<SessionFiles> files = SessionFiles::open(log);
  if (!files) requests.damage = files.error;
  if (!files) return requests;
  for (const std::filesystem::path& file : files->logs()) {
    record::LogSummary summary = record::read_event_log(file, [&](record::LogEvent&& event) {
      if (!publisher.is_request(event)) return;
      if (open_event(keys, event)) {
        ++requests.distrusted;
      } else if (is_wanted(event, options)) {
        requests.events.push_back(std::move(event));
      }
    });
    if (requests.damage.empty()) requests.damage = std::move(summary.damage);
  }
  return requests;
}

void print_faults(const std::filesystem::path& log, const LoggedRequests& requests) {
  if (!requests.damage.empty()) print_error(requests.damage);
  if (requests.distrusted > 0) {
    print_error(fmt::format("{}: {} messages left out: their signature is missing or not good",
                            log.string(), requests.distrusted));
  }
}

/// Returns the distance by which ids are shifted from one time to the next: more than the largest
/// difference of two ids.
std::uint64_t id_shift_of(const std::vector<record::LogEvent>& events) {
  std::optional<std::int64_t> least, most;
  for (const record::LogEvent& event : events) {
    const auto sender = wire::peek_sender(wire::layout_of<plan_request_t>(), event.data);
    if (!sender) continue;
    least = std::min(least.value_or(sender->request_id), sender->request_id);
    most = std::max(most.value_or(sender->request_id), sender->request_id);
  }
  if (!least) return 1;
  return static_cast<std::uint64_t>(*most) - static_cast<std::uint64_t>(*least) + 1;
}

/// Sends the events once, with the pauses between them, divided by the speed, or in lockstep.
/// Returns false if LCM refused one.
bool send_once(const std::vector<record::LogEvent>& events, std::uint64_t id_shift,
               const PublishOptions& options, Publisher& publisher) {
  const Clock::time_point start = Clock::now();
  const auto wait_for_last = [&] {
    publisher.listen_until(Clock::now() + seconds(options.wait_s),
                           [&] { return publisher.is_last_answered(); });
  };
  for (const record::LogEvent& event : events) {
    if (options.lockstep && !publisher.continues_last(event, id_shift)) wait_for_last();
    if (!options.lockstep && options.speed > 0.0) {
      publisher.listen_until(start + due_after(events.front(), event, options.speed),
                             [] { return false; });
    }
    if (!publisher.send(event, id_shift)) {
      print_error("LCM refused a message of " + std::to_string(event.data.size()) + " bytes");
      return false;
    }
  }
  if (options.lockstep) wait_for_last();
  return true;
}

/// Sends the events as often as wanted, and waits for answers. Returns false if LCM refused one.
bool send_all(const std::vector<record::LogEvent>& events, const PublishOptions& options,
              Publisher& publisher) {
  const std::uint64_t shift = id_shift_of(events);
  for (int turn = 0; turn < options.times; ++turn) {
    if (!send_once(events, shift * static_cast<std::uint64_t>(turn), options, publisher)) {
      return false;
    }
  }
  publisher.listen_until(Clock::now() + seconds(options.wait_s),
                         [&] { return publisher.are_all_answered(); });
  return true;
}

/// Reports what came of the requests that were sent. Returns the exit code.
ExitCode outcome_of(const std::filesystem::path& log, const LoggedRequests& requests,
                    const Publisher& publisher) {
  fmt::print("sent {} messages; {} of {} planning requests answered\n", publisher.sent_count(),
             publisher.answered_count(), publisher.asked_count());
  if (publisher.answered_count() < publisher.asked_count()) return ExitCode::kNegative;
  if (publisher.other_version_count() > 0) {
    print_error(
        fmt::format("{}: {} of its messages are of another version of the wire types, which "
                    "only a daemon of that version reads",
                    log.string(), publisher.other_version_count()));
    return ExitCode::kInvalidInput;
  }
  return requests.damage.empty() ? ExitCode::kSuccess : ExitCode::kInvalidInput;
}

}  // namespace

ExitCode publish_log(const std::filesystem::path& log, const PublishOptions& options,
                     std::shared_ptr<const wire::MessageKeys> keys) {
  const wire::Channels channels{options.prefix};
  const wire::OpenedLcm opened = wire::open_lcm(options.url);
  if (!opened.lcm) {
    print_error(
        "LCM cannot use the network: is there a multicast route? "
        "(ip route add 224.0.0.0/4 dev lo)");
    return ExitCode::kInvalidInput;
  }
  std::optional<wire::MessageAuth> auth;
  wire::ReplayGuard::Limits limits;
  limits.only_since_start = false;  // this lives for moments, and the daemon's clock may be behind
  if (keys) auth.emplace(keys, limits);
  Publisher publisher(*opened.lcm, channels, auth ? &*auth : nullptr);
  if (!opened.unguarded.empty()) {
    print_error("other hosts of the network can be heard: " + opened.unguarded);
  }
  const LoggedRequests requests = read_requests(log, publisher, options, keys.get());
  print_faults(log, requests);
  if (requests.events.empty()) {
    print_error(fmt::format("{}: holds no requests on {}_*", log.string(), options.prefix));
    return ExitCode::kInvalidInput;
  }
  if (!send_all(requests.events, options, publisher)) return ExitCode::kOurFault;
  return outcome_of(log, requests, publisher);
}

}  // namespace camway::tools
