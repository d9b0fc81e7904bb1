// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "daemon/service/core.h"

namespace camway::service {

/// Answers plan requests. The loop thread calls it; workers only run the planner and encode.
///
/// A request takes this way: bytes checked, decoded, pages joined, known ones answered from the
/// cache or left alone while they are being planned, scene looked up, queued, planned, encoded,
/// cached, sent. Deadlines run from when all pages are there. All answers to requests that were
/// read are cached but `overloaded`, so that the same request can be sent again later, and
/// conflicts, whose ids belong to another request.
class PlanService {
 public:
  PlanService(Core& core, Planner planner)
      : core_(core),
        planner_(std::move(planner)),
        pages_(core.config.assembly),
        cache_(core.config.cache) {}

  /// A message on the plan request channel. Throws only for want of memory.
  void on_message(std::span<const std::uint8_t> message);

 private:
  struct Pending;

  void on_malformed(std::span<const std::uint8_t> message, std::string_view reason);
  void on_request(plan_request_t request);
  void begin(std::shared_ptr<const plan_request_t> request, const RequestKey& key);
  void run(const Pending& pending);
  void finish(const Pending& pending, const plan_response_t& answer, Pages pages);
  void finish_plainly(const Pending& pending, std::int32_t status, std::string_view message);
  void abandon(const Pending& pending, Refusal why);
  void answer_uncached(const plan_request_t& request, std::int32_t status,
                       std::string_view message);
  void send(const RequestKey& key, Pages pages);

  Core& core_;
  Planner planner_;
  PageAssembly<plan_request_t> pages_;
  AnswerCache cache_;
};

}  // namespace camway::service
