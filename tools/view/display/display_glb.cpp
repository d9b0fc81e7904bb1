// SPDX-License-Identifier: MIT
#include "tools/view/display/display_glb.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/cameras/files/glb_file.h"
#include "tools/view/display/display_mesh.h"

namespace camway::view {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kCompression[] = "EXT_meshopt_compression";
constexpr char kQuantisation[] = "KHR_mesh_quantization";

/// The whole numbers of a normalised coordinate: -1 to 1.
constexpr std::int32_t kUnitSteps = std::numeric_limits<std::int16_t>::max();

// Types of components in glTF.
constexpr int kShortType = 5122;
constexpr int kUnsignedShortType = 5123;
constexpr int kUnsignedIntType = 5125;
constexpr int kFloatType = 5126;

/// Content of a buffer view, compressed, with the numbers of elements and of bytes for each.
struct View {
  std::string bytes;
  const char* mode = "";
  std::size_t count = 0;
  std::size_t stride = 0;
};

/// Says what the readers of the extension read.
void choose_versions() {
  [[maybe_unused]] static const bool is_done = [] {
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
    return true;
  }();
}

View compressed(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  std::vector<unsigned char> bytes(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  bytes.resize(
      meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
  const bool is_short = vertices <= std::numeric_limits<std::uint16_t>::max();
  return {{bytes.begin(), bytes.end()},
          "TRIANGLES",
          indices.size(),
          is_short ? sizeof(std::uint16_t) : sizeof(std::uint32_t)};
}

template <class Vertex>
View compressed(const std::vector<Vertex>& vertices) {
  std::vector<unsigned char> bytes(
      meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vertices.data(),
                                          vertices.size(), sizeof(Vertex)));
  return {{bytes.begin(), bytes.end()}, "ATTRIBUTES", vertices.size(), sizeof(Vertex)};
}

/// Positions of vertices in units of `scale_m`: as normalised whole numbers where the grid is
/// coarse enough, else in single precision.
struct Positions {
  View view;
  Json accessor;
  double scale_m = 1.0;
};

/// Returns the bounds of the numbers in the file.
template <class Vertex>
void add_bounds(const std::vector<Vertex>& vertices, Json& accessor) {
  Json min = Json::array();
  Json max = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::ranges::minmax_element(
        vertices, {}, [axis](const Vertex& vertex) { return vertex.at(axis); });
    min.push_back(least->at(axis));
    max.push_back(most->at(axis));
  }
  accessor["min"] = std::move(min);
  accessor["max"] = std::move(max);
}

template <class Number, std::size_t kSize>
Positions positions_as(const DisplayMesh& mesh, int type, double scale_m) {
  std::vector<std::array<Number, kSize>> vertices;  // the last number, if any, fills up
  vertices.reserve(mesh.vertices.size());
  for (const DisplayMesh::GridPoint& point : mesh.vertices) {
    std::array<Number, kSize>& vertex = vertices.emplace_back();
    std::ranges::transform(point, vertex.begin(),
                           [](std::int32_t x) { return static_cast<Number>(x); });
  }
  Json accessor{
      {"bufferView", 0}, {"componentType", type}, {"count", vertices.size()}, {"type", "VEC3"}};
  add_bounds(vertices, accessor);
  return {compressed(vertices), std::move(accessor), scale_m};
}

Positions positions_of(const DisplayMesh& mesh) {
  const bool is_short = std::ranges::all_of(mesh.vertices, [](const auto& point) {
    return std::ranges::all_of(point, [](std::int32_t x) { return std::abs(x) <= kUnitSteps; });
  });
  if (!is_short) return positions_as<float, 3>(mesh, kFloatType, mesh.step_m);
  Positions positions = positions_as<std::int16_t, 4>(mesh, kShortType, mesh.step_m * kUnitSteps);
  positions.accessor["normalized"] = true;
  return positions;
}

/// Adds a view of the buffer that a reader decompresses into.
void add_view(View view, int target, Json& root, std::string& buffer) {
  Json& fallback = root["buffers"][1]["byteLength"];
  const auto begin = fallback.get<std::size_t>();
  const std::size_t length = view.count * view.stride;
  Json json{{"buffer", 1}, {"byteOffset", begin}, {"byteLength", length}};
  const bool is_vertices = target == 34962;
  if (is_vertices) json["byteStride"] = view.stride;
  json["target"] = target;
  json["extensions"][kCompression] = {{"buffer", 0},
                                      {"byteOffset", buffer.size()},
                                      {"byteLength", view.bytes.size()},
                                      {"byteStride", view.stride},
                                      {"count", view.count},
                                      {"mode", view.mode}};
  root["bufferViews"].push_back(std::move(json));
  constexpr std::size_t kAlignment = 4;
  fallback = (begin + length + kAlignment - 1) / kAlignment * kAlignment;
  buffer += view.bytes;
  while (buffer.size() % kAlignment != 0) buffer += '\0';
  root["buffers"][0]["byteLength"] = buffer.size();
}

Json bare_document(const DisplayMesh& mesh) {
  Json root;
  root["asset"] = {{"version", "2.0"},
                   {"generator", "Camway"},
                   {"extras",
                    {{"triangles", mesh.triangles},
                     {"shown", mesh.shown()},
                     {"simplified", mesh.is_simplified},
                     {"error_m", mesh.error_m}}}};
  root["scene"] = 0;
  root["scenes"] = Json::array({{{"nodes", {0}}}});
  root["nodes"] =
      Json::array({{{"translation", {mesh.centre_O.x(), mesh.centre_O.y(), mesh.centre_O.z()}}}});
  return root;
}

/// Adds what shows the triangles to a document. Returns the content of its buffer.
std::string add_mesh(const DisplayMesh& mesh, Json& root) {
  constexpr int kVertexTarget = 34962;
  constexpr int kIndexTarget = 34963;
  Positions positions = positions_of(mesh);
  View indices = compressed(mesh.indices, mesh.vertices.size());
  const bool is_short = indices.stride == sizeof(std::uint16_t);
  root["extensionsUsed"] = {kCompression, kQuantisation};
  root["extensionsRequired"] = root["extensionsUsed"];
  root["nodes"][0]["scale"] = {positions.scale_m, positions.scale_m, positions.scale_m};
  root["nodes"][0]["mesh"] = 0;
  root["meshes"] = Json::array(
      {{{"primitives", Json::array({{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}})}}});
  root["accessors"] =
      Json::array({std::move(positions.accessor),
                   {{"bufferView", 1},
                    {"componentType", is_short ? kUnsignedShortType : kUnsignedIntType},
                    {"count", indices.count},
                    {"type", "SCALAR"}}});
  root["buffers"] =
      Json::array({{{"byteLength", 0}},
                   {{"byteLength", 0}, {"extensions", {{kCompression, {{"fallback", true}}}}}}});
  root["bufferViews"] = Json::array();
  std::string buffer;
  add_view(std::move(positions.view), kVertexTarget, root, buffer);
  add_view(std::move(indices), kIndexTarget, root, buffer);
  return buffer;
}

}  // namespace

std::size_t triangles_to_show(std::int64_t object_triangles, std::int64_t scene_triangles) {
  if (scene_triangles <= kShownTriangles) return static_cast<std::size_t>(object_triangles);
  constexpr double kStepsOfHalf = 4.0;
  const double share = static_cast<double>(kShownTriangles) / static_cast<double>(scene_triangles);
  const double in_steps = std::exp2(std::floor(std::log2(share) * kStepsOfHalf) / kStepsOfHalf);
  return static_cast<std::size_t>(static_cast<double>(object_triangles) * in_steps);
}

std::string mesh_glb(const scene::Mesh& mesh_O, std::size_t most_triangles) {
  choose_versions();
  const DisplayMesh mesh = display_mesh(mesh_O, most_triangles);
  Json root = bare_document(mesh);
  std::string buffer;
  if (mesh.shown() > 0) buffer = add_mesh(mesh, root);
  return tools::glb_file(root.dump(), std::move(buffer));
}

}  // namespace camway::view
