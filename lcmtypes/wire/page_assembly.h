// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include <camway/missing_pages_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

#include "lcmtypes/wire/pages.h"

namespace camway::wire {

/// Joins pages to messages, in whatever order and however often they arrive. Holds a bounded number
/// of bytes of incomplete messages; where a new page does not fit, drops the message that waited
/// longest for a page. `Message` is plan_request_t or plan_response_t.
/// Not thread-safe.
template <class Message>
class PageAssembly {
 public:
  using Clock = std::chrono::steady_clock;

  /// Pages are sent back to back: when none arrived for this long, the missing ones are lost.
  static constexpr std::chrono::milliseconds kPageWait{100};
  /// How often missing pages are asked for while none arrives, each time after twice the wait.
  static constexpr int kMostAsked = 5;

  struct Limits {
    std::size_t max_messages = 16;                  ///< incomplete messages at a time
    std::size_t max_bytes = std::size_t{64} << 20;  ///< size of their pages, as encoded
  };

  PageAssembly() : PageAssembly(Limits{}) {}
  explicit PageAssembly(const Limits& limits) : limits_(limits) {}

  /// Result of adding a page: the whole message (as page 0 of 1), an error, or neither while pages
  /// are missing.
  struct Outcome {
    std::optional<Message> whole;
    std::string error;
    std::size_t given_up = 0;  ///< number of other messages that were dropped for want of room
  };

  /// Adds a page. A page that differs from those before in anything but page, utime, body and lists
  /// starts the message anew, as its sender did. The body is that of page 0.
  Outcome add(Message page, Clock::time_point now = Clock::now());

  /// Returns requests for the missing pages of messages for which no page arrived for a while by
  /// `now`: for each message up to `kMostAsked` times, with growing pauses. The caller sets
  /// `utime`.
  std::vector<missing_pages_t> take_missing(Clock::time_point now);
  /// Returns the time of the next such message; the end of time if no message waits for pages.
  [[nodiscard]] Clock::time_point next_missing() const;

  [[nodiscard]] std::size_t half_received() const { return partial_.size(); }

 private:
  struct Partial {
    PageSet<Message> pages;          ///< at least one
    Clock::time_point missing_at{};  ///< time at which pages count as missing
    int asked = 0;                   ///< how often they were asked for since the last page
  };
  using Position = typename std::list<Partial>::iterator;

  /// Returns how many messages were dropped.
  std::size_t make_room(Position keep);

  Limits limits_;
  std::list<Partial> partial_;  ///< longest without a page first
};

extern template class PageAssembly<plan_request_t>;
extern template class PageAssembly<plan_response_t>;

}  // namespace camway::wire
