// SPDX-License-Identifier: MIT
#include "client/c/pending_call.h"

#include <chrono>
#include <utility>

#include "client/c/handles.h"
#include "client/c/handling.h"
#include "client/c/waiting.h"

namespace camway::c {
namespace {

static_assert(CAMWAY_CERTIFYING == static_cast<int>(PlanProgress::Stage::kCertifying));

camway_progress progress_of(const PlanProgress& from) {
  camway_progress progress{};
  progress.struct_size = sizeof progress;
  progress.stage = static_cast<std::int32_t>(from.stage);
  progress.requests_ahead = from.requests_ahead;
  progress.num_collisions = from.num_collisions;
  progress.num_corrected = from.num_corrected;
  progress.is_known = 1;
  progress.since_receipt_s = from.since_receipt_s;
  progress.deadline_s = from.deadline_s;
  return progress;
}

}  // namespace

std::shared_ptr<PendingCall> PendingCall::start(const std::shared_ptr<Client>& client,
                                                const PlanRequest& request,
                                                const camway_plan_handlers& handlers) {
  const std::shared_ptr<PendingCall> call(new PendingCall(client));
  PlanHandlers taken;
  taken.on_progress = [call, handlers](const PlanProgress& progress) {
    call->take_progress(progress, handlers);
  };
  taken.on_answer = [call, handlers](const PlanResponse& response) {
    call->take_answer(response, handlers);
  };
  PendingPlan pending = client->plan_async(request, std::move(taken));
  call->request_id_ = pending.request_id;
  call->answer_ = std::make_shared<const std::shared_future<PlanResponse>>(pending.answer.share());
  return call;
}

bool PendingCall::is_answered() const {
  return answer_->wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

PendingCall::Answer PendingCall::wait(double timeout_s) const {
  if (!is_answered()) {
    if (!(timeout_s > 0.0)) return nullptr;
    Handling::refuse_to_wait(waits_for_);
    if (answer_->wait_until(end_of_wait(timeout_s)) != std::future_status::ready) return nullptr;
  }
  return {answer_, &answer_->get()};
}

camway_progress PendingCall::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void PendingCall::cancel() const {
  if (is_answered()) return;
  if (const std::shared_ptr<Client> client = client_.lock()) client->cancel(request_id_);
}

void PendingCall::take_progress(const PlanProgress& progress,
                                const camway_plan_handlers& handlers) {
  const camway_progress taken = progress_of(progress);
  {
    const std::lock_guard lock(mutex_);
    progress_ = taken;
  }
  if (handlers.on_progress == nullptr) return;
  const Handling handling(waits_for_);
  handlers.on_progress(handlers.user, &taken);
}

void PendingCall::take_answer(const PlanResponse& response,
                              const camway_plan_handlers& handlers) const {
  if (handlers.on_answer == nullptr) return;
  const Handling handling(waits_for_);
  const ScopedHandle<camway_answer> handle(std::make_shared<const PlanResponse>(response));
  handlers.on_answer(handlers.user, handle.get());
}

}  // namespace camway::c
