// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <stop_token>

namespace camway::scene {

/// The state of a scene change, from its begin to its end: pending, committed or cancelled. The
/// thread that makes the change commits it; any thread may cancel it before. The first of the two
/// wins, so a change that was reported as cancelled never takes effect. Copies share the state.
/// Thread-safe.
class Undertaking {
 public:
  Undertaking() : shared_(std::make_shared<Shared>()) {}

  /// Cancels the change and requests a stop of the work on it. Returns false if it was committed or
  /// cancelled before.
  bool call_off() const {
    if (!leave(State::kCalledOff)) return false;
    shared_->stop.request_stop();
    return true;
  }

  /// Commits the change. Returns false if it was cancelled: then it must change nothing.
  [[nodiscard]] bool come_into_force() const {
    return leave(State::kInForce) || shared_->state.load() == State::kInForce;
  }

  [[nodiscard]] bool is_called_off() const { return shared_->state.load() == State::kCalledOff; }
  [[nodiscard]] std::stop_token stop() const { return shared_->stop.get_token(); }

 private:
  enum class State { kBegun, kInForce, kCalledOff };
  struct Shared {
    std::atomic<State> state = State::kBegun;
    std::stop_source stop;
  };

  /// Leaves the pending state. Returns whether it was pending.
  [[nodiscard]] bool leave(State next) const {
    State begun = State::kBegun;
    return shared_->state.compare_exchange_strong(begun, next);
  }

  std::shared_ptr<Shared> shared_;
};

}  // namespace camway::scene
