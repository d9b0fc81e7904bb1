// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

/// Messages that are sent in pages: `Message` is plan_request_t or plan_response_t. A page is a
/// message of its own, with a part of the lists; all else stands on every page, but for the body of
/// a request, which stands on page 0 alone. Daemon and client cut and join by this.
namespace camway::wire {

/// A message as it is encoded.
using Bytes = std::vector<std::uint8_t>;

/// Encodes `whole` as messages of at most `kMaxMessageBytes`: as many list elements on each page as
/// fit, in order; `page` and `num_pages` are set, `whole`'s own values do not matter. The same
/// message gives the same bytes. Requires counts that agree with their lists, a body within the
/// limits of `layout.h`, and less than 2 GB in all, since LCM counts bytes in an int.
template <class Message>
std::vector<Bytes> encode_pages(const Message& whole);

/// Returns the number of pages that `encode_pages` makes, without making or copying them, so that
/// an answer that is too long needs no memory. Same requirements.
template <class Message>
std::size_t count_pages(const Message& whole);

/// Returns why there is no such page, e.g. "page: 7 is not within 0 to 3"; empty if there is.
template <class Message>
std::string page_fault(const Message& page);

/// Returns the members that all pages of a message have in common, encoded: all but `page`,
/// `utime`, body and lists.
template <class Message>
Bytes page_head(const Message& page);

/// Returns page 0 without its lists, as page 0 of 1. `append_page` then adds the lists of each page
/// in order, page 0 included.
template <class Message>
Message begin_whole(const Message& page_0);
template <class Message>
void append_page(Message& whole, const Message& page);

}  // namespace camway::wire
