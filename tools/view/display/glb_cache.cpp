// SPDX-License-Identifier: MIT
#include "tools/view/display/glb_cache.h"

#include <algorithm>
#include <utility>

namespace camway::view {

GlbCache::Glb GlbCache::find(std::string_view key) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(entries_, key, &Entry::key);
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->glb;
}

void GlbCache::put(std::string key, Glb glb) {
  const std::lock_guard lock(mutex_);
  const auto same = std::ranges::find(entries_, key, &Entry::key);
  if (same != entries_.end()) {
    bytes_ -= same->glb->size();
    entries_.erase(same);
  }
  if (glb->size() > most_bytes_) return;
  bytes_ += glb->size();
  entries_.push_front({std::move(key), std::move(glb)});
  while (bytes_ > most_bytes_) {
    bytes_ -= entries_.back().glb->size();
    entries_.pop_back();
  }
}

}  // namespace camway::view
