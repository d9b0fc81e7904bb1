// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/scene_file.h"

#include <cerrno>
#include <filesystem>
#include <string_view>
#include <utility>

#include "daemon/base/result.h"
#include "daemon/scene/import/child/assimp_reader.h"
#include "daemon/scene/import/child/map_reader.h"
#include "daemon/scene/import/child/splat_voxels.h"
#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/common/included_files.h"
#include "daemon/scene/import/common/mapped_file.h"
#include "daemon/scene/import/points/point_reader.h"
#include "daemon/scene/import/readers/mesh_reader.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/import/record/record_layout.h"
#include "daemon/scene/import/surfaces/bezier_patches.h"
#include "daemon/scene/import/unigrafix/unigrafix_reader.h"

namespace camway::scene {
namespace {

/// Whether a reader of our own reads the file from its bytes.
bool is_read_directly(const std::string& file, const std::string& extension) {
  return mesh_readers::is_known_extension(extension) ||
         unigrafix::is_unigrafix_extension(extension) || surfaces::is_bezier_extension(extension) ||
         point_readers::is_point_extension(extension) || is_splat_voxel_name(file);
}

/// Requires `is_read_directly`.
base::Result<import_record::Record> read_directly(const std::string& file,
                                                  const std::string& extension,
                                                  std::string_view bytes) {
  if (unigrafix::is_unigrafix_extension(extension)) {
    return unigrafix::read_unigrafix(bytes, files_below(file));
  }
  if (surfaces::is_bezier_extension(extension)) return surfaces::read_bezier_patches(bytes);
  if (point_readers::is_point_extension(extension)) {
    return point_readers::read_points(extension, bytes);
  }
  if (is_splat_voxel_name(file)) {
    return read_splat_voxels(std::filesystem::path(file).filename().string(), bytes,
                             files_below(file));
  }
  return mesh_readers::read_mesh(extension, bytes);
}

/// The bytes without the mark before UTF-8, which a binary STL could have by chance.
std::string_view text_of(std::string_view extension, std::string_view bytes) {
  const std::string_view text = mesh_readers::without_bom(bytes);
  const bool is_stl = mesh_readers::equals_ignoring_case(extension, ".stl");
  return is_stl && !text.starts_with("solid") ? bytes : text;
}

int import_directly(const std::string& file, const std::string& extension) {
  const import_process::MappedFile mapped(file);
  if (!mapped.is_open()) {
    // The file is there and not empty, so what is missing is address space.
    return errno == ENOMEM ? import_record::kExitOutOfMemory
                           : import_process::refuse("cannot be opened");
  }
  base::Result<import_record::Record> read =
      read_directly(file, extension, text_of(extension, mapped.bytes()));
  if (!read) return import_process::refuse(std::move(read.error));
  return import_process::write_record(*read);
}

int import_map(const std::string& file, const std::string& extension) {
  import_record::Record record;
  std::string refusal = read_map(file, extension, record);
  if (!refusal.empty()) return import_process::refuse(std::move(refusal));
  return import_process::write_record(record);
}

}  // namespace

int import_scene_file(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (is_read_directly(file, extension)) return import_directly(file, extension);
  if (mesh_readers::equals_ignoring_case(extension, ".json")) {
    return import_process::refuse(
        "of JSON only voxels of splats are read: a file named .voxel.json, with its .voxel.bin "
        "beside it. Being two files, they cannot be uploaded");
  }
  if (is_map_extension(extension)) return import_map(file, extension);
  return import_with_assimp(file, extension);
}

}  // namespace camway::scene
