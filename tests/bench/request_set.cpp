// SPDX-License-Identifier: MIT
#include "tests/bench/request_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <tuple>

#include "daemon/motion/spline/derive_times.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/planning/request/validate.h"
#include "daemon/scene/import/import.h"
#include "tools/json/json_request.h"

namespace camway::bench {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void give_up(const std::string& message) {
  fmt::print(stderr, "bench: {}\n", message);
  std::exit(2);
}

std::vector<fs::path> request_files(const std::string& source, const std::string& only) {
  if (!fs::exists(source)) give_up(source + ": does not exist");
  if (!fs::is_directory(source)) return {source};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(source)) {
    const std::string name = entry.path().filename().string();
    const bool wanted = name.ends_with(".json") && !name.ends_with(".index.json");
    if (wanted && name.find(only) != std::string::npos) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) give_up(source + ": holds no requests");
  return files;
}

std::string difficulty_of(const std::string& name) {
  for (const char* word : {"free", "graze", "wall", "narrow", "sealed", "impossible"}) {
    if (name.find(word) != std::string::npos) return word;
  }
  return "other";
}

BenchRequest to_bench(const fs::path& file, planning::PlanRequest request) {
  if (request.body) give_up(file.string() + ": has a body; benchmarks know cameras alone");
  std::vector<motion::Keyframe>& keyframes = request.keyframes;
  for (motion::Keyframe& keyframe : keyframes) keyframe.pose.orientation.normalize();
  if (!request.has_times) {
    std::vector<motion::Pose> poses;
    for (const motion::Keyframe& keyframe : keyframes) poses.push_back(keyframe.pose);
    const std::vector<double> times_s = motion::derive_times_s(poses);
    for (std::size_t i = 0; i < keyframes.size(); ++i) keyframes[i].time_s = times_s[i];
  }
  const std::string name = file.stem().string();
  request.has_times = true;
  return {name,
          difficulty_of(name),
          request.camera,
          motion::interpolate(keyframes),
          keyframes.size(),
          std::move(request)};
}

}  // namespace

std::shared_ptr<const scene::Mesh> load_mesh(const std::string& file, double scale) {
  scene::ImportOptions options;
  options.scale = scale;
  scene::ImportResult result = scene::import_mesh(file, options);
  if (!result.mesh) give_up(result.error);
  return std::make_shared<const scene::Mesh>(std::move(*result.mesh));
}

std::vector<BenchScene> load_requests(const RequestSource& source) {
  std::map<std::string, BenchScene> scenes;
  for (const fs::path& file : request_files(source.requests, source.only)) {
    base::Result<tools::RequestFile> parsed = tools::read_as<tools::RequestFile>(file.string());
    if (!parsed) give_up(parsed.error);
    if (const auto invalid = planning::validate(*parsed)) {
      give_up(file.string() + ": " + invalid->message);
    }
    const fs::path named = file.parent_path() / parsed->scene;
    const std::string scene_file =
        source.scene.empty() ? fs::weakly_canonical(named).string() : source.scene;
    BenchScene& scene = scenes[scene_file];
    if (!scene.mesh) {
      scene.name = fs::path(scene_file).stem().string();
      scene.mesh = load_mesh(scene_file, source.scale);
    }
    BenchRequest request = to_bench(file, std::move(*parsed));
    const auto same =
        std::ranges::count(scene.requests, request.difficulty, &BenchRequest::difficulty);
    if (static_cast<std::size_t>(same) >= source.each) continue;
    scene.requests.push_back(std::move(request));
  }
  std::vector<BenchScene> list;
  for (auto& [file, scene] : scenes) list.push_back(std::move(scene));
  return list;
}

std::vector<BenchScene> load_sets(const RequestSource& source,
                                  const std::vector<RequestSet>& sets) {
  if (sets.empty()) return load_requests(source);
  std::vector<BenchScene> scenes;
  for (const RequestSet& set : sets) {
    RequestSource one = source;
    std::tie(one.requests, one.scene, one.scale) = set;
    std::ranges::move(load_requests(one), std::back_inserter(scenes));
  }
  return scenes;
}

std::string own_scenes() { return CAMWAY_SCENES_FOLDER; }

}  // namespace camway::bench
