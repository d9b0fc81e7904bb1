// SPDX-License-Identifier: MIT
#include "tools/view/daemon/planner_daemon.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string_view>
#include <utility>

#include "tools/answers/plan_answer.h"
#include "tools/answers/scene_record.h"
#include "tools/support/client_request.h"
#include "tools/support/client_response.h"
#include "tools/support/watch_event_name.h"
#include "tools/view/daemon/daemon_meshes.h"
#include "tools/view/daemon/daemon_scenes.h"
#include "tools/view/daemon/heartbeats.h"
#include "tools/view/daemon/status_json.h"
#include "tools/view/here/path_proof.h"
#include "tools/view/here/scene_parts.h"
#include "tools/view/reporter.h"
#include "tools/view/work_pool.h"

namespace camway::view {
namespace {

/// Calls about scenes wait for the daemon; so many of them wait at a time.
constexpr int kCallers = 4;

/// Proofs take a core each, and others of them wait.
constexpr int kProvers = 2;

std::string_view name_of(PlanProgress::Stage stage) {
  switch (stage) {
    case PlanProgress::Stage::kWaiting:
      return "waiting";
    case PlanProgress::Stage::kPreparing:
      return "preparing";
    case PlanProgress::Stage::kDetecting:
      return "detecting";
    case PlanProgress::Stage::kCorrecting:
      return "correcting";
    case PlanProgress::Stage::kCertifying:
      return "certifying";
  }
  return "unknown";
}

std::string progress_json(const PlanProgress& progress) {
  return fmt::format(
      "{{\"stage\": \"{}\", \"collisions\": {}, \"corrected\": {}, \"elapsed_s\": {:.3f}, "
      "\"deadline_s\": {}, \"requests_ahead\": {}}}",
      name_of(progress.stage), progress.num_collisions, progress.num_corrected,
      progress.since_receipt_s, progress.deadline_s, progress.requests_ahead);
}

tools::PlanAnswer to_plan_answer(const PlanResponse& response, const PlanOrder& order) {
  tools::PlanAnswer answer;
  answer.scene = order.scene;
  answer.scene_digest = response.scene_digest;
  answer.vertical_axis = tools::vertical_axis(std::nullopt, order.request);
  answer.request_warnings = tools::request_warnings(order.request);
  answer.result = tools::to_plan_result(response);
  return answer;
}

Answer no_daemon() { return failure(code::kNoDaemon, "no daemon is heard"); }

class DaemonJob final : public Job {
 public:
  DaemonJob(Client& client, std::int64_t id) : client_(client), id_(id) {}
  void cancel() override { client_.cancel(id_); }

 private:
  Client& client_;
  const std::int64_t id_;
};

class PathWatch final : public Watch {
 public:
  PathWatch(Client& client, std::int64_t id) : client_(client), id_(id) {}
  ~PathWatch() override { client_.unwatch(id_); }
  PathWatch(const PathWatch&) = delete;
  PathWatch& operator=(const PathWatch&) = delete;

 private:
  Client& client_;
  const std::int64_t id_;
};

std::string event_json(const WatchEvent& event, const PlanOrder& order) {
  std::string json = fmt::format("{{\"kind\": \"{}\", \"scene_revision\": {}",
                                 tools::name_of(event.kind), event.scene_revision);
  if (event.kind == WatchEvent::Kind::kBroken) {
    std::string_view separator = ", \"broken\": [";
    for (const CollisionInterval& interval : event.broken) {
      json += fmt::format("{}{{\"t_begin\": {}, \"t_end\": {}}}", std::exchange(separator, ", "),
                          interval.t_begin_s, interval.t_end_s);
    }
    json += event.broken.empty() ? ", \"broken\": []" : "]";
  }
  if (event.answer && tools::has_result(event.answer->status)) {
    const auto text = tools::answer_text(to_plan_answer(*event.answer, order));
    if (text) json += ", \"answer\": " + *text;
  }
  if (!event.error.empty()) json += ", \"error\": " + json_string(event.error);
  return json + "}";
}

class PlannerDaemon final : public Backend {
 public:
  PlannerDaemon(std::string scene, const ClientOptions& options)
      : scene_(std::move(scene)), client_(std::in_place, options) {
    if (!client_->good()) return;
    meshes_.emplace(*client_);
    heartbeats_.emplace(*client_);
    heartbeats_->on_silence([this] {
      fail_plans();
      client_->cancel_scene_calls();
    });
  }
  ~PlannerDaemon() override {
    stop_calls();
    heartbeats_.reset();
    // Its last answers go to the writer.
    client_.reset();
    writer_.stop();
  }
  PlannerDaemon(const PlannerDaemon&) = delete;
  PlannerDaemon& operator=(const PlannerDaemon&) = delete;

  /// Returns why no daemon can be asked; empty if one can.
  [[nodiscard]] const std::string& error() const { return client_->error(); }

  [[nodiscard]] std::string scene() const override { return scene_; }
  std::shared_ptr<Job> plan(PlanOrder order, Tell progress, Done done) override;
  std::shared_ptr<Job> check(CheckOrder order, Done done) override;
  void ask_scene(SceneOrder order, Done done) override;
  void status(Done done) override;
  void mesh(std::string scene, std::string digest, MeshDone done) override;
  void triangles(std::string scene, std::vector<std::int64_t> indices, Done done) override;
  std::unique_ptr<Watch> watch_scenes(Tell event) override {
    return heartbeats_->watch(std::move(event));
  }
  std::unique_ptr<Watch> watch_path(PlanOrder order, Tell event) override;
  [[nodiscard]] std::shared_ptr<const LastPlan> last() const override;

 private:
  /// Runs a call that waits for the daemon on one of these threads. Answers at once if the daemon
  /// is silent.
  void call(WorkPool& threads, Done done, std::function<Answer()> ask);
  /// Runs work on one of these threads.
  void run(WorkPool& threads, Done done, std::function<Answer()> ask);
  /// Returns the answer, or that no daemon is heard if it was cancelled for that.
  [[nodiscard]] Answer unless_silent(Answer answer);
  void stop_calls();
  /// Returns who is to be told of a plan; null if that was done.
  std::shared_ptr<Reporter> take_plan(std::uint64_t key);
  /// Answers plans that are under way: the daemon is silent.
  void fail_plans();
  [[nodiscard]] Answer planned(const PlanResponse& response, const PlanOrder& order);
  /// Fetches the triangles of a scene for pictures of paths, unless they are here or on their way.
  void fetch_walls(const std::string& scene, const std::string& digest);
  [[nodiscard]] Answer checked(const CheckOrder& order, const StoppableJob& job);
  [[nodiscard]] Answer status_answer();

  const std::string scene_;
  mutable std::mutex mutex_;  ///< guards what is below
  std::condition_variable call_ended_;
  int calls_ = 0;  ///< calls that run
  bool has_stopped_ = false;
  std::shared_ptr<const LastPlan> last_;
  std::string walls_asked_;  ///< digest of the scene whose triangles were asked for last
  std::map<std::uint64_t, std::shared_ptr<Reporter>> plans_;  ///< those without an answer
  std::uint64_t last_plan_ = 0;                               ///< last key of `plans_`
  WorkPool writer_{1};  ///< writes answers, which would take the time of the client's thread
  std::optional<Client> client_;
  std::optional<DaemonMeshes> meshes_;    ///< set unless the client has an error
  std::optional<Heartbeats> heartbeats_;  ///< set unless the client has an error
  std::stop_source proofs_;
  WorkPool callers_{kCallers};
  WorkPool provers_{kProvers};
};

std::shared_ptr<Job> PlannerDaemon::plan(PlanOrder order, Tell progress, Done done) {
  PlanHandlers handlers;
  PlanRequest request = tools::to_client_request(order.request, order.scene);
  if (progress) {
    constexpr double kProgressPeriod_s = 0.1;
    request.progress_period_s = kProgressPeriod_s;
    handlers.on_progress = [progress = std::move(progress)](const PlanProgress& state) {
      progress(progress_json(state));
    };
  }
  auto reporter = std::make_shared<Reporter>(std::move(done));
  // The client would repeat the request for seconds.
  if (heartbeats_->is_silent()) {
    reporter->report(no_daemon());
    return nullptr;
  }
  std::uint64_t key = 0;
  {
    const std::lock_guard lock(mutex_);
    key = ++last_plan_;
    plans_.emplace(key, std::move(reporter));
  }
  auto asked = std::make_shared<const PlanOrder>(std::move(order));
  handlers.on_answer = [this, asked, key](const PlanResponse& response) {
    writer_.post([this, asked, key, response] {
      if (const auto told = take_plan(key)) told->report(planned(response, *asked));
    });
  };
  const PendingPlan pending = client_->plan_async(request, std::move(handlers));
  return std::make_shared<DaemonJob>(*client_, pending.request_id);
}

std::shared_ptr<Reporter> PlannerDaemon::take_plan(std::uint64_t key) {
  const std::lock_guard lock(mutex_);
  const auto found = plans_.find(key);
  if (found == plans_.end()) return nullptr;
  std::shared_ptr<Reporter> reporter = std::move(found->second);
  plans_.erase(found);
  return reporter;
}

void PlannerDaemon::fail_plans() {
  const std::lock_guard lock(mutex_);
  for (auto& [key, reporter] : plans_)
    writer_.post([reporter = std::move(reporter)] { reporter->report(no_daemon()); });
  plans_.clear();
}

Answer PlannerDaemon::planned(const PlanResponse& response, const PlanOrder& order) {
  if (!tools::has_result(response.status) || response.status == Status::kUnknownScene) {
    return failure(code_of(response.status), response.error);
  }
  tools::PlanAnswer answer = to_plan_answer(response, order);
  const base::Result<std::string> text = tools::answer_text(answer);
  if (!text) return failure(code::kOurFault, "the answer cannot be written: " + text.error);
  auto last = std::make_shared<const LastPlan>(
      LastPlan{order.request, std::move(answer.result), nullptr, order.text,
               std::make_shared<const std::string>(*text), answer.scene_digest});
  fetch_walls(order.scene, answer.scene_digest);
  const std::lock_guard lock(mutex_);
  last_.swap(last);
  return {code::kOk, *text, {}};
}

Answer PlannerDaemon::unless_silent(Answer answer) {
  return answer.code == code::kCancelled && heartbeats_->is_silent() ? no_daemon()
                                                                     : std::move(answer);
}

void PlannerDaemon::call(WorkPool& threads, Done done, std::function<Answer()> ask) {
  // The client would repeat the question for seconds.
  run(threads, std::move(done), [this, ask = std::move(ask)] {
    return heartbeats_->is_silent() ? no_daemon() : unless_silent(ask());
  });
}

void PlannerDaemon::run(WorkPool& threads, Done done, std::function<Answer()> ask) {
  auto reporter = std::make_shared<Reporter>(std::move(done));
  threads.post([this, reporter, ask = std::move(ask)] {
    {
      const std::lock_guard lock(mutex_);
      if (has_stopped_) return;
      ++calls_;
    }
    reporter->report(ask());
    const std::lock_guard lock(mutex_);
    --calls_;
    call_ended_.notify_all();
  });
}

void PlannerDaemon::stop_calls() {
  constexpr std::chrono::milliseconds kAgain{20};
  if (heartbeats_) heartbeats_->stop();
  proofs_.request_stop();
  {
    std::unique_lock lock(mutex_);
    has_stopped_ = true;
    while (calls_ > 0) {
      // Repeated, because a call may not have reached the client yet.
      lock.unlock();
      client_->cancel_scene_calls();
      lock.lock();
      call_ended_.wait_for(lock, kAgain, [this] { return calls_ == 0; });
    }
  }
  callers_.stop();
  provers_.stop();
}

void PlannerDaemon::ask_scene(SceneOrder order, Done done) {
  call(callers_, std::move(done), [this, order = std::move(order)] {
    Answer answer = ask_daemon_scene(*client_, order,
                                     [this](const SceneInfo& scene, const SceneObject& object) {
                                       return meshes_->mesh_digest(scene, object);
                                     });
    if (order.is_change() && answer.code == code::kOk) {
      // Heartbeats tell of it as well, up to a second later.
      const SceneAnswer list = client_->list_scenes();
      if (list.ok()) heartbeats_->scenes_changed(list.scenes);
    }
    return answer;
  });
}

void PlannerDaemon::status(Done done) {
  run(callers_, std::move(done), [this] { return status_answer(); });
}

Answer PlannerDaemon::status_answer() {
  const std::optional<DaemonStatus> status = heartbeats_->wait();
  if (!status) return no_daemon();
  return {
      code::kOk,
      fmt::format("{{\"planner\": \"daemon\", \"scene\": {}, \"daemon\": {}}}", json_string(scene_),
                  status_json(*status).dump(-1, ' ', false,
                                            nlohmann::ordered_json::error_handler_t::replace)),
      {}};
}

std::shared_ptr<Job> PlannerDaemon::check(CheckOrder order, Done done) {
  auto job = std::make_shared<StoppableJob>();
  run(provers_, std::move(done),
      [this, job, order = std::move(order)] { return checked(order, *job); });
  return job;
}

Answer PlannerDaemon::checked(const CheckOrder& order, const StoppableJob& job) {
  if (heartbeats_->is_silent()) return no_daemon();
  const RebuiltScene scene = meshes_->rebuilt(order.scene);
  if (!scene.snapshot) return unless_silent(failure(scene.code, scene.error));
  if (scene.lacks_inside) {
    return failure(code::kNotOffered,
                   "the scene has an occupancy map, whose inside a daemon does not send; "
                   "camway check and camway view --scene FILE prove paths in it");
  }
  return proof_of(order, scene.snapshot, job.token(), proofs_.get_token());
}

void PlannerDaemon::mesh(std::string scene, std::string digest, MeshDone done) {
  auto found = std::make_shared<MeshAnswer>();
  const auto report = [found, done = std::move(done)](Answer answer) {
    found->code = answer.code;
    found->error = std::move(answer.error);
    if (answer.code != code::kOk) found->mesh = nullptr;
    done(std::move(*found));
  };
  run(callers_, report, [this, found, scene = std::move(scene), digest = std::move(digest)] {
    // A mesh that is kept here needs no daemon.
    if (heartbeats_->is_silent() && !meshes_->keeps(digest)) return no_daemon();
    *found = meshes_->mesh(scene, digest);
    return unless_silent({found->code, {}, found->error});
  });
}

void PlannerDaemon::triangles(std::string scene, std::vector<std::int64_t> indices, Done done) {
  call(callers_, std::move(done), [this, scene = std::move(scene), indices = std::move(indices)] {
    const RebuiltScene found = meshes_->rebuilt(scene);
    if (!found.snapshot) return failure(found.code, found.error);
    return scene_triangles(*found.snapshot, indices);
  });
}

void PlannerDaemon::fetch_walls(const std::string& scene, const std::string& digest) {
  if (digest.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(walls_asked_, digest) == digest) return;
  }
  call(
      callers_, [](const Answer&) {},
      [this, scene] {
        meshes_->rebuilt(scene);
        return Answer{code::kOk, {}, {}};
      });
}

std::shared_ptr<const LastPlan> PlannerDaemon::last() const {
  std::shared_ptr<const LastPlan> last;
  {
    const std::lock_guard lock(mutex_);
    last = last_;
  }
  if (!last || last->mesh) return last;
  auto with_walls = std::make_shared<LastPlan>(*last);
  with_walls->mesh = meshes_->known(last->scene_digest);
  return with_walls;
}

std::unique_ptr<Watch> PlannerDaemon::watch_path(PlanOrder order, Tell event) {
  const PlanRequest request = tools::to_client_request(order.request, order.scene);
  auto asked = std::make_shared<const PlanOrder>(std::move(order));
  const std::int64_t id =
      client_->watch(request, [this, asked, event = std::move(event)](const WatchEvent& told) {
        writer_.post([asked, event, told] { event(event_json(told, *asked)); });
      });
  return std::make_unique<PathWatch>(*client_, id);
}

}  // namespace

base::Result<std::unique_ptr<Backend>> plan_by_daemon(std::string scene,
                                                      const ClientOptions& options) {
  auto backend = std::make_unique<PlannerDaemon>(std::move(scene), options);
  if (!backend->error().empty()) return base::Failure{backend->error()};
  return std::unique_ptr<Backend>(std::move(backend));
}

}  // namespace camway::view
