// SPDX-License-Identifier: MIT
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "client/engine/context.h"
#include "client/messages/plan.h"

namespace camway {

/// A request for a path on its way.
class PlanCall final : public Call {
 public:
  /// `id` is the request's. Precondition: no `fault_in_form(request)`.
  PlanCall(Context& context, const PlanRequest& request, std::int64_t id, PlanHandlers handlers);

  std::future<PlanResponse> answer() { return promise_.get_future(); }

  void take_answer(std::span<const std::uint8_t> bytes, Clock::time_point now) override;
  void take_progress(std::span<const std::uint8_t> bytes) override;
  bool answered() const override { return collector_.complete(); }
  std::vector<Outgoing> missing() const override;
  void cancel() override;
  void finish(Outcome outcome) override;

 private:
  PlanResponse response_of(Outcome outcome) const;

  Context& context_;
  PlanHandlers handlers_;
  PlanCollector collector_;
  std::optional<PlanResponse> refusal_;  ///< what the daemon said when it refused for now
  const Clock::time_point start_ = Clock::now();
  std::promise<PlanResponse> promise_;
};

}  // namespace camway
