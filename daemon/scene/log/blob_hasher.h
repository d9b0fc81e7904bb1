// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

/// Computes `blob_id_of` of bytes that come in parts, and never are in memory together.
/// Not thread-safe.
class BlobHasher {
 public:
  BlobHasher();
  ~BlobHasher();
  BlobHasher(const BlobHasher&) = delete;
  BlobHasher& operator=(const BlobHasher&) = delete;

  void add(std::span<const std::byte> part);
  /// Returns the id of all parts. To be called once, as the last.
  [[nodiscard]] BlobId finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace camway::scene
