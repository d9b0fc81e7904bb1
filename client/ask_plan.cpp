// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <utility>

#include "client/plan_wire.h"
#include "client/session.h"

namespace camway {
namespace {

/// The sentence for a person about an answer that is not ok.
std::string explain(const PlanResponse& response) {
  const std::string said = response.message.empty() ? "(no reason given)" : response.message;
  switch (response.status) {
    case Status::kTimeout:
      return "planning ran out of time; raise PlanRequest.deadline_s: " + said;
    case Status::kUnknownScene:
      return "the daemon does not hold scene \"" + response.scene + "\": " + said;
    case Status::kOverloaded:
      return "the daemon's queue stayed full: " + said;
    default:
      return to_string(response.status) + ": " + said;
  }
}

/// Takes what comes on the response channel for one request.
class Inbox {
 public:
  Inbox(Session& session, std::int64_t request_id)
      : session_(session), collector_(session.options().client_id, request_id) {
    session_.receive_plan_with([this](std::span<const std::uint8_t> bytes) { take(bytes); });
  }
  ~Inbox() { session_.receive_plan_with({}); }
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  const PlanCollector& collector() const { return collector_; }
  /// What the daemon said when it refused for now, if it did.
  const std::optional<PlanResponse>& refusal() const { return refusal_; }

 private:
  void take(std::span<const std::uint8_t> bytes) {
    const PlanCollector::Taken taken = collector_.take(bytes);
    if (taken == PlanCollector::Taken::kForeign || taken == PlanCollector::Taken::kBad) return;
    session_.note_life();
    if (collector_.complete() && collector_.status() == Status::kOverloaded) {
      refusal_ = collector_.response();
      collector_.clear();
    } else if (taken == PlanCollector::Taken::kNew) {
      session_.note_news();
    }
  }

  Session& session_;
  PlanCollector collector_;
  std::optional<PlanResponse> refusal_;
};

PlanResponse no_answer(const Session& session, Outcome outcome, const Inbox& inbox) {
  if (inbox.refusal() && outcome == Outcome::kDeadline) return *inbox.refusal();
  const PlanCollector& collector = inbox.collector();
  std::string partly;
  if (collector.pages_here() > 0) {
    partly = std::to_string(collector.pages_here()) + " of " +
             std::to_string(collector.pages_expected()) + " pages";
  }
  return failed<PlanResponse>(session.explain(outcome, partly, collector.fault()));
}

}  // namespace

PlanResponse ask_plan(Session& session, const PlanRequest& request) {
  if (const auto fault = fault_in_form(request)) {
    return failed<PlanResponse>({Status::kInvalid, *fault});
  }
  const Clock::time_point start = Clock::now();
  const ClientOptions& options = session.options();
  // Not before the request's own deadline, and the answer needs some time to travel.
  const double planning_s = std::isfinite(request.deadline_s) ? request.deadline_s : 0.0;
  const double wait_s = std::max(options.deadline_s, planning_s + options.try_timeout_s);
  const std::int64_t id = request.request_id != 0 ? request.request_id : session.new_request_id();

  Inbox inbox(session, id);
  const auto answered = [&] { return inbox.collector().complete(); };
  const auto begun = [&] { return inbox.collector().pages_here() > 0; };
  const Question question{session.channels().plan_request(),
                          to_pages(request, options.client_id, id), answered, begun};
  int tries = 0;
  const Outcome outcome = session.ask(question, after(wait_s), tries);

  PlanResponse response = outcome == Outcome::kAnswered ? inbox.collector().response()
                                                        : no_answer(session, outcome, inbox);
  if (!response.ok() && response.error.empty()) response.error = explain(response);
  response.request_id = id;
  response.tries = tries;
  response.elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
  return response;
}

}  // namespace camway
