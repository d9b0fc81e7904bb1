// SPDX-License-Identifier: MIT
#include "client/exchange.h"

#include <algorithm>

namespace camway {
namespace {

using Seconds = std::chrono::duration<double>;
using std::chrono::milliseconds;

/// So long after the last page that came, a missing one counts as lost: pages are sent back to
/// back.
constexpr double kPageGap_s = 0.25;

/// Pages sent without a breath. Two fit the usual receive buffer of 208 KiB with room for others.
constexpr std::size_t kBurst = 2;
constexpr milliseconds kBreath{1};

Clock::duration duration(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
}

/// Whether the daemon that we heard cannot have seen what was sent at `sent`.
bool started_after(const Signs& signs, Clock::time_point sent) {
  return signs.heartbeat && duration(signs.uptime_s) < Clock::now() - sent;
}

}  // namespace

Outcome Exchange::ask(const Question& question, Clock::time_point deadline) {
  double wait_s = options_.try_timeout_s;
  for (int silent_tries = 0; silent_tries <= options_.retries;) {
    signs_.news = signs_.life = signs_.heartbeat = false;
    if (!send(question)) return Outcome::kBroken;
    const Clock::time_point until = std::min(deadline, Clock::now() + duration(wait_s));
    if (!wait_for_answer(question, until)) return Outcome::kBroken;
    if (question.answered()) return Outcome::kAnswered;
    if (Clock::now() >= deadline) return Outcome::kDeadline;

    silent_tries = signs_.life ? 0 : silent_tries + 1;
    wait_s = signs_.news ? kPageGap_s : wait_s * options_.backoff;
    wait_s = std::min(wait_s, options_.max_try_timeout_s);
  }
  return Outcome::kSilence;
}

/// Sends all messages of the question once. Between them it listens, so that the daemon has time to
/// take them and nothing piles up here.
bool Exchange::send(const Question& question) {
  ++tries_;
  for (std::size_t i = 0; i < question.messages.size(); ++i) {
    if (!link_.publish(question.channel, question.messages[i])) return false;
    if (i % kBurst == kBurst - 1 && link_.wait(Clock::now() + kBreath) == Link::Wait::kBroken) {
      return false;
    }
  }
  return true;
}

/// Listens until the answer is here, or `until`, or there is reason to send again sooner.
/// False if the network broke.
bool Exchange::wait_for_answer(const Question& question, Clock::time_point until) {
  const Clock::time_point sent = Clock::now();
  while (!question.answered()) {
    Clock::time_point soon = until;
    if (signs_.news && question.begun()) {
      soon = std::min(soon, signs_.last_news + duration(kPageGap_s));
    }
    switch (link_.wait(soon)) {
      case Link::Wait::kBroken:
        return false;
      case Link::Wait::kTimeUp:
        return true;
      case Link::Wait::kHandled:
        break;
    }
    if (Clock::now() >= until || started_after(signs_, sent)) return true;
  }
  return true;
}

}  // namespace camway
