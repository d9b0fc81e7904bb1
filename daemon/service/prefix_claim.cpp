// SPDX-License-Identifier: MIT
#include "daemon/service/prefix_claim.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <random>

#include "lcmtypes/wire/channels.h"

namespace camway::service {
namespace {

/// Largest number of answers per second; a daemon that starts asks five times.
constexpr double kAnswersPerS = 100.0;
/// A daemon counts as older than another if it began to serve this much earlier.
constexpr double kSameTime_s = 2.0;
/// How long after it began to serve a daemon still yields to an older one, whose answer may be
/// late.
constexpr double kYields_s = 10.0;

std::int64_t random_id() {
  std::random_device device;
  return static_cast<std::int64_t>((std::uint64_t{device()} << 32U) | device());
}

std::string host_name() {
  std::array<char, wire::kMaxHostBytes + 1> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return {};
  return name.data();
}

}  // namespace

PrefixClaim::PrefixClaim(Core& core)
    : core_(core), start_id_(random_id()), answers_(kAnswersPerS, kAnswersPerS) {}

void PrefixClaim::on_message(std::span<const std::uint8_t> bytes) {
  const wire::Decoded<claim_t> decoded = wire::decode<claim_t>(bytes);
  if (!decoded.message) {
    const std::string reason = decoded.fault.text("claim_t");
    if (core_.note_malformed(core_.channels.claim(), bytes.size(), reason)) {
      core_.report_unanswerable(core_.channels.claim(), bytes, reason);
    }
    return;
  }
  const claim_t& other = *decoded.message;
  if (other.start_id == start_id_ || is_leaving_) return;
  const Clock::time_point now = Clock::now();
  if (yields_to(other, now)) {
    rival_ = fmt::format("host {}, process {}", wire::printable(other.host), other.pid);
  } else if (other.state == claim_t::ASKS && serves_since_ && answers_.take(now)) {
    claim_t answer = message(claim_t::SERVES, now);
    answer.asked_by = other.start_id;
    publish(answer);
  }
}

bool PrefixClaim::yields_to(const claim_t& other, Clock::time_point now) const {
  if (!has_asked_) return false;
  if (other.state == claim_t::ASKS) return !serves_since_ && other.start_id < start_id_;
  if (other.state != claim_t::SERVES || other.asked_by != start_id_) return false;
  if (!serves_since_) return true;
  // Both serve, since answers came too late. Both compare the same two ages, so one of them yields.
  const double lead_s = other.served_s - served_s(now);
  const bool is_older = lead_s > kSameTime_s;
  const bool is_as_old = lead_s > -kSameTime_s;
  return served_s(now) < kYields_s && (is_older || (is_as_old && other.start_id < start_id_));
}

double PrefixClaim::served_s(Clock::time_point now) const {
  return serves_since_ ? std::chrono::duration<double>(now - *serves_since_).count() : 0.0;
}

void PrefixClaim::ask() {
  has_asked_ = true;
  publish(message(claim_t::ASKS, Clock::now()));
}

void PrefixClaim::serve(Clock::time_point now) { serves_since_ = now; }

claim_t PrefixClaim::message(std::int8_t state, Clock::time_point now) const {
  claim_t message{};
  message.start_id = start_id_;
  message.utime = utime_now();
  message.state = state;
  message.served_s = served_s(now);
  message.host = host_name();
  message.pid = static_cast<std::int32_t>(getpid());
  return message;
}

// Bypasses the outbox: the daemon that asks waits only a quarter of a second.
void PrefixClaim::publish(const claim_t& message) {
  if (!core_.transport.publish(core_.channels.claim(), wire::encode(message))) {
    core_.limited_log.trouble.write("a message to other daemons could not be published");
  }
}

}  // namespace camway::service
