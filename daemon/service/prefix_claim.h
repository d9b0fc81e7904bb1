// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <camway/claim_t.hpp>

#include "daemon/base/token_bucket.h"
#include "daemon/service/core/core.h"

namespace camway::service {

/// Ensures that no two daemons serve on the same channels. A daemon that starts asks several times,
/// for a quarter of a second, whether another one serves; a daemon that serves answers at once.
/// Only answers to its own questions count, so a daemon that was killed before it started is no
/// obstacle. Of two that start at the same time, the one with the lower random number continues. A
/// late answer, from a daemon that had to wait for the processor, still counts for some seconds.
/// Daemons with different keys do not hear each other.
/// Not thread-safe: for the loop thread.
class PrefixClaim {
 public:
  using Clock = std::chrono::steady_clock;

  explicit PrefixClaim(Core& core);

  /// Handles a message on the claim channel. Throws only if memory runs out.
  void on_message(std::span<const std::uint8_t> message);

  /// Asks whether another daemon serves.
  void ask();
  /// Declares that this daemon serves, and answers all that ask from now on.
  void serve(Clock::time_point now);
  /// Stops claiming the prefix: a stop finishes its work while another daemon may start.
  void leave() { is_leaving_ = true; }

  /// Returns the other daemon that has the prefix, if there is one: "host HOST, process PID".
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
  bool has_asked_ = false;  ///< a daemon that shares its prefix never asks, and yields to none
  bool is_leaving_ = false;
  base::TokenBucket answers_;
};

}  // namespace camway::service
