// SPDX-License-Identifier: MIT
#include "tools/view/here/planner_here.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <stop_token>
#include <utility>
#include <vector>

#include "daemon/base/progress.h"
#include "daemon/scene/import/import_warnings.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "tools/answers/plan_answer.h"
#include "tools/view/facts.h"
#include "tools/view/here/object_source.h"
#include "tools/view/here/path_proof.h"
#include "tools/view/here/progress_ticker.h"
#include "tools/view/here/scene_parts.h"
#include "tools/view/reporter.h"
#include "tools/view/work_pool.h"

namespace camway::view {
namespace {

SceneFacts facts_of(const scene::Snapshot& snapshot) {
  SceneFacts facts;
  facts.name = snapshot.name;
  facts.revision = static_cast<std::int64_t>(snapshot.revision);
  facts.digest = snapshot.digest;
  facts.triangles = static_cast<std::int64_t>(snapshot.index.size());
  if (const geometry::Box bounds = snapshot.index.bounds(); !bounds.isEmpty()) {
    std::copy_n(bounds.min().data(), 3, facts.min_m.begin());
    std::copy_n(bounds.max().data(), 3, facts.max_m.begin());
  }
  facts.body_bounds = geometry::optional_bounds_of(snapshot.options.bounds);
  return facts;
}

ObjectFacts facts_of(const scene::SceneObject& object, MeshDigests& meshes) {
  ObjectFacts facts;
  facts.mesh_digest = meshes.of(object.source);
  facts.name = object.name;
  facts.kind = scene::to_string(object.source->kind);
  facts.digest = object.digest;
  facts.triangles = static_cast<std::int64_t>(object.triangles);
  std::copy_n(object.placement.position_W().data(), 3, facts.position_m.begin());
  const geometry::Vec4 wxyz = geometry::wxyz(object.placement.orientation_WO());
  std::copy_n(wxyz.data(), 4, facts.orientation_wxyz.begin());
  if (!object.bounds_W.isEmpty()) {
    std::copy_n(object.bounds_W.min().data(), 3, facts.min_m.begin());
    std::copy_n(object.bounds_W.max().data(), 3, facts.max_m.begin());
  }
  return facts;
}

/// Returns the answer about a scene and all of its objects, or the one of that name.
Answer answer_about(const scene::Snapshot& snapshot, MeshDigests& meshes,
                    const std::string& object = {}) {
  std::vector<ObjectFacts> objects;
  for (const auto& each : snapshot.objects) {
    if (object.empty() || each->name == object) objects.push_back(facts_of(*each, meshes));
  }
  return {code::kOk, objects_json(facts_of(snapshot), objects), {}};
}

int code_of(scene::StoreFault fault) {
  switch (fault) {
    case scene::StoreFault::kUnknownScene:
      return code::kNotFound;
    case scene::StoreFault::kLimit:
    case scene::StoreFault::kFull:
      return code::kTooLarge;
    case scene::StoreFault::kInvalid:
      return code::kInvalid;
    default:
      return code::kOurFault;
  }
}

/// Those who wait for changes of scenes. Kept by them and by the backend. Thread-safe.
class SceneWatchers {
 public:
  using Key = std::uint64_t;

  Key add(Tell tell) {
    const std::lock_guard lock(mutex_);
    watchers_.emplace(++last_, std::move(tell));
    return last_;
  }
  void remove(Key key) {
    const std::lock_guard lock(mutex_);
    watchers_.erase(key);
  }
  void tell(const std::string& event) {
    std::map<Key, Tell> watchers;
    {
      const std::lock_guard lock(mutex_);
      watchers = watchers_;
    }
    for (const auto& [key, tell] : watchers) tell(event);
  }

 private:
  std::mutex mutex_;
  std::map<Key, Tell> watchers_;
  Key last_ = 0;
};

class SceneWatch final : public Watch {
 public:
  SceneWatch(std::shared_ptr<SceneWatchers> watchers, Tell tell)
      : watchers_(std::move(watchers)), key_(watchers_->add(std::move(tell))) {}
  ~SceneWatch() override { watchers_->remove(key_); }
  SceneWatch(const SceneWatch&) = delete;
  SceneWatch& operator=(const SceneWatch&) = delete;

 private:
  const std::shared_ptr<SceneWatchers> watchers_;
  const SceneWatchers::Key key_;
};

class PlannerHere final : public Backend {
 public:
  PlannerHere(std::shared_ptr<const scene::Snapshot> snapshot, const HereOptions& options)
      : name_(snapshot->name),
        text_(options.scene_text.empty() ? name_ : options.scene_text),
        reading_(options.scene_reading),
        pool_(options.threads) {
    store_.put(std::move(snapshot), {.operation = "load"});
    store_.on_change([this] { watchers_->tell(scenes_event()); });
  }
  ~PlannerHere() override {
    all_.request_stop();
    pool_.stop();
  }
  PlannerHere(const PlannerHere&) = delete;
  PlannerHere& operator=(const PlannerHere&) = delete;

  [[nodiscard]] std::string scene() const override { return name_; }
  std::shared_ptr<Job> plan(PlanOrder order, Tell progress, Done done) override;
  std::shared_ptr<Job> check(CheckOrder order, Done done) override;
  void ask_scene(SceneOrder order, Done done) override;
  void status(Done done) override;
  void mesh(std::string scene, std::string digest, MeshDone done) override;
  void triangles(std::string scene, std::vector<std::int64_t> indices, Done done) override;
  std::unique_ptr<Watch> watch_scenes(Tell event) override;
  std::unique_ptr<Watch> watch_path(PlanOrder, Tell) override { return nullptr; }
  [[nodiscard]] std::shared_ptr<const LastPlan> last() const override {
    const std::lock_guard lock(mutex_);
    return last_;
  }

 private:
  /// Runs `work` on the pool. If the backend ends before that, `done` is told so.
  template <class Work>
  void post(Done done, Work work);
  [[nodiscard]] Answer planned(const PlanOrder& order, const Tell& progress,
                               const StoppableJob& job);
  [[nodiscard]] Answer checked(const CheckOrder& order, const StoppableJob& job) const;
  [[nodiscard]] Answer asked(const SceneOrder& order);
  [[nodiscard]] Answer changed(const SceneOrder& order);
  [[nodiscard]] base::Result<scene::SceneChange> change_of(const SceneOrder& order,
                                                           const scene::Snapshot& before) const;
  [[nodiscard]] Answer unknown_scene(const std::string& scene) const;
  [[nodiscard]] std::vector<SceneFacts> all_facts() const;
  [[nodiscard]] std::string scenes_event() const {
    return fmt::format("{{\"kind\": \"scenes\", \"state\": {}}}", scenes_json(all_facts()));
  }

  const std::string name_;
  const std::string text_;
  const std::optional<scene::ImportOptions> reading_;
  scene::SceneStore store_;
  MeshDigests mesh_digests_;
  const std::shared_ptr<SceneWatchers> watchers_ = std::make_shared<SceneWatchers>();
  std::stop_source all_;
  std::atomic<int> running_ = 0;
  mutable std::mutex mutex_;  ///< guards last_
  std::shared_ptr<const LastPlan> last_;
  ProgressTicker ticker_;
  WorkPool pool_;  ///< destroyed first
};

template <class Work>
void PlannerHere::post(Done done, Work work) {
  auto reporter = std::make_shared<Reporter>(std::move(done));
  pool_.post([this, reporter = std::move(reporter), work = std::move(work)]() mutable {
    ++running_;
    Answer answer = work();
    --running_;
    reporter->report(std::move(answer));
  });
}

std::shared_ptr<Job> PlannerHere::plan(PlanOrder order, Tell progress, Done done) {
  auto job = std::make_shared<StoppableJob>();
  post(std::move(done), [this, job, order = std::move(order), progress = std::move(progress)] {
    return planned(order, progress, *job);
  });
  return job;
}

Answer PlannerHere::planned(const PlanOrder& order, const Tell& progress, const StoppableJob& job) {
  const std::shared_ptr<const scene::Snapshot> snapshot = store_.find(order.scene);
  if (!snapshot) return unknown_scene(order.scene);
  std::stop_source stop;
  const std::stop_callback by_client(job.token(), [&] { stop.request_stop(); });
  const std::stop_callback by_end(all_.get_token(), [&] { stop.request_stop(); });
  const double deadline_s = order.request.options.deadline_s;
  const auto state = std::make_shared<base::Progress>();
  const base::Deadline deadline =
      base::Deadline::after_s(deadline_s).watched(stop.get_token(), state);
  tools::PlanAnswer answer;
  answer.scene = text_;
  answer.scene_reading = reading_;
  {
    const ProgressTicker::Entry entry = ticker_.enter(progress, state, deadline, deadline_s);
    tools::plan_in_scene(*snapshot, order.request, deadline, answer);
  }
  if (stop.stop_requested()) return failure(code::kCancelled, "the plan was cancelled");
  const base::Result<std::string> text = tools::answer_text(answer);
  if (!text) return failure(code::kOurFault, "the answer cannot be written: " + text.error);
  {
    auto last = std::make_shared<const LastPlan>(
        LastPlan{order.request, std::move(answer.result), snapshot->mesh.share(), order.text,
                 std::make_shared<const std::string>(*text)});
    const std::lock_guard lock(mutex_);
    last_.swap(last);
  }
  return {code::kOk, *text, {}};
}

std::shared_ptr<Job> PlannerHere::check(CheckOrder order, Done done) {
  auto job = std::make_shared<StoppableJob>();
  post(std::move(done), [this, job, order = std::move(order)] { return checked(order, *job); });
  return job;
}

Answer PlannerHere::checked(const CheckOrder& order, const StoppableJob& job) const {
  std::shared_ptr<const scene::Snapshot> snapshot = store_.find(order.scene);
  if (!snapshot) return unknown_scene(order.scene);
  return proof_of(order, std::move(snapshot), job.token(), all_.get_token());
}

void PlannerHere::ask_scene(SceneOrder order, Done done) {
  post(std::move(done), [this, order = std::move(order)] { return asked(order); });
}

Answer PlannerHere::asked(const SceneOrder& order) {
  if (order.kind == SceneOrder::Kind::kList) {
    return {code::kOk, scenes_json(all_facts()), {}};
  }
  if (order.is_change()) return changed(order);
  const std::shared_ptr<const scene::Snapshot> snapshot = store_.find(order.scene);
  return snapshot ? answer_about(*snapshot, mesh_digests_) : unknown_scene(order.scene);
}

Answer PlannerHere::changed(const SceneOrder& order) {
  const std::shared_ptr<const scene::Snapshot> before = store_.find(order.scene);
  if (!before) return unknown_scene(order.scene);
  if (order.kind != SceneOrder::Kind::kAdd && before->find(order.object) == nullptr) {
    return failure(code::kNotFound,
                   fmt::format("the scene '{}' has no object '{}'", order.scene, order.object));
  }
  base::Result<scene::SceneChange> change = change_of(order, *before);
  if (!change) return failure(code::kInvalid, change.error);
  const scene::StoreResult made = store_.change(order.scene, *std::move(change));
  if (!made.snapshot) return failure(code_of(made.fault), made.error);
  return answer_about(*made.snapshot, mesh_digests_, order.object);
}

base::Result<scene::SceneChange> PlannerHere::change_of(const SceneOrder& order,
                                                        const scene::Snapshot& before) const {
  using Kind = SceneOrder::Kind;
  scene::SceneChange change;
  change.object = order.object;
  change.kind = order.kind == Kind::kAdd    ? scene::SceneChange::Kind::kPut
                : order.kind == Kind::kMove ? scene::SceneChange::Kind::kMove
                                            : scene::SceneChange::Kind::kRemove;
  if (order.kind == Kind::kRemove) return change;
  const scene::SceneObject* const object =
      order.kind == Kind::kMove ? before.find(order.object) : nullptr;
  const scene::Placement now = object != nullptr ? object->placement : scene::Placement();
  std::string fault;
  change.placement =
      scene::Placement::make(order.position_m.value_or(now.position_W()),
                             order.orientation.value_or(now.orientation_WO()), fault);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  if (order.kind == Kind::kMove) return change;
  auto source = make_object_source(order.form, before.options);
  if (!source) return base::Failure{source.error};
  change.source = *std::move(source);
  return change;
}

Answer PlannerHere::unknown_scene(const std::string& scene) const {
  return failure(code::kNotFound, fmt::format("unknown scene '{}'; {}", scene, store_.summary()));
}

std::vector<SceneFacts> PlannerHere::all_facts() const {
  std::vector<SceneFacts> facts;
  for (const auto& snapshot : store_.list()) facts.push_back(facts_of(*snapshot));
  return facts;
}

void PlannerHere::status(Done done) {
  done({code::kOk,
        fmt::format("{{\"planner\": \"here\", \"scene\": {}, \"running\": {}, \"state\": {}}}",
                    json_string(name_), running_.load(), scenes_json(all_facts())),
        {}});
}

void PlannerHere::mesh(std::string scene, std::string digest, MeshDone done) {
  auto found = std::make_shared<MeshAnswer>();
  const auto report = [found, done = std::move(done)](Answer answer) {
    found->code = answer.code;
    found->error = std::move(answer.error);
    done(std::move(*found));
  };
  post(report, [this, found, scene = std::move(scene), digest = std::move(digest)] {
    const std::shared_ptr<const scene::Snapshot> snapshot = store_.find(scene);
    if (!snapshot) return unknown_scene(scene);
    *found = object_mesh(*snapshot, digest);
    return Answer{found->code, {}, found->error};
  });
}

void PlannerHere::triangles(std::string scene, std::vector<std::int64_t> indices, Done done) {
  post(std::move(done), [this, scene = std::move(scene), indices = std::move(indices)] {
    const std::shared_ptr<const scene::Snapshot> snapshot = store_.find(scene);
    return snapshot ? scene_triangles(*snapshot, indices) : unknown_scene(scene);
  });
}

std::unique_ptr<Watch> PlannerHere::watch_scenes(Tell event) {
  auto watch = std::make_unique<SceneWatch>(watchers_, event);
  event(scenes_event());
  return watch;
}

}  // namespace

std::unique_ptr<Backend> plan_here(std::shared_ptr<const scene::Snapshot> snapshot,
                                   const HereOptions& options) {
  return std::make_unique<PlannerHere>(std::move(snapshot), options);
}

}  // namespace camway::view
