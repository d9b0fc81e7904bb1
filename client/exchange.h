// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "camway/client.h"
#include "client/link.h"

namespace camway {

/// What the handlers of a link saw while a question is being asked.
struct Signs {
  Clock::time_point last_news{};  ///< when the last new part of the answer came
  bool news = false;              ///< a new part of the answer came in this try
  bool life = false;              ///< something came from a daemon in this try
  bool ever_heard = false;        ///< something came from a daemon in any try
  bool heartbeat = false;         ///< a heartbeat came in this try
  double uptime_s = 0.0;          ///< from the last heartbeat
};

/// One question: what to send, and when it is answered.
struct Question {
  std::string channel;
  std::vector<Bytes> messages;
  std::function<bool()> answered;  ///< whether the whole answer is here
  std::function<bool()> begun;     ///< whether part of it is
};

enum class Outcome {
  kAnswered,
  kSilence,   ///< `retries` tries in a row without a sign of a daemon
  kDeadline,  ///< the deadline came first
  kBroken,    ///< the network cannot send or receive
};

/// Sends the question again and again until it is answered, with growing waits:
/// - from `try_timeout_s` on, times `backoff`, up to `max_try_timeout_s`;
/// - a quarter of a second after the last new page when others are still missing;
/// - at once when a heartbeat shows a daemon that was started after the question was sent.
/// Gives up after `retries` repetitions without any sign of life, or at the deadline.
class Exchange {
 public:
  Exchange(Link& link, Signs& signs, const ClientOptions& options)
      : link_(link), signs_(signs), options_(options) {}

  Outcome ask(const Question& question, Clock::time_point deadline);
  /// How often the question was sent.
  int tries() const { return tries_; }

 private:
  bool send(const Question& question);
  bool wait_for_answer(const Question& question, Clock::time_point until);

  Link& link_;
  Signs& signs_;
  const ClientOptions& options_;
  int tries_ = 0;
};

}  // namespace camway
