// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "tools/view/answer.h"

namespace camway::view {

/// Calls `done` once: with the answer, or with the reason that the backend has ended. Work that may
/// be dropped owns one.
class Reporter {
 public:
  explicit Reporter(Done done) : done_(std::move(done)) {}
  ~Reporter() {
    if (done_) done_(failure(code::kNoDaemon, "camway view is ending"));
  }
  Reporter(const Reporter&) = delete;
  Reporter& operator=(const Reporter&) = delete;
  /// To be called once at most.
  void report(Answer answer) { std::exchange(done_, nullptr)(std::move(answer)); }

 private:
  Done done_;
};

}  // namespace camway::view
