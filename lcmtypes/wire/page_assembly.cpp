// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/page_assembly.h"

#include <camway/members.h>

#include <algorithm>
#include <utility>

namespace camway::wire {

template <class Message>
typename PageAssembly<Message>::Outcome PageAssembly<Message>::add(Message page,
                                                                   Clock::time_point now) {
  if (std::string fault = page_fault(page); !fault.empty()) return {std::nullopt, fault, 0};
  if (page.num_pages == 1) return {std::move(page), {}, 0};

  const auto same_ids = [&](const Partial& partial) {
    const Message& held = partial.pages.any();
    return held.request_id == page.request_id && held.client_id == page.client_id;
  };
  Position position = std::find_if(partial_.begin(), partial_.end(), same_ids);
  if (position == partial_.end()) position = partial_.emplace(partial_.end());
  partial_.splice(partial_.end(), partial_, position);
  position->pages.add(std::move(page));
  position->missing_at = now + kPageWait;
  position->asked = 0;
  if (!position->pages.complete()) return {std::nullopt, {}, make_room(position)};
  Message whole = position->pages.whole();
  partial_.erase(position);
  return {std::move(whole), {}, 0};
}

template <class Message>
std::vector<missing_pages_t> PageAssembly<Message>::take_missing(Clock::time_point now) {
  std::vector<missing_pages_t> all;
  for (Partial& partial : partial_) {
    if (partial.missing_at > now) continue;
    ++partial.asked;
    partial.missing_at = partial.asked < kMostAsked ? now + kPageWait * (1 << partial.asked)
                                                    : Clock::time_point::max();
    const Message& held = partial.pages.any();
    missing_pages_t& question = all.emplace_back();
    question.client_id = held.client_id;
    question.request_id = held.request_id;
    question.num_pages = held.num_pages;
    question.missing = partial.pages.missing();
    set_counts(question);
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
std::size_t PageAssembly<Message>::make_room(Position keep) {
  std::size_t bytes = 0;
  for (const Partial& partial : partial_) bytes += partial.pages.bytes();
  std::size_t given_up = 0;
  while ((partial_.size() > limits_.max_messages || bytes > limits_.max_bytes) &&
         partial_.begin() != keep) {
    bytes -= partial_.front().pages.bytes();
    partial_.pop_front();
    ++given_up;
  }
  return given_up;
}

template class PageAssembly<plan_request_t>;
template class PageAssembly<plan_response_t>;

}  // namespace camway::wire
