// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <stop_token>

namespace camway::scene {

/// A change of scenes from when it is begun until it is in force. Whoever makes it says when it
/// comes into force, and anybody else may call it off before: the first of the two wins, so that
/// nothing is told to be called off that comes into force after all. Copies are the same
/// undertaking. Safe from any thread.
class Undertaking {
 public:
  Undertaking() : shared_(std::make_shared<Shared>()) {}

  /// From now on it does not come into force, and `stop` asks to leave off making it. False if it
  /// is in force, or was called off before.
  bool call_off() const {
    if (!leave(State::kCalledOff)) return false;
    shared_->stop.request_stop();
    return true;
  }

  /// False if it was called off: then it must change nothing.
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

  /// The state that it is begun in. Whether it was in that.
  [[nodiscard]] bool leave(State next) const {
    State begun = State::kBegun;
    return shared_->state.compare_exchange_strong(begun, next);
  }

  std::shared_ptr<Shared> shared_;
};

}  // namespace camway::scene
