// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/auth/replay_guard.h"

#include <algorithm>

namespace camway::wire {
namespace {

/// Returns a - b, clamped to the range of the type.
std::int64_t difference(std::int64_t a, std::int64_t b) {
  std::int64_t result = 0;
  if (!__builtin_sub_overflow(a, b, &result)) return result;
  return a > b ? INT64_MAX : INT64_MIN;
}

}  // namespace

ReplayGuard::Verdict ReplayGuard::take(const envelope_t& envelope, std::int64_t now_us) {
  const std::int64_t age_us = difference(now_us, envelope.utime);
  const bool from_before = limits_.only_since_start && envelope.utime < began_us_;
  if (age_us > limits_.window_us || age_us < -limits_.window_us || from_before) {
    return Verdict::kStale;
  }
  const std::pair key{envelope.key_id, envelope.sender};
  auto sender = senders_.find(key);
  if (sender == senders_.end()) {
    if (senders_.size() >= limits_.senders) forget_silent(now_us);
    if (senders_.size() >= limits_.senders) return Verdict::kCrowded;
    sender = senders_.try_emplace(key).first;
    sender->second.highest = envelope.counter;
    sender->second.newest_us = envelope.utime;
    sender->second.seen.set(0);
    return Verdict::kNew;
  }
  if (!note(sender->second, envelope.counter)) return Verdict::kReplayed;
  sender->second.newest_us = std::max(sender->second.newest_us, envelope.utime);
  return Verdict::kNew;
}

/// Forgets the senders whose messages so far are all stale.
void ReplayGuard::forget_silent(std::int64_t now_us) {
  std::erase_if(senders_, [&](const auto& entry) {
    return difference(now_us, entry.second.newest_us) > limits_.window_us;
  });
}

/// Notes a counter of a sender. Returns false if it was noted before or may have been.
bool ReplayGuard::note(Sender& sender, std::int64_t counter) {
  const std::int64_t ahead = difference(counter, sender.highest);
  if (ahead > 0) {
    // A shift by the width or more leaves nothing.
    sender.seen <<=
        static_cast<std::size_t>(std::min(ahead, static_cast<std::int64_t>(kReordered)));
    sender.seen.set(0);
    sender.highest = counter;
    return true;
  }
  if (ahead <= -static_cast<std::int64_t>(kReordered)) return false;
  const auto back = static_cast<std::size_t>(-ahead);
  if (sender.seen.test(back)) return false;
  sender.seen.set(back);
  return true;
}

}  // namespace camway::wire
