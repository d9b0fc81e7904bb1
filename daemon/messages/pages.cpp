// SPDX-License-Identifier: MIT
#include "daemon/messages/pages.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace camway::messages {

template <class Message>
typename PageAssembly<Message>::Outcome PageAssembly<Message>::add(Message page,
                                                                   Clock::time_point now) {
  if (std::string fault = wire::page_fault(page); !fault.empty()) return {std::nullopt, fault, 0};
  if (page.num_pages == 1) return {std::move(page), {}, 0};

  const Position position = find_or_begin(page, wire::page_head(page));
  std::optional<Message>& place = position->pages[static_cast<std::size_t>(page.page)];
  if (!place) {
    const auto size = static_cast<std::size_t>(page.getEncodedSize());
    position->bytes += size;
    bytes_ += size;
    --position->missing;
    place = std::move(page);
  }
  position->missing_at = now + kPageWait;
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
                                                                              wire::Bytes header) {
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
std::vector<typename PageAssembly<Message>::MissingPages> PageAssembly<Message>::take_missing(
    Clock::time_point now) {
  std::vector<MissingPages> all;
  for (Partial& partial : partial_) {
    if (partial.missing_at > now) continue;
    ++partial.asked;
    partial.missing_at = partial.asked < kMostAsked ? now + kPageWait * (1 << partial.asked)
                                                    : Clock::time_point::max();
    MissingPages lost;
    for (std::size_t i = 0; i < partial.pages.size(); ++i) {
      if (!partial.pages[i]) {
        lost.missing.push_back(static_cast<std::int32_t>(i));
        continue;
      }
      lost.client_id = partial.pages[i]->client_id;
      lost.request_id = partial.pages[i]->request_id;
    }
    lost.num_pages = static_cast<std::int32_t>(partial.pages.size());
    all.push_back(std::move(lost));
  }
  return all;
}

template <class Message>
typename PageAssembly<Message>::Clock::time_point PageAssembly<Message>::next_missing() const {
  Clock::time_point next = Clock::time_point::max();
  for (const Partial& partial : partial_) next = std::min(next, partial.missing_at);
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
  Message whole = wire::begin_whole(*partial.pages.front());
  for (const std::optional<Message>& page : partial.pages) wire::append_page(whole, *page);
  return whole;
}

template class PageAssembly<plan_request_t>;
template class PageAssembly<plan_response_t>;

}  // namespace camway::messages
