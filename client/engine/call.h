// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "client/engine/link.h"
#include "client/engine/retry.h"

namespace camway {

/// How a call ended.
enum class Outcome {
  kAnswered,
  kSilence,   ///< as many tries in a row as allowed without a sign of a daemon
  kDeadline,  ///< the deadline came first
  kBroken,    ///< the network cannot send or receive
  kUnsigned,  ///< the daemon drops what is not signed, and we have no keys
  kClosed,    ///< the client went away
};

/// Bytes on their way out.
struct Outgoing {
  std::string channel;
  Bytes bytes;
};

/// A question on its way. After it was handed to an engine only that engine's thread uses it.
class Call {
 public:
  enum class Kind { kPlan, kOccupancy, kScene, kUpload, kMap };

  Call(Kind kind, std::int64_t request_id, std::vector<Outgoing> question, Retry retry)
      : kind_(kind), request_id_(request_id), question_(std::move(question)), retry_(retry) {}
  virtual ~Call() = default;
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  Kind kind() const { return kind_; }
  std::int64_t request_id() const { return request_id_; }
  Retry& retry() { return retry_; }
  const Retry& retry() const { return retry_; }
  /// All that is sent in a try.
  const std::vector<Outgoing>& question() const { return question_; }

  /// A message on the channel for answers came, for this request.
  virtual void take_answer(std::span<const std::uint8_t> bytes, Clock::time_point now) = 0;
  /// How far the daemon is.
  virtual void take_progress(std::span<const std::uint8_t> /*bytes*/) {}
  /// Whether the whole answer is here.
  virtual bool answered() const = 0;
  /// What asks for the parts of the answer that did not come.
  virtual std::vector<Outgoing> missing() const { return {}; }
  /// Nobody wants the answer any more.
  virtual void cancel() {}
  /// The last thing that is called, once.
  virtual void finish(Outcome outcome) = 0;

 protected:
  void replace_question(std::vector<Outgoing> question) { question_ = std::move(question); }

 private:
  Kind kind_;
  std::int64_t request_id_;
  std::vector<Outgoing> question_;
  Retry retry_;
};

}  // namespace camway
