// SPDX-License-Identifier: MIT
#include "daemon/process/configured_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "daemon/planning/request/request.h"
#include "daemon/process/settings/bounds_text.h"
#include "daemon/scene/import/import.h"
#include "daemon/scene/import/import_warnings.h"
#include "daemon/scene/mirror/scene_mirror.h"
#include "daemon/service/scenes/scene_rules.h"

namespace camway::process {
namespace {

std::string text_of(const geometry::Vec3& point) {
  return fmt::format("{:.3g},{:.3g},{:.3g}", point.x(), point.y(), point.z());
}

void log_scene(const scene::Snapshot& snapshot, const SceneArgument& scene, bool is_from_cache,
               service::Log& log) {
  const scene::ImportReport& report = snapshot.report;
  log.info("scene read", {{"scene", snapshot.name},
                          {"file", scene.file.string()},
                          {"format", report.format},
                          {"from_cache", is_from_cache ? "yes" : "no"},
                          {"triangles", report.triangles},
                          {"min_m", text_of(report.bounds_m.min())},
                          {"max_m", text_of(report.bounds_m.max())},
                          {"scale", report.scale},
                          {"rounding_m", report.rounding_m},
                          {"surface_error_m", report.surface_error_m},
                          {"degenerate_left_out", report.degenerate_triangles},
                          {"bad_left_out", report.dropped_nonfinite + report.dropped_bad_index},
                          {"digest", snapshot.digest}});
  for (const std::string& warning : scene::import_warnings(
           report, planning::PlanOptions{}.interval_tolerance_m, scene::kOfDefault)) {
    log.warn("scene read with a warning", {{"scene", snapshot.name}, {"warning", warning}});
  }
  if (snapshot.occupancy) {
    log.info("occupancy map built",
             {{"scene", snapshot.name},
              {"occupied_voxels", snapshot.occupancy->statistics().occupied_voxels},
              {"resolution_m", snapshot.occupancy->resolution_m()}});
  }
}

/// Returns whether the object has the content that was read. Maps are never equal here: two may
/// have the same faces, and differ in which side is solid.
bool has_content(const scene::SceneObject& object, const scene::ImportResult& read) {
  return !read.map && !object.source->map_O &&
         scene::mesh_digest(*read.mesh) == scene::mesh_digest(*object.source->parts_O.front().mesh);
}

std::shared_ptr<const scene::ObjectSource> source_of(scene::ImportResult read,
                                                     const scene::ObjectOptions& options) {
  if (read.map) {
    return scene::make_map_source(std::move(read.map), std::move(read.report), options,
                                  read.map_origin_m);
  }
  return scene::make_source(scene::ObjectKind::kMesh, std::move(*read.mesh), std::move(read.report),
                            options);
}

std::string text_of(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "none";
}

/// Returns whether a scene was made with the options that are said of the whole scene.
bool has_options(const scene::Snapshot& kept, const SceneArgument& scene) {
  return kept.options.occupancy_resolution_m == scene.options.occupancy_resolution_m &&
         kept.options.bounds == scene.options.bounds;
}

bool same(const SceneArgument& a, const SceneArgument& b) {
  return a.name == b.name && a.file == b.file && a.options.import.scale == b.options.import.scale &&
         a.options.import.up == b.options.import.up &&
         a.options.import.unknown == b.options.import.unknown &&
         a.options.import.voxel_m == b.options.import.voxel_m &&
         a.options.occupancy_resolution_m == b.options.occupancy_resolution_m &&
         a.options.bounds == b.options.bounds;
}

}  // namespace

bool ConfiguredScenes::update(const std::vector<SceneArgument>& wanted,
                              const std::stop_token& stop) {
  fault_.clear();
  std::vector<Held> next;
  std::vector<std::shared_ptr<const scene::Snapshot>> loaded;
  for (const SceneArgument& scene : wanted) {
    // Taken before reading, so that a change during the reading is noticed the next time.
    next.push_back({scene, FileStamp::of(scene.file)});
    if (holds(next.back()) || holds_from_log(next.back(), stop)) continue;
    if (stop.stop_requested()) return false;
    loaded.push_back(load(scene, stop));
    if (!loaded.back()) return false;
  }
  remove_all_but(wanted);
  held_ = std::move(next);
  bool all = true;
  for (std::shared_ptr<const scene::Snapshot>& snapshot : loaded) {
    const std::string name = snapshot->name;
    warn_of_losses(name);
    const auto held =
        std::ranges::find(held_, name, [](const Held& each) { return each.scene.name; });
    scene::ChangeNote note{.operation = "load"};
    // Processes that begin at the same time put a scene once.
    if (is_shared_) {
      note.request = "configured " + SceneOrigins::options_of(held->scene) + snapshot->digest;
    }
    const scene::StoreResult put = store_.put(std::move(snapshot), std::move(note));
    if (put.snapshot) {
      origins_.set(held->scene, held->stamp);
      continue;
    }
    const std::string reason = service::with_setting(put.error, put.limit);
    log_->error("scene cannot be held", {{"scene", name}, {"reason", reason}});
    note_fault(name, reason);
    // Tried again the next time. An older scene of that name stays until it is no longer wanted.
    held->stamp = {};
    all = false;
  }
  return all;
}

void ConfiguredScenes::warn_of_losses(const std::string& name) {
  const auto before = store_.find(name);
  const std::size_t own = before && before->find(name) != nullptr ? 1 : 0;
  if (!before || before->objects.size() == own) return;
  log_->warn(
      "scene is read anew, what clients added to it goes",
      {{"scene", name}, {"revision", before->revision}, {"objects", before->objects.size() - own}});
}

void ConfiguredScenes::note_fault(const std::string& scene, const std::string& reason) {
  if (fault_.empty()) fault_ = fmt::format("scene '{}': {}", scene, reason);
}

void ConfiguredScenes::remove_all_but(const std::vector<SceneArgument>& wanted) {
  for (const Held& held : held_) {
    if (std::ranges::find(wanted, held.scene.name, &SceneArgument::name) == wanted.end()) {
      remove(held.scene.name);
    }
  }
  // Scenes of an earlier process with the same log.
  for (const std::string& name : origins_.names()) {
    if (std::ranges::find(wanted, name, &SceneArgument::name) == wanted.end()) remove(name);
  }
}

// The note of this process says first that it drops the scene, and forgets the scene last. So if
// the process ends in between, the next one begins again; and of two processes that drop a scene at
// once, the second one to say so sees that the other one does, too, and removes it. A process that
// begins to want the scene between the look at the notes and the removal loses it until its next
// start.
void ConfiguredScenes::remove(const std::string& name) {
  origins_.mark_dropped(name, true);
  const base::Result<std::string> other = origins_.other_owner_of(name);
  if (!other) {
    log_->warn("scene is not unloaded: it is not known whether another front configures it",
               {{"scene", name}, {"reason", other.error}});
    return;
  }
  if (!other->empty()) {
    origins_.erase(name);
    log_->info("scene kept: another front configures it", {{"scene", name}, {"front", *other}});
    return;
  }
  const scene::StoreResult removed = store_.remove(name);
  if (!removed.snapshot && removed.fault != scene::StoreFault::kUnknownScene) {
    log_->error("scene cannot be unloaded", {{"scene", name}, {"reason", removed.error}});
    return;
  }
  origins_.erase(name);
  log_->info("scene unloaded", {{"scene", name}});
}

bool ConfiguredScenes::watches_files() const {
  return std::ranges::any_of(held_, [](const Held& held) { return held.scene.watch; });
}

void ConfiguredScenes::look_at_files(const std::stop_token& stop) {
  for (Held& held : held_) {
    if (stop.stop_requested()) return;
    if (held.scene.watch) look_at(held, stop);
  }
}

void ConfiguredScenes::look_at(Held& held, const std::stop_token& stop) {
  const FileStamp now = FileStamp::of(held.scene.file);
  const bool is_stable = std::exchange(held.seen, now) == now;
  if (now == held.tried || !is_stable) return;
  const FileStamp tried = std::exchange(held.tried, now);
  if (now == FileStamp{}) {
    log_->warn("scene file is gone, what was read of it stays",
               {{"scene", held.scene.name}, {"file", held.scene.file.string()}});
    return;
  }
  if (read_again(held.scene, stop)) {
    held.stamp = now;
    origins_.set(held.scene, now);
  } else if (stop.stop_requested()) {
    held.tried = tried;
  }
}

bool ConfiguredScenes::read_again(const SceneArgument& scene, const std::stop_token& stop) {
  const auto before = store_.find(scene.name);
  const scene::SceneObject* const object = before ? before->find(scene.name) : nullptr;
  if (object == nullptr) {
    log_->info("scene file changed, but a client has taken it out",
               {{"scene", scene.name}, {"file", scene.file.string()}});
    return false;
  }
  log_->info("reading scene", {{"scene", scene.name}, {"file", scene.file.string()}});
  scene::ImportResult read = scene::import_mesh(scene.file, scene.options.import, stop);
  if (stop.stop_requested()) return false;
  if (!read.mesh) {
    log_->warn("scene file cannot be read again, what was read before stays",
               {{"scene", scene.name}, {"reason", service::with_setting(read.error, read.limit)}});
    return false;
  }
  if (has_content(*object, read)) return true;
  const auto source = source_of(std::move(read), before->options);
  // Reading takes a while, in which clients may move the object or take it out.
  const auto put = [&](const scene::Snapshot& newest) -> scene::MadeChange {
    const scene::SceneObject* const now = newest.find(scene.name);
    if (now == nullptr) return {{}, "a client has taken it out"};
    return {scene::SceneChange{scene::SceneChange::Kind::kPut, scene.name, source, now->placement}};
  };
  const scene::StoreResult changed = store_.change(scene.name, scene::ChangeMaker(put),
                                                   {.operation = "put", .object = scene.name});
  if (!changed.snapshot) {
    log_->warn(
        "scene cannot be changed, what was read before stays",
        {{"scene", scene.name}, {"reason", service::with_setting(changed.error, changed.limit)}});
    return false;
  }
  log_->info("scene file changed", {{"scene", scene.name},
                                    {"file", scene.file.string()},
                                    {"revision", changed.snapshot->revision}});
  log_scene(*changed.snapshot, scene, false, *log_);
  return true;
}

bool ConfiguredScenes::holds(const Held& wanted) const {
  return std::any_of(held_.begin(), held_.end(), [&](const Held& held) {
    return same(held.scene, wanted.scene) && held.stamp == wanted.stamp;
  });
}

bool ConfiguredScenes::holds_from_log(const Held& wanted, const std::stop_token& stop) {
  const SceneArgument& scene = wanted.scene;
  if (std::ranges::any_of(held_, [&](const Held& held) { return held.scene.name == scene.name; })) {
    return false;
  }
  const std::optional<SceneOrigins::Origin> origin = origins_.find(scene.name);
  // Before the scene is looked for: others that drop it have to see that it is wanted.
  if (is_shared_ && !origin) origins_.set(scene, {});
  origins_.mark_dropped(scene.name, false);
  const auto kept = store_.find(scene.name);
  if (!kept || (!origin && !is_shared_)) return false;
  const bool has_other_options =
      origin && !origin->arguments.ends_with(SceneOrigins::scene_options_of(scene));
  if (has_other_options && !has_options(*kept, scene)) return false;
  log_->info("scene kept",
             {{"scene", scene.name}, {"revision", kept->revision}, {"digest", kept->digest}});
  warn_of_options(*kept, scene);
  const std::string other = origins_.other_reader_of(scene);
  if (!other.empty()) {
    log_->warn(
        "another front reads the scene with another scale, up, unknown or voxel_m: the one that "
        "was started last counts",
        {{"scene", scene.name}, {"front", other}});
  }
  if (other.empty() && origin && origin->stamp == wanted.stamp &&
      origin->arguments == SceneOrigins::arguments_of(scene)) {
    return true;
  }
  if (wanted.stamp == FileStamp{}) {
    log_->warn("scene file is gone, what was kept of it stays",
               {{"scene", scene.name}, {"file", scene.file.string()}});
  } else if (read_again(scene, stop)) {
    origins_.set(scene, wanted.stamp);
  }
  return true;
}

void ConfiguredScenes::warn_of_options(const scene::Snapshot& kept, const SceneArgument& scene) {
  const auto warn = [&](std::string_view option, const std::string& made, const std::string& said) {
    if (made == said) return;
    log_->warn("scene was made with another option, which it keeps: unload it to have it made anew",
               {{"scene", scene.name}, {"option", option}, {"kept", made}, {"configured", said}});
  };
  warn("occupancy_resolution_m", text_of(kept.options.occupancy_resolution_m),
       text_of(scene.options.occupancy_resolution_m));
  warn("bounds", bounds_text(kept.options.bounds), bounds_text(scene.options.bounds));
}

std::shared_ptr<const scene::Snapshot> ConfiguredScenes::load(const SceneArgument& scene,
                                                              const std::stop_token& stop) {
  log_->info("reading scene", {{"scene", scene.name}, {"file", scene.file.string()}});
  scene::SnapshotResult result = scene::load_snapshot(scene.name, scene.file, scene.options, stop,
                                                      cache_ ? &*cache_ : nullptr);
  if (stop.stop_requested()) return nullptr;
  if (!result.snapshot) {
    const std::string reason = service::with_setting(result.error, result.limit);
    log_->error("scene cannot be read",
                {{"scene", scene.name}, {"said_at", scene.set_at}, {"reason", reason}});
    note_fault(scene.name, reason);
  } else {
    log_scene(*result.snapshot, scene, result.is_from_cache, *log_);
  }
  return result.snapshot;
}

}  // namespace camway::process
