// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/import/unsupported_formats.h"
#include "tools/cameras/files/mcap_records.h"
#include "tools/cameras/files/text_rows.h"
#include "tools/cameras/formats/camera_format.h"
#include "tools/cameras/formats/csv_columns.h"
#include "tools/cameras/formats/pose_tables.h"
#include "tools/json/json_document.h"

namespace camway::tools {
namespace {

namespace readers = scene::mesh_readers;

constexpr std::string_view kFbxMagic = "Kaydara FBX Binary";
constexpr std::string_view kGltfMagic = "glTF";

bool has_text(const CameraFile& file, std::string_view text) {
  return file.bytes.find(text) != std::string::npos;
}

bool has_extension(const CameraFile& file, std::string_view lower) {
  return readers::equals_ignoring_case(std::filesystem::path(file.name).extension().string(),
                                       lower);
}

/// The first line that has words and is no remark; nothing if there is none.
std::optional<std::vector<std::string_view>> first_row(const CameraFile& file) {
  std::string_view text = file.bytes;
  while (!text.empty()) {
    const std::string_view line = readers::take_line(text);
    const std::vector<TextRow> rows = rows_of(line);
    if (!rows.empty()) return rows[0].words;
  }
  return std::nullopt;
}

bool is_number(std::string_view word) { return std::isfinite(readers::parse_decimal(word)); }

bool has_numbers(const std::vector<std::string_view>& words, std::size_t count) {
  return words.size() >= count &&
         std::all_of(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(count), is_number);
}

/// The format of a text by the first line that counts. Names like `images.txt` say nothing else
/// than that it may be COLMAP's.
const CameraFormat* format_of_rows(const CameraFile& file) {
  const auto row = first_row(file);
  const bool is_images = std::filesystem::path(file.name).filename() == "images.txt";
  if (!row) return is_images ? camera_format("colmap") : nullptr;
  constexpr std::size_t kColmapNumbers = 9;
  if (row->size() > kColmapNumbers && has_numbers(*row, kColmapNumbers) &&
      !is_number((*row)[kColmapNumbers])) {
    return camera_format("colmap");
  }
  // A line of names alone is that of a table, whose reader says which column is missing.
  constexpr std::size_t kFewestColumns = 8;
  if (row->size() >= kFewestColumns && std::ranges::none_of(*row, is_number)) {
    return camera_format("csv");
  }
  // Files of KITTI and TUM may be damaged in the first line, too: then their readers say how.
  if (row->size() == 12) return camera_format("kitti");
  if (row->size() == 8) return camera_format("tum");
  return is_images ? camera_format("colmap") : nullptr;
}

struct Known {
  std::string_view extension;
  std::string_view why;
};

constexpr std::string_view kBag =
    "recordings of ROS are not read: write the poses as TUM, as 'evo_traj bag' does, or as MCAP "
    "with messages in JSON";
/// Files in which users have camera paths. Those that no scene is read from either are in
/// `scene::why_unsupported`.
constexpr std::array<Known, 9> kNotRead = {{
    {".blend", "Blender alone reads its files: use the add-on (docs/blender.md), or export glTF"},
    {".bag", kBag},
    {".db3", kBag},
    {".abc", "Alembic is not read: export glTF or FBX"},
    {".bvh", "BVH has no camera: export glTF or FBX"},
    {".nk", "scripts of Nuke are not read: export the camera as .chan"},
    {".bin", "COLMAP's binary model is not read: 'colmap model_converter --output_type TXT'"},
    {".c4d", "Cinema 4D alone reads its files: export glTF or FBX"},
    {".hip", "Houdini alone reads its files: export .chan, glTF or FBX"},
}};

std::string why_no_json(const CameraFile& file) {
  const auto document = parse_document(file.bytes, file.name);
  if (!document) return document.error.substr(file.name.size() + 2);
  if (document->is_object() && document->contains("keyframes") && document->contains("camera")) {
    return "is a request of Camway: 'camway plan' reads it";
  }
  return "has neither 'camera_path', as nerfstudio's camera_path.json, nor frames with "
         "'transform_matrix', as transforms.json";
}

bool is_binary(std::string_view bytes) {
  constexpr std::size_t kBegin = 4096;
  return bytes.substr(0, kBegin).find('\0') != std::string_view::npos;
}

}  // namespace

const CameraFormat* format_of(const CameraFile& file) {
  const auto is = [&](std::string_view lower) { return has_extension(file, lower); };
  if (file.bytes.starts_with(kGltfMagic)) return camera_format("gltf");
  if (file.bytes.starts_with(kMcapMagic) || is(".mcap")) return camera_format("mcap");
  if (is(".glb") || is(".gltf")) return camera_format("gltf");
  if (is(".fbx")) return camera_format("fbx");
  if (is(".dae")) return camera_format("collada");
  if (is(".py")) return camera_format("blender");
  if (is(".chan")) return camera_format("chan");
  if (has_text(file, "\"camera_path\"")) return camera_format("nerfstudio");
  if (has_text(file, "\"transform_matrix\"")) return camera_format("transforms");
  if (is(".json")) return nullptr;
  if (has_pose_columns(file) && !is(".txt") && !is(".tum")) return camera_format("csv");
  return format_of_rows(file);
}

std::string why_unreadable(const CameraFile& file) {
  constexpr std::string_view kUtf16 = "\xFF\xFE";
  constexpr std::string_view kUtf16Big = "\xFE\xFF";
  if (readers::is_blank(std::string_view(file.bytes))) return "is empty";
  if (file.bytes.starts_with(kUtf16) || file.bytes.starts_with(kUtf16Big)) {
    return "is UTF-16: save it as UTF-8, or as plain CSV";
  }
  if (file.bytes.starts_with(kFbxMagic) && !has_extension(file, ".fbx")) {
    return "is FBX, which its name does not say: rename it to .fbx";
  }
  return "";
}

std::string why_no_format(const CameraFile& file) {
  for (const Known& known : kNotRead) {
    if (has_extension(file, known.extension)) return std::string(known.why);
  }
  const std::string extension = std::filesystem::path(file.name).extension().string();
  if (const auto why = scene::why_unsupported(extension); !why.empty()) return std::string(why);
  if (has_extension(file, ".json")) return why_no_json(file);
  if (is_binary(file.bytes)) {
    return "is binary, and of no format that is known (see camway import --help)";
  }
  std::string_view text = file.bytes;
  const base::Result<PoseColumns> columns = take_pose_columns(text);
  if (has_extension(file, ".csv") && !columns) return columns.error;
  const auto row = first_row(file);
  return fmt::format(
      "is of no format that is known; --format names one. Its first line has {} words; lines of "
      "tum have 8, of kitti 12, of chan 7 or 8, and a table begins with names of columns",
      row ? row->size() : 0);
}

}  // namespace camway::tools
