// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"
#include "daemon/scene/snapshot/scene_object.h"

namespace camway::scene {

/// The contents of objects as blobs of a log. An occupancy map after a scan is kept as the
/// difference from the map before, so that a scan costs what it changes.
/// Thread-safe.
class SourceBlobs {
 public:
  /// Refers to `log`, which must outlive it.
  explicit SourceBlobs(SceneLog& log) : log_(log) {}

  /// Sets `id` to the blob of a content, which it puts into the log if it is not there. `before`:
  /// the content that this one takes the place of; may be null.
  AppendResult keep(const std::shared_ptr<const ObjectSource>& source,
                    const std::shared_ptr<const ObjectSource>& before, BlobId& id);

  /// Contents that were read, so that objects with the same content share it.
  using Read = std::map<BlobId, std::shared_ptr<const ObjectSource>>;
  /// Returns the content of a blob, built with `options`, with which all in `read` were built.
  base::Result<std::shared_ptr<const ObjectSource>> read(const BlobId& id,
                                                         const ObjectOptions& options, Read& read);

  /// Reads the whole records among these blobs into `read`, on all processors. Leaves out
  /// differences, and what cannot be read: `read` then says why.
  void read_whole(std::span<const BlobId> ids, const ObjectOptions& options, Read& read);

  /// Adds a content to `read` if its blob is known.
  void add_known(const std::shared_ptr<const ObjectSource>& source, Read& read);

  /// Makes the blob of a content that somebody still holds, and whose blob was kept or read here.
  /// Nothing if there is none, or if it was kept as a difference from one that is gone.
  [[nodiscard]] std::optional<Blob> blob_again(const BlobId& id);

  /// Forgets the contents that no scene holds any more.
  void forget_unused();

 private:
  struct Known {
    std::weak_ptr<const ObjectSource> source;
    BlobId id{};
    int differences = 0;                       ///< between this and a whole record
    std::weak_ptr<const ObjectSource> before;  ///< that the last of them is from; else null
  };

  [[nodiscard]] std::optional<Known> find(const std::shared_ptr<const ObjectSource>& source);
  void remember(const std::shared_ptr<const ObjectSource>& source, Known known);
  AppendResult put(const std::shared_ptr<const ObjectSource>& source, const Blob& blob, Known known,
                   BlobId& id);
  /// Returns the difference between two maps as a blob; nothing if a whole record is better.
  std::optional<Blob> difference(const ObjectSource& source, const ObjectSource& before,
                                 const Known& base);

  SceneLog& log_;
  std::mutex mutex_;  ///< guards known_
  std::map<const ObjectSource*, Known> known_;
};

}  // namespace camway::scene
