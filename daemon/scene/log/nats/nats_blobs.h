// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/nats/connection.h"
#include "daemon/nats/stream.h"
#include "daemon/scene/log/nats/log_message.h"
#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

/// When to give up.
using PatienceEnd = std::chrono::steady_clock::time_point;
/// The time until then, but no more than one request to a server may take; 0 if it is over.
std::chrono::milliseconds rest_of(PatienceEnd end);
/// Waits before a request is made again. Returns false if the time is over.
bool pause_before_retry(PatienceEnd end);

/// The blobs of a log, in a stream of their own.
///
/// A process that is about to name a blob holds it: if nothing is known to need it, its part 0 is
/// written again, unless that was done a moment ago. Another process drops a blob only if it has
/// seen for `grace` that nothing needs it, with the same part 0, so it drops none that is held. No
/// clocks are compared for that. Thread-safe.
class NatsBlobs {
 public:
  struct Options {
    std::string prefix;    ///< of the subjects
    bool is_alone = true;  ///< one server keeps them, so messages are in one order
    std::chrono::milliseconds grace;
    std::chrono::milliseconds recent_time;  ///< for which blobs are kept that were written
    std::function<void(const std::string&)> warn;
  };
  NatsBlobs(nats::Connection& connection, std::unique_ptr<nats::Stream> stream, Options options);

  /// Returns whether blobs are in the log because something needs them.
  using IsNeeded = std::function<bool(const BlobId&)>;

  /// Result of holding a blob.
  enum class Held : std::uint8_t { kHeld, kMissing, kUnreachable };
  struct HoldResult {
    Held held = Held::kUnreachable;
    AppendResult fault;  ///< set if it is unreachable
  };
  HoldResult hold(const BlobId& id, const IsNeeded& is_needed, PatienceEnd end);
  /// Writes a blob, and holds it.
  AppendResult put(const BlobId& id, const Blob& blob, PatienceEnd end);
  base::Result<Bytes> read(const BlobId& id, PatienceEnd end);

  /// Drops the blobs that are not in `roots`, and that no blob needs that is used.
  AppendResult drop_unused(const std::set<BlobId>& roots, PatienceEnd end);

  /// The blobs that are at the server, by their parts 0.
  nats::StreamResult<std::set<BlobId>> all(PatienceEnd end);
  /// Returns the blobs that a blob needs. Requires that it is there.
  nats::StreamResult<std::vector<BlobId>> needs_of(const BlobId& id, PatienceEnd end);
  /// Whether blobs are about to be dropped.
  [[nodiscard]] bool has_marks();

  /// Writes again the blobs of the last minutes that the server has lost. Returns why that failed.
  std::string repair(PatienceEnd end);

 private:
  using Clock = std::chrono::steady_clock;
  /// A blob that was written here, or whose part 0 was.
  struct Recent {
    BlobId id{};
    Clock::time_point when;
    Bytes head;
    std::shared_ptr<const Bytes> content;  ///< in parts; null if only part 0 was written

    [[nodiscard]] std::size_t bytes() const {
      return head.size() + (content ? content->size() : 0);
    }
  };
  struct Mark {
    std::uint64_t sequence = 0;  ///< of part 0
    Clock::time_point since;
  };
  using Published = nats::StreamResult<std::uint64_t>;

  [[nodiscard]] std::string subject(const BlobId& id, std::uint32_t part) const;
  [[nodiscard]] std::size_t part_bytes() const;
  [[nodiscard]] bool is_held(const BlobId& id);
  void set_held(const BlobId& id);
  void remember(Recent recent);
  void forget(const BlobId& id);
  Published publish(const BlobId& id, std::uint32_t part, std::span<const std::byte> bytes,
                    std::optional<std::uint64_t> expected, PatienceEnd end);
  Published write(const Recent& recent, PatienceEnd end);
  /// The last message of a subject; tries again until it gets an answer.
  nats::StreamResult<nats::Stream::Found> last(const std::string& subject, PatienceEnd end);
  nats::StreamResult<nats::Stream::Found> find_part(const BlobId& id, std::uint32_t part,
                                                    PatienceEnd end);
  base::Result<Bytes> read_parts(const BlobId& id, const BlobHead& head, PatienceEnd end);
  /// Adds a blob to those that are used, and what it needs. Returns why that is not known.
  std::string use(const BlobId& id, std::set<BlobId>& used, PatienceEnd end);
  AppendResult drop(const BlobId& id, std::uint32_t last_part, bool is_whole, PatienceEnd end);
  /// Whether the server has all parts but part 0.
  using Subjects = std::map<std::string, std::uint64_t>;
  [[nodiscard]] bool has_parts(const Recent& recent, const Subjects& there) const;
  void warn(const std::string& sentence) const;

  nats::Connection& connection_;
  const std::unique_ptr<nats::Stream> stream_;
  const Options options_;
  std::mutex mutex_;  ///< guards what follows
  std::map<BlobId, Clock::time_point> held_;
  std::deque<Recent> recent_;
  std::size_t recent_bytes_ = 0;
  bool has_warned_ = false;
  std::map<BlobId, std::vector<BlobId>> needs_;
  std::mutex drop_mutex_;  ///< held while blobs are dropped; guards marks_
  std::map<BlobId, Mark> marks_;
};

/// The result of a call that a stream did not answer as it should.
AppendResult append_fault(nats::StreamFault fault, const std::string& error);

}  // namespace camway::scene
