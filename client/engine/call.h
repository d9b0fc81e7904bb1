// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "client/engine/lcm_connection.h"
#include "client/engine/retry.h"

namespace camway {

/// The outcome of a call.
enum class Outcome {
  kAnswered,
  kSilence,   ///< no sign of life of a daemon during as many tries as allowed
  kDeadline,  ///< the deadline came first
  kBroken,    ///< the network cannot send or receive
  kUnsigned,  ///< the daemon drops unsigned messages, and this client has no keys
  kClosed,    ///< the client was destroyed, or a later call replaced this one
};

/// An encoded message to send, and its channel.
struct Outgoing {
  std::string channel;
  Bytes bytes;
};

/// A pending request: the messages to send, the state of their repetition, and the collection of
/// the answer. Not thread-safe: once it was passed to an engine, only the engine's thread may use
/// it.
class Call {
 public:
  enum class Kind { kPlan, kOccupancy, kScene, kUpload, kMap };

  Call(Kind kind, std::int64_t request_id, std::vector<Outgoing> messages, Retry retry)
      : kind_(kind),
        request_id_(request_id),
        request_messages_(std::move(messages)),
        retry_(retry) {}
  virtual ~Call() = default;
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  Kind kind() const { return kind_; }
  std::int64_t request_id() const { return request_id_; }
  Retry& retry() { return retry_; }
  const Retry& retry() const { return retry_; }
  /// Returns all messages of one try.
  const std::vector<Outgoing>& request_messages() const { return request_messages_; }

  /// Takes a message from the channel for answers. The message is for this request, or cannot be
  /// read.
  virtual void take_answer(std::span<const std::uint8_t> bytes, Clock::time_point now) = 0;
  /// Takes a progress report.
  virtual void take_progress(std::span<const std::uint8_t> /*bytes*/) {}
  /// Returns whether the answer is complete.
  virtual bool answered() const = 0;
  /// Returns the messages that ask for the missing pages of the answer.
  virtual std::vector<Outgoing> missing() const { return {}; }
  /// Cancels the request.
  virtual void cancel() {}
  /// Ends the call. Called exactly once, after all other members.
  virtual void finish(Outcome outcome) = 0;

 protected:
  void replace_request_messages(std::vector<Outgoing> messages) {
    request_messages_ = std::move(messages);
  }

 private:
  Kind kind_;
  std::int64_t request_id_;
  std::vector<Outgoing> request_messages_;
  Retry retry_;
};

}  // namespace camway
