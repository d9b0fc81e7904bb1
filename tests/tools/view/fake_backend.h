// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tools/view/backend.h"
#include "tools/view/facts.h"

namespace camway::view {

/// A backend whose plans end when the test says so. Thread-safe.
class FakeBackend final : public Backend {
 public:
  /// A plan that the door has asked for.
  struct Asked {
    PlanOrder order;
    Tell progress;
    Done done;
    std::shared_ptr<bool> is_cancelled;
  };

  [[nodiscard]] std::string scene() const override { return "office"; }
  std::shared_ptr<Job> plan(PlanOrder order, Tell progress, Done done) override {
    auto is_cancelled = std::make_shared<bool>(false);
    const std::lock_guard lock(mutex_);
    asked_.push_back({std::move(order), std::move(progress), std::move(done), is_cancelled});
    ++plans_;
    changed_.notify_all();
    return std::make_shared<FakeJob>(*this, is_cancelled);
  }
  std::shared_ptr<Job> check(CheckOrder, Done done) override {
    done({code::kOk, R"({"verdict": "free"})", {}});
    return nullptr;
  }
  void ask_scene(SceneOrder order, Done done) override {
    {
      const std::lock_guard lock(mutex_);
      orders_.push_back(order);
    }
    done({code::kOk, R"({"scene": )" + json_string(order.scene) + "}", {}});
  }
  void mesh(std::string, std::string digest, MeshDone done) override {
    done({display_mesh, 1, display_mesh ? code::kOk : code::kNotFound,
          display_mesh ? "" : "no object " + digest});
  }
  void triangles(std::string, std::vector<std::int64_t> indices, Done done) override {
    std::map<std::int64_t, geometry::Triangle> found;
    for (const std::int64_t index : indices) {
      found[index].fill(geometry::Vec3::Zero());
    }
    done({code::kOk, triangles_json(1, found), {}});
  }
  void status(Done done) override { done({code::kOk, R"({"planner": "fake"})", {}}); }
  std::unique_ptr<Watch> watch_scenes(Tell event) override {
    event(R"({"kind": "scenes"})");
    return std::make_unique<Watch>();
  }
  std::unique_ptr<Watch> watch_path(PlanOrder, Tell) override { return nullptr; }
  [[nodiscard]] std::shared_ptr<const LastPlan> last() const override { return last_plan; }

  /// Waits for the next plan and takes it.
  Asked take() {
    std::unique_lock lock(mutex_);
    expect(lock, [this] { return !asked_.empty(); });
    Asked asked = std::move(asked_.front());
    asked_.pop_front();
    return asked;
  }
  /// Waits until a plan that was taken is cancelled.
  void wait_until_cancelled(const Asked& asked) {
    std::unique_lock lock(mutex_);
    expect(lock, [&] { return *asked.is_cancelled; });
  }
  /// Returns how many plans were asked for.
  int plans() {
    const std::lock_guard lock(mutex_);
    return plans_;
  }
  std::deque<SceneOrder> orders() {
    const std::lock_guard lock(mutex_);
    return orders_;
  }

  std::shared_ptr<const scene::Mesh> display_mesh;  ///< of all objects; null: there is none
  std::shared_ptr<const LastPlan> last_plan;        ///< set before the door is opened

 private:
  class FakeJob final : public Job {
   public:
    FakeJob(FakeBackend& backend, std::shared_ptr<bool> is_cancelled)
        : backend_(backend), is_cancelled_(std::move(is_cancelled)) {}
    void cancel() override {
      const std::lock_guard lock(backend_.mutex_);
      *is_cancelled_ = true;
      backend_.changed_.notify_all();
    }

   private:
    FakeBackend& backend_;
    std::shared_ptr<bool> is_cancelled_;
  };

  /// Waits for what must come soon.
  template <class Condition>
  void expect(std::unique_lock<std::mutex>& lock, const Condition& condition) {
    constexpr std::chrono::seconds kPatience{30};
    if (!changed_.wait_for(lock, kPatience, condition)) throw std::runtime_error("nothing came");
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Asked> asked_;
  std::deque<SceneOrder> orders_;
  int plans_ = 0;
};

/// A request that is valid, as text.
inline constexpr char kSmallRequest[] =
    R"({"camera": {"fov_x_deg": 70, "fov_y_deg": 50, "near": 0.1}, "keyframes": [
      {"position": [0, 0, 0], "orientation": [1, 0, 0, 0]},
      {"position": [1, 0, 0], "orientation": [1, 0, 0, 0]}]})";

/// Returns a message that asks for a plan.
inline std::string plan_message(int id, const std::string& more = {}) {
  return R"({"id": )" + std::to_string(id) + R"(, "do": "plan", "request": )" + kSmallRequest +
         more + "}";
}

}  // namespace camway::view
