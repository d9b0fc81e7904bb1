// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>

#include <camway/plan_request_t.hpp>

#include "daemon/service/transport/answer_pages.h"

namespace camway::service {

/// Digest of the content of a request, without `utime` and its division into pages. XXH3-128:
/// protects clients from their own mistakes, not the daemon from forgery.
using RequestDigest = std::array<std::uint64_t, 2>;
RequestDigest digest_of_bytes(const Bytes& bytes);
RequestDigest digest_of(const plan_request_t& whole);

/// Remembers which requests are being planned and, within its limits, the answers to earlier ones,
/// so that sending a request again is harmless and cheap.
/// Not thread-safe.
class AnswerCache {
 public:
  struct Limits {
    std::size_t max_answers = 4096;
    std::size_t max_bytes = std::size_t{128} << 20;  ///< size of the encoded answers
  };

  enum class Known {
    kNew,       ///< unknown or forgotten; counts as being planned from now on
    kRunning,   ///< being planned
    kAnswered,  ///< `pages` is the answer
    kConflict,  ///< the ids belong to a request with other content
  };
  struct Found {
    Known known = Known::kNew;
    Pages pages;
    bool was_watched = false;
  };

  AnswerCache() : AnswerCache(Limits{}) {}
  explicit AnswerCache(const Limits& limits) : limits_(limits) {}

  Found find_or_begin(const RequestKey& key, const RequestDigest& digest);

  /// Returns the answer to the request with these ids, whatever its content; null if there is none.
  [[nodiscard]] Pages find(const RequestKey& key);

  /// Keeps the answer to a request that was being planned. To make room, forgets the answers that
  /// were not asked for during the longest time.
  void finish(const RequestKey& key, Pages pages);

  /// Replaces the answer to a request, or adds it if it was forgotten; does nothing while the
  /// request is being planned.
  void replace(const RequestKey& key, const RequestDigest& digest, Pages pages);

  /// Records that the path of this answer is watched.
  void mark_watched(const RequestKey& key);

  /// Forgets the answer, so that the request counts as new.
  void forget_answer(const RequestKey& key);

  /// Forgets a request that was not planned in the end.
  void forget(const RequestKey& key);

  [[nodiscard]] std::size_t answers() const { return by_age_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Entry {
    RequestDigest digest{};
    Pages pages;  ///< null while it is being planned
    std::list<RequestKey>::iterator age;
    bool was_watched = false;
  };

  void make_room();

  Limits limits_;
  std::map<RequestKey, Entry> entries_;
  std::list<RequestKey> by_age_;  ///< answered requests, longest not asked for first
  std::size_t bytes_ = 0;
};

}  // namespace camway::service
