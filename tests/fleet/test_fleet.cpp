// SPDX-License-Identifier: MIT
#include "tests/fleet/test_fleet.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "daemon/messages/plan.h"
#include "daemon/planning/plan.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "tests/messages/request_on_wire.h"
#include "tests/support/watched_scenes.h"

namespace camway::testing {
namespace {

constexpr std::chrono::seconds kFleetPatience{30};

}  // namespace

service::Planner HeldPlanner::planner() {
  return [this](const scene::Snapshot& snapshot, const planning::PlanRequest& request,
                const base::Deadline& deadline) {
    enter(deadline);
    planning::PlanResult result = planning::plan(snapshot, request, deadline);
    leave();
    return result;
  };
}

void HeldPlanner::enter(const base::Deadline& deadline) {
  std::unique_lock lock(mutex_);
  ++calls_;
  most_ = std::max(most_, ++running_);
  changed_.notify_all();
  if (is_held_) {
    deadline.report(base::Progress::Stage::kCorrecting);
    deadline.report_collisions(5, 2);
  }
  while (is_held_ && deadline.remaining_s() > 0.0) {
    changed_.wait_for(lock, std::chrono::milliseconds(2));
  }
}

void HeldPlanner::leave() {
  const std::lock_guard lock(mutex_);
  --running_;
}

void HeldPlanner::hold() {
  const std::lock_guard lock(mutex_);
  is_held_ = true;
}

void HeldPlanner::release() {
  {
    const std::lock_guard lock(mutex_);
    is_held_ = false;
  }
  changed_.notify_all();
}

bool HeldPlanner::wait_for_calls(int count) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kFleetPatience, [&] { return calls_ >= count; });
}

int HeldPlanner::calls() const {
  const std::lock_guard lock(mutex_);
  return calls_;
}

int HeldPlanner::most_at_a_time() const {
  const std::lock_guard lock(mutex_);
  return most_;
}

std::vector<std::shared_ptr<const scene::Snapshot>> rooms(std::size_t revisions) {
  scene::SceneStore store;
  store.put(scene::assemble("room", 1, {}, {}));
  std::vector<std::shared_ptr<const scene::Snapshot>> list{store.find("room")};
  while (list.size() < revisions) {
    const double place = 0.7 * static_cast<double>(list.size());
    const std::string name = "box" + std::to_string(list.size());
    list.push_back(store
                       .change("room", {scene::SceneChange::Kind::kPut, name,
                                        box_source({0.4, 0.5, 0.6}), at({place - 2.0, place, 0.0})})
                       .snapshot);
  }
  return list;
}

plan_request_t room_request(const std::string& client, std::int64_t id, Random& random) {
  planning::PlanRequest request = random_path_request(4, random);
  plan_request_t wire = messages::to_wire(request, {client, id, 0});
  wire.scene = "room";
  return wire;
}

wire::Bytes timeless(const plan_response_t& answer) {
  return wire::encode(messages::without_times(answer));
}

TestPlanner::TestPlanner(MemoryNetwork& network, const std::string& id, int workers)
    : bus(network), answerer_(held.planner(), {}) {
  options.planner_id = id;
  options.workers = workers;
  options.version = "test";
}

TestPlanner::~TestPlanner() {
  held.release();
  server.reset();
}

void TestPlanner::follow(const std::shared_ptr<const scene::Snapshot>& snapshot) {
  scenes.put(snapshot);
  position = static_cast<std::int64_t>(snapshot->revision);
}

void TestPlanner::start() {
  auto opened = fleet::PlannerServer::open(
      {bus, scenes, answerer_}, options, [this] { return position.load(); }, log.log());
  ASSERT_TRUE(opened) << opened.error;
  server = *std::move(opened);
}

bool TestPlanner::end(std::chrono::milliseconds limit) { return server->stop(limit); }

TestFront::TestFront(MemoryNetwork& network, const std::string& id)
    : bus(network), here(held.planner(), {}) {
  fleet::FrontOptions options;
  options.front_id = id;
  auto opened = fleet::RemoteAnswerer::open(
      {bus, board, scenes, here}, options, [this](const std::string&) { return position.load(); },
      log.log());
  if (!opened) {
    ADD_FAILURE() << opened.error;
    return;
  }
  answerer = *std::move(opened);
}

void TestFront::follow(const std::shared_ptr<const scene::Snapshot>& snapshot) {
  scenes.put(snapshot);
  position = static_cast<std::int64_t>(snapshot->revision);
}

bool TestFront::wait_for_slots(int slots) const {
  return eventually([&] { return board.free_slots() == slots; });
}

plan_response_t TestFront::answer(const plan_request_t& request, double deadline_s) {
  return answerer->answer(scenes.find(request.scene), request, base::Deadline::after_s(deadline_s))
      .wire;
}

plan_response_t TestFront::local(const plan_request_t& request) {
  service::LocalAnswerer planner(
      [](const scene::Snapshot& snapshot, const planning::PlanRequest& wanted,
         const base::Deadline& deadline) { return planning::plan(snapshot, wanted, deadline); },
      {});
  return planner.answer(scenes.find(request.scene), request, base::Deadline::never()).wire;
}

bool eventually(const std::function<bool()>& is_so) {
  const auto until = std::chrono::steady_clock::now() + kFleetPatience;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

Asked::Asked(TestFront& front, plan_request_t request, double deadline_s)
    : thread_([this, &front, request = std::move(request), deadline_s] {
        answer_ = front.answer(request, deadline_s);
      }) {}

const plan_response_t& Asked::answer() {
  if (thread_.joinable()) thread_.join();
  return answer_;
}

}  // namespace camway::testing
