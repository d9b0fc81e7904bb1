// SPDX-License-Identifier: MIT
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <camway/envelope_t.hpp>

namespace camway::wire {

/// Tells messages that are new from those that were sent before, or are too old to tell. Its memory
/// is bounded: who is not heard for longer than messages are accepted is forgotten, and what he
/// said is stale by then. To be asked about messages only whose tag is right. For one thread at a
/// time.
class ReplayGuard {
 public:
  struct Limits {
    /// How far a message's time may be from ours, in microseconds, both included: its way and what
    /// the clocks of two hosts differ by.
    std::int64_t window_us = 30'000'000;
    std::size_t senders = 16'384;
    /// Whether what was signed before this guard began is stale, for it does not remember what came
    /// then. Else it may be said again to a program that has just started.
    bool only_since_start = true;
  };
  /// Messages may overtake each other by so many.
  static constexpr std::size_t kReordered = 1024;

  enum class Verdict : std::uint8_t {
    kNew,
    kStale,     ///< outside the window, or from before this guard began
    kReplayed,  ///< was here, or is older than more than `kReordered` that were
    kCrowded,   ///< there are too many senders to remember another
  };

  ReplayGuard(const Limits& limits, std::int64_t began_us) : limits_(limits), began_us_(began_us) {}

  /// Judges a message, and remembers it if it is new.
  Verdict take(const envelope_t& envelope, std::int64_t now_us);

  [[nodiscard]] std::size_t senders() const { return senders_.size(); }

 private:
  struct Sender {
    std::int64_t newest_us = 0;
    std::int64_t highest = 0;
    std::bitset<kReordered> seen;  ///< bit i: whether number `highest - i` was here
  };

  void forget_silent(std::int64_t now_us);
  static bool note(Sender& sender, std::int64_t counter);

  const Limits limits_;
  const std::int64_t began_us_;
  std::map<std::pair<std::int32_t, std::int64_t>, Sender> senders_;  ///< by key and sender
};

}  // namespace camway::wire
