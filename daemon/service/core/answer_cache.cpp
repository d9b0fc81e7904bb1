// SPDX-License-Identifier: MIT
#include "daemon/service/core/answer_cache.h"

#include <xxhash.h>

#include <iterator>
#include <numeric>
#include <utility>

#include "lcmtypes/wire/check.h"

namespace camway::service {
namespace {

std::size_t size_of(const Pages& pages) {
  return std::accumulate(pages->begin(), pages->end(), std::size_t{0},
                         [](std::size_t sum, const Bytes& page) { return sum + page.size(); });
}

}  // namespace

RequestDigest digest_of_bytes(const Bytes& bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

RequestDigest digest_of(const plan_request_t& whole) {
  plan_request_t content = whole;
  content.utime = 0;
  content.page = 0;
  content.num_pages = 1;
  return digest_of_bytes(wire::encode(content));
}

AnswerCache::Found AnswerCache::find_or_begin(const RequestKey& key, const RequestDigest& digest) {
  const auto [position, inserted] = entries_.try_emplace(key, Entry{digest, nullptr, {}});
  if (inserted) return {Known::kNew, nullptr};
  Entry& entry = position->second;
  if (entry.digest != digest) return {Known::kConflict, nullptr};
  if (!entry.pages) return {Known::kRunning, nullptr};
  by_age_.splice(by_age_.end(), by_age_, entry.age);
  return {Known::kAnswered, entry.pages, entry.was_watched};
}

Pages AnswerCache::find(const RequestKey& key) {
  const auto position = entries_.find(key);
  if (position == entries_.end() || !position->second.pages) return nullptr;
  by_age_.splice(by_age_.end(), by_age_, position->second.age);
  return position->second.pages;
}

void AnswerCache::finish(const RequestKey& key, Pages pages) {
  const auto position = entries_.find(key);
  if (position == entries_.end() || position->second.pages) return;
  bytes_ += size_of(pages);
  position->second.pages = std::move(pages);
  position->second.age = by_age_.insert(by_age_.end(), key);
  make_room();
}

void AnswerCache::replace(const RequestKey& key, const RequestDigest& digest, Pages pages) {
  const Known known = find_or_begin(key, digest).known;
  if (known == Known::kRunning || known == Known::kConflict) return;
  Entry& entry = entries_.find(key)->second;
  if (!entry.pages) {
    finish(key, std::move(pages));
    mark_watched(key);
    return;
  }
  bytes_ += size_of(pages);
  bytes_ -= size_of(entry.pages);
  entry.pages = std::move(pages);
  make_room();
}

void AnswerCache::mark_watched(const RequestKey& key) {
  const auto position = entries_.find(key);
  if (position != entries_.end()) position->second.was_watched = true;
}

void AnswerCache::forget_answer(const RequestKey& key) {
  const auto position = entries_.find(key);
  if (position == entries_.end() || !position->second.pages) return;
  bytes_ -= size_of(position->second.pages);
  by_age_.erase(position->second.age);
  entries_.erase(position);
}

void AnswerCache::make_room() {
  while (by_age_.size() > limits_.max_answers || bytes_ > limits_.max_bytes) {
    const auto oldest = entries_.find(by_age_.front());
    bytes_ -= size_of(oldest->second.pages);
    entries_.erase(oldest);
    by_age_.pop_front();
  }
}

void AnswerCache::forget(const RequestKey& key) {
  const auto position = entries_.find(key);
  if (position != entries_.end() && !position->second.pages) entries_.erase(position);
}

}  // namespace camway::service
