// SPDX-License-Identifier: MIT
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <camway/envelope_t.hpp>

namespace camway::wire {

/// Recognises messages that were received before, or that are too old to tell. Memory is bounded: a
/// sender is forgotten once all its messages are stale. Requires messages whose tag is right.
///
/// Not thread-safe.
class ReplayGuard {
 public:
  struct Limits {
    /// Largest difference between the time of a message and the local clock, inclusive. It allows
    /// for the transmission and for the difference of two hosts' clocks. [Units: microseconds]
    std::int64_t window_us = 30'000'000;
    std::size_t senders = 16'384;  ///< largest number of senders to remember
    /// Whether a message that was signed before this guard began is stale. If not, a message can be
    /// replayed to a program that has just started, because the guard does not remember it.
    bool only_since_start = true;
  };
  /// Number of a sender's newest counters that are remembered. A message is accepted if its counter
  /// is less than this below the highest one.
  static constexpr std::size_t kReordered = 1024;

  enum class Verdict : std::uint8_t {
    kNew,
    kStale,     ///< outside the window, or signed before this guard began
    kReplayed,  ///< received before, or `kReordered` or more below the sender's highest counter
    kCrowded,   ///< from a new sender, when the memory for senders is full
  };

  ReplayGuard(const Limits& limits, std::int64_t began_us) : limits_(limits), began_us_(began_us) {}

  /// Returns the verdict on a message and remembers a new one.
  Verdict take(const envelope_t& envelope, std::int64_t now_us);

  [[nodiscard]] std::size_t senders() const { return senders_.size(); }

 private:
  struct Sender {
    std::int64_t newest_us = 0;
    std::int64_t highest = 0;
    std::bitset<kReordered> seen;  ///< bit i: whether the counter `highest - i` was received
  };

  void forget_silent(std::int64_t now_us);
  static bool note(Sender& sender, std::int64_t counter);

  const Limits limits_;
  const std::int64_t began_us_;
  std::map<std::pair<std::int32_t, std::int64_t>, Sender> senders_;  ///< by key and sender
};

}  // namespace camway::wire
