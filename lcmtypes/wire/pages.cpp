// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/pages.h"

#include <camway/members.h>

#include <utility>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"

namespace camway::wire {
namespace {

std::int32_t most_pages(const plan_request_t&) { return kMaxRequestPages; }
std::int32_t most_pages(const plan_response_t&) { return kMaxResponsePages; }

void clear_body(plan_request_t& request) { request.body = body_t{}; }
void clear_body(plan_response_t&) {}

/// Returns the bytes that later pages save by having no body.
std::size_t body_bytes(const plan_request_t& request) {
  return static_cast<std::size_t>(request.body._getEncodedSizeNoHash() -
                                  body_t{}._getEncodedSizeNoHash());
}
std::size_t body_bytes(const plan_response_t&) { return 0; }

std::size_t bytes_of(std::int32_t number) { return sizeof(number); }

template <class Element>
std::size_t bytes_of(const Element& element) {
  return static_cast<std::size_t>(element._getEncodedSizeNoHash());
}

template <class Message>
Message without_lists(Message message) {
  for_each_list<Message>([&](auto list, auto) { (message.*list).clear(); });
  set_counts(message);
  return message;
}

/// Returns the members that all pages of a message have in common.
template <class Message>
Message blank_page(const Message& message) {
  Message blank = without_lists(message);
  clear_body(blank);
  return blank;
}

/// Returns the members that all pages of a message have in common, encoded.
template <class Message>
Bytes page_head(const Message& page) {
  Message head = blank_page(page);
  head.page = 0;
  head.utime = 0;
  return encode(head);
}

/// Returns the size of a message without the elements of its lists.
template <class Message>
std::size_t header_bytes(const Message& whole) {
  auto bytes = static_cast<std::size_t>(whole.getEncodedSize());
  for_each_list<Message>([&](auto list, auto) {
    for (const auto& element : whole.*list) bytes -= bytes_of(element);
  });
  return bytes;
}

std::size_t room_beside(std::size_t bytes) {
  return bytes < kMaxMessageBytes ? kMaxMessageBytes - bytes : 0;
}

/// Distributes the elements over pages, each list from where it stopped on the page before: calls
/// `turn_page()` before each page but the first and `put(list, element)` in between.
template <class Message, class TurnPage, class Put>
void distribute(const Message& whole, const TurnPage& turn_page, const Put& put) {
  const std::size_t first_header = header_bytes(whole);
  const std::size_t later_room = room_beside(first_header - body_bytes(whole));
  std::size_t left = room_beside(first_header);
  for_each_list<Message>([&](auto list, auto) {
    for (const auto& element : whole.*list) {
      const std::size_t size = bytes_of(element);
      if (left < size) {
        turn_page();
        left = later_room;
      }
      put(list, element);
      left -= size;
    }
  });
}

}  // namespace

template <class Message>
std::vector<Bytes> encode_pages(const Message& whole) {
  const Message blank = blank_page(whole);
  std::vector<Message> pages{without_lists(whole)};
  distribute(
      whole, [&] { pages.push_back(blank); },
      [&](auto list, const auto& element) { (pages.back().*list).push_back(element); });
  std::vector<Bytes> encoded;
  encoded.reserve(pages.size());
  for (Message& page : pages) {
    set_counts(page);
    page.page = static_cast<std::int32_t>(encoded.size());
    page.num_pages = static_cast<std::int32_t>(pages.size());
    encoded.push_back(encode(page));
  }
  return encoded;
}

template <class Message>
std::size_t count_pages(const Message& whole) {
  std::size_t pages = 1;
  distribute(
      whole, [&] { ++pages; }, [](auto, const auto&) {});
  return pages;
}

template <class Message>
std::string page_fault(const Message& page) {
  const std::int32_t most = most_pages(page);
  if (page.num_pages < 1 || page.num_pages > most) {
    return "num_pages: " + std::to_string(page.num_pages) + " is not within 1 to " +
           std::to_string(most);
  }
  if (page.page < 0 || page.page >= page.num_pages) {
    return "page: " + std::to_string(page.page) + " is not within 0 to " +
           std::to_string(page.num_pages - 1);
  }
  return {};
}

template <class Message>
bool PageSet<Message>::add(Message page) {
  Bytes head = page_head(page);
  if (head != head_) *this = PageSet();
  head_ = std::move(head);
  const std::int32_t number = page.page;
  const auto bytes = static_cast<std::size_t>(page.getEncodedSize());
  const bool is_new = pages_.try_emplace(number, std::move(page)).second;
  if (is_new) bytes_ += bytes;
  return is_new;
}

template <class Message>
std::vector<std::int32_t> PageSet<Message>::missing() const {
  std::vector<std::int32_t> missing;
  for (std::int32_t page = 0; std::cmp_less(page, expected()); ++page) {
    if (!pages_.contains(page)) missing.push_back(page);
  }
  return missing;
}

template <class Message>
Message PageSet<Message>::whole() const {
  Message whole = without_lists(pages_.begin()->second);
  whole.num_pages = 1;
  for (const auto& [number, page] : pages_) {
    for_each_list<Message>([&whole, &from = page](auto list, auto) {
      (whole.*list).insert((whole.*list).end(), (from.*list).begin(), (from.*list).end());
    });
  }
  set_counts(whole);
  return whole;
}

template std::vector<Bytes> encode_pages(const plan_request_t&);
template std::vector<Bytes> encode_pages(const plan_response_t&);
template std::size_t count_pages(const plan_request_t&);
template std::size_t count_pages(const plan_response_t&);
template std::string page_fault(const plan_request_t&);
template std::string page_fault(const plan_response_t&);
template class PageSet<plan_request_t>;
template class PageSet<plan_response_t>;

}  // namespace camway::wire
