// SPDX-License-Identifier: MIT
#include "daemon/scene/log/nats/nats_reserve.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace camway::scene {
namespace {

/// A server compares its limit before it stores a message, so the message that reaches the limit
/// may go beyond it by the size of a part of a blob. All pieces together have room for that part
/// and for many removals.
constexpr std::uint64_t kMostPieceBytes = std::uint64_t{128} << 10U;
/// A small stream is not to be filled by its reserve: all pieces take a quarter of it.
constexpr std::uint64_t kStreamShare = 4 * NatsReserve::kPieces;

std::size_t bytes_of_piece(std::uint64_t most_bytes) {
  if (most_bytes == 0) return kMostPieceBytes;
  return static_cast<std::size_t>(std::min(kMostPieceBytes, most_bytes / kStreamShare));
}

}  // namespace

NatsReserve::NatsReserve(nats::Stream& stream, std::string prefix, std::uint64_t most_bytes)
    : stream_(stream), prefix_(std::move(prefix)), piece_bytes_(bytes_of_piece(most_bytes)) {}

std::string NatsReserve::subject(std::size_t piece) const {
  return prefix_ + "." + std::to_string(piece);
}

void NatsReserve::fill(PatienceEnd end) {
  const auto there = stream_.subjects(prefix_ + ".>", rest_of(end));
  if (!there) return;
  const std::vector<std::uint8_t> bytes(piece_bytes_);
  for (std::size_t piece = 0; piece < kPieces; ++piece) {
    if (there->contains(subject(piece))) continue;
    // Another process may put the same piece there.
    const auto done = stream_.publish(subject(piece), bytes, 0, rest_of(end));
    if (!done && done.fault != nats::StreamFault::kConflict) {
      is_incomplete_ = true;
      return;
    }
  }
  is_incomplete_ = false;
}

bool NatsReserve::release(std::size_t kept, PatienceEnd end) {
  const auto there = stream_.subjects(prefix_ + ".>", rest_of(end));
  if (!there) return false;
  std::size_t left = there->size();
  for (const auto& [subject, count] : *there) {
    if (left <= kept) return false;
    const auto purged =
        stream_.purge(subject, std::numeric_limits<std::uint64_t>::max(), rest_of(end));
    if (!purged) return false;
    --left;
    is_incomplete_ = true;
    // Another process may have just deleted it.
    if (*purged > 0) return true;
  }
  return false;
}

}  // namespace camway::scene
