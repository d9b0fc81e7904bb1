// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/known_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include "tests/bench/fidelity/changed_ranges.h"
#include "tests/bench/measure.h"

namespace camway::bench {

namespace {

using motion::CubicPath;
using motion::CubicPiece;
using nlohmann::json;

template <class Point>
void append(const Point& point, json& numbers) {
  for (const double coordinate : point) numbers.push_back(coordinate);
}

template <class Point>
void take(const json& numbers, std::size_t& next, Point& point) {
  for (double& coordinate : point) coordinate = numbers.at(next++).get<double>();
}

json to_json(const CubicPath& path) {
  json reference;
  append(path.reference, reference);
  json pieces;
  for (const CubicPiece& piece : path.pieces) {
    json numbers = {piece.t0_s, piece.t1_s};
    for (const geometry::Vec3& point : piece.position) append(point, numbers);
    for (const geometry::Vec4& point : piece.image) append(point, numbers);
    pieces.push_back(std::move(numbers));
  }
  return {{"reference", std::move(reference)}, {"pieces", std::move(pieces)}};
}

CubicPath from_json(const json& value) {
  CubicPath path;
  std::size_t next = 0;
  take(value.at("reference"), next, path.reference);
  for (const json& numbers : value.at("pieces")) {
    CubicPiece& piece = path.pieces.emplace_back();
    piece.t0_s = numbers.at(0).get<double>();
    piece.t1_s = numbers.at(1).get<double>();
    next = 2;
    for (geometry::Vec3& point : piece.position) take(numbers, next, point);
    for (geometry::Vec4& point : piece.image) take(numbers, next, point);
  }
  return path;
}

/// Whether the path was found for these keyframes.
bool fits(const CubicPath& path, const Shot& shot) {
  const CubicPath& interpolated = shot.interpolated();
  const bool is_comparable = !path.pieces.empty() && (path.reference - interpolated.reference).norm() <= kSame &&
                             path.begin_s() == interpolated.begin_s() &&
                             path.end_s() == interpolated.end_s();
  return is_comparable &&
         std::ranges::all_of(shot.plan().keyframes, [&](const motion::Keyframe& keyframe) {
           const motion::CubicPoint now = path.at(keyframe.time_s);
           const motion::CubicPoint given = interpolated.at(keyframe.time_s);
           return (now.position - given.position).norm() <= kSame &&
                  (now.image - given.image).norm() <= kSame;
         });
}

std::string key_of(const std::string& scene, const Shot& shot) {
  return scene + "/" + shot.request().name;
}

}  // namespace

KnownPaths::KnownPaths(std::string file) : file_(std::move(file)), document_(json::object()) {
  if (file_.empty() || !std::filesystem::exists(file_)) return;
  std::ifstream in(file_);
  document_ = json::parse(in, nullptr, /*allow_exceptions=*/false);
  if (document_.is_object()) return;
  fmt::print(stderr, "bench: {}: is no file of known paths\n", file_);
  std::exit(2);
}

std::vector<CubicPath> KnownPaths::of(const std::string& scene, const Shot& shot) const {
  std::vector<CubicPath> paths;
  const auto known = document_.find(key_of(scene, shot));
  if (known == document_.end()) return paths;
  try {
    for (const auto& [way, value] : known->items()) {
      CubicPath path = from_json(value);
      if (fits(path, shot)) paths.push_back(std::move(path));
    }
  } catch (const json::exception& fault) {
    fmt::print(stderr, "bench: {}: {}: {}\n", file_, key_of(scene, shot), fault.what());
    std::exit(2);
  }
  return paths;
}

void KnownPaths::keep(const std::string& scene, const Shot& shot, const std::string& way,
                      const CubicPath& path) {
  document_[key_of(scene, shot)][way] = to_json(path);
}

std::string KnownPaths::write() const { return write_json(file_, document_); }

}  // namespace camway::bench
