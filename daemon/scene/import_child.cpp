// SPDX-License-Identifier: MIT

/// camway-import FILE MEMORY_BYTES CPU_SECONDS: reads FILE with assimp and writes what
/// `import_format.h` describes to file descriptor 3. Started by `import_mesh` only. The one place
/// that sees assimp; a process of its own, because a file of a few bytes can make assimp crash or
/// take all memory.

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cctype>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/Importer.hpp>

#include "daemon/scene/import_format.h"

namespace {

namespace format = camway::scene::import_format;

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
         set_limit(RLIMIT_FSIZE, memory_bytes) && prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
}

bool write_all(const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(format::kOutputFd, at, size);
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

bool write_record(format::Record& record) {
  record.header.text_bytes = record.text.size();
  record.header.vertices = record.vertices.size();
  record.header.triangles = record.triangles.size();
  record.header.objects = record.objects.size();
  record.header.name_bytes = record.names.size();
  return write_all(&record.header, sizeof record.header) &&
         write_all(record.text.data(), record.text.size()) && write_all(record.vertices) &&
         write_all(record.triangles) && write_all(record.objects) &&
         write_all(record.names.data(), record.names.size());
}

int refuse(std::string reason) {
  format::Record record;
  record.text = std::move(reason);
  return write_record(record) ? format::kExitRefused : format::kExitInternal;
}

std::string object_name(const aiNode& node, const aiMesh& mesh) {
  const std::string_view node_name = node.mName.C_Str();
  const std::string_view mesh_name = mesh.mName.C_Str();
  if (node_name.empty()) return std::string(mesh_name);
  if (mesh_name.empty() || mesh_name == node_name) return std::string(node_name);
  return std::string(node_name) + "/" + std::string(mesh_name);
}

void append_mesh(const aiNode& node, const aiMesh& mesh, format::Record& record) {
  const auto base = static_cast<std::uint32_t>(record.vertices.size());
  const std::size_t first_triangle = record.triangles.size();
  for (const aiVector3D& v : std::span(mesh.mVertices, mesh.mNumVertices)) {
    record.vertices.push_back({v.x, v.y, v.z});
  }
  for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
    if (face.mNumIndices != 3) {
      ++record.header.dropped_points_and_lines;
      continue;
    }
    format::Triangle triangle{};
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

void append_nodes(const aiNode& node, const aiScene& scene, format::Record& record) {
  for (const unsigned mesh : std::span(node.mMeshes, node.mNumMeshes)) {
    if (mesh < scene.mNumMeshes) append_mesh(node, *scene.mMeshes[mesh], record);
  }
  for (const aiNode* child : std::span(node.mChildren, node.mNumChildren)) {
    append_nodes(*child, scene, record);
  }
}

/// assimp 5.2 allocates what the header of an OFF file promises before it looks whether anything
/// follows: 27 bytes cost 5 GB and 15 s. Every vertex and every face takes at least 2 bytes.
std::optional<std::string> refuse_off_counts(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension != ".off") return std::nullopt;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    const char* begin = line.data();
    const char* const end = begin + line.size();
    std::uint64_t counts[2] = {};
    int found = 0;
    for (; found < 2; ++found) {
      while (begin != end && std::isspace(static_cast<unsigned char>(*begin))) ++begin;
      const auto [next, error] = std::from_chars(begin, end, counts[found]);
      if (error == std::errc::result_out_of_range) return "its counts are out of range";
      if (error != std::errc{}) break;
      begin = next;
    }
    if (found < 2) continue;  // "OFF", a comment, or an empty line
    const std::uintmax_t bytes = std::filesystem::file_size(file);
    if (counts[0] > bytes || counts[1] > bytes) {
      return "says it has " + std::to_string(counts[0]) + " vertices and " +
             std::to_string(counts[1]) + " faces, in " + std::to_string(bytes) + " bytes";
    }
    return std::nullopt;
  }
  return std::nullopt;
}

int import_file(const std::string& file) {
  if (const std::optional<std::string> reason = refuse_off_counts(file)) return refuse(*reason);
  Assimp::Importer importer;
  // Node transforms are applied before polygons are cut to triangles, and nodes keep their names.
  importer.SetPropertyBool(AI_CONFIG_PP_PTV_KEEP_HIERARCHY, true);
  // Only positions matter; the rest goes before it costs time.
  importer.SetPropertyInteger(
      AI_CONFIG_PP_RVC_FLAGS,
      aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
          aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
          aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS | aiComponent_MATERIALS);
  const aiScene* scene = importer.ReadFile(
      file, aiProcess_RemoveComponent | aiProcess_PreTransformVertices | aiProcess_Triangulate);
  if (scene == nullptr) return refuse(importer.GetErrorString());
  if (scene->mRootNode == nullptr || !scene->HasMeshes()) return refuse("holds no mesh");
  format::Record record;
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* description =
      index >= 0 ? importer.GetImporterInfo(static_cast<std::size_t>(index)) : nullptr;
  record.text = description != nullptr ? description->mName : "unknown";
  append_nodes(*scene->mRootNode, *scene, record);
  return write_record(record) ? format::kExitOk : format::kExitInternal;
}

std::optional<rlim_t> parse_limit(std::string_view text) {
  rlim_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return format::kExitInternal;
  const std::optional<rlim_t> memory_bytes = parse_limit(argv[2]);
  const std::optional<rlim_t> cpu_s = parse_limit(argv[3]);
  if (!memory_bytes || !cpu_s || !limit_this_process(*memory_bytes, *cpu_s)) {
    return format::kExitInternal;
  }
  // assimp catches bad_alloc and calls it something else; this comes before.
  std::set_new_handler([] { _exit(format::kExitOutOfMemory); });
  int code = format::kExitInternal;
  try {
    code = import_file(argv[1]);
  } catch (const std::exception& e) {
    code = refuse(e.what());
  }
  // What was written is complete; what assimp left behind at exit can only fail.
  _exit(code);
}
