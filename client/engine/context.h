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

/// The failure of a call, with a text for the user.
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

/// How often a call begins anew if the scene changes while it is read in parts, or if the daemon
/// has dropped the upload or the export.
inline constexpr int kMaxRestarts = 3;

/// Returns the fault of options that cannot be used; empty if they can.
std::string fault_in(const ClientOptions& options);

/// State that all calls of a client share. Thread-safe, except for `set_url`.
class Context {
 public:
  /// Picks a random client id if the options have none.
  explicit Context(ClientOptions options);

  const ClientOptions& options() const { return options_; }
  const wire::Channels& channels() const { return channels_; }

  /// Returns an id that this client id has not used before. It comes from the clock, so ids stay
  /// unique across restarts.
  std::int64_t new_request_id();

  /// Returns the repetition state of a request that ends at `deadline`.
  Retry retry(Clock::time_point deadline);

  /// Returns the failure of a call without an answer. `partly` names the part of the answer that
  /// came ("2 of 5 pages"). `fault` describes an unreadable message on the channel of the answer.
  /// Both may be empty.
  Failure explain(Outcome outcome, bool ever_heard, std::string_view partly,
                  std::string_view fault) const;

  /// Returns the failure for a daemon that gave no sign of life for `silent_s`.
  Failure silence(double silent_s) const;

  /// Sets the network's URL for messages. Requires that no other thread uses this object yet.
  void set_url(std::string url) { url_ = std::move(url); }

 private:
  std::string where() const;
  /// Returns a hint to check the keys. A daemon with other keys does not answer, so it looks like
  /// no daemon.
  std::string about_keys() const;

  ClientOptions options_;
  wire::Channels channels_;
  std::string url_;
  std::atomic<std::int64_t> last_request_id_ = 0;
  std::atomic<std::uint64_t> next_seed_;
};

/// Returns the instant `seconds` from now, at most a year away; now for NaN.
Clock::time_point after(double seconds);

}  // namespace camway
