// SPDX-License-Identifier: MIT
#include "client/c/watch_event.h"

#include <utility>

#include "client/c/answer.h"

namespace camway::c {

static_assert(CAMWAY_EVENT_RESTARTED == static_cast<int>(WatchEvent::Kind::kRestarted));

WatchEventInC::WatchEventInC(std::shared_ptr<const WatchEvent> from, std::int64_t num_missed)
    : from_(std::move(from)) {
  for (const CollisionInterval& interval : from_->broken) broken_.push_back(collision_of(interval));
  if (from_->answer) answer_.emplace(std::shared_ptr<const PlanResponse>(from_, &*from_->answer));
  event_.struct_size = sizeof event_;
  event_.kind = static_cast<std::int32_t>(from_->kind);
  event_.watch = from_->request_id;
  event_.scene_revision = from_->scene_revision;
  event_.status = static_cast<camway_status>(from_->status);
  event_.num_broken = static_cast<std::uint32_t>(broken_.size());
  event_.error = from_->error.c_str();
  event_.answer = answer_ ? answer_->get() : nullptr;
  event_.broken = broken_.empty() ? nullptr : broken_.data();
  event_.num_missed = num_missed;
}

}  // namespace camway::c
