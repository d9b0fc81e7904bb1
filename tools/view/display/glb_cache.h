// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace camway::view {

/// The files of meshes that were asked for last, up to a number of bytes. Thread-safe.
class GlbCache {
 public:
  using Glb = std::shared_ptr<const std::string>;

  explicit GlbCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Returns the file of that key; null if it is not here.
  [[nodiscard]] Glb find(std::string_view key);
  /// Keeps a file, which is not null, and drops those that nobody has asked for the longest. One
  /// that is larger than the whole cache is not kept.
  void put(std::string key, Glb glb);

 private:
  struct Entry {
    std::string key;
    Glb glb;
  };

  const std::size_t most_bytes_;
  std::mutex mutex_;          ///< guards what is below
  std::list<Entry> entries_;  ///< the one asked for last first
  std::size_t bytes_ = 0;
};

}  // namespace camway::view
