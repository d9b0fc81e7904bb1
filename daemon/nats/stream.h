// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/nats/connection.h"

namespace camway::nats {

/// The reason why a stream did not do what it was asked for.
enum class StreamFault : std::uint8_t {
  kNone,
  kConflict,     ///< the last message of the subject is another one than was expected
  kFull,         ///< the stream or the disk of the server has no room
  kStalled,      ///< as `kUnreachable`, and for long: the server answers, but a stream does not
  kUnreachable,  ///< no answer: what was asked for may have been done, or may still be
  kRefused,      ///< the server says no
};

/// Answer of a stream: a value, or a fault with its reason.
template <class T>
struct [[nodiscard]] StreamResult {
  std::optional<T> value;
  StreamFault fault = StreamFault::kNone;
  std::string error;  ///< empty exactly without a fault

  StreamResult(T result) : value(std::move(result)) {}
  StreamResult(StreamFault why, std::string text) : fault(why), error(std::move(text)) {}

  /// Returns whether there is a value.
  explicit operator bool() const { return value.has_value(); }
  [[nodiscard]] const T& operator*() const& { return *value; }
  [[nodiscard]] T&& operator*() && { return *std::move(value); }
  [[nodiscard]] const T* operator->() const { return &*value; }
};

/// A message in a stream.
struct StoredMessage {
  std::string subject;
  std::uint64_t sequence = 0;  ///< in the stream, from 1
  std::vector<std::uint8_t> payload;
};

struct StreamState {
  std::uint64_t last_sequence = 0;  ///< also of a message that is not there any more; 0: none yet
  std::uint64_t bytes = 0;
};

/// How a stream is made. It keeps all messages in files, and refuses new ones when it is full.
struct StreamConfig {
  std::string name;
  std::string subject;  ///< of its messages; may end in the wildcard `>`
  int replicas = 1;
  std::uint64_t most_bytes = 0;    ///< 0: as the server allows, or as an existing stream has it
  bool one_for_a_subject = false;  ///< a new message takes the place of the one before
  /// The server sends an empty message to `news` + "." + the end of the subject once a message is
  /// stored. Empty: it does not.
  std::string news;
};

class ReplyInbox;

/// A stream of JetStream: messages that servers keep. It is asked without consumers, because those
/// of the server 2.9 skip messages of all subjects when one subject is purged. Thread-safe.
class Stream {
 public:
  using Wait = std::chrono::milliseconds;

  /// Makes the stream, or uses one that is there: sets its replicas and limit if they differ, and
  /// fails if it keeps its messages in another way. Fails if the server has no JetStream.
  static base::Result<std::unique_ptr<Stream>> ensure(Connection& connection,
                                                      const StreamConfig& config, Wait wait);

  /// Makes the stream again if the server has lost it. Returns why that failed; empty otherwise.
  std::string ensure_again(Wait wait);

  /// Appends a message, and returns its sequence. `expected`: the sequence of the last message of
  /// the subject, 0 for none; without it, nothing is expected. With replicas, a message may be
  /// appended although another one came sooner: if 0 is expected, or if both came at once.
  StreamResult<std::uint64_t> publish(const std::string& subject,
                                      std::span<const std::uint8_t> payload,
                                      std::optional<std::uint64_t> expected, Wait wait);

  using Found = std::optional<StoredMessage>;
  /// The last message of a subject, as the leader of the stream has it.
  StreamResult<Found> last(const std::string& subject, Wait wait);
  /// The same as any server has it: faster for large messages, and may be out of date.
  StreamResult<Found> last_of_any_server(const std::string& subject, Wait wait);

  /// Calls the handler in order for the messages from one sequence to another that a filter
  /// matches. Those that are deleted meanwhile may come or not. Returns the sequence up to which it
  /// has read: `to`, or that of the last message of the stream.
  using Handler = std::function<void(StoredMessage message)>;
  StreamResult<std::uint64_t> read(std::uint64_t from, std::uint64_t to, const std::string& filter,
                                   const Handler& handler, Wait wait);

  /// Deletes the messages that a filter matches, up to a sequence, which is not included, one after
  /// the other: the server 2.9 does not take those off what it counts against its limits that it
  /// purges by a filter. If this fails, some may be deleted. Returns how many it deleted.
  StreamResult<std::uint64_t> purge(const std::string& filter, std::uint64_t before, Wait wait);
  /// Deletes a message. Returns whether it was there.
  StreamResult<bool> remove(std::uint64_t sequence, Wait wait);
  StreamResult<StreamState> state(Wait wait);
  /// The subjects that a filter matches, with the number of messages of each.
  StreamResult<std::map<std::string, std::uint64_t>> subjects(const std::string& filter, Wait wait);

 private:
  Stream(Connection& connection, StreamConfig config)
      : connection_(connection), config_(std::move(config)), name_(config_.name) {}

  /// Subscriptions are dear, so reads use them again.
  std::shared_ptr<ReplyInbox> take_inbox();
  void give_back(const std::shared_ptr<ReplyInbox>& inbox);

  Connection& connection_;
  const StreamConfig config_;
  const std::string& name_;
  std::mutex mutex_;  ///< guards inboxes_
  std::vector<std::shared_ptr<ReplyInbox>> inboxes_;
};

}  // namespace camway::nats
