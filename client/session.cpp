// SPDX-License-Identifier: MIT
#include "client/session.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <random>
#include <utility>

#include <camway/status_t.hpp>

#include "client/scene_wire.h"
#include "client/text.h"
#include "lcmtypes/wire_check.h"

namespace camway {
namespace {

constexpr int kResponseQueue = 2 * wire::kMaxResponsePages;  // an answer may come twice at once
constexpr int kSceneQueue = 30;
constexpr int kStatusQueue = 16;

std::string random_client_id() {
  std::random_device device;
  char text[wire::kMaxClientIdLength + 1];
  std::snprintf(text, sizeof(text), "%d-%08x%08x", static_cast<int>(::getpid()), device(),
                device());
  return text;
}

/// Why the options cannot be used; empty if they can.
std::string fault_in(const ClientOptions& options) {
  const auto is_time = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!wire::is_prefix(options.prefix)) {
    return "ClientOptions.prefix: \"" + options.prefix + "\" is not of [A-Za-z0-9_-]{1,11}";
  }
  if (!options.client_id.empty() && !wire::is_client_id(options.client_id)) {
    return "ClientOptions.client_id: \"" + options.client_id + "\" is not of [A-Za-z0-9_-]{1,32}";
  }
  if (!is_time(options.deadline_s)) return "ClientOptions.deadline_s: must be above 0";
  if (!is_time(options.try_timeout_s)) return "ClientOptions.try_timeout_s: must be above 0";
  if (!is_time(options.max_try_timeout_s))
    return "ClientOptions.max_try_timeout_s: must be above 0";
  if (!(options.backoff >= 1.0)) return "ClientOptions.backoff: must not be below 1";
  if (options.retries < 0) return "ClientOptions.retries: must not be negative";
  return {};
}

DaemonStatus from_wire(const status_t& wire) {
  DaemonStatus status;
  status.status = Status::kOk;
  status.version = wire.version;
  status.uptime_s = wire.uptime_s;
  status.num_workers = wire.num_workers;
  status.queued_requests = wire.queued_requests;
  status.running_requests = wire.running_requests;
  status.answered_requests = wire.answered_requests;
  status.repeated_requests = wire.repeated_requests;
  status.overloaded_requests = wire.overloaded_requests;
  status.malformed_messages = wire.malformed_messages;
  status.total_scenes = wire.total_scenes;
  for (const scene_info_t& scene : wire.scenes) status.scenes.push_back(from_wire(scene));
  return status;
}

}  // namespace

Session::Session(ClientOptions options) : options_(std::move(options)) {
  error_ = fault_in(options_);
  if (!error_.empty()) return;
  if (options_.client_id.empty()) options_.client_id = random_client_id();
  channels_.prefix = options_.prefix;
  error_status_ = Status::kNetworkUnusable;
  error_ = link_.open(options_.url);
  if (error_.empty()) listen();
}

void Session::listen() {
  link_.listen(channels_.plan_response(options_.client_id), kResponseQueue,
               [this](std::span<const std::uint8_t> bytes) {
                 if (plan_receiver_) plan_receiver_(bytes);
               });
  link_.listen(channels_.occupancy_response(options_.client_id), kResponseQueue,
               [this](std::span<const std::uint8_t> bytes) {
                 if (occupancy_receiver_) occupancy_receiver_(bytes);
               });
  link_.listen(channels_.scene_response(options_.client_id), kSceneQueue,
               [this](std::span<const std::uint8_t> bytes) {
                 if (scene_receiver_) scene_receiver_(bytes);
               });
  link_.listen(channels_.upload_status(options_.client_id), kSceneQueue,
               [this](std::span<const std::uint8_t> bytes) {
                 if (upload_receiver_) upload_receiver_(bytes);
               });
  link_.listen(channels_.status(), kStatusQueue,
               [this](std::span<const std::uint8_t> bytes) { take_heartbeat(bytes); });
}

void Session::take_heartbeat(std::span<const std::uint8_t> bytes) {
  const wire::Decoded<status_t> decoded = wire::decode<status_t>(bytes);
  if (!decoded.message) return;
  heartbeat_ = from_wire(*decoded.message);
  note_life();
  signs_.heartbeat = true;
  signs_.uptime_s = heartbeat_->uptime_s;
}

std::int64_t Session::new_request_id() {
  last_request_id_ = std::max(last_request_id_ + 1, microseconds_since_1970());
  return last_request_id_;
}

void Session::note_news() {
  note_life();
  signs_.news = true;
  signs_.last_news = Clock::now();
}

void Session::note_life() { signs_.life = signs_.ever_heard = true; }

Outcome Session::ask(const Question& question, Clock::time_point deadline, int& tries) {
  link_.drain();  // what came between calls is old
  signs_ = Signs{};
  Exchange exchange(link_, signs_, options_);
  const Outcome outcome = exchange.ask(question, deadline);
  tries += exchange.tries();
  return outcome;
}

std::string Session::where() const {
  return " (channels " + options_.prefix + "_*, LCM network " + link_.url() + ")";
}

Failure Session::explain(Outcome outcome, std::string_view partly, std::string_view fault) const {
  if (outcome == Outcome::kBroken) {
    return {Status::kNetworkUnusable, "the network failed in the middle of a call" + where()};
  }
  if (!fault.empty()) {
    return {Status::kBadAnswer, "the answer could not be read: " + std::string(fault) +
                                    "; check that client and daemon are of one version"};
  }
  if (!signs_.ever_heard) {
    return {Status::kNoDaemon, "no daemon was heard" + where() +
                                   "; start camwayd with the same prefix on the same network"};
  }
  std::string text = outcome == Outcome::kSilence ? "the daemon fell silent"
                                                  : "the daemon did not answer by the deadline";
  if (!partly.empty()) text += ", only " + std::string(partly) + " came";
  return {Status::kNoAnswer,
          text + where() + "; raise ClientOptions.deadline_s or look at the daemon's log"};
}

DaemonStatus Session::next_heartbeat(Clock::time_point deadline) {
  link_.drain();
  heartbeat_.reset();
  signs_ = Signs{};
  while (!heartbeat_) {
    const Link::Wait wait = link_.wait(deadline);
    if (wait == Link::Wait::kBroken) return failed<DaemonStatus>(explain(Outcome::kBroken, {}, {}));
    if (heartbeat_) break;
    if (Clock::now() >= deadline) return failed<DaemonStatus>(explain(Outcome::kSilence, {}, {}));
  }
  return *heartbeat_;
}

Clock::time_point after(double seconds) {
  // A wait of a year is a wait for ever; more could overflow the clock.
  constexpr double kYear_s = 365.0 * 24 * 3600;
  const double bounded = std::isnan(seconds) ? 0.0 : std::clamp(seconds, 0.0, kYear_s);
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(bounded));
}

}  // namespace camway
