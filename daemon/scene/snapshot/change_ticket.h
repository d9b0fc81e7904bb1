// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <stop_token>

namespace camway::scene {

/// Decides between commit and cancel of a scene change. A change is *begun*, then *committed* or
/// *cancelled*. The thread that makes the change commits it; any thread may cancel it before. The
/// first of the two wins, so a change that was reported as cancelled never takes effect. Copies
/// share the state.
///
/// Thread-safe.
class ChangeTicket {
 public:
  ChangeTicket() : shared_(std::make_shared<Shared>()) {}

  /// Cancels the change and requests a stop of the work on it. Returns false if it was committed or
  /// cancelled before.
  bool cancel() const {
    if (!leave(State::kCancelled)) return false;
    shared_->stop.request_stop();
    return true;
  }

  /// Commits the change. Returns false if it was cancelled: then it must change nothing.
  [[nodiscard]] bool try_commit() const {
    return leave(State::kCommitted) || shared_->state.load() == State::kCommitted;
  }

  [[nodiscard]] bool is_cancelled() const { return shared_->state.load() == State::kCancelled; }
  [[nodiscard]] std::stop_token stop() const { return shared_->stop.get_token(); }

 private:
  enum class State { kBegun, kCommitted, kCancelled };
  struct Shared {
    std::atomic<State> state = State::kBegun;
    std::stop_source stop;
  };

  /// Leaves the state kBegun. Returns false if the change was in another state.
  [[nodiscard]] bool leave(State next) const {
    State begun = State::kBegun;
    return shared_->state.compare_exchange_strong(begun, next);
  }

  std::shared_ptr<Shared> shared_;
};

}  // namespace camway::scene
