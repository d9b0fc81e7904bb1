// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/assimp_reader.h"

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <assimp/Importer.hpp>

#include "daemon/scene/import/child/assimp_cameras.h"
#include "daemon/scene/import/child/assimp_refusal.h"
#include "daemon/scene/import/child/collada_text.h"
#include "daemon/scene/import/child/encoded_names.h"
#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/common/transform_chain.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene {
namespace {

namespace layout = import_record;
using import_process::refuse;
using import_process::write_record;

std::string object_name(const aiNode& node, const aiMesh& mesh) {
  const std::string_view node_name = node.mName.C_Str();
  const std::string_view mesh_name = mesh.mName.C_Str();
  if (node_name.empty()) return std::string(mesh_name);
  if (mesh_name.empty() || mesh_name == node_name) return std::string(node_name);
  return std::string(node_name) + "/" + std::string(mesh_name);
}

void append_mesh(const aiNode& node, const aiMesh& mesh, layout::Record& record) {
  const auto base = static_cast<std::uint32_t>(record.vertices.size());
  const std::size_t first_triangle = record.triangles.size();
  for (const aiVector3D& v : std::span(mesh.mVertices, mesh.mNumVertices)) {
    record.vertices.push_back(
        {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)});
  }
  for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
    if (face.mNumIndices != 3) {
      ++record.header.dropped_points_and_lines;
      continue;
    }
    layout::Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      // assimp passes on an index that no vertex has; it must not reach into the next mesh.
      const std::uint32_t index = face.mIndices[k];
      triangle[k] = index < mesh.mNumVertices ? base + index : ~std::uint32_t{0};
    }
    record.triangles.push_back(triangle);
  }
  const std::string name = object_name(node, mesh);
  record.objects.push_back({static_cast<std::uint32_t>(record.triangles.size() - first_triangle),
                            static_cast<std::uint32_t>(name.size())});
  record.names += name;
}

void append_nodes(const aiNode& node, const aiScene& scene, layout::Record& record) {
  for (const unsigned mesh : std::span(node.mMeshes, node.mNumMeshes)) {
    if (mesh < scene.mNumMeshes) append_mesh(node, *scene.mMeshes[mesh], record);
  }
  for (const aiNode* child : std::span(node.mChildren, node.mNumChildren)) {
    append_nodes(*child, scene, record);
  }
}

/// Row by row, as assimp multiplies points: from the right.
import_process::Magnitudes magnitudes(const aiMatrix4x4& matrix) {
  import_process::Magnitudes result{};
  for (unsigned i = 0; i < 4; ++i) {
    for (unsigned j = 0; j < 4; ++j) result[i][j] = std::abs(static_cast<double>(matrix[i][j]));
  }
  return result;
}

/// Bounds the rounding of node transforms in single precision.
class TransformRounding {
 public:
  explicit TransformRounding(const aiScene& scene) : scene_(scene) {
    add(*scene.mRootNode, import_process::TransformChain());
  }
  [[nodiscard]] double bound() const { return bound_; }

 private:
  void add(const aiNode& node, const import_process::TransformChain& parent) {
    const bool moves = !node.mTransformation.IsIdentity();
    const import_process::TransformChain chain =
        moves ? parent.then(magnitudes(node.mTransformation)) : parent;
    for (const unsigned mesh : std::span(node.mMeshes, node.mNumMeshes)) {
      if (mesh < scene_.mNumMeshes) add_mesh(*scene_.mMeshes[mesh], chain);
    }
    for (const aiNode* child : std::span(node.mChildren, node.mNumChildren)) add(*child, chain);
  }

  void add_mesh(const aiMesh& mesh, const import_process::TransformChain& chain) {
    std::array<double, 3> largest{};
    for (const aiVector3D& v : std::span(mesh.mVertices, mesh.mNumVertices)) {
      for (unsigned k = 0; k < 3; ++k) {
        if (std::isfinite(v[k]))
          largest[k] = std::max(largest[k], std::abs(static_cast<double>(v[k])));
      }
    }
    bound_ = std::max(bound_, chain.rounding(largest));
  }

  const aiScene& scene_;
  double bound_ = 0.0;
};

constexpr double kCentimetre_m = 0.01;

/// The unit of an FBX file in centimetres, if it states one. Its reader only reports it.
std::optional<double> fbx_unit_cm(const aiScene& scene, const std::string& format) {
  float centimetres = 0.0F;
  if (format.find("FBX") == std::string::npos || scene.mMetaData == nullptr ||
      !scene.mMetaData->Get("UnitScaleFactor", centimetres)) {
    return std::nullopt;
  }
  return static_cast<double>(centimetres);
}

/// Returns why the unit of a file cannot be used; empty if it can.
std::string unit_fault(const aiScene& scene, const std::string& format) {
  const std::optional<double> unit_cm = fbx_unit_cm(scene, format);
  if (!unit_cm || (*unit_cm * kCentimetre_m >= layout::kSmallestUnit_m &&
                   *unit_cm * kCentimetre_m <= layout::kLargestUnit_m)) {
    return "";
  }
  char number[32];
  std::snprintf(number, sizeof number, "%g", *unit_cm);
  return "its UnitScaleFactor, the length of its unit in centimetres, is " + std::string(number);
}

/// Says what the readers of assimp do with units and axes, and takes the unit that they only
/// report.
void note_unit_and_axes(const aiScene& scene, layout::Record& record) {
  if (record.text.find("Collada") != std::string::npos) {
    record.notes += "the file's own <unit> and <up_axis> are applied: metres, Y up\n";
    record.header.unit_m = 1.0;
  }
  if (record.text.find("FBX") == std::string::npos || scene.mMetaData == nullptr) return;
  if (const std::optional<double> unit_cm = fbx_unit_cm(scene, record.text)) {
    record.header.unit_m = kCentimetre_m * *unit_cm;
  }
  int axis = 0;
  if (scene.mMetaData->Get("UpAxis", axis) && axis >= 0 && axis < 3) {
    record.notes += std::string("the file says that ") + "XYZ"[axis] + " is up; axes are kept\n";
  }
}

constexpr std::size_t kWhole = std::numeric_limits<std::size_t>::max();

std::string text_of(const std::string& file, std::size_t most) {
  std::string text;
  std::ifstream stream(file, std::ios::binary);
  for (std::istreambuf_iterator<char> at(stream), end; at != end && text.size() < most; ++at) {
    text += *at;
  }
  return text;
}

/// The first part of a file, which says what it is.
std::string begin_of(const std::string& file) { return text_of(file, std::size_t{1} << 20); }

bool is_collada(const std::string& extension) {
  return mesh_readers::equals_ignoring_case(extension, ".dae");
}

const aiScene* read_with_assimp(Assimp::Importer& importer, const std::string& file,
                                const std::string& extension, unsigned steps) {
  if (!is_collada(extension)) {
    importer.SetIOHandler(new EncodedNames);  // which the importer deletes
    return importer.ReadFile(file, steps);
  }
  const std::string document = without_blanks_before_numbers(text_of(file, kWhole));
  return importer.ReadFileFromMemory(document.data(), document.size(), steps, "dae");
}

std::string format_of(const Assimp::Importer& importer) {
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* description =
      index >= 0 ? importer.GetImporterInfo(static_cast<std::size_t>(index)) : nullptr;
  return description != nullptr ? description->mName : "unknown";
}

}  // namespace

int import_cameras_with_assimp(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (is_collada(extension) && animates_single_axes(text_of(file, kWhole))) {
    return refuse(
        "its animation has channels for single axes, which are not read: export it with a matrix "
        "for each frame (in Blender: animation curves off, or sampled)");
  }
  Assimp::Importer importer;
  // Without this, nodes that only FBX has stand between the camera and its animated node.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  const aiScene* scene = read_with_assimp(importer, file, extension, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return refuse(refusal_of_assimp(extension, begin_of(file), importer.GetErrorString()));
  }
  layout::Record record;
  record.text = format_of(importer);
  if (std::string fault = unit_fault(*scene, record.text); !fault.empty()) {
    return refuse(std::move(fault));
  }
  note_unit_and_axes(*scene, record);
  record.names = cameras_text(*scene, record.text);
  if (record.names.empty()) return refuse("has no camera");
  return write_record(record);
}

int import_with_assimp(const std::string& file, const std::string& extension) {
  Assimp::Importer importer;
  // Node transforms are applied before polygons are cut to triangles, and nodes keep their names.
  importer.SetPropertyBool(AI_CONFIG_PP_PTV_KEEP_HIERARCHY, true);
  // Only positions matter; the rest goes before it costs time.
  importer.SetPropertyInteger(
      AI_CONFIG_PP_RVC_FLAGS,
      aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
          aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
          aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS | aiComponent_MATERIALS);
  const aiScene* scene = read_with_assimp(importer, file, extension, aiProcess_RemoveComponent);
  const auto refuse_for = [&](const std::string& error) {
    return refuse(refusal_of_assimp(extension, begin_of(file), error));
  };
  if (scene == nullptr) return refuse_for(importer.GetErrorString());
  if (scene->mRootNode == nullptr || !scene->HasMeshes()) return refuse_for("holds no mesh");
  layout::Record record;
  record.header.single_precision = 1;
  record.header.relative_rounding =
      import_process::kReadingRoundoffs * import_process::kFloatRoundoff;
  record.header.absolute_rounding = TransformRounding(*scene).bound();
  record.text = format_of(importer);
  if (std::string fault = unit_fault(*scene, record.text); !fault.empty()) {
    return refuse(std::move(fault));
  }
  note_unit_and_axes(*scene, record);
  scene = importer.ApplyPostProcessing(aiProcess_PreTransformVertices | aiProcess_Triangulate);
  if (scene == nullptr) return refuse(importer.GetErrorString());
  append_nodes(*scene->mRootNode, *scene, record);
  return write_record(record);
}

}  // namespace camway::scene
