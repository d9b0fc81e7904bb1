// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace camway::scene {

using Bytes = std::vector<std::byte>;

/// SHA-256 of the bytes of a blob.
using BlobId = std::array<std::byte, 32>;
BlobId blob_id_of(const Bytes& bytes);

/// A part of the content of a scene that is kept once, however many changes name it: the mesh or
/// the map of an object.
struct Blob {
  Bytes bytes;
  std::vector<BlobId> needs;  ///< blobs that are needed to read this one
};

/// A change of a scene in the log.
struct LogEntry {
  std::uint64_t before = 0;    ///< revision that the change was made on; 0 for a new scene
  std::uint64_t revision = 0;  ///< revision that it made [Limit: before < value]
  Bytes record;
  std::vector<BlobId> needs;  ///< blobs that the record names
};

/// A scene in the log: the last summary, and the entries after it in order of revision.
struct LoggedScene {
  std::string name;
  std::uint64_t summary_revision = 0;  ///< 0 if there is no summary
  Bytes summary;
  std::vector<LogEntry> entries;
};

/// The reason why an entry was not appended.
enum class AppendFault : std::uint8_t {
  kNone,
  kConflict,  ///< the newest revision is another than `before`
  kFull,      ///< the disk is full, or the log has reached its limit
  kBroken,    ///< the log cannot be written
};

struct AppendResult {
  AppendFault fault = AppendFault::kNone;
  std::string error;  ///< empty exactly without a fault
};

/// An ordered, durable log of the changes of scenes, from which any process rebuilds the same
/// scenes. What an entry and a summary mean is not known here (`change_record.h`).
///
/// A change is kept once `append` has returned without a fault, even if the process or the machine
/// fails right after. An append that fails, or during which the process ends, leaves all or
/// nothing. Thread-safe.
class SceneLog {
 public:
  virtual ~SceneLog() = default;

  /// Keeps a blob for entries that will name it. It is durable once an entry is that names it;
  /// until then the next `drop_unused_blobs` drops it. Requires that the blobs that it needs are
  /// there, and that `id` is that of its bytes.
  virtual AppendResult put_blob(const BlobId& id, const Blob& blob) = 0;
  [[nodiscard]] virtual bool has_blob(const BlobId& id) = 0;
  /// Fails if there is no such blob, or if its bytes are damaged.
  virtual base::Result<Bytes> blob(const BlobId& id) = 0;

  /// Appends an entry to a scene if its newest revision is `entry.before` (0 if there is no such
  /// scene). Requires that all blobs that it needs are there.
  virtual AppendResult append(std::string_view scene, const LogEntry& entry) = 0;
  /// Replaces all entries of a scene up to `revision` by a summary of them, which needs these
  /// blobs. Requires that a change made `revision`, and that no summary of a later one is there.
  virtual AppendResult summarize(std::string_view scene, std::uint64_t revision,
                                 const Bytes& summary, const std::vector<BlobId>& needs) = 0;
  /// Removes a scene if its newest revision is `revision`, and remembers the revision and the
  /// `request` for it (`ChangeNote::request`); empty: none.
  virtual AppendResult remove(std::string_view scene, std::uint64_t revision,
                              std::string_view request = {}) = 0;
  /// The highest revision of all scenes that were removed.
  [[nodiscard]] virtual std::uint64_t highest_removed() = 0;
  /// The requests of the last removals, some hundred (`removal_requests.h`).
  [[nodiscard]] virtual std::vector<std::string> removals() = 0;

  /// Returns a blob that the owner of the log still has, in other form; nothing if it has not.
  using LostBlob = std::function<std::optional<Blob>(const BlobId&)>;
  /// Lets the log ask for blobs that it has lost, from any thread. An empty function ends that:
  /// the one before does not run any more when this has returned.
  virtual void on_lost_blob(LostBlob find) { static_cast<void>(find); }

  /// Whether the log has lost blobs of a scene that the owner has not either, so that a summary
  /// which does not need them is of use.
  [[nodiscard]] virtual bool lacks_blobs_of(std::string_view scene) {
    static_cast<void>(scene);
    return false;
  }

  /// All scenes in order of name. Fails if anything in the log is damaged, with what is lost and
  /// how to go on: it is never read in part.
  virtual base::Result<std::vector<LoggedScene>> scenes() = 0;

  /// A text that is kept under a key; empty if there is none.
  [[nodiscard]] virtual std::string note(std::string_view key) = 0;
  virtual AppendResult set_note(std::string_view key, std::string_view text) = 0;
  /// All notes whose keys begin with `prefix`, by key, without empty ones. Fails if they cannot be
  /// read.
  virtual base::Result<std::map<std::string, std::string>> notes(std::string_view prefix) = 0;

  /// Waits until this process has taken in all that other processes had appended when this was
  /// called. Returns false if that takes longer than `patience`, or if no other process writes the
  /// log.
  virtual bool catch_up(std::chrono::milliseconds /*patience*/) { return false; }

  /// Drops the blobs that nothing needs, directly or through another blob.
  virtual AppendResult drop_unused_blobs() = 0;
};

}  // namespace camway::scene
