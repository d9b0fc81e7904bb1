// SPDX-License-Identifier: MIT
#include "daemon/service/queue/known_clients.h"

#include <iterator>

namespace camway::service {

void KnownClients::note_served(const std::string& id) {
  const auto [found, is_new] = places_.try_emplace(id);
  Place& place = found->second;
  if (is_new) {
    half(false).push_front(id);
    place.position = half(false).begin();
  } else {
    // From either half to the front of the second; the iterator stays valid.
    half(true).splice(half(true).begin(), half(place.again), place.position);
    place.again = true;
  }
  if (half(true).size() > most_of_a_half_) {
    places_.find(half(true).back())->second.again = false;
    half(false).splice(half(false).begin(), half(true), std::prev(half(true).end()));
  }
  if (half(false).size() > most_of_a_half_) {
    places_.erase(half(false).back());
    half(false).pop_back();
  }
}

}  // namespace camway::service
