// SPDX-License-Identifier: MIT
#include "tools/view/routes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "tools/view/access/access.h"

namespace camway::view {
namespace {

struct FixedPlace {
  std::string_view path;
  Place place;
  std::string_view methods;
};

constexpr std::array<FixedPlace, 15> kFixedPlaces{{
    {"/", Place::kPage, "GET"},
    {"/page.js", Place::kScript, "GET"},
    {"/page.css", Place::kStyle, "GET"},
    {"/plan.svg", Place::kPicture, "GET"},
    {"/v1/version", Place::kVersion, "GET"},
    {"/v1/status", Place::kStatus, "GET"},
    {"/v1/plan", Place::kPlan, "POST"},
    {"/v1/check", Place::kCheck, "POST"},
    {"/v1/interpolate", Place::kInterpolate, "POST"},
    {"/v1/fields", Place::kFields, "GET"},
    {"/v1/last", Place::kLast, "GET"},
    {"/v1/review", Place::kReview, "POST"},
    {"/v1/export", Place::kExport, "POST"},
    {"/v1/socket", Place::kSocket, "GET"},
    {"/v1/scenes", Place::kScenes, "GET"},
}};

/// Removes the next part of a path, up to the next slash, and returns it.
std::string_view next_part(std::string_view& path) {
  const std::size_t end = std::min(path.find('/'), path.size());
  const std::string_view part = path.substr(0, end);
  path.remove_prefix(std::min(end + 1, path.size()));
  return part;
}

/// Finds places below `/v1/scenes/`.
std::optional<Route> scene_route(std::string_view path) {
  constexpr std::string_view kFolder = "/v1/scenes/";
  if (!path.starts_with(kFolder) || path.ends_with('/')) return std::nullopt;
  path.remove_prefix(kFolder.size());
  Route route;
  route.scene = next_part(path);
  if (route.scene.empty()) return std::nullopt;
  route.place = Place::kScene;
  route.allowed = "GET";
  if (path.empty()) return route;
  const std::string_view kind = next_part(path);
  route.object = next_part(path);
  if (!path.empty()) return std::nullopt;
  if (kind == "objects") {
    route.place = route.object.empty() ? Place::kObjects : Place::kObject;
    route.allowed = route.object.empty() ? "POST" : "PATCH, DELETE";
    return route;
  }
  if (kind == "triangles" && route.object.empty()) {
    route.place = Place::kTriangles;
    route.allowed = "POST";
    return route;
  }
  if (kind != "meshes" || route.object.empty()) return std::nullopt;
  route.place = Place::kMesh;
  return route;
}

std::optional<Route> place_of(std::string_view path) {
  const auto* const fixed = std::ranges::find(kFixedPlaces, path, &FixedPlace::path);
  if (fixed == kFixedPlaces.end()) return scene_route(path);
  return Route{fixed->place, {}, {}, code::kOk, fixed->methods};
}

bool is_among(std::string_view method, std::string_view methods) {
  while (!methods.empty()) {
    const std::size_t end = std::min(methods.find(", "), methods.size());
    if (methods.substr(0, end) == method) return true;
    methods.remove_prefix(std::min(end + 2, methods.size()));
  }
  return false;
}

}  // namespace

Route route_of(std::string_view method, std::string_view target) {
  std::optional<Route> route = place_of(path_of(target));
  if (!route) return Route{Place::kPage, {}, {}, code::kNotFound, {}};
  if (!is_among(method == "HEAD" ? "GET" : method, route->allowed)) route->code = code::kNotAllowed;
  return *route;
}

}  // namespace camway::view
