// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "daemon/nats/stream.h"
#include "daemon/scene/log/nats/nats_blobs.h"

namespace camway::scene {

/// Messages in the stream of a log that hold room, whichever limit of JetStream is reached: that of
/// the stream, of the account or of the server. Where there is no room left, a piece is deleted so
/// that a message fits which will make room: a removal or a summary. Thread-safe.
class NatsReserve {
 public:
  /// `most_bytes`: of the stream; 0: as the server allows.
  NatsReserve(nats::Stream& stream, std::string prefix, std::uint64_t most_bytes);

  /// Puts back what is missing, as far as there is room.
  void fill(PatienceEnd end);
  /// Deletes a piece if there are more than `kept`. Returns whether it did.
  bool release(std::size_t kept, PatienceEnd end);
  /// Whether a piece was missing when it was last looked.
  [[nodiscard]] bool is_incomplete() const { return is_incomplete_; }

  static constexpr std::size_t kPieces = 16;
  /// Those for summaries and removals of scenes. The others are for small changes, too, such as the
  /// removal of an object.
  static constexpr std::size_t kLastPieces = 8;

 private:
  [[nodiscard]] std::string subject(std::size_t piece) const;

  nats::Stream& stream_;
  const std::string prefix_;
  const std::size_t piece_bytes_;
  std::atomic<bool> is_incomplete_ = true;
};

}  // namespace camway::scene
