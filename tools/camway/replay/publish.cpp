// SPDX-License-Identifier: MIT
#include "tools/camway/replay/publish.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include <camway/plan_request_t.hpp>
#include <camway/scene_request_t.hpp>

#include "daemon/planning/stages/sentences.h"
#include "lcmtypes/wire/auth/message_auth.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/local_traffic.h"
#include "tools/camway/replay/publisher.h"

namespace camway::tools {
namespace {

using planning::counted;
using Clock = Publisher::Clock;

/// Most requests and changes that are named as unanswered.
constexpr std::size_t kMostNamed = 5;
/// Time within which a daemon is heard: more than two of its heartbeats.
constexpr std::chrono::milliseconds kHeartbeat{2500};

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

void print_faults(const std::filesystem::path& log, const PublishedSession& session) {
  if (!session.damage.empty()) print_error(session.damage);
  if (session.distrusted > 0) {
    print_error(fmt::format("{}: {} left out: their signature is missing or not good", log.string(),
                            counted(session.distrusted, "message")));
  }
}

/// Returns the distance by which ids are shifted from one time to the next: more than the largest
/// difference of two ids.
std::uint64_t id_shift_of(const std::vector<record::LogEvent>& events, std::string_view prefix) {
  const wire::Channels channels{std::string(prefix)};
  std::optional<std::int64_t> least, most;
  for (const record::LogEvent& event : events) {
    const bool is_change = event.channel == channels.scene_request();
    const auto sender = wire::peek_sender(
        is_change ? wire::layout_of<scene_request_t>() : wire::layout_of<plan_request_t>(),
        event.data);
    if (!sender) continue;
    least = std::min(least.value_or(sender->request_id), sender->request_id);
    most = std::max(most.value_or(sender->request_id), sender->request_id);
  }
  if (!least) return 1;
  return static_cast<std::uint64_t>(*most) - static_cast<std::uint64_t>(*least) + 1;
}

/// Returns the number that is added to all ids of this run, so that no daemon has heard them. Small
/// ids stay exact as doubles.
std::uint64_t fresh_id_shift() {
  std::random_device device;
  constexpr std::uint64_t kBelow = std::uint64_t{1} << 52;
  return ((std::uint64_t{device()} << 32) | device()) % kBelow;
}

/// Sends the events once, with the pauses between them, divided by the speed, or in lockstep. What
/// follows a change waits for its answer. Returns false if LCM refused one.
bool send_once(const PublishedSession& session, const PublishOptions& options,
               Publisher& publisher) {
  const Clock::time_point start = Clock::now();
  const auto wait_for_last = [&] {
    publisher.listen_until(Clock::now() + seconds(options.wait_s),
                           [&] { return publisher.is_last_answered(); });
  };
  for (std::size_t i = 0; i < session.events.size(); ++i) {
    const record::LogEvent& event = session.events[i];
    if (options.lockstep && !publisher.continues_last(i)) wait_for_last();
    if (!options.lockstep && options.speed > 0.0) {
      publisher.listen_until(start + due_after(session.events.front(), event, options.speed),
                             [] { return false; });
    }
    publisher.prepare(i, seconds(options.wait_s));
    if (!publisher.send(i)) {
      print_error("LCM refused a message of " + std::to_string(event.data.size()) + " bytes");
      return false;
    }
    if (publisher.is_change(i)) wait_for_last();
  }
  if (options.lockstep) wait_for_last();
  return true;
}

/// Sends the events as often as wanted, and waits for answers. Returns false if LCM refused one.
bool send_all(const PublishedSession& session, const PublishOptions& options,
              Publisher& publisher) {
  const std::uint64_t step = id_shift_of(session.events, options.prefix);
  std::uint64_t shift = fresh_id_shift();
  for (int turn = 0; turn < options.times; ++turn) {
    publisher.set_id_shift(shift);
    if (!send_once(session, options, publisher)) return false;
    shift += step;
  }
  publisher.listen_until(Clock::now() + seconds(options.wait_s),
                         [&] { return publisher.are_all_answered(); });
  publisher.listen_until(Clock::now() + kHeartbeat, [&] { return publisher.is_heard(); });
  return true;
}

/// Returns the number of answers of each status: ": 12 ok, 3 overloaded"; empty without answers.
std::string status_list(const PublishTally& tally) {
  std::string list;
  for (const auto& [status, count] : tally.by_status) {
    list += fmt::format("{}{} {}", list.empty() ? ": " : ", ", count, status);
  }
  return list;
}

void print_changes(const PublishedSession& session, const PublishOptions& options,
                   const PublishTally& tally) {
  if (tally.changes > 0) {
    fmt::print("{} of {} of scenes made\n", tally.made_changes, counted(tally.changes, "change"));
  }
  if (session.unsent_changes == 0) return;
  fmt::print("note: {} not sent: {}\n",
             session.unsent_changes == 1
                 ? "1 change of scenes was"
                 : fmt::format("{} changes of scenes were", session.unsent_changes),
             options.wanted ? "a selection sends planning requests alone"
                            : "the session has no message that another daemon could carry out");
}

/// Returns the first requests without an answer, for people.
std::string named(const std::vector<RequestKey>& requests) {
  std::string names;
  for (std::size_t i = 0; i < std::min(requests.size(), kMostNamed); ++i) {
    names += fmt::format("{}{} {}", i == 0 ? "" : ", ", requests[i].first, requests[i].second);
  }
  return requests.size() > kMostNamed ? names + ", ..." : names;
}

/// Prints why requests have no answer, or changes were not made. Returns the exit code.
ExitCode print_failures(const PublishOptions& options, const PublishTally& tally) {
  if (tally.unanswered.empty() && tally.unmade.empty()) return ExitCode::kSuccess;
  if (!tally.is_heard) {
    print_error(fmt::format("no daemon was heard on {}_*", options.prefix));
    return ExitCode::kNoDaemon;
  }
  for (std::size_t i = 0; i < std::min(tally.unmade.size(), kMostNamed); ++i) {
    print_error("not made: " + tally.unmade[i]);
  }
  if (!tally.unanswered.empty()) {
    print_error(fmt::format(
        "{} not answered within {:g} s after the last message ({}): --wait-s waits longer",
        counted(tally.unanswered.size(), "request"), options.wait_s, named(tally.unanswered)));
  }
  return ExitCode::kNegative;
}

/// Reports what came of the messages that were sent. Returns the exit code.
ExitCode outcome_of(const std::filesystem::path& log, const PublishedSession& session,
                    const PublishOptions& options, const PublishTally& tally) {
  fmt::print("sent {}; {} of {} answered{}\n", counted(tally.sent, "message"), tally.answered(),
             counted(tally.asked, "planning request"), status_list(tally));
  print_changes(session, options, tally);
  const ExitCode code = print_failures(options, tally);
  if (code != ExitCode::kSuccess) return code;
  if (tally.other_version > 0) {
    print_error(
        fmt::format("{}: {} of its messages are of another version of the wire types, which "
                    "only a daemon of that version reads",
                    log.string(), tally.other_version));
    return ExitCode::kInvalidInput;
  }
  return session.damage.empty() ? ExitCode::kSuccess : ExitCode::kInvalidInput;
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
  if (!opened.unguarded.empty()) {
    print_error("other hosts of the network can be heard: " + opened.unguarded);
  }
  const PublishedSession session = read_published(log, options.prefix, options.wanted, keys.get());
  print_faults(log, session);
  if (session.events.empty()) {
    print_error(fmt::format("{}: holds no requests on {}_*", log.string(), options.prefix));
    return ExitCode::kInvalidInput;
  }
  Publisher publisher(*opened.lcm, channels, auth ? &*auth : nullptr, session);
  if (!send_all(session, options, publisher)) return ExitCode::kOurFault;
  return outcome_of(log, session, options, publisher.tally());
}

}  // namespace camway::tools
