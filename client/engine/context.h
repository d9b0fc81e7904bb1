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

/// The failure of a call.
struct Failure {
  Status status;      ///< not `kOk`, unless there is no failure
  std::string error;  ///< a text for the user
};

/// Returns an answer that has the status and the error of `failure`, and nothing else.
template <class Answer>
Answer failed(Failure failure) {
  Answer answer;
  answer.status = failure.status;
  answer.error = std::move(failure.error);
  return answer;
}

/// Largest number of times that a call begins anew: because the scene changed while it was read in
/// parts, or because the daemon dropped the upload or the export.
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

  /// Returns a request id that this client has not used before. It comes from the clock, so that
  /// ids stay unique across restarts.
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

  /// Sets the network's URL, which error texts name. Requires that no other thread uses this object
  /// yet.
  void set_url(std::string url) { url_ = std::move(url); }

 private:
  std::string where() const;
  /// Returns a hint to check the keys: a daemon with other keys does not answer, just as if there
  /// were none.
  std::string about_keys() const;

  ClientOptions options_;
  wire::Channels channels_;
  std::string url_;
  std::atomic<std::int64_t> last_request_id_ = 0;
  std::atomic<std::uint64_t> next_seed_;
};

/// Returns the instant `seconds` after another one, at most a year away; that one for NaN.
Clock::time_point after(double seconds, Clock::time_point start = Clock::now());

}  // namespace camway
