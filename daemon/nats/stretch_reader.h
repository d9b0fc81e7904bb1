// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/nats/connection_parts.h"
#include "daemon/nats/stream.h"

namespace camway::nats {

/// A subscription for the replies to several requests at once. Not thread-safe.
class ReplyInbox {
 public:
  explicit ReplyInbox(Connection& connection);
  ~ReplyInbox();
  ReplyInbox(const ReplyInbox&) = delete;
  ReplyInbox& operator=(const ReplyInbox&) = delete;

  /// Whether it belongs to this connection, and all replies have come: then it can be used again.
  [[nodiscard]] bool is_idle(const NatsHandle& handle) const {
    return subscription_ != nullptr && handle == handle_ && awaited_ == 0;
  }
  /// Sends a request. Returns false if it cannot be sent. The reply has its number.
  bool ask(const std::string& subject, const std::string& request, std::size_t number);
  /// The next reply, to whichever request; null if none comes in time.
  NatsOwned<natsMsg> next(std::chrono::milliseconds wait);
  static std::size_t number_of(natsMsg& reply);

 private:
  Connection::Parts& parts_;
  NatsHandle handle_;
  NatsOwned<char> inbox_;
  NatsOwned<natsSubscription> subscription_;
  std::size_t awaited_ = 0;
};

/// Reads a stretch of a stream by asking for each sequence the first message from there on, several
/// at once. Where all are there, no two answers are the same. Not thread-safe.
class StretchReader {
 public:
  /// `is_direct`: asks any server that keeps the stream, which costs it half as much.
  StretchReader(ReplyInbox& replies, const std::string& stream, std::string filter, bool is_direct,
                std::chrono::milliseconds wait);

  /// Reads the next messages. Returns them in order; none at the end of the stream.
  StreamResult<std::vector<StoredMessage>> next(std::uint64_t from, std::uint64_t to);

 private:
  [[nodiscard]] StreamResult<Stream::Found> message_from(natsMsg& reply) const;
  StreamResult<std::vector<Stream::Found>> ask_for(std::uint64_t from, std::size_t count);

  ReplyInbox& replies_;
  bool is_direct_;
  std::string subject_;
  std::string filter_;
  std::chrono::milliseconds wait_;
  std::size_t at_once_ = 1;
};

/// Reads the reply to a direct request: a message as it is, with its place in headers, or a status.
StreamResult<Stream::Found> direct_message_from(natsMsg& reply);

}  // namespace camway::nats
