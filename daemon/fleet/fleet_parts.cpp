// SPDX-License-Identifier: MIT
#include "daemon/fleet/fleet_parts.h"

#include <iterator>

namespace camway::fleet {
namespace {

/// Memory that a part takes beside its bytes. It counts, so that many empty parts are limited too.
constexpr std::size_t kPartOverhead = 128;

}  // namespace

std::optional<Bytes> PartJoiner::add(const Key& key, std::int32_t part, std::int32_t num_parts,
                                     Bytes bytes) {
  const auto known = by_key_.find(key);
  if (known == by_key_.end() && num_parts == 1) return bytes;
  if (known == by_key_.end()) {
    by_age_.push_back({key, num_parts, {}, 0});
    by_key_.emplace(key, std::prev(by_age_.end()));
  } else {
    if (known->second->num_parts != num_parts) return std::nullopt;
    by_age_.splice(by_age_.end(), by_age_, known->second);
  }
  const Position position = std::prev(by_age_.end());
  const std::size_t size = bytes.size() + kPartOverhead;
  if (!position->parts.try_emplace(part, std::move(bytes)).second) return std::nullopt;
  position->bytes += size;
  bytes_ += size;
  if (position->parts.size() == static_cast<std::size_t>(num_parts)) {
    Bytes whole;
    whole.reserve(position->bytes);
    for (const auto& [number, piece] : position->parts) {
      whole.insert(whole.end(), piece.begin(), piece.end());
    }
    drop(position);
    return whole;
  }
  // The last one is that of this part: it goes if it alone is too large.
  while (bytes_ > limits_.max_bytes || by_age_.size() > limits_.max_payloads) drop(by_age_.begin());
  return std::nullopt;
}

void PartJoiner::forget(const Key& key) {
  const auto known = by_key_.find(key);
  if (known != by_key_.end()) drop(known->second);
}

void PartJoiner::drop(Position position) {
  bytes_ -= position->bytes;
  by_key_.erase(position->key);
  by_age_.erase(position);
}

}  // namespace camway::fleet
