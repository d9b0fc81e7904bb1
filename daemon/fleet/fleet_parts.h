// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "daemon/fleet/fleet_messages.h"
#include "daemon/nats/bus.h"
#include "lcmtypes/wire/check.h"

namespace camway::fleet {

/// Sends `payload` in as many messages as it takes, of at most `wire::kMaxFleetBytes` and what the
/// bus takes. `head` has all members but part, num_parts and payload. `Message` is fleet_job_t or
/// fleet_answer_t. Returns false if a message could not be sent, or if it takes more than
/// `wire::kMaxFleetParts`; some may have been sent then.
template <class Message>
bool publish_parts(nats::Bus& bus, const std::string& subject, Message head,
                   std::span<const std::uint8_t> payload) {
  head.payload.clear();
  head.num_bytes = 0;
  const auto frame = static_cast<std::size_t>(head.getEncodedSize());
  const std::size_t most = std::min(bus.most_bytes(), wire::kMaxFleetBytes);
  if (most <= frame) return false;
  const std::size_t of_a_part = most - frame;
  const std::size_t parts = std::max<std::size_t>(1, (payload.size() + of_a_part - 1) / of_a_part);
  if (parts > static_cast<std::size_t>(wire::kMaxFleetParts)) return false;
  head.num_parts = static_cast<std::int32_t>(parts);
  for (head.part = 0; head.part < head.num_parts; ++head.part) {
    const auto piece = payload.first(std::min(of_a_part, payload.size()));
    payload = payload.subspan(piece.size());
    head.payload.assign(piece.begin(), piece.end());
    head.num_bytes = static_cast<std::int32_t>(piece.size());
    if (!bus.publish(subject, wire::encode(head))) return false;
  }
  return true;
}

/// Joins the parts of jobs or answers, in whatever order and however often they arrive, those of
/// several mixed. Holds a bounded number of bytes; where a new part does not fit, drops the payload
/// that waited longest for a part.
/// Not thread-safe.
class PartJoiner {
 public:
  /// The sender, and its number of the job.
  using Key = std::pair<std::string, std::int64_t>;

  struct Limits {
    std::size_t max_bytes = kMaxPayloadBytes;  ///< of all parts together, with what keeps them
    std::size_t max_payloads = 1024;           ///< half received at a time
  };

  PartJoiner() : PartJoiner(Limits{}) {}
  explicit PartJoiner(const Limits& limits) : limits_(limits) {}

  /// Adds a part. Returns the whole payload if this was the last part that was missing; then it is
  /// forgotten, and further parts begin it anew. Refuses a part whose `num_parts` is not that of
  /// the parts before. Requires 0 <= part < num_parts.
  std::optional<Bytes> add(const Key& key, std::int32_t part, std::int32_t num_parts, Bytes bytes);
  /// Forgets the parts of a payload that is not wanted any more.
  void forget(const Key& key);

  [[nodiscard]] std::size_t half_received() const { return by_key_.size(); }
  /// Returns the bytes that count for the limit.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Partial {
    Key key;
    std::int32_t num_parts = 0;
    std::map<std::int32_t, Bytes> parts;
    std::size_t bytes = 0;
  };
  using Position = std::list<Partial>::iterator;

  void drop(Position position);

  const Limits limits_;
  std::list<Partial> by_age_;  ///< longest without a part first
  std::map<Key, Position> by_key_;
  std::size_t bytes_ = 0;
};

}  // namespace camway::fleet
