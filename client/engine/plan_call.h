// SPDX-License-Identifier: MIT
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "client/engine/context.h"
#include "client/engine/plan_collector.h"

namespace camway {

/// A pending request for a path. Not thread-safe; see `Call`.
class PlanCall final : public Call {
 public:
  /// `id` is the id of the request. Requires a request without `fault_in_form`.
  PlanCall(Context& context, const PlanRequest& request, std::int64_t id, PlanHandlers handlers);

  std::future<PlanResponse> answer() { return promise_.get_future(); }

  void take_answer(std::span<const std::uint8_t> bytes, Clock::time_point now) override;
  void take_progress(std::span<const std::uint8_t> bytes) override;
  bool answered() const override { return collector_.complete(); }
  std::vector<Outgoing> missing() const override;
  void cancel() override;
  void finish(Outcome outcome) override;

 private:
  PlanCall(Context& context, const PlanRequest& request, std::int64_t id, PlanHandlers handlers,
           Clock::time_point start);

  PlanResponse response_of(Outcome outcome) const;

  Context& context_;
  PlanHandlers handlers_;
  PlanCollector collector_;
  std::optional<PlanResponse> refusal_;  ///< the last answer of a daemon that was overloaded
  const Clock::time_point start_;        ///< the deadline is counted from it, too
  std::promise<PlanResponse> promise_;
};

}  // namespace camway
