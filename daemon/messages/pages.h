// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

#include "lcmtypes/wire/pages.h"

namespace camway::service {

using Bytes = std::vector<std::uint8_t>;

using wire::count_pages;
using wire::encode_pages;

/// Puts pages together again, in whatever order and however often they come. Holds a bounded number
/// of bytes of half-received messages; where a new page does not fit, the message that waited
/// longest for a page is given up. For one thread at a time. `Message` is plan_request_t or
/// plan_response_t.
template <class Message>
class PageAssembly {
 public:
  using Clock = std::chrono::steady_clock;

  /// Pages are sent back to back: after so long a time without one, what is missing was lost.
  static constexpr std::chrono::milliseconds kGap{100};
  /// How often is asked for missing pages without one coming, each time after twice the wait.
  static constexpr int kMostAsked = 5;

  struct Limits {
    std::size_t max_messages = 16;                  ///< half received at a time
    std::size_t max_bytes = std::size_t{64} << 20;  ///< of their pages, as encoded
  };

  PageAssembly() : PageAssembly(Limits{}) {}
  explicit PageAssembly(const Limits& limits) : limits_(limits) {}

  /// What a page led to: the whole message (as page 0 of 1), an error text, or neither while pages
  /// are missing.
  struct Outcome {
    std::optional<Message> whole;
    std::string error;
    std::size_t given_up = 0;  ///< other messages, for want of room
  };

  /// A page that disagrees with those before in anything but page, utime, body and lists begins the
  /// message anew: its sender did. The body is that of page 0.
  Outcome add(Message page, Clock::time_point now = Clock::now());

  /// A message of which pages did not come.
  struct Gap {
    std::string client_id;
    std::int64_t request_id = 0;
    std::int32_t num_pages = 0;
    std::vector<std::int32_t> missing;
  };
  /// The messages that by `now` had no page for a while, each again and again, a few times.
  std::vector<Gap> take_gaps(Clock::time_point now);
  /// When there will be one; the end of time if no message waits for pages.
  [[nodiscard]] Clock::time_point next_gap() const;

  [[nodiscard]] std::size_t half_received() const { return partial_.size(); }

 private:
  struct Partial {
    Bytes header;  ///< what all pages agree on, encoded
    std::vector<std::optional<Message>> pages;
    std::size_t missing = 0;
    std::size_t bytes = 0;
    Clock::time_point gap_at{};  ///< when it counts as a gap that no page came
    int asked = 0;               ///< since the last page
  };
  using Position = typename std::list<Partial>::iterator;

  Position find_or_begin(const Message& page, Bytes header);
  void forget(Position position);
  /// Returns how many were given up.
  std::size_t make_room(Position keep);
  static Message join(Partial partial);

  Limits limits_;
  std::list<Partial> partial_;  ///< longest without a page first
  std::size_t bytes_ = 0;
};

extern template class PageAssembly<plan_request_t>;
extern template class PageAssembly<plan_response_t>;

}  // namespace camway::service
