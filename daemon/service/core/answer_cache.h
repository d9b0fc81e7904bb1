// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>

#include <camway/plan_request_t.hpp>

#include "daemon/messages/answer_pages.h"

namespace camway::service {

/// Digest of a request's content: all but `utime` and how it was cut into pages. XXH3-128: it
/// guards clients against their own mistakes, not the daemon against forgery.
using RequestDigest = std::array<std::uint64_t, 2>;
RequestDigest digest_of(const plan_request_t& whole);

/// Remembers which requests are being planned, and the answers to as many of the others as its
/// limits allow, so that sending a request again is harmless and cheap. For one thread at a time.
class AnswerCache {
 public:
  struct Limits {
    std::size_t max_answers = 4096;
    std::size_t max_bytes = std::size_t{128} << 20;  ///< of encoded answers
  };

  enum class Known {
    kNew,       ///< never seen or forgotten; it counts as being planned from now on
    kRunning,   ///< is being planned
    kAnswered,  ///< `pages` is the answer
    kConflict,  ///< the same ids were used for another content
  };
  struct Found {
    Known known = Known::kNew;
    Pages pages;
    bool was_watched = false;
  };

  AnswerCache() : AnswerCache(Limits{}) {}
  explicit AnswerCache(const Limits& limits) : limits_(limits) {}

  Found find_or_begin(const RequestKey& key, const RequestDigest& digest);

  /// The answer under these ids, whatever was asked; null if there is none.
  [[nodiscard]] Pages find(const RequestKey& key);

  /// Keeps the answer to a request that was being planned; the answers that were longest not asked
  /// for make room.
  void finish(const RequestKey& key, Pages pages);

  /// Another answer in the place of one that is known or was forgotten; nothing if the request is
  /// being planned.
  void replace(const RequestKey& key, const RequestDigest& digest, Pages pages);

  /// The path of that answer is watched from now on.
  void mark_watched(const RequestKey& key);

  /// Forgets the answer, so that the request counts as new.
  void forget_answer(const RequestKey& key);

  /// Forgets a request that was not planned after all.
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
  std::list<RequestKey> by_age_;  ///< answered ones, longest not asked for first
  std::size_t bytes_ = 0;
};

}  // namespace camway::service
