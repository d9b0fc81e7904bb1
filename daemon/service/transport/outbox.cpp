// SPDX-License-Identifier: MIT
#include "daemon/service/transport/outbox.h"

#include <utility>

namespace camway::service {

bool Outbox::add(const std::string& channel, Pages pages, std::vector<std::size_t> which,
                 Kind kind) {
  if (here_.contains(pages.get())) return false;
  const auto [position, is_new] = channels_.try_emplace(channel);
  std::size_t bytes = 0;
  for (const Bytes& page : *pages) bytes += page.size();
  // An answer that is larger than the limit is accepted when nothing else waits.
  const bool is_too_much = bytes_ > 0 && bytes_ + bytes > limits_.bytes;
  const bool one_refusal_more = kind == Kind::kRefusal && refusals_ >= limits_.refusals;
  if (here_.size() >= limits_.answers || is_too_much || one_refusal_more ||
      position->second.size() >= limits_.answers_of_a_channel) {
    if (is_new) channels_.erase(position);
    ++dropped_;
    return false;
  }
  if (is_new) turns_.push_back(position);
  here_.insert(pages.get());
  position->second.push_back({std::move(pages), std::move(which), bytes, 0, kind});
  bytes_ += bytes;
  if (kind == Kind::kRefusal) ++refusals_;
  return true;
}

void Outbox::send_burst() {
  std::size_t room = kBurstBytes;
  for (int sent = 0; sent < kBurstMessages && !turns_.empty(); ++sent) {
    Answer& answer = turns_.front()->second.front();
    const Bytes& page = answer.page();
    if (page.size() > room) return;
    room -= page.size();
    // A message that the transport refuses is lost, as it may be in the network; the transport
    // counts it.
    static_cast<void>(transport_.publish(turns_.front()->first, page));
    ++answer.next;
    end_turn();
  }
}

void Outbox::end_turn() {
  const Channels::iterator channel = turns_.front();
  turns_.pop_front();
  std::deque<Answer>& answers = channel->second;
  if (answers.front().sent()) {
    here_.erase(answers.front().pages.get());
    bytes_ -= answers.front().bytes;
    if (answers.front().kind == Kind::kRefusal) --refusals_;
  } else {
    answers.push_back(std::move(answers.front()));
  }
  answers.pop_front();
  if (answers.empty()) {
    channels_.erase(channel);
  } else {
    turns_.push_back(channel);
  }
}

}  // namespace camway::service
