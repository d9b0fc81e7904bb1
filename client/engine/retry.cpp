// SPDX-License-Identifier: MIT
#include "client/engine/retry.h"

#include <algorithm>

namespace camway {
namespace {

/// Time after the last page at which a missing page counts as lost: pages are sent back to back.
constexpr double kPageWait_s = 0.1;
/// Time for the daemon to send missing pages.
constexpr double kMissingWait_s = 0.25;
constexpr int kMostAsked = 2;

Clock::duration duration(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

Retry::Action Retry::next(Clock::time_point now) {
  if (send_now_) return send(now);
  if (now >= deadline_) return Action::kDeadline;
  if (now >= give_up_at()) return Action::kSilence;
  if (has_part_ && asked_missing_ < kMostAsked) {
    if (now < missing_at_) return Action::kWait;
    ++asked_missing_;
    missing_at_ = now + duration(kMissingWait_s);
    again_at_ = missing_at_;
    return Action::kAskMissing;
  }
  if (now < again_at_) return Action::kWait;
  silent_tries_ = life_ ? 0 : silent_tries_ + 1;
  if (silent_tries_ > rules_.retries) return Action::kSilence;
  wait_s_ = std::min(wait_s_ * rules_.backoff, rules_.max_try_timeout_s);
  return send(now);
}

Retry::Action Retry::send(Clock::time_point now) {
  send_now_ = life_ = false;
  // An endless time fits no duration of a clock.
  if (tries_ == 0 && std::chrono::duration<double>(deadline_ - now).count() > rules_.silence_s) {
    silent_until_ = now + duration(rules_.silence_s);
  }
  ++tries_;
  sent_at_ = now;
  std::uniform_real_distribution<double> blur(1.0 - rules_.jitter, 1.0 + rules_.jitter);
  again_at_ = now + duration(wait_s_ * blur(random_));
  return Action::kSend;
}

Clock::time_point Retry::wake() const {
  const bool asks = has_part_ && asked_missing_ < kMostAsked;
  return std::min({asks ? missing_at_ : again_at_, deadline_, give_up_at()});
}

void Retry::note_part(Clock::time_point now) {
  note_life();
  has_part_ = true;
  asked_missing_ = 0;
  missing_at_ = now + duration(kPageWait_s);
}

void Retry::note_stopping(Clock::time_point now) {
  note_life();
  // The wait would pass the deadline, and may be infinite, which no clock duration can hold.
  if (std::chrono::duration<double>(deadline_ - now).count() < rules_.successor_wait_s) return;
  // The daemon gives the same answer to each repetition until it is gone, so the minimum counts.
  give_up_at_ = std::min(give_up_at_, now + duration(rules_.successor_wait_s));
}

void Retry::note_heartbeat(double uptime_s, Clock::time_point now) {
  note_life();
  give_up_at_ = Clock::time_point::max();
  // A daemon that started after the request was sent cannot have received it.
  const std::chrono::duration<double> since_sent = now - sent_at_;
  if (tries_ > 0 && uptime_s < since_sent.count()) send_now_ = true;
}

void Retry::restart() {
  send_now_ = true;
  silent_tries_ = 0;
  wait_s_ = rules_.try_timeout_s;
}

void Retry::restart_within(double patience_s, Clock::time_point now) {
  constexpr double kWaits = 4.0;  // so that a lost message is repeated within the time
  restart();
  wait_s_ = std::min(wait_s_, patience_s / kWaits);
  deadline_ = std::min(deadline_, now + duration(patience_s));
}

}  // namespace camway
