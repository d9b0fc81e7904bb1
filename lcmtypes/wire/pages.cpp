// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/pages.h"

#include <camway/members.h>

#include <type_traits>
#include <utility>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"

namespace camway::wire {
namespace {

std::int32_t most_pages(const plan_request_t&) { return kMaxRequestPages; }
std::int32_t most_pages(const plan_response_t&) { return kMaxResponsePages; }

/// Calls `visit(list_of)` for each list that is cut into pages; `list_of(message)` is the list.
/// Those of the body come first.
template <class Message, class Visit>
void for_each_paged_list(const Visit& visit) {
  if constexpr (std::is_same_v<Message, plan_request_t>) {
    for_each_list<body_t>([&](auto list, auto) {
      visit([list](auto& message) -> auto& { return message.body.*list; });
    });
  }
  for_each_list<Message>(
      [&](auto list, auto) { visit([list](auto& message) -> auto& { return message.*list; }); });
}

void set_all_counts(plan_request_t& request) {
  set_counts(request.body);
  set_counts(request);
}
void set_all_counts(plan_response_t& response) { set_counts(response); }

void clear_body(plan_request_t& request) { request.body = body_t{}; }
void clear_body(plan_response_t&) {}

std::size_t bytes_of(std::int32_t number) { return sizeof(number); }

template <class Number>
std::size_t bytes_of(const std::vector<Number>& numbers) {
  return numbers.size() * sizeof(Number);
}

template <class Element>
std::size_t bytes_of(const Element& element) {
  return static_cast<std::size_t>(element._getEncodedSizeNoHash());
}

template <class Message>
Message without_lists(Message message) {
  for_each_paged_list<Message>([&](const auto& list_of) { list_of(message).clear(); });
  set_all_counts(message);
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

/// Returns the size of a page without the elements of its lists. All pages have the same: an empty
/// body is as long as any without its lists.
template <class Message>
std::size_t header_bytes(const Message& whole) {
  auto bytes = static_cast<std::size_t>(whole.getEncodedSize());
  for_each_paged_list<Message>([&](const auto& list_of) {
    for (const auto& element : list_of(whole)) bytes -= bytes_of(element);
  });
  return bytes;
}

std::size_t room_beside(std::size_t bytes) {
  return bytes < kMaxMessageBytes ? kMaxMessageBytes - bytes : 0;
}

/// Distributes the elements over pages, each list from where it stopped on the page before: calls
/// `turn_page()` before each page but the first and `put(list_of, element)` in between.
template <class Message, class TurnPage, class Put>
void distribute(const Message& whole, const TurnPage& turn_page, const Put& put) {
  const std::size_t room = room_beside(header_bytes(whole));
  std::size_t left = room;
  for_each_paged_list<Message>([&](const auto& list_of) {
    for (const auto& element : list_of(whole)) {
      const std::size_t size = bytes_of(element);
      if (left < size) {
        turn_page();
        left = room;
      }
      put(list_of, element);
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
      [&](const auto& list_of, const auto& element) { list_of(pages.back()).push_back(element); });
  std::vector<Bytes> encoded;
  encoded.reserve(pages.size());
  for (Message& page : pages) {
    set_all_counts(page);
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
      whole, [&] { ++pages; }, [](const auto&, const auto&) {});
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
    for_each_paged_list<Message>([&whole, &from = page](const auto& list_of) {
      auto& into = list_of(whole);
      into.insert(into.end(), list_of(from).begin(), list_of(from).end());
    });
  }
  set_all_counts(whole);
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
