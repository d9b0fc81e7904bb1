// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "daemon/fleet/planner_server.h"
#include "daemon/fleet/remote_answerer.h"
#include "tests/support/captured_log.h"
#include "tests/support/memory_bus.h"
#include "tests/support/random.h"

namespace camway::testing {

/// Plans for real, but can be held, and counts. Thread-safe.
class HeldPlanner {
 public:
  [[nodiscard]] service::Planner planner();

  void hold();
  void release();
  /// Waits until so many calls have begun. Returns false if that takes too long.
  [[nodiscard]] bool wait_for_calls(int count) const;
  [[nodiscard]] int calls() const;
  [[nodiscard]] int most_at_a_time() const;

 private:
  void enter(const base::Deadline& deadline);
  void leave();

  mutable std::mutex mutex_;  ///< guards all below
  mutable std::condition_variable changed_;
  bool is_held_ = false;
  int calls_ = 0;
  int running_ = 0;
  int most_ = 0;
};

/// Returns revisions 1, 2, ... of the scene "room": a box more in each.
std::vector<std::shared_ptr<const scene::Snapshot>> rooms(std::size_t revisions);

/// Returns a request on the scene "room", which is planned in milliseconds.
plan_request_t room_request(const std::string& client, std::int64_t id, Random& random);

/// Returns the answer without its times, encoded.
wire::Bytes timeless(const plan_response_t& answer);

/// A planner process in memory.
class TestPlanner {
 public:
  TestPlanner(MemoryNetwork& network, const std::string& id, int workers = 1);
  ~TestPlanner();

  /// Holds the scene in this revision from then on, as the log has it at this position.
  void follow(const std::shared_ptr<const scene::Snapshot>& snapshot);
  void start();
  bool end(std::chrono::milliseconds limit = std::chrono::milliseconds(0));

  MemoryBus bus;
  scene::SceneStore scenes;
  HeldPlanner held;
  std::atomic<std::int64_t> position = 0;
  CapturedLog log;
  fleet::PlannerOptions options;
  std::unique_ptr<fleet::PlannerServer> server;

 private:
  service::LocalAnswerer answerer_;
};

/// A front process in memory, without LCM.
class TestFront {
 public:
  TestFront(MemoryNetwork& network, const std::string& id);

  void follow(const std::shared_ptr<const scene::Snapshot>& snapshot);
  /// Waits until the board has so many planners that take jobs, with this many slots together.
  [[nodiscard]] bool wait_for_slots(int slots) const;
  plan_response_t answer(const plan_request_t& request, double deadline_s = 30.0);
  /// Returns the answer of a planner in this process.
  plan_response_t local(const plan_request_t& request);
  [[nodiscard]] fleet::FrontCounts counts() const { return answerer->counts(); }

  MemoryBus bus;
  scene::SceneStore scenes;
  HeldPlanner held;
  std::atomic<std::int64_t> position = 0;
  CapturedLog log;
  fleet::PlannerBoard board;
  service::LocalAnswerer here;
  std::unique_ptr<fleet::RemoteAnswerer> answerer;
};

/// Waits until `is_so`. Returns false if that takes too long.
bool eventually(const std::function<bool()>& is_so);

/// A call of a front on a thread of its own.
class Asked {
 public:
  Asked(TestFront& front, plan_request_t request, double deadline_s = 30.0);
  /// Waits for the answer.
  const plan_response_t& answer();

 private:
  plan_response_t answer_;
  std::thread thread_;
};

}  // namespace camway::testing
