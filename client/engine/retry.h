// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <random>

namespace camway {

using Clock = std::chrono::steady_clock;

/// Decides when a request is sent again and when it is given up. A state machine without a clock or
/// network of its own. Not thread-safe.
///
/// - A request is repeated after `try_timeout_s`, then after growing waits. Each wait is multiplied
///   by a random factor from 1 - `jitter` to 1 + `jitter`, so that clients that were refused
///   together do not come back together.
/// - If a part of the answer has come and no more follows, the missing pages are asked for, twice.
///   Then the request is repeated.
/// - It is repeated at once if a heartbeat shows that the daemon started after it was sent.
/// - It is given up after `retries` repetitions without a sign of life, after `silence_s` in which
///   there was none at all, at the deadline, or if the daemon announced its end and no other daemon
///   is heard within `successor_wait_s`.
class Retry {
 public:
  struct Rules {
    double try_timeout_s;      ///< first wait for an answer [Limit: 0 < value]
    double backoff;            ///< factor of each wait to the one before [Limit: 1 <= value]
    double max_try_timeout_s;  ///< largest wait, before `jitter` [Limit: 0 < value]
    double jitter;             ///< largest relative random change of a wait [Limit: 0 <= value < 1]
    int retries;               ///< repetitions without a sign of life [Limit: 0 <= value]
    /// Time to wait for another daemon after one has announced its end. [Limit: 0 <= value]
    double successor_wait_s = std::numeric_limits<double>::infinity();
    /// Longest time from the first sending without any sign of life. [Limit: 0 < value]
    double silence_s = std::numeric_limits<double>::infinity();
  };

  Retry(const Rules& rules, Clock::time_point deadline, std::uint64_t seed)
      : rules_(rules), deadline_(deadline), random_(seed), wait_s_(rules.try_timeout_s) {}

  enum class Action {
    kWait,        ///< wait until `wake`, or until a message comes
    kSend,        ///< send the whole request
    kAskMissing,  ///< ask for the missing pages of the answer
    kSilence,     ///< give up: no daemon is there
    kDeadline,    ///< give up: the deadline has passed
  };
  /// Returns the next action. Call it again at `wake`, and after every message.
  Action next(Clock::time_point now);
  Clock::time_point wake() const;

  /// Notes that a new page of the answer came.
  void note_part(Clock::time_point now);
  /// Notes a sign of life of the daemon that is neither a page nor a heartbeat.
  void note_life() { life_ = ever_heard_ = true; }
  /// Notes that the daemon announced its end. The request is given up after `successor_wait_s`
  /// unless a heartbeat comes.
  void note_stopping(Clock::time_point now);
  /// Notes a heartbeat of a daemon that has run for `uptime_s`.
  void note_heartbeat(double uptime_s, Clock::time_point now);
  /// Forgets that pages came, because their answer was discarded.
  void forget_parts() { has_part_ = false; }

  /// Starts over for a new request that replaces the current one. The next call of `next` sends it.
  void restart();
  /// Starts over for a request that is given up after `patience_s`, or at the deadline if that is
  /// sooner. It is repeated within that time.
  void restart_within(double patience_s, Clock::time_point now);

  bool ever_heard() const { return ever_heard_; }
  /// Returns how often the whole request was sent.
  int tries() const { return tries_; }

 private:
  Action send(Clock::time_point now);
  [[nodiscard]] Clock::time_point give_up_at() const {
    return ever_heard_ ? give_up_at_ : std::min(give_up_at_, silent_until_);
  }

  Rules rules_;
  Clock::time_point deadline_;
  std::mt19937_64 random_;
  double wait_s_;
  int tries_ = 0;
  int silent_tries_ = 0;
  bool life_ = false;  ///< whether the daemon gave a sign of life in this try
  bool ever_heard_ = false;
  bool has_part_ = false;
  bool send_now_ = true;
  int asked_missing_ = 0;  ///< requests for missing pages since the last page came
  Clock::time_point sent_at_{};
  Clock::time_point again_at_{};
  Clock::time_point missing_at_{};
  Clock::time_point give_up_at_ = Clock::time_point::max();  ///< set when a daemon stops
  /// End of the request if nobody was ever heard; set when it is first sent.
  Clock::time_point silent_until_ = Clock::time_point::max();
};

}  // namespace camway
