// SPDX-License-Identifier: MIT
#include "client/engine/context.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

std::string random_client_id() {
  std::random_device device;
  char text[wire::kMaxClientIdLength + 1];
  std::snprintf(text, sizeof(text), "%d-%08x%08x", static_cast<int>(::getpid()), device(),
                device());
  return text;
}

std::uint64_t random_seed() {
  std::random_device device;
  return (std::uint64_t{device()} << 32) | device();
}

}  // namespace

std::string fault_in(const ClientOptions& options) {
  const auto is_time = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!wire::is_prefix(options.prefix)) {
    return "ClientOptions.prefix: \"" + options.prefix + "\" is not of [A-Za-z0-9_-]{1,11}";
  }
  if (!options.client_id.empty() && !wire::is_client_id(options.client_id)) {
    return "ClientOptions.client_id: \"" + options.client_id + "\" is not of [A-Za-z0-9_-]{1,32}";
  }
  if (!is_time(options.deadline_s)) return "ClientOptions.deadline_s: must be above 0";
  if (!(options.change_deadline_s >= 0.0)) {
    return "ClientOptions.change_deadline_s: must not be below 0";
  }
  if (!is_time(options.try_timeout_s)) return "ClientOptions.try_timeout_s: must be above 0";
  if (!is_time(options.max_try_timeout_s))
    return "ClientOptions.max_try_timeout_s: must be above 0";
  if (!(options.backoff >= 1.0)) return "ClientOptions.backoff: must not be below 1";
  if (!(options.jitter >= 0.0 && options.jitter < 1.0)) {
    return "ClientOptions.jitter: must be within 0 and 1, less than 1";
  }
  if (!(options.watch_lease_s >= 1.0 && options.watch_lease_s <= 86'400.0)) {
    return "ClientOptions.watch_lease_s: must be within 1 and 86400";
  }
  if (!(options.successor_wait_s >= 0.0)) {
    return "ClientOptions.successor_wait_s: must not be below 0";
  }
  if (options.retries < 0) return "ClientOptions.retries: must not be negative";
  return {};
}

Context::Context(ClientOptions options) : options_(std::move(options)) {
  if (options_.client_id.empty()) options_.client_id = random_client_id();
  channels_.prefix = options_.prefix;
  next_seed_ = options_.seed != 0 ? options_.seed : random_seed();
}

std::int64_t Context::new_request_id() {
  std::int64_t last = last_request_id_;
  std::int64_t next = 0;
  do {
    next = std::max(last + 1, wire::utime_now());
  } while (!last_request_id_.compare_exchange_weak(last, next));
  return next;
}

Retry Context::retry(Clock::time_point deadline) {
  const Retry::Rules rules{options_.try_timeout_s, options_.backoff, options_.max_try_timeout_s,
                           options_.jitter,        options_.retries, options_.successor_wait_s,
                           options_.deadline_s};
  return Retry(rules, deadline, next_seed_++);
}

std::string Context::where() const {
  return " (channels " + options_.prefix + "_*, LCM network " + url_ + ")";
}

std::string Context::about_keys() const {
  return options_.authentication
             ? "; or its keys are others: both sides drop what is signed with those, and say "
               "nothing"
             : "; or it has keys: then it drops what is not signed with them, and says nothing";
}

Failure Context::explain(Outcome outcome, bool ever_heard, std::string_view partly,
                         std::string_view fault) const {
  if (outcome == Outcome::kBroken) {
    return {Status::kNetworkUnusable, "the network failed in the middle of a call" + where()};
  }
  if (outcome == Outcome::kUnsigned) {
    return {Status::kNoAnswer,
            "the daemon has keys (auth.key_file) and drops what is not signed "
            "with them, and this client has none" +
                where()};
  }
  if (outcome == Outcome::kClosed) {
    return {Status::kNoAnswer,
            "the client was destroyed, or the same request id asked again, "
            "before the answer came"};
  }
  if (!fault.empty()) {
    return {Status::kBadAnswer, "the answer could not be read: " + std::string(fault) +
                                    "; check that client and daemon are of one version"};
  }
  if (!ever_heard) {
    return {Status::kNoDaemon, "no daemon was heard" + where() +
                                   "; start camwayd with the same prefix on the same network" +
                                   about_keys()};
  }
  std::string text = outcome == Outcome::kSilence ? "the daemon fell silent"
                                                  : "the daemon did not answer by the deadline";
  if (!partly.empty()) text += ", only " + std::string(partly) + " came";
  // If a part of the answer came, the keys are right.
  return {Status::kNoAnswer, text + where() + "; wait longer, or look at the daemon's log" +
                                 (partly.empty() ? about_keys() : std::string())};
}

Failure Context::silence(double silent_s) const {
  char seconds[32];
  std::snprintf(seconds, sizeof(seconds), "%.3g", silent_s);
  return {Status::kNoDaemon, "the daemon fell silent: for " + std::string(seconds) +
                                 " s neither a heartbeat nor an answer came" + where() +
                                 "; it ended, or the network fails"};
}

Clock::time_point after(double seconds, Clock::time_point start) {
  // A longer wait than a year could overflow the clock.
  constexpr double kYear_s = 365.0 * 24 * 3600;
  const double bounded = std::isnan(seconds) ? 0.0 : std::clamp(seconds, 0.0, kYear_s);
  return start +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(bounded));
}

}  // namespace camway
