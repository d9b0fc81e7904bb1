// SPDX-License-Identifier: MIT
#include "daemon/messages/pages.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "lcmtypes/wire/check.h"

namespace camway::service {
namespace {

/// The lists of a message that are spread over its pages, in wire order, each with its count.
template <class Message>
struct Lists;
template <>
struct Lists<plan_request_t> {
  static constexpr auto kMembers =
      std::make_tuple(std::pair{&plan_request_t::keyframes, &plan_request_t::num_keyframes});
  static constexpr std::int32_t kMaxPages = wire::kMaxRequestPages;
};
template <>
struct Lists<plan_response_t> {
  static constexpr auto kMembers = std::make_tuple(
      std::pair{&plan_response_t::segments, &plan_response_t::num_segments},
      std::pair{&plan_response_t::keyframes, &plan_response_t::num_keyframes},
      std::pair{&plan_response_t::collisions, &plan_response_t::num_collisions},
      std::pair{&plan_response_t::remaining, &plan_response_t::num_remaining},
      std::pair{&plan_response_t::corrections, &plan_response_t::num_corrections},
      std::pair{&plan_response_t::slowed, &plan_response_t::num_slowed},
      std::pair{&plan_response_t::keyframe_faults, &plan_response_t::num_keyframe_faults},
      std::pair{&plan_response_t::proof_triangles, &plan_response_t::num_proof_triangles});
  static constexpr std::int32_t kMaxPages = wire::kMaxResponsePages;
};

/// Calls `visit(pointer to the list, pointer to its count)` for each.
template <class Message, class Visit>
void for_each_list(const Visit& visit) {
  std::apply([&](const auto&... member) { (visit(member.first, member.second), ...); },
             Lists<Message>::kMembers);
}

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
  for_each_list<Message>([&](auto list, auto count) {
    (message.*list).clear();
    message.*count = 0;
  });
  return message;
}

/// Returns the members that all pages of a message have in common.
template <class Message>
Message blank_page(const Message& message) {
  Message blank = without_lists(message);
  clear_body(blank);
  return blank;
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
  return bytes < wire::kMaxMessageBytes ? wire::kMaxMessageBytes - bytes : 0;
}

template <class Message>
void append_lists(Message& whole, const Message& page) {
  for_each_list<Message>([&](auto list, auto count) {
    (whole.*list).insert((whole.*list).end(), (page.*list).begin(), (page.*list).end());
    whole.*count = static_cast<std::int32_t>((whole.*list).size());
  });
}

/// Distributes the elements over pages, each list from where it stopped on the page before: calls
/// `turn_page()` before each page but the first and `put(list, count, element)` in between.
template <class Message, class TurnPage, class Put>
void deal(const Message& whole, const TurnPage& turn_page, const Put& put) {
  const std::size_t first_header = header_bytes(whole);
  const std::size_t later_room = room_beside(first_header - body_bytes(whole));
  std::size_t left = room_beside(first_header);
  for_each_list<Message>([&](auto list, auto count) {
    for (const auto& element : whole.*list) {
      const std::size_t size = bytes_of(element);
      if (left < size) {
        turn_page();
        left = later_room;
      }
      put(list, count, element);
      left -= size;
    }
  });
}

template <class Message>
std::vector<Message> split(const Message& whole) {
  const Message blank = blank_page(whole);
  std::vector<Message> pages{without_lists(whole)};
  deal(
      whole, [&] { pages.push_back(blank); },
      [&](auto list, auto count, const auto& element) {
        (pages.back().*list).push_back(element);
        ++(pages.back().*count);
      });
  return pages;
}

template <class Message>
std::vector<Bytes> encode_pages_of(const Message& whole) {
  std::vector<Message> pages = split(whole);
  std::vector<Bytes> encoded;
  encoded.reserve(pages.size());
  for (Message& page : pages) {
    page.page = static_cast<std::int32_t>(encoded.size());
    page.num_pages = static_cast<std::int32_t>(pages.size());
    encoded.push_back(wire::encode(page));
  }
  return encoded;
}

template <class Message>
Bytes header_of(const Message& page) {
  Message header = blank_page(page);
  header.page = 0;
  header.utime = 0;
  return wire::encode(header);
}

template <class Message>
std::string page_fault(const Message& page) {
  if (page.num_pages < 1 || page.num_pages > Lists<Message>::kMaxPages) {
    return "num_pages: " + std::to_string(page.num_pages) + " is not within 1 to " +
           std::to_string(Lists<Message>::kMaxPages);
  }
  if (page.page < 0 || page.page >= page.num_pages) {
    return "page: " + std::to_string(page.page) + " is not within 0 to " +
           std::to_string(page.num_pages - 1);
  }
  return {};
}

}  // namespace

std::vector<Bytes> encode_pages(const plan_request_t& whole) { return encode_pages_of(whole); }
std::vector<Bytes> encode_pages(const plan_response_t& whole) { return encode_pages_of(whole); }

std::size_t count_pages(const plan_response_t& whole) {
  std::size_t pages = 1;
  deal(
      whole, [&] { ++pages; }, [](auto, auto, const auto&) {});
  return pages;
}

template <class Message>
typename PageAssembly<Message>::Outcome PageAssembly<Message>::add(Message page,
                                                                   Clock::time_point now) {
  if (std::string fault = page_fault(page); !fault.empty()) return {std::nullopt, fault, 0};
  if (page.num_pages == 1) return {std::move(page), {}, 0};

  const Position position = find_or_begin(page, header_of(page));
  std::optional<Message>& place = position->pages[static_cast<std::size_t>(page.page)];
  if (!place) {
    const auto size = static_cast<std::size_t>(page.getEncodedSize());
    position->bytes += size;
    bytes_ += size;
    --position->missing;
    place = std::move(page);
  }
  position->gap_at = now + kGap;
  position->asked = 0;
  if (position->missing == 0) {
    Partial complete = std::move(*position);
    bytes_ -= complete.bytes;
    partial_.erase(position);
    return {join(std::move(complete)), {}, 0};
  }
  return {std::nullopt, {}, make_room(position)};
}

template <class Message>
typename PageAssembly<Message>::Position PageAssembly<Message>::find_or_begin(const Message& page,
                                                                              Bytes header) {
  const auto same_ids = [&](const Partial& partial) {
    const auto held = std::find_if(partial.pages.begin(), partial.pages.end(),
                                   [](const std::optional<Message>& p) { return p.has_value(); });
    return held != partial.pages.end() && (*held)->request_id == page.request_id &&
           (*held)->client_id == page.client_id;
  };
  const Position found = std::find_if(partial_.begin(), partial_.end(), same_ids);
  if (found != partial_.end()) {
    if (found->header == header) {
      partial_.splice(partial_.end(), partial_, found);
      return found;
    }
    forget(found);
  }
  const auto num_pages = static_cast<std::size_t>(page.num_pages);
  partial_.push_back(
      {std::move(header), std::vector<std::optional<Message>>(num_pages), num_pages, 0, {}, 0});
  return std::prev(partial_.end());
}

template <class Message>
std::vector<typename PageAssembly<Message>::Gap> PageAssembly<Message>::take_gaps(
    Clock::time_point now) {
  std::vector<Gap> gaps;
  for (Partial& partial : partial_) {
    if (partial.gap_at > now) continue;
    ++partial.asked;
    partial.gap_at =
        partial.asked < kMostAsked ? now + kGap * (1 << partial.asked) : Clock::time_point::max();
    Gap gap;
    for (std::size_t i = 0; i < partial.pages.size(); ++i) {
      if (!partial.pages[i]) {
        gap.missing.push_back(static_cast<std::int32_t>(i));
        continue;
      }
      gap.client_id = partial.pages[i]->client_id;
      gap.request_id = partial.pages[i]->request_id;
    }
    gap.num_pages = static_cast<std::int32_t>(partial.pages.size());
    gaps.push_back(std::move(gap));
  }
  return gaps;
}

template <class Message>
typename PageAssembly<Message>::Clock::time_point PageAssembly<Message>::next_gap() const {
  Clock::time_point next = Clock::time_point::max();
  for (const Partial& partial : partial_) next = std::min(next, partial.gap_at);
  return next;
}

template <class Message>
void PageAssembly<Message>::forget(Position position) {
  bytes_ -= position->bytes;
  partial_.erase(position);
}

template <class Message>
std::size_t PageAssembly<Message>::make_room(Position keep) {
  std::size_t given_up = 0;
  while ((partial_.size() > limits_.max_messages || bytes_ > limits_.max_bytes) &&
         partial_.begin() != keep) {
    forget(partial_.begin());
    ++given_up;
  }
  return given_up;
}

template <class Message>
Message PageAssembly<Message>::join(Partial partial) {
  Message whole = without_lists(*partial.pages.front());
  for (const std::optional<Message>& page : partial.pages) append_lists(whole, *page);
  whole.page = 0;
  whole.num_pages = 1;
  return whole;
}

template class PageAssembly<plan_request_t>;
template class PageAssembly<plan_response_t>;

}  // namespace camway::service
