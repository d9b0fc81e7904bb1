// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "daemon/base/token_bucket.h"
#include "tools/view/backend.h"
#include "tools/view/door.h"
#include "tools/view/work_pool.h"

namespace camway::view {

/// The part that HTTP and sockets have in common: the rules that orders have to keep, and the
/// backend that answers them. Thread-safe.
class Desk {
 public:
  Desk(const DoorOptions& options, Backend& backend)
      : options_(options),
        backend_(backend),
        rate_(options.limits.changes_per_s, options.limits.change_burst) {}

  [[nodiscard]] const DoorLimits& limits() const { return options_.limits; }
  [[nodiscard]] Backend& backend() const { return backend_; }

  /// Names the scene of an order that names none.
  template <class Order>
  [[nodiscard]] Order in_scene(Order order) const {
    if (order.scene.empty()) order.scene = backend_.scene();
    return order;
  }

  /// Takes a place for a plan of a socket, which the result keeps as long as it lives. Null if all
  /// places are taken.
  using Place = std::shared_ptr<void>;
  [[nodiscard]] Place take_place();

  /// Returns the refusal of any change of a scene; nothing where scenes may be changed.
  [[nodiscard]] std::optional<Answer> refuse_change() const;
  /// Looks at a scene or changes it, if the rules allow it.
  void ask_scene(SceneOrder order, Done done);
  /// Answers with the state of the door and of the backend.
  void status(Done done) const;
  /// Returns the versions of the program and of the door.
  [[nodiscard]] static Answer version();
  /// Answers with the path of a request as interpolated.
  void interpolate(PlanOrder order, Done done);
  /// Answers with triangles of a scene.
  void triangles(TrianglesOrder order, Done done);
  /// Returns the last plan: its request and its answer, as far as there are any.
  [[nodiscard]] Answer last() const;
  /// Returns the table of the options of requests, and the formats of exports.
  [[nodiscard]] static Answer fields();

  /// Runs work that takes time on a thread of the desk. Drops it once the desk was stopped.
  void post(WorkPool::Work work) { workers_.post(std::move(work)); }
  /// Waits for the work that runs, and drops the rest. Must come before the end of the desk, which
  /// its own work may keep.
  void stop() { workers_.stop(); }

 private:
  /// Bodies are parsed, pictures drawn and paths interpolated on threads of their own, so that
  /// large ones keep nobody waiting. Two, so that a picture does not keep requests waiting either.
  static constexpr int kWorkers = 2;

  /// Counts a change of a scene. Returns false, and counts nothing, if it comes too soon.
  bool takes_change();

  const DoorOptions options_;
  Backend& backend_;
  std::mutex rate_mutex_;
  base::TokenBucket rate_;  ///< of changes of scenes
  /// Plans of all sockets under way. Places keep it, which may outlive the desk.
  const std::shared_ptr<std::atomic<int>> plans_ = std::make_shared<std::atomic<int>>(0);
  WorkPool workers_{kWorkers};
};

}  // namespace camway::view
