// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <stop_token>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/view/backend.h"

namespace camway::view {

/// A plan or a proof that is under way in this process.
class StoppableJob final : public Job {
 public:
  void cancel() override { stop_.request_stop(); }
  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  std::stop_source stop_;
};

/// Proves a path in `snapshot` in this thread, until a client or the end of the backend stops it.
/// Answers as `Backend::check` does. `snapshot` must not be null.
Answer proof_of(const CheckOrder& order, std::shared_ptr<const scene::Snapshot> snapshot,
                const std::stop_token& by_client, const std::stop_token& by_end);

}  // namespace camway::view
