// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>

#include <memory>

#include "client/c/handles.h"
#include "client/c/handling.h"
#include "client/c/request.h"
#include "client/c/watch_event.h"

namespace camway::c {
namespace {

void deliver(const WatchEvent& from, const void* client, camway_watch_handler handler, void* user) {
  const WatchEventInC event(std::make_shared<const WatchEvent>(from), 0);
  const Handling handling(client);
  handler(user, &event.get());
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_watch_start(camway_client* client, const camway_plan_request* request,
                                 camway_watch_handler handler, void* user, int64_t* watch) {
  return guarded([&] {
    require(watch, "watch");
    *watch = 0;
    if (handler == nullptr) require(nullptr, "handler");
    const auto found = Handles::all().find(client);
    const camway::PlanRequest sent = request_of(request);
    const void* const handled = found.get();
    const std::int64_t id = found->watch(
        sent, [=](const camway::WatchEvent& event) { deliver(event, handled, handler, user); });
    if (id == 0)
      return remember(CAMWAY_INVALID, "the request cannot be sent; the handler was told why");
    *watch = id;
    return camway_status{CAMWAY_OK};
  });
}

camway_status camway_watch_end(camway_client* client, int64_t watch, double timeout_s) {
  return guarded([&] {
    const auto found = Handles::all().find(client);
    if (!(timeout_s > 0.0)) {
      found->unwatch(watch);
      return camway_status{CAMWAY_OK};
    }
    Handling::refuse_to_wait(found.get());
    if (found->unwatch(watch, timeout_s)) return camway_status{CAMWAY_OK};
    return remember(CAMWAY_NOT_READY, "the daemon did not confirm the end of the watch in time");
  });
}

camway_status camway_watch_take_better(camway_client* client, int64_t watch) {
  return guarded([&] {
    Handles::all().find(client)->take_better(watch);
    return CAMWAY_OK;
  });
}
