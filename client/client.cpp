// SPDX-License-Identifier: MIT
#include "camway/client.h"

#include <atomic>
#include <utility>

#include "client/ask_scene.h"
#include "client/scene_wire.h"
#include "client/session.h"

namespace camway {
namespace {

/// Marks a client as in a call, for as long as it lives.
class InCall {
 public:
  explicit InCall(std::atomic<bool>& busy) : busy_(busy), alone_(!busy.exchange(true)) {}
  ~InCall() {
    if (alone_) busy_ = false;
  }
  InCall(const InCall&) = delete;
  InCall& operator=(const InCall&) = delete;
  /// Whether no other call was running.
  bool alone() const { return alone_; }

 private:
  std::atomic<bool>& busy_;
  bool alone_;
};

scene_request_t request_for(std::int8_t operation, const std::string& scene,
                            const std::string& object = {}) {
  scene_request_t request{};
  request.operation = operation;
  request.scene = scene;
  request.object = object;
  return request;
}

}  // namespace

class Client::Impl {
 public:
  explicit Impl(ClientOptions options) : session(std::move(options)) {}

  /// Runs `call` unless the client is unusable or in a call.
  template <class Answer, class Call>
  Answer guarded(Call call) {
    const InCall in_call(busy);
    if (!in_call.alone()) {
      return failed<Answer>(
          {Status::kBusy, "this client is in a call on another thread; use one client each"});
    }
    if (!session.error().empty()) {
      return failed<Answer>({session.error_status(), session.error()});
    }
    return call();
  }

  Session session;
  std::atomic<bool> busy = false;
};

Client::Client(ClientOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Client::~Client() = default;

const std::string& Client::error() const { return impl_->session.error(); }

const std::string& Client::client_id() const { return impl_->session.options().client_id; }

PlanResponse Client::plan(const PlanRequest& request) {
  return impl_->guarded<PlanResponse>([&] { return ask_plan(impl_->session, request); });
}

OccupancyAnswer Client::occupancy(const OccupancyBatch& batch) {
  return impl_->guarded<OccupancyAnswer>([&] { return ask_occupancy(impl_->session, batch); });
}

SceneAnswer Client::load_scene(const std::string& scene, const SceneMesh& mesh,
                               double occupancy_resolution_m) {
  return impl_->guarded<SceneAnswer>([&] {
    scene_request_t request = request_for(scene_request_t::LOAD, scene);
    request.occupancy_resolution_m = occupancy_resolution_m;
    const Bytes upload = put_mesh(mesh, request);
    return ask_scene(impl_->session, std::move(request), upload);
  });
}

SceneAnswer Client::unload_scene(const std::string& scene) {
  return impl_->guarded<SceneAnswer>(
      [&] { return ask_scene(impl_->session, request_for(scene_request_t::UNLOAD, scene)); });
}

SceneAnswer Client::list_scenes() {
  return impl_->guarded<SceneAnswer>(
      [&] { return ask_scene_list(impl_->session, request_for(scene_request_t::LIST, "")); });
}

SceneAnswer Client::describe_scene(const std::string& scene) {
  return impl_->guarded<SceneAnswer>([&] {
    return ask_scene_list(impl_->session, request_for(scene_request_t::DESCRIBE, scene));
  });
}

SceneAnswer Client::put_object(const std::string& scene, const std::string& object,
                               const SceneShape& shape, const Pose& pose) {
  return impl_->guarded<SceneAnswer>([&] {
    scene_request_t request = request_for(scene_request_t::PUT, scene, object);
    const Bytes upload = put_shape(shape, request);
    put_pose(pose, request);
    return ask_scene(impl_->session, std::move(request), upload);
  });
}

SceneAnswer Client::move_object(const std::string& scene, const std::string& object,
                                const Pose& pose) {
  return impl_->guarded<SceneAnswer>([&] {
    scene_request_t request = request_for(scene_request_t::MOVE, scene, object);
    put_pose(pose, request);
    return ask_scene(impl_->session, std::move(request));
  });
}

SceneAnswer Client::remove_object(const std::string& scene, const std::string& object) {
  return impl_->guarded<SceneAnswer>([&] {
    return ask_scene(impl_->session, request_for(scene_request_t::REMOVE, scene, object));
  });
}

DaemonStatus Client::status(double timeout_s) {
  return impl_->guarded<DaemonStatus>(
      [&] { return impl_->session.next_heartbeat(after(timeout_s)); });
}

}  // namespace camway
