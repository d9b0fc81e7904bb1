// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/shut_in_list.h"

#include <algorithm>

namespace camway::correction {

namespace {

// The entry that was found first says most: it may be complete.
void add_if_new(const ShutIn& found, std::vector<ShutIn>& list) {
  const auto same = std::ranges::find(list, found.keyframe, &ShutIn::keyframe);
  if (same == list.end()) list.push_back(found);
}

}  // namespace

void ShutInList::add(std::size_t leg, const Pocket& pocket) {
  const ShutIn shut_in{leg + (pocket.is_at_end ? 1 : 0), pocket.reached_W, pocket.unsure_m,
                       pocket.is_complete};
  if (pocket.is_complete) {
    add_if_new(shut_in, complete_);
    return;
  }
  std::erase_if(not_left_, [&](const NotLeft& known) { return known.leg == leg; });
  not_left_.push_back({leg, shut_in, pocket.is_narrow});
}

void ShutInList::mark_searched(std::size_t leg) {
  for (NotLeft& known : not_left_) known.is_searched |= known.leg == leg;
}

bool ShutInList::is_shut_off(std::size_t leg, const geometry::Vec3& begin_W,
                             const geometry::Vec3& end_W) const {
  return std::ranges::any_of(complete_, [&](const ShutIn& known) {
    return (known.keyframe == leg && !known.may_hold(end_W)) ||
           (known.keyframe == leg + 1 && !known.may_hold(begin_W));
  });
}

bool ShutInList::is_worthless(std::size_t leg) const {
  return std::ranges::any_of(not_left_, [&](const NotLeft& own) {
    return own.leg == leg && own.is_narrow &&
           std::ranges::any_of(not_left_, [&](const NotLeft& other) {
             return other.is_searched && other.shut_in.keyframe == own.shut_in.keyframe;
           });
  });
}

std::vector<ShutIn> ShutInList::all(const std::function<bool(std::size_t leg)>& is_open) const {
  std::vector<ShutIn> all = complete_;
  for (const NotLeft& known : not_left_) {
    if (is_open(known.leg)) add_if_new(known.shut_in, all);
  }
  return all;
}

}  // namespace camway::correction
