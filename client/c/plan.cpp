// SPDX-License-Identifier: MIT
#include <camway/camway.h>

#include <limits>
#include <memory>
#include <utility>

#include "client/c/handles.h"
#include "client/c/handling.h"
#include "client/c/pending_call.h"
#include "client/c/request.h"
#include "client/c/sized.h"

namespace camway::c {
namespace {

/// Returns the status of an answer, and gives a handle of it to the caller, who may want none.
camway_status hand_over(PendingCall::Answer found, camway_answer** answer) {
  if (!found) return remember(CAMWAY_NOT_READY, "the answer did not come within the time to wait");
  const camway_status status = returned(found->status, found->error);
  if (answer != nullptr) *answer = Handles::all().add<camway_answer>(std::move(found));
  return status;
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_plan(camway_client* client, const camway_plan_request* request,
                          double timeout_s, camway_answer** answer) {
  return guarded([&] {
    require(answer, "answer");
    *answer = nullptr;
    const auto found = Handles::all().find(client);
    const camway::PlanRequest sent = request_of(request);
    Handling::refuse_to_wait(found.get());
    const std::shared_ptr<PendingCall> call =
        PendingCall::start(found, sent, camway_plan_handlers{});
    PendingCall::Answer got =
        call->wait(timeout_s > 0.0 ? timeout_s : std::numeric_limits<double>::infinity());
    if (!got) call->cancel();
    return hand_over(std::move(got), answer);
  });
}

camway_status camway_plan_handlers_init(camway_plan_handlers* handlers, size_t struct_size) {
  return guarded([&] {
    init_sized(camway_plan_handlers{}, handlers, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_plan_start(camway_client* client, const camway_plan_request* request,
                                const camway_plan_handlers* handlers, camway_pending** pending) {
  return guarded([&] {
    require(pending, "pending");
    *pending = nullptr;
    const auto found = Handles::all().find(client);
    const camway::PlanRequest sent = request_of(request);
    const camway_plan_handlers taken =
        handlers == nullptr ? camway_plan_handlers{}
                            : read_sized(handlers, camway_plan_handlers{}, "handlers");
    *pending = Handles::all().add<camway_pending>(PendingCall::start(found, sent, taken));
    return CAMWAY_OK;
  });
}

camway_status camway_pending_wait(camway_pending* pending, double timeout_s,
                                  camway_answer** answer) {
  return guarded([&] {
    if (answer != nullptr) *answer = nullptr;
    return hand_over(Handles::all().find(pending)->wait(timeout_s), answer);
  });
}

camway_status camway_pending_progress(const camway_pending* pending, camway_progress* progress,
                                      size_t struct_size) {
  return guarded([&] {
    write_sized(Handles::all().find(pending)->progress(), progress, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_pending_cancel(camway_pending* pending) {
  return guarded([&] {
    Handles::all().find(pending)->cancel();
    return CAMWAY_OK;
  });
}

camway_status camway_pending_free(camway_pending* pending) {
  return guarded([&] {
    if (const auto call = Handles::all().take(pending)) call->cancel();
    return CAMWAY_OK;
  });
}
