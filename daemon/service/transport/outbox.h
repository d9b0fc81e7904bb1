// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemon/service/transport/answer_pages.h"
#include "daemon/service/transport/transport.h"

namespace camway::service {

/// Queue of answers, which sends a few pages at a time. With Debian's default of 212,992 bytes, the
/// socket buffer of a receiver holds only about three messages of full size, so a long answer that
/// is sent at once is lost. Channels take turns, page by page, and so do the answers on one
/// channel. So a long answer delays neither other clients nor the short answers behind it. Not
/// thread-safe: for the loop thread.
class Outbox {
 public:
  /// Bytes that may be sent before the next pause: two messages of full size.
  static constexpr std::size_t kBurstBytes = 120'000;
  /// Messages that may be sent before the next pause: the receiver's queue holds 30 by default.
  static constexpr int kBurstMessages = 16;
  /// Time that the receiver has to empty its buffer after a burst.
  static constexpr std::chrono::milliseconds kPause{2};

  /// Limits of the answers that wait. Further ones are dropped, and their clients ask again.
  struct Limits {
    std::size_t answers = 4096;
    std::size_t answers_of_a_channel = 1024;
    std::size_t bytes = std::size_t{256} << 20;
    /// Limit of the refusals among them. These cost their clients nothing, so they must not take
    /// the room of answers that took work.
    std::size_t refusals = 1024;
  };
  /// Whether the answer took work, or refuses it.
  enum class Kind : bool { kAnswer, kRefusal };

  explicit Outbox(Transport& transport) : Outbox(transport, Limits{}) {}
  Outbox(Transport& transport, const Limits& limits) : transport_(transport), limits_(limits) {}

  /// Queues an answer. If `which` is not empty, queues only the pages that it lists. Returns false
  /// if there is no room, or if this very answer is still waiting. Requires valid indices in
  /// `which`.
  bool add(const std::string& channel, Pages pages, std::vector<std::size_t> which = {},
           Kind kind = Kind::kAnswer);

  /// Sends the next burst.
  void send_burst();

  [[nodiscard]] bool empty() const { return turns_.empty(); }

  /// Returns the number of answers for which there was no room.
  [[nodiscard]] std::int64_t dropped() const { return dropped_; }

 private:
  struct Answer {
    Pages pages;
    std::vector<std::size_t> which;
    std::size_t bytes = 0;  ///< size of all pages, which stay as long as one of them waits
    std::size_t next = 0;   ///< index into `which`, or into `pages` if `which` is empty
    Kind kind = Kind::kAnswer;

    [[nodiscard]] const Bytes& page() const { return (*pages)[which.empty() ? next : which[next]]; }
    [[nodiscard]] bool sent() const {
      return next == (which.empty() ? pages->size() : which.size());
    }
  };
  using Channels = std::map<std::string, std::deque<Answer>>;

  /// Moves the channel that was served to the back.
  void end_turn();

  Transport& transport_;
  const Limits limits_;
  Channels channels_;                         ///< channels with waiting answers
  std::deque<Channels::iterator> turns_;      ///< all of `channels_`, the next one to serve first
  std::set<const std::vector<Bytes>*> here_;  ///< the pages of all waiting answers
  std::size_t bytes_ = 0;                     ///< size of all waiting answers
  std::size_t refusals_ = 0;                  ///< number of waiting refusals
  std::int64_t dropped_ = 0;
};

}  // namespace camway::service
