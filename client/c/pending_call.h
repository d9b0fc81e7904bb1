// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/client.h>

#include <cstdint>
#include <future>
#include <memory>
#include <mutex>

namespace camway::c {

/// A request for a path that was started, and later its answer. Thread-safe.
class PendingCall {
 public:
  using Answer = std::shared_ptr<const PlanResponse>;

  /// Starts a request. The handlers run as `camway_plan_handlers` says.
  static std::shared_ptr<PendingCall> start(const std::shared_ptr<Client>& client,
                                            const PlanRequest& request,
                                            const camway_plan_handlers& handlers);

  /// Returns the answer, or nothing if `timeout_s` passes first. Throws `Refusal` if it had to wait
  /// in a handler of the client.
  Answer wait(double timeout_s) const;

  camway_progress progress() const;
  void cancel() const;

 private:
  explicit PendingCall(const std::shared_ptr<Client>& client)
      : client_(client), waits_for_(client.get()) {}

  bool is_answered() const;
  void take_progress(const PlanProgress& progress, const camway_plan_handlers& handlers);
  void take_answer(const PlanResponse& response, const camway_plan_handlers& handlers) const;

  std::weak_ptr<Client> client_;
  const void* waits_for_;  ///< the client, to recognise its handlers
  // Set before anybody else has this object.
  std::int64_t request_id_ = 0;
  std::shared_ptr<const std::shared_future<PlanResponse>> answer_;
  mutable std::mutex mutex_;  ///< of `progress_`
  camway_progress progress_{};
};

}  // namespace camway::c
