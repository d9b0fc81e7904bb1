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

#include "daemon/messages/answer_pages.h"
#include "daemon/service/transport/transport.h"

namespace camway::service {

/// Answers on their way out, a few pages at a time: a receiver's socket buffer holds only about
/// three messages of full size with Debian's default of 212,992 bytes, so a long answer that is
/// sent at once is lost. Channels take turns, page by page, and so do the answers on a channel: a
/// long one holds up neither other clients nor the short ones behind it. For the loop thread.
class Outbox {
 public:
  /// Bytes that may be sent before the next pause: two messages of full size.
  static constexpr std::size_t kBurstBytes = 120'000;
  /// Messages likewise: each takes a place in the receiver's queue, of 30 by default.
  static constexpr int kBurstMessages = 16;
  /// How long the receiver is given to empty its buffer after a burst.
  static constexpr std::chrono::milliseconds kPause{2};

  /// Of answers that wait; the rest is refused, its clients ask again.
  struct Limits {
    std::size_t answers = 4096;
    std::size_t answers_of_a_channel = 1024;
    std::size_t bytes = std::size_t{256} << 20;
    /// Refusals among them, which cost who causes them nothing: they must not take the room of
    /// what was worked for.
    std::size_t refusals = 1024;
  };
  /// Whether something was done for it.
  enum class Kind : bool { kAnswer, kRefusal };

  explicit Outbox(Transport& transport) : Outbox(transport, Limits{}) {}
  Outbox(Transport& transport, const Limits& limits) : transport_(transport), limits_(limits) {}

  /// Queues an answer, or those of its pages that `which` lists, unless that is empty. False if
  /// there is no room, or if this very answer is still waiting to be sent.
  /// Precondition: `which` counts pages that there are.
  bool add(const std::string& channel, Pages pages, std::vector<std::size_t> which = {},
           Kind kind = Kind::kAnswer);

  /// Sends the next burst.
  void send_burst();

  [[nodiscard]] bool empty() const { return turns_.empty(); }

  /// Answers for which there was no room.
  [[nodiscard]] std::int64_t dropped() const { return dropped_; }

 private:
  struct Answer {
    Pages pages;
    std::vector<std::size_t> which;
    std::size_t bytes = 0;  ///< of all pages, which stay as long as one of them waits
    std::size_t next = 0;   ///< in `which`, or in `pages` if that is empty
    Kind kind = Kind::kAnswer;

    [[nodiscard]] const Bytes& page() const { return (*pages)[which.empty() ? next : which[next]]; }
    [[nodiscard]] bool sent() const {
      return next == (which.empty() ? pages->size() : which.size());
    }
  };
  using Channels = std::map<std::string, std::deque<Answer>>;

  /// Who was served goes to the back.
  void end_turn();

  Transport& transport_;
  const Limits limits_;
  Channels channels_;                         ///< those on which answers wait
  std::deque<Channels::iterator> turns_;      ///< the same, who is next first
  std::set<const std::vector<Bytes>*> here_;  ///< the pages of all answers that wait
  std::size_t bytes_ = 0;                     ///< likewise
  std::size_t refusals_ = 0;                  ///< that wait
  std::int64_t dropped_ = 0;
};

}  // namespace camway::service
