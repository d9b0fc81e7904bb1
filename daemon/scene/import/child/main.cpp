// SPDX-License-Identifier: MIT

/// camway-import FILE MEMORY_BYTES CPU_SECONDS [cameras]: reads FILE and writes the record of
/// `record_layout.h` to file descriptor 3. OBJ, OFF, PLY, STL and UniGrafix are read by our own
/// readers, occupancy maps by OctoMap, all else by assimp. Started by `import_mesh` only. The only
/// program that sees assimp; a process of its own, because a file of a few bytes can make assimp
/// crash or take all memory.

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/Importer.hpp>

#include "daemon/scene/import/child/assimp_cameras.h"
#include "daemon/scene/import/child/assimp_refusal.h"
#include "daemon/scene/import/child/collada_text.h"
#include "daemon/scene/import/child/import_confinement.h"
#include "daemon/scene/import/child/included_files.h"
#include "daemon/scene/import/child/map_reader.h"
#include "daemon/scene/import/readers/mesh_reader.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/import/record/record_layout.h"
#include "daemon/scene/import/unigrafix/unigrafix_reader.h"

namespace {

namespace layout = camway::scene::import_record;
namespace mesh_readers = camway::scene::mesh_readers;
namespace unigrafix = camway::scene::unigrafix;

/// Enough for a scene file and the files that it refers to, one after the other.
constexpr rlim_t kMaxOpenFiles = 64;

bool set_limit(int resource, rlim_t value) {
  const rlimit limit{value, value};
  return setrlimit(static_cast<__rlimit_resource_t>(resource), &limit) == 0;
}

bool limit_this_process(rlim_t memory_bytes, rlim_t cpu_s) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  // Sanitizers reserve terabytes of address space.
  const bool address_space = true;
#else
  const bool address_space = set_limit(RLIMIT_AS, memory_bytes);
#endif
  return address_space && set_limit(RLIMIT_CPU, cpu_s) && set_limit(RLIMIT_CORE, 0) &&
         set_limit(RLIMIT_FSIZE, memory_bytes) && set_limit(RLIMIT_NOFILE, kMaxOpenFiles) &&
         set_limit(RLIMIT_NPROC, 0) && prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
}

bool confine([[maybe_unused]] const char* file) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;  // sanitizers need more system calls than are left
#else
  return camway::scene::confine_this_process(file, layout::kOutputFd);
#endif
}

bool write_all(const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(layout::kOutputFd, at, size);
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

template <class T>
bool write_all(const std::vector<T>& values) {
  return write_all(values.data(), values.size() * sizeof(T));
}

bool write_record(layout::Record& record) {
  record.header.text_bytes = record.text.size();
  record.header.note_bytes = record.notes.size();
  record.header.vertices = record.vertices.size();
  record.header.triangles = record.triangles.size();
  record.header.objects = record.objects.size();
  record.header.name_bytes = record.names.size();
  record.header.occupied = record.occupied.size();
  record.header.free = record.free.size();
  return write_all(&record.header, sizeof record.header) &&
         write_all(record.text.data(), record.text.size()) &&
         write_all(record.notes.data(), record.notes.size()) && write_all(record.vertices) &&
         write_all(record.triangles) && write_all(record.objects) &&
         write_all(record.names.data(), record.names.size()) && write_all(record.occupied) &&
         write_all(record.free);
}

int refuse(std::string reason) {
  layout::Record record;
  record.text = std::move(reason);
  return write_record(record) ? layout::kExitRefused : layout::kExitInternal;
}

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

/// Error of a number that assimp only reads: it makes a decimal of whole part and fraction, each
/// rounded, and their sum, and multiplies by a power of ten, rounded too.
constexpr double kReadingRoundoffs = 8.0;
constexpr double kRoundoff = static_cast<double>(std::numeric_limits<ai_real>::epsilon()) / 2.0;

/// A 4 × 4 matrix of magnitudes, for bounds.
using Magnitudes = std::array<std::array<double, 4>, 4>;

Magnitudes product_of_magnitudes(const Magnitudes& a, const aiMatrix4x4& b) {
  Magnitudes product{};
  for (unsigned i = 0; i < 4; ++i) {
    for (unsigned j = 0; j < 4; ++j) {
      for (unsigned k = 0; k < 4; ++k)
        product[i][j] += a[i][k] * std::abs(static_cast<double>(b[k][j]));
    }
  }
  return product;
}

/// Bounds the rounding of node transforms in single precision. A chain of m products of 4 terms,
/// the last with a vertex, is off by less than 4 m roundoffs, and a few of reading, of the same
/// chain of magnitudes (Higham 2002, "Accuracy and Stability of Numerical Algorithms",
/// section 3.5); doubled, which is more than the terms of higher order come to.
class TransformRounding {
 public:
  explicit TransformRounding(const aiScene& scene) : scene_(scene) {
    Magnitudes identity{};
    for (std::size_t i = 0; i < 4; ++i) identity[i][i] = 1.0;
    add(*scene.mRootNode, identity, 0.0);
  }
  [[nodiscard]] double bound() const { return bound_; }

 private:
  void add(const aiNode& node, const Magnitudes& parent, double products) {
    const bool moves = !node.mTransformation.IsIdentity();
    const Magnitudes chain = product_of_magnitudes(parent, node.mTransformation);
    const double here = products + (moves ? 1.0 : 0.0);
    if (here > 0.0) {
      const double roundoffs = 2.0 * (4.0 * here + (here + 1.0) * kReadingRoundoffs);
      for (const unsigned mesh : std::span(node.mMeshes, node.mNumMeshes)) {
        if (mesh < scene_.mNumMeshes) add_mesh(*scene_.mMeshes[mesh], chain, roundoffs);
      }
    }
    for (const aiNode* child : std::span(node.mChildren, node.mNumChildren)) {
      add(*child, chain, here);
    }
  }

  void add_mesh(const aiMesh& mesh, const Magnitudes& chain, double roundoffs) {
    std::array<double, 4> largest = {0.0, 0.0, 0.0, 1.0};
    for (const aiVector3D& v : std::span(mesh.mVertices, mesh.mNumVertices)) {
      for (unsigned k = 0; k < 3; ++k) {
        if (std::isfinite(v[k]))
          largest[k] = std::max(largest[k], std::abs(static_cast<double>(v[k])));
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      double size = 0.0;
      for (std::size_t k = 0; k < 4; ++k) size += chain[i][k] * largest[k];
      bound_ = std::max(bound_, roundoffs * kRoundoff * size);
    }
  }

  const aiScene& scene_;
  double bound_ = 0.0;
};

/// Says what the readers of assimp do with units and axes, and takes the unit that they only
/// report.
void note_unit_and_axes(const aiScene& scene, layout::Record& record) {
  if (record.text.find("Collada") != std::string::npos) {
    record.notes += "the file's own <unit> and <up_axis> are applied: metres, Y up\n";
  }
  if (record.text.find("FBX") == std::string::npos || scene.mMetaData == nullptr) return;
  constexpr double kCentimetre_m = 0.01;
  float centimetres = 0.0F;
  if (scene.mMetaData->Get("UnitScaleFactor", centimetres) && centimetres > 0.0F) {
    record.header.unit_m = kCentimetre_m * static_cast<double>(centimetres);
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

/// As much as says what a file is.
std::string begin_of(const std::string& file) { return text_of(file, std::size_t{1} << 20); }

bool is_collada(const std::string& extension) {
  return mesh_readers::equals_ignoring_case(extension, ".dae");
}

const aiScene* read_with_assimp(Assimp::Importer& importer, const std::string& file,
                                const std::string& extension, unsigned steps) {
  if (!is_collada(extension)) {
    return importer.ReadFile(file, steps);
  }
  const std::string document = camway::scene::without_blanks_before_numbers(text_of(file, kWhole));
  return importer.ReadFileFromMemory(document.data(), document.size(), steps, "dae");
}

std::string format_of(const Assimp::Importer& importer) {
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* description =
      index >= 0 ? importer.GetImporterInfo(static_cast<std::size_t>(index)) : nullptr;
  return description != nullptr ? description->mName : "unknown";
}

int import_cameras(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (is_collada(extension) && camway::scene::animates_single_axes(text_of(file, kWhole))) {
    return refuse(
        "its animation has channels for single axes, which are not read: export it with a matrix "
        "for each frame (in Blender: animation curves off, or sampled)");
  }
  Assimp::Importer importer;
  // Else nodes that only FBX has stand between the camera and what moves it.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  const aiScene* scene = read_with_assimp(importer, file, extension, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return refuse(
        camway::scene::refusal_of_assimp(extension, begin_of(file), importer.GetErrorString()));
  }
  layout::Record record;
  record.text = format_of(importer);
  note_unit_and_axes(*scene, record);
  record.names = camway::scene::cameras_text(*scene, record.text);
  if (record.names.empty()) return refuse("has no camera");
  return write_record(record) ? layout::kExitOk : layout::kExitInternal;
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
    return refuse(camway::scene::refusal_of_assimp(extension, begin_of(file), error));
  };
  if (scene == nullptr) return refuse_for(importer.GetErrorString());
  if (scene->mRootNode == nullptr || !scene->HasMeshes()) return refuse_for("holds no mesh");
  layout::Record record;
  record.header.single_precision = 1;
  record.header.relative_rounding = kReadingRoundoffs * kRoundoff;
  record.header.absolute_rounding = TransformRounding(*scene).bound();
  record.text = format_of(importer);
  note_unit_and_axes(*scene, record);
  scene = importer.ApplyPostProcessing(aiProcess_PreTransformVertices | aiProcess_Triangulate);
  if (scene == nullptr) return refuse(importer.GetErrorString());
  append_nodes(*scene->mRootNode, *scene, record);
  return write_record(record) ? layout::kExitOk : layout::kExitInternal;
}

/// The bytes of a file, mapped. If the file shrinks meanwhile this process crashes, as it may.
class MappedFile {
 public:
  explicit MappedFile(const std::string& file) : fd_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat information {};
    if (fd_ < 0 || fstat(fd_, &information) != 0) return;
    size_ = static_cast<std::size_t>(information.st_size);
    data_ = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, fd_, 0);
  }
  ~MappedFile() {
    if (is_open()) munmap(data_, size_);
    if (fd_ >= 0) close(fd_);
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] bool is_open() const { return data_ != MAP_FAILED; }
  [[nodiscard]] std::string_view bytes() const { return {static_cast<const char*>(data_), size_}; }

 private:
  int fd_;
  std::size_t size_ = 0;
  void* data_ = MAP_FAILED;
};

int import_directly(const std::string& file, const std::string& extension) {
  const MappedFile mapped(file);
  if (!mapped.is_open()) {
    // The file is there and not empty, so what is missing is address space.
    return errno == ENOMEM ? layout::kExitOutOfMemory : refuse("cannot be opened");
  }
  camway::base::Result<layout::Record> read =
      unigrafix::is_unigrafix_extension(extension)
          ? unigrafix::read_unigrafix(mapped.bytes(), camway::scene::files_below(file))
          : mesh_readers::read_mesh(extension, mapped.bytes());
  if (!read) return refuse(std::move(read.error));
  return write_record(*read) ? layout::kExitOk : layout::kExitInternal;
}

int import_map(const std::string& file, const std::string& extension) {
  layout::Record record;
  std::string refusal = camway::scene::read_map(file, extension, record);
  if (!refusal.empty()) return refuse(std::move(refusal));
  return write_record(record) ? layout::kExitOk : layout::kExitInternal;
}

int import_file(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (mesh_readers::is_known_extension(extension) || unigrafix::is_unigrafix_extension(extension)) {
    return import_directly(file, extension);
  }
  if (camway::scene::is_map_extension(extension)) return import_map(file, extension);
  return import_with_assimp(file, extension);
}

std::optional<rlim_t> parse_limit(std::string_view text) {
  rlim_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  const bool wants_cameras = argc == 5 && argv[4] == std::string_view(layout::kCamerasArgument);
  if (argc != 4 && !wants_cameras) return layout::kExitInternal;
  const std::optional<rlim_t> memory_bytes = parse_limit(argv[2]);
  const std::optional<rlim_t> cpu_s = parse_limit(argv[3]);
  if (!memory_bytes || !cpu_s || !limit_this_process(*memory_bytes, *cpu_s)) {
    return layout::kExitInternal;
  }
  if (!confine(argv[1])) return layout::kExitNotConfined;
  // Called before assimp can catch bad_alloc and report it as something else.
  std::set_new_handler([] { _exit(layout::kExitOutOfMemory); });
  int code = layout::kExitInternal;
  try {
    code = wants_cameras ? import_cameras(argv[1]) : import_file(argv[1]);
  } catch (const std::exception& e) {
    code = refuse(e.what());
  }
  // The output is complete; the destructors of assimp at exit could only fail.
  _exit(code);
}
