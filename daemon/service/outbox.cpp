// SPDX-License-Identifier: MIT
#include "daemon/service/outbox.h"

#include <algorithm>
#include <utility>

namespace camway::service {

bool Outbox::add(std::string channel, Pages pages, std::vector<std::size_t> which) {
  const bool waits = std::any_of(answers_.begin(), answers_.end(),
                                 [&](const Answer& answer) { return answer.pages == pages; });
  if (waits || answers_.size() >= kCapacity) return false;
  answers_.push_back({std::move(channel), std::move(pages), std::move(which), 0});
  return true;
}

void Outbox::send_burst() {
  std::size_t room = kBurstBytes;
  for (int sent = 0; sent < kBurstMessages && !answers_.empty(); ++sent) {
    Answer& answer = answers_.front();
    const bool all = answer.which.empty();
    const Bytes& page = (*answer.pages)[all ? answer.next : answer.which[answer.next]];
    if (page.size() > room) return;
    room -= page.size();
    if (!transport_.publish(answer.channel, page)) ++failed_;
    if (++answer.next == (all ? answer.pages->size() : answer.which.size())) answers_.pop_front();
  }
}

}  // namespace camway::service
