// SPDX-License-Identifier: MIT
#include "daemon/fleet/answer_comparer.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <iterator>
#include <vector>

#include "daemon/messages/plan.h"
#include "lcmtypes/wire/check.h"

namespace camway::fleet {

AnswerMark mark_of(const plan_response_t& answer, std::string planner) {
  const std::vector<std::uint8_t> bytes = wire::encode(messages::without_times(answer));
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  AnswerMark mark;
  mark.planner = std::move(planner);
  mark.client_id = answer.client_id;
  mark.request_id = answer.request_id;
  mark.scene_revision = answer.scene_revision;
  mark.scene_digest = answer.scene_digest;
  mark.digest = {hash.high64, hash.low64};
  mark.is_cut_short = answer.deadline_reached != 0 ||
                      answer.status == plan_response_t::STATUS_TIMEOUT ||
                      answer.status == plan_response_t::STATUS_CANCELLED;
  return mark;
}

bool differ(const AnswerMark& a, const AnswerMark& b) {
  const bool is_one_scene =
      a.scene_revision == b.scene_revision && a.scene_digest == b.scene_digest;
  return is_one_scene && !a.is_cut_short && !b.is_cut_short && a.digest != b.digest;
}

void AnswerMemory::keep(std::int64_t job, AnswerMark mark, Clock::time_point now) {
  while (!by_age_.empty() && (by_age_.front().until <= now || by_age_.size() >= kMost)) {
    drop_oldest();
  }
  by_age_.push_back({job, std::move(mark), now + kKept});
  by_job_[job] = std::prev(by_age_.end());
}

const AnswerMark* AnswerMemory::find(std::int64_t job, Clock::time_point now) {
  while (!by_age_.empty() && by_age_.front().until <= now) drop_oldest();
  const auto found = by_job_.find(job);
  return found == by_job_.end() ? nullptr : &found->second->mark;
}

bool AnswerMemory::forget(std::int64_t job) {
  const auto found = by_job_.find(job);
  if (found == by_job_.end()) return false;
  by_age_.erase(found->second);
  by_job_.erase(found);
  return true;
}

void AnswerMemory::drop_oldest() {
  by_job_.erase(by_age_.front().job);
  by_age_.pop_front();
}

}  // namespace camway::fleet
