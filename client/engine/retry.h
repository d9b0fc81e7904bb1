// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <random>

namespace camway {

using Clock = std::chrono::steady_clock;

/// When a question is sent again, and when it is given up: a state machine without a clock or a
/// network of its own. For one thread at a time.
///
/// - The question is sent again after `try_timeout_s`, then after longer and longer waits, each
///   blurred by `jitter`, so that clients that were refused together do not come back together.
/// - When part of the answer is here and no more comes, the rest is asked for, twice; then the
///   question is sent again.
/// - It is sent again at once when a heartbeat shows a daemon that was started after it was sent.
/// - It is given up after `retries` repetitions without a sign of life, at the deadline, or when
/// the
///   daemon said that it ends and no other is heard within `successor_wait_s`.
class Retry {
 public:
  struct Rules {
    double try_timeout_s;
    double backoff;
    double max_try_timeout_s;
    double jitter;
    int retries;
    /// How long another daemon is waited for when one said that it ends.
    double successor_wait_s = std::numeric_limits<double>::infinity();
  };

  Retry(const Rules& rules, Clock::time_point deadline, std::uint64_t seed)
      : rules_(rules), deadline_(deadline), random_(seed), wait_s_(rules.try_timeout_s) {}

  enum class Action {
    kWait,        ///< until `wake`, unless something comes before
    kSend,        ///< the whole question
    kAskMissing,  ///< for the parts of the answer that did not come
    kSilence,     ///< give up: nobody is there
    kDeadline,    ///< give up: it took too long
  };
  /// What to do now; to be asked again at `wake`, and after anything came.
  Action next(Clock::time_point now);
  Clock::time_point wake() const;

  /// A new part of the answer came.
  void note_part(Clock::time_point now);
  /// Something else came from the daemon.
  void note_life() { life_ = ever_heard_ = true; }
  /// The daemon said that it ends: it is given up soon, unless another is heard.
  void note_stopping(Clock::time_point now);
  /// A heartbeat came, of a daemon that has run for so long.
  void note_heartbeat(double uptime_s, Clock::time_point now);
  /// All parts that came were of an answer that does not count.
  void forget_parts() { has_part_ = false; }

  /// Another question takes the place of this one: it is sent at once.
  void restart();

  bool ever_heard() const { return ever_heard_; }
  /// How often the whole question was sent.
  int tries() const { return tries_; }

 private:
  Action send(Clock::time_point now);

  Rules rules_;
  Clock::time_point deadline_;
  std::mt19937_64 random_;
  double wait_s_;
  int tries_ = 0;
  int silent_tries_ = 0;
  bool life_ = false;  ///< in this try
  bool ever_heard_ = false;
  bool has_part_ = false;
  bool send_now_ = true;
  int asked_missing_ = 0;  ///< since the last part came
  Clock::time_point sent_at_{};
  Clock::time_point again_at_{};
  Clock::time_point missing_at_{};
  Clock::time_point give_up_at_ = Clock::time_point::max();  ///< as the daemon ends
};

}  // namespace camway
