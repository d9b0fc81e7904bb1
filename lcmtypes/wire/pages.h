// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

/// Messages that are sent in pages: `Message` is plan_request_t or plan_response_t. A page is a
/// message of its own, with a part of the lists, those of a request's body included. All else stands
/// on every page, but for the numbers of the body, which stand on page 0 alone. Daemon and client
/// cut and join by this.
namespace camway::wire {

/// A message as it is encoded.
using Bytes = std::vector<std::uint8_t>;

/// Encodes `whole` as messages of at most `kMaxMessageBytes`: as many list elements on each page as
/// fit, in order; `page` and `num_pages` are set, `whole`'s own values do not matter. The same
/// message gives the same bytes. Requires counts that agree with their lists, and less than 2 GB in
/// all, since LCM counts bytes in an int.
template <class Message>
std::vector<Bytes> encode_pages(const Message& whole);

/// Returns the number of pages that `encode_pages` makes, without making or copying them, so that
/// an answer that is too long needs no memory. Same requirements.
template <class Message>
std::size_t count_pages(const Message& whole);

/// Returns why there is no such page, e.g. "page: 7 is not within 0 to 3"; empty if there is.
template <class Message>
std::string page_fault(const Message& page);

/// Collects the pages of one message, which may come in any order and repeatedly. `utime` is no
/// part of what makes a message the same.
/// Not thread-safe.
template <class Message>
class PageSet {
 public:
  /// Adds a page; returns whether it is new. A page that differs from those that are here in more
  /// than `page`, `utime`, body and lists is of another message, so it replaces them all. Requires
  /// a page without `page_fault`.
  bool add(Message page);

  /// Returns the number of pages that are here.
  [[nodiscard]] std::size_t held() const { return pages_.size(); }
  /// Returns the size of these pages, as encoded.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  /// Returns the number of pages of the whole message; 0 before the first page.
  [[nodiscard]] std::size_t expected() const {
    return pages_.empty() ? 0 : static_cast<std::size_t>(any().num_pages);
  }
  [[nodiscard]] bool complete() const { return held() > 0 && held() == expected(); }
  /// Returns the numbers of the missing pages, increasing.
  [[nodiscard]] std::vector<std::int32_t> missing() const;
  /// Returns one of the pages. Requires at least one.
  [[nodiscard]] const Message& any() const { return pages_.begin()->second; }

  /// Returns the whole message as page 0 of 1. All but the lists is that of page 0. Requires
  /// `complete()`.
  [[nodiscard]] Message whole() const;

 private:
  Bytes head_;  ///< encoded members that are equal on all pages
  std::map<std::int32_t, Message> pages_;
  std::size_t bytes_ = 0;
};

extern template class PageSet<plan_request_t>;
extern template class PageSet<plan_response_t>;

}  // namespace camway::wire
