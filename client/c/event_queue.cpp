// SPDX-License-Identifier: MIT
#include "client/c/event_queue.h"

#include <camway/camway.h>
#include <camway/client.h>

#include <algorithm>
#include <utility>

#include "client/c/handles.h"
#include "client/c/handling.h"
#include "client/c/request.h"
#include "client/c/sized.h"
#include "client/c/waiting.h"

namespace camway::c {

void EventQueue::put(const WatchEvent& event) {
  auto copy = std::make_shared<const WatchEvent>(event);
  const std::scoped_lock lock(mutex_);
  Backlog& backlog = backlogs_[event.request_id];
  if (backlog.num_kept == kMostOfAWatch) {
    kept_.erase(std::find_if(kept_.begin(), kept_.end(), [&](const auto& each) {
      return each->request_id == event.request_id;
    }));
    ++backlog.num_missed;
  } else {
    ++backlog.num_kept;
  }
  kept_.push_back(std::move(copy));
  came_.notify_one();
}

std::optional<camway_watch_event> EventQueue::next(double timeout_s) {
  std::unique_lock lock(mutex_);
  taken_.reset();
  const auto has_event = [this] { return !kept_.empty(); };
  if (!has_event()) {
    if (!(timeout_s > 0.0)) return std::nullopt;
    Handling::refuse_to_wait_at_all();
    if (!came_.wait_until(lock, end_of_wait(timeout_s), has_event)) return std::nullopt;
  }
  const auto backlog = backlogs_.find(kept_.front()->request_id);
  taken_ = std::make_unique<const WatchEventInC>(std::move(kept_.front()),
                                                 std::exchange(backlog->second.num_missed, 0));
  kept_.pop_front();
  if (--backlog->second.num_kept == 0) backlogs_.erase(backlog);
  return taken_->get();
}

}  // namespace camway::c

using namespace camway::c;

camway_status camway_event_queue_create(camway_event_queue** queue) {
  return guarded([&] {
    require(queue, "queue");
    *queue = Handles::all().add<camway_event_queue>(std::make_shared<EventQueue>());
    return CAMWAY_OK;
  });
}

camway_status camway_event_queue_free(camway_event_queue* queue) {
  return guarded([&] {
    Handles::all().take(queue);
    return CAMWAY_OK;
  });
}

camway_status camway_watch_start_polled(camway_client* client, const camway_plan_request* request,
                                        camway_event_queue* queue, int64_t* watch) {
  return guarded([&] {
    require(watch, "watch");
    *watch = 0;
    const auto found = Handles::all().find(client);
    const camway::PlanRequest sent = request_of(request);
    // A queue that was freed takes no events.
    const std::weak_ptr<EventQueue> target = Handles::all().find(queue);
    const auto unsent = std::make_shared<Refusal>();
    *watch = found->watch(sent, [target, unsent](const camway::WatchEvent& event) {
      if (event.request_id == 0) {
        *unsent = {static_cast<camway_status>(event.status), event.error};
      } else if (const std::shared_ptr<EventQueue> live = target.lock()) {
        live->put(event);
      }
    });
    if (*watch == 0) throw *unsent;
    return camway_status{CAMWAY_OK};
  });
}

camway_status camway_event_queue_next(camway_event_queue* queue, double timeout_s,
                                      camway_watch_event* event, size_t struct_size) {
  return guarded([&] {
    const auto found = Handles::all().find(queue);
    require(event, "event");
    require_size<camway_watch_event>(struct_size);
    const std::optional<camway_watch_event> taken = found->next(timeout_s);
    if (!taken) return remember(CAMWAY_NOT_READY, "no event came within the time to wait");
    write_sized(*taken, event, struct_size);
    return camway_status{CAMWAY_OK};
  });
}
