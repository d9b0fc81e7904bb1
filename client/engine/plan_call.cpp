// SPDX-License-Identifier: MIT
#include "client/engine/plan_call.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <camway/cancel_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/plan_progress_t.hpp>

#include "client/engine/handler.h"
#include "client/messages/plan.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/utime.h"

namespace camway {
namespace {

/// Returns the sentence for the user about an answer that is not ok.
std::string explain(const PlanResponse& response) {
  const std::string said = response.message.empty() ? "(no reason given)" : response.message;
  switch (response.status) {
    case Status::kTimeout:
      return "planning ran out of time; raise PlanRequest.deadline_s: " + said;
    case Status::kUnknownScene:
      return "the daemon does not hold scene \"" + response.scene + "\": " + said;
    case Status::kCancelled:
      return "the request was cancelled: " + said;
    case Status::kOverloaded:
      return "the daemon's queue stayed full: " + said;
    default:
      return to_string(response.status) + ": " + said;
  }
}

/// Returns when a call ends: not before the request's own deadline plus the time for the answer to
/// arrive.
Clock::time_point deadline_of(const PlanRequest& request, const ClientOptions& options,
                              Clock::time_point start) {
  const double planning_s = std::isfinite(request.deadline_s) ? request.deadline_s : 0.0;
  return after(std::max(options.deadline_s, planning_s + options.try_timeout_s), start);
}

std::vector<Outgoing> request_messages_of(const Context& context, const PlanRequest& request,
                                          std::int64_t id) {
  std::vector<Outgoing> messages;
  for (Bytes& page : to_pages(request, context.options().client_id, id)) {
    messages.push_back({context.channels().plan_request(), std::move(page)});
  }
  return messages;
}

}  // namespace

PlanCall::PlanCall(Context& context, const PlanRequest& request, std::int64_t id,
                   PlanHandlers handlers)
    : PlanCall(context, request, id, std::move(handlers), Clock::now()) {}

PlanCall::PlanCall(Context& context, const PlanRequest& request, std::int64_t id,
                   PlanHandlers handlers, Clock::time_point start)
    : Call(Kind::kPlan, id, request_messages_of(context, request, id),
           context.retry(deadline_of(request, context.options(), start))),
      context_(context),
      handlers_(std::move(handlers)),
      collector_(context.options().client_id, id),
      start_(start) {}

void PlanCall::take_answer(std::span<const std::uint8_t> bytes, Clock::time_point now) {
  const PlanCollector::Taken taken = collector_.take(bytes);
  if (taken == PlanCollector::Taken::kForeign || taken == PlanCollector::Taken::kBad) return;
  retry().note_life();
  if (collector_.complete() && collector_.status() == Status::kOverloaded) {
    refusal_ = collector_.response();
    collector_.clear();
    retry().forget_parts();
  } else if (taken == PlanCollector::Taken::kNew) {
    retry().note_part(now);
  }
}

void PlanCall::take_progress(std::span<const std::uint8_t> bytes) {
  const auto decoded = wire::decode<plan_progress_t>(bytes);
  if (!decoded.message || decoded.message->client_id != context_.options().client_id) return;
  retry().note_life();
  PlanProgress progress;
  convert(*decoded.message, progress);
  call_handler(handlers_.on_progress, progress);
}

std::vector<Outgoing> PlanCall::missing() const {
  missing_pages_t message{};
  message.client_id = context_.options().client_id;
  message.request_id = request_id();
  message.utime = wire::utime_now();
  message.num_pages = static_cast<std::int32_t>(collector_.pages().expected());
  message.missing = collector_.pages().missing();
  message.num_missing = static_cast<std::int32_t>(message.missing.size());
  return {{context_.channels().missing_pages(), wire::encode(message)}};
}

void PlanCall::cancel() {
  cancel_t message{};
  message.client_id = context_.options().client_id;
  message.request_id = request_id();
  message.utime = wire::utime_now();
  replace_request_messages({{context_.channels().cancel(), wire::encode(message)}});
  retry().restart();
}

void PlanCall::finish(Outcome outcome) {
  PlanResponse response = response_of(outcome);
  if (!response.ok() && response.error.empty()) response.error = explain(response);
  response.request_id = request_id();
  response.tries = retry().tries();
  response.elapsed_s = std::chrono::duration<double>(Clock::now() - start_).count();
  call_handler(handlers_.on_answer, response);
  promise_.set_value(std::move(response));
}

PlanResponse PlanCall::response_of(Outcome outcome) const {
  if (outcome == Outcome::kAnswered) return collector_.response();
  if (refusal_ && outcome == Outcome::kDeadline) return *refusal_;
  std::string partly;
  if (collector_.pages().held() > 0) {
    partly = std::to_string(collector_.pages().held()) + " of " +
             std::to_string(collector_.pages().expected()) + " pages";
  }
  return failed<PlanResponse>(
      context_.explain(outcome, retry().ever_heard(), partly, collector_.fault()));
}

}  // namespace camway
