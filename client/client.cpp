// SPDX-License-Identifier: MIT
#include <camway/client.h>

#include <future>
#include <memory>
#include <utility>

#include "client/engine/ask_occupancy.h"
#include "client/engine/ask_scene.h"
#include "client/engine/context.h"
#include "client/engine/engine.h"
#include "client/engine/handler.h"
#include "client/engine/plan_call.h"
#include "client/messages/convert.h"
#include "client/messages/plan_faults.h"
#include "client/messages/scene.h"

namespace camway {
namespace {

/// Period of progress reports if the request has none.
constexpr double kProgressPeriod_s = 0.5;

template <class Answer>
std::future<Answer> ready(Answer answer) {
  std::promise<Answer> promise;
  promise.set_value(std::move(answer));
  return promise.get_future();
}

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
  explicit Impl(ClientOptions options) : context(std::move(options)) {
    error = fault_in(context.options());
    if (!error.empty()) return;
    error_status = Status::kNetworkUnusable;
    error = connection.open(context.options().url);
    context.set_url(connection.url());
    if (!connection.warning().empty()) {
      warning = "other hosts of the network can be heard though ttl is 0: " + connection.warning();
    }
    if (const auto& authentication = context.options().authentication) {
      connection.authenticate(authentication->begin());
    }
    if (error.empty()) engine.emplace(connection, context);
  }

  /// Returns why no call can be made, or nothing.
  std::optional<Failure> failure() const {
    if (!error.empty()) return Failure{error_status, error};
    return std::nullopt;
  }

  /// Returns why no call can be made that waits for its answer, or nothing.
  std::optional<Failure> failure_to_wait() const {
    if (engine && engine->is_this_thread()) {
      return Failure{Status::kBusy,
                     "a handler of this client must not wait for it; use plan_async there"};
    }
    return failure();
  }

  SceneAnswer ask(scene_request_t request, const Bytes& upload = {}) {
    if (const auto why = failure_to_wait()) return failed<SceneAnswer>(*why);
    return ask_scene(asker(), std::move(request), upload);
  }

  SceneAnswer ask_list(scene_request_t request) {
    if (const auto why = failure_to_wait()) return failed<SceneAnswer>(*why);
    return ask_scene_list(asker(), std::move(request));
  }

  SceneAsker asker() { return {context, *engine, scene_cancel}; }

  Context context;
  LcmConnection connection;
  std::string error;
  std::string warning;
  Status error_status = Status::kInvalid;
  SceneCancel scene_cancel;
  std::optional<Engine> engine;  ///< last member: its thread uses the others
};

Client::Client(ClientOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}

Client::~Client() {
  if (!impl_->engine || !impl_->engine->is_this_thread()) return;
  // The engine's thread uses `impl_` until the handler has returned, so it destroys it at its end.
  Engine& engine = *impl_->engine;
  engine.close_from_handler(
      [impl = std::shared_ptr<Impl>(std::move(impl_))]() mutable { impl.reset(); });
}

const std::string& Client::error() const { return impl_->error; }

const std::string& Client::warning() const { return impl_->warning; }

const std::string& Client::client_id() const { return impl_->context.options().client_id; }

PlanResponse Client::plan(const PlanRequest& request) {
  if (const auto failure = impl_->failure_to_wait()) return failed<PlanResponse>(*failure);
  return plan_async(request).answer.get();
}

PendingPlan Client::plan_async(const PlanRequest& request, PlanHandlers handlers) {
  std::optional<Failure> failure = impl_->failure();
  if (!failure) {
    if (auto fault = fault_in_form(request)) failure = Failure{Status::kInvalid, *fault};
  }
  if (failure) {
    const auto response = failed<PlanResponse>(*failure);
    call_handler(handlers.on_answer, response);
    return {0, ready(response)};
  }
  PlanRequest sent = request;
  if (handlers.on_progress && !(sent.progress_period_s > 0.0)) {
    sent.progress_period_s = kProgressPeriod_s;
  }
  const std::int64_t id =
      request.request_id != 0 ? request.request_id : impl_->context.new_request_id();
  const auto call = std::make_shared<PlanCall>(impl_->context, sent, id, std::move(handlers));
  PendingPlan pending{id, call->answer()};
  impl_->engine->start(call);
  return pending;
}

void Client::cancel(std::int64_t request_id) {
  if (impl_->engine) impl_->engine->cancel(Call::Kind::kPlan, request_id);
}

std::int64_t Client::watch(const PlanRequest& request, WatchHandler on_event) {
  std::optional<Failure> failure = impl_->failure();
  if (!failure) {
    if (auto fault = fault_in_form(request)) failure = Failure{Status::kInvalid, *fault};
  }
  if (failure) {
    WatchEvent event;
    event.kind = WatchEvent::Kind::kEnded;
    event.status = failure->status;
    event.error = failure->error;
    call_handler(on_event, event);
    return 0;
  }
  PlanRequest sent = request;
  if (sent.request_id == 0) sent.request_id = impl_->context.new_request_id();
  sent.watch_lease_s = impl_->context.options().watch_lease_s;
  impl_->engine->watch(sent, std::move(on_event));
  return sent.request_id;
}

void Client::unwatch(std::int64_t request_id) {
  if (impl_->engine) impl_->engine->unwatch(request_id);
}

void Client::take_better(std::int64_t request_id) {
  if (impl_->engine) impl_->engine->take_better(request_id);
}

bool Client::unwatch(std::int64_t request_id, double timeout_s) {
  if (impl_->failure_to_wait()) return false;
  return impl_->engine->unwatch(request_id, after(timeout_s)).get();
}

OccupancyAnswer Client::occupancy(const OccupancyBatch& batch) {
  if (const auto failure = impl_->failure_to_wait()) return failed<OccupancyAnswer>(*failure);
  return ask_occupancy(impl_->context, *impl_->engine, batch);
}

SceneAnswer Client::load_scene(const std::string& scene, const SceneMesh& mesh,
                               double occupancy_resolution_m, const Bounds& body_bounds) {
  scene_request_t request = request_for(scene_request_t::LOAD, scene);
  request.occupancy_resolution_m = occupancy_resolution_m;
  convert(body_bounds, request.body_bounds);
  const Bytes upload = put_mesh(mesh, request);
  return impl_->ask(std::move(request), upload);
}

SceneAnswer Client::unload_scene(const std::string& scene) {
  return impl_->ask(request_for(scene_request_t::UNLOAD, scene));
}

SceneAnswer Client::list_scenes() {
  return impl_->ask_list(request_for(scene_request_t::LIST, ""));
}

SceneAnswer Client::describe_scene(const std::string& scene) {
  return impl_->ask_list(request_for(scene_request_t::DESCRIBE, scene));
}

SceneAnswer Client::put_object(const std::string& scene, const std::string& object,
                               const SceneShape& shape, const Pose& pose) {
  scene_request_t request = request_for(scene_request_t::PUT, scene, object);
  const Bytes upload = put_shape(shape, request);
  put_pose(pose, request);
  return impl_->ask(std::move(request), upload);
}

SceneAnswer Client::move_object(const std::string& scene, const std::string& object,
                                const Pose& pose) {
  scene_request_t request = request_for(scene_request_t::MOVE, scene, object);
  put_pose(pose, request);
  return impl_->ask(std::move(request));
}

SceneAnswer Client::remove_object(const std::string& scene, const std::string& object) {
  return impl_->ask(request_for(scene_request_t::REMOVE, scene, object));
}

SceneAnswer Client::scene_history(const std::string& scene) {
  return impl_->ask_list(request_for(scene_request_t::HISTORY, scene));
}

SceneAnswer Client::restore_scene(const std::string& scene, std::int64_t revision,
                                  const std::string& restore_as) {
  scene_request_t request = request_for(scene_request_t::RESTORE, scene);
  request.revision = revision;
  request.restore_as = restore_as;
  return impl_->ask(std::move(request));
}

SceneAnswer Client::insert_scan(const std::string& scene, const std::string& object,
                                const std::vector<std::array<double, 3>>& points_m,
                                const std::array<double, 3>& origin_m) {
  if (points_m.empty()) return failed<SceneAnswer>({Status::kInvalid, "points_m: are none"});
  scene_request_t request = request_for(scene_request_t::SCAN, scene, object);
  std::copy(origin_m.begin(), origin_m.end(), request.position_m);
  const Bytes upload = put_points(points_m, request);
  return impl_->ask(std::move(request), upload);
}

SceneMap Client::export_map(const std::string& scene) {
  if (const auto why = impl_->failure_to_wait()) return failed<SceneMap>(*why);
  return ask_scene_map(impl_->asker(), request_for(scene_request_t::EXPORT, scene));
}

SceneTriangles Client::object_triangles(const std::string& scene, const std::string& digest) {
  if (const auto why = impl_->failure_to_wait()) return failed<SceneTriangles>(*why);
  scene_request_t request = request_for(scene_request_t::TRIANGLES, scene);
  request.digest = digest;
  return ask_triangles(impl_->asker(), request);
}

SceneAnswer Client::export_map_to(const std::string& scene, const std::string& file) {
  scene_request_t request = request_for(scene_request_t::EXPORT, scene);
  request.file = file;
  if (file.empty()) return failed<SceneAnswer>({Status::kInvalid, "file: is empty"});
  return impl_->ask(std::move(request));
}

void Client::cancel_scene_calls() {
  if (impl_->engine) impl_->scene_cancel.cancel(*impl_->engine);
}

DaemonStatus Client::status(double timeout_s) {
  if (const auto failure = impl_->failure_to_wait()) return failed<DaemonStatus>(*failure);
  const std::optional<DaemonStatus> heartbeat =
      impl_->engine->next_heartbeat(after(timeout_s)).get();
  if (heartbeat) return *heartbeat;
  return failed<DaemonStatus>(impl_->context.explain(Outcome::kSilence, false, {}, {}));
}

}  // namespace camway
