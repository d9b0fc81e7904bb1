// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <camway/claim_t.hpp>

#include "daemon/service/core/core.h"
#include "daemon/service/log/token_bucket.h"

namespace camway::service {

/// Sees to it that no two daemons serve on the same channels. One that starts asks several times,
/// for a quarter of a second, whether another serves there; one that serves answers at once. Only
/// answers to its own questions count, so a daemon that was killed before it began is no obstacle.
/// Of two that start at the same time the one with the lower random number goes on. An answer that
/// comes late, from a daemon that had to wait for the processor, counts for some seconds more.
/// Daemons with different keys do not hear each other. The loop thread calls everything here.
class PrefixClaim {
 public:
  using Clock = std::chrono::steady_clock;

  explicit PrefixClaim(Core& core);

  /// A message on the claim channel. Throws only for want of memory.
  void on_message(std::span<const std::uint8_t> message);

  /// Asks whether another daemon serves.
  void ask();
  /// From now on this daemon serves, and says so to all that ask.
  void serve(Clock::time_point now);
  /// From now on it does not: a stop finishes what was begun, and another may start meanwhile.
  void leave() { is_leaving_ = true; }

  /// The other daemon, if one speaks against this: "host HOST, process PID".
  [[nodiscard]] const std::optional<std::string>& rival() const { return rival_; }

 private:
  [[nodiscard]] claim_t message(std::int8_t state, Clock::time_point now) const;
  [[nodiscard]] bool yields_to(const claim_t& other, Clock::time_point now) const;
  void publish(const claim_t& message);
  [[nodiscard]] double served_s(Clock::time_point now) const;

  Core& core_;
  const std::int64_t start_id_;
  std::optional<Clock::time_point> serves_since_;
  std::optional<std::string> rival_;
  bool has_asked_ = false;  ///< one that shares its prefix yields to nobody
  bool is_leaving_ = false;
  TokenBucket answers_;
};

}  // namespace camway::service
