// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "client/engine/call.h"
#include "lcmtypes/wire/channels.h"

namespace camway {

/// How a call failed, with a text for a person.
struct Failure {
  Status status;
  std::string error;
};

template <class Answer>
Answer failed(Failure failure) {
  Answer answer;
  answer.status = failure.status;
  answer.error = std::move(failure.error);
  return answer;
}

/// Why the options cannot be used; empty if they can.
std::string fault_in(const ClientOptions& options);

/// What all calls of a client share. Safe from any thread.
class Context {
 public:
  /// Makes up a client id if there is none.
  explicit Context(ClientOptions options);

  const ClientOptions& options() const { return options_; }
  const wire::Channels& channels() const { return channels_; }

  /// A number this client id never used: from the clock, so that it holds across restarts too.
  std::int64_t new_request_id();

  /// When to repeat a question that has to be answered by `deadline`.
  Retry retry(Clock::time_point deadline);

  /// Why there is no answer. `partly` and `fault` may be empty: what came of the answer, and what
  /// was wrong with a message that came on the answer's channel.
  Failure explain(Outcome outcome, bool ever_heard, std::string_view partly,
                  std::string_view fault) const;

  /// Why a daemon that was heard before counts as gone, so long after the last sign of life.
  Failure silence(double silent_s) const;

  /// The network, for texts.
  void set_url(std::string url) { url_ = std::move(url); }

 private:
  std::string where() const;
  /// Keys that do not match look like a daemon that is not there.
  std::string about_keys() const;

  ClientOptions options_;
  wire::Channels channels_;
  std::string url_;
  std::atomic<std::int64_t> last_request_id_ = 0;
  std::atomic<std::uint64_t> next_seed_;
};

/// The instant so many seconds from now.
Clock::time_point after(double seconds);

}  // namespace camway
