// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include <camway/plan_request_t.hpp>

#include "daemon/base/deadline.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "daemon/service/plans/plan_answer.h"

namespace camway::service {

/// Answers plan requests, here or in another process. Thread-safe.
class PlanAnswerer {
 public:
  virtual ~PlanAnswerer() = default;

  /// Answers a request in the scene of `snapshot`, at its revision or a later one, which the answer
  /// names. Requires a snapshot that is not null. Returns within the deadline, or shortly after.
  /// Writes the progress of planning to the deadline. Must not throw.
  virtual Answered answer(const std::shared_ptr<const scene::Snapshot>& snapshot,
                          const plan_request_t& request, const base::Deadline& deadline) = 0;
};

/// Plans in this process, on the thread that asks. Thread-safe.
class LocalAnswerer final : public PlanAnswerer {
 public:
  /// `limits`: of the deadlines of requests.
  LocalAnswerer(Planner planner, const messages::DeadlineLimits& limits)
      : planner_(std::move(planner)), limits_(limits) {}

  Answered answer(const std::shared_ptr<const scene::Snapshot>& snapshot,
                  const plan_request_t& request, const base::Deadline& deadline) override {
    return answer_of(planner_, snapshot, request, limits_, deadline);
  }

 private:
  const Planner planner_;
  const messages::DeadlineLimits limits_;
};

}  // namespace camway::service
