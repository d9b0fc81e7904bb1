// SPDX-License-Identifier: MIT
#include "daemon/scene/import/import.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/camera_import.h"
#include "daemon/scene/import/content_kind.h"
#include "daemon/scene/import/import_process.h"
#include "daemon/scene/import/record/cad_names.h"
#include "daemon/scene/import/record/import_record.h"
#include "daemon/scene/import/unsupported_formats.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

std::string begin_of(const fs::path& file) {
  std::string begin(kContentBegin, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(stream.gcount()));
  return begin;
}

/// The fault of a file before anything reads it; empty if there is none.
std::string reason_not_to_read(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return "there is no such file";
  if (error) return error.message();
  if (status.type() == fs::file_type::directory) return "is a directory";
  if (status.type() != fs::file_type::regular) return "is not a regular file";
  if (access(file.c_str(), R_OK) != 0) return "cannot be read: permission denied";
  if (fs::file_size(file, error) == 0 && !error) return "is empty";
  const std::string_view why = why_unsupported(file.extension().string());
  if (!why.empty()) return "cannot be read: " + std::string(why);
  if (error) return error.message();
  const std::string fault = content_fault(file.extension().string(), begin_of(file));
  return fault.empty() ? "" : "cannot be read: " + fault;
}

/// Why the reader refused the file, without its name, which the caller adds.
std::string refusal(const fs::path& file, const std::string& reason) {
  if (reason.starts_with("No suitable reader found")) {
    return "no reader recognises it: files of type '" + file.extension().string() +
           "' are not supported, or its content is not what the name says";
  }
  return "cannot be read: " + reason;
}

std::string describe(const fs::path& file, const ImportProcessResult& process,
                     const ImportOptions& options) {
  using End = ImportProcessResult::End;
  const bool is_ifc = file.extension() == ".ifc";
  switch (process.end) {
    case End::kOutOfMemory:
      return "reading it takes more than the limit of " +
             std::to_string(options.memory_limit_bytes >> 20) + " MiB";
    case End::kOutOfTime: {
      char seconds[32];
      std::snprintf(seconds, sizeof seconds, "%g", options.time_limit_s);
      return "reading it takes more than the limit of " + std::string(seconds) + " s";
    }
    case End::kStopped:
      return "reading it was cancelled";
    case End::kCrashed:
      return "crashed its reader (" + process.detail + ")" +
             (is_ifc ? ": assimp does not know all of IFC4; export IFC2x3 or glTF" : "") +
             (is_cad_name(file.filename().string())
                  ? ": it is damaged, or has what Open CASCADE does not know"
                  : "");
    case End::kNotStarted:
      return "cannot be imported: " + process.detail;
    case End::kFinished:
      break;
  }
  return "cannot be imported";
}

/// The bounds of a record's mesh in the frame of the scene.
geometry::Box bounds_of(const ImportRecordResult& record) {
  geometry::Box bounds = record.mesh->bounds();
  if (!bounds.isEmpty()) bounds.translate(record.map_origin_m);
  return bounds;
}

/// See `ImportReport::rounding_m`. The reader's rounding is relative to coordinates or absolute in
/// file units; the product with the scale rounds once more, and so does the product of a scale with
/// the unit of the file.
double rounding_m(const ImportRecordResult& record, const ImportReport& report,
                  double asked_scale) {
  const geometry::Box& bounds_m = report.bounds_m;
  if (bounds_m.isEmpty()) return 0.0;
  const double largest_m = bounds_m.min().cwiseAbs().cwiseMax(bounds_m.max().cwiseAbs()).maxCoeff();
  const bool has_product = report.unit_m != 0.0 && asked_scale != 1.0;
  const double of_scale = (report.scale == 1.0 ? 0.0 : geometry::kUnitRoundoff) +
                          (has_product ? geometry::kUnitRoundoff : 0.0);
  return (record.relative_rounding + of_scale) * largest_m +
         record.absolute_rounding * report.scale;
}

std::string import_into(ImportResult& result, const fs::path& file, const ImportOptions& options,
                        const std::stop_token& stop) {
  if (!(options.scale > 0.0) || !std::isfinite(options.scale)) {
    return "the scale must be a positive number";
  }
  if (std::string reason = reason_not_to_read(file); !reason.empty()) return reason;
  const ImportProcessResult process =
      run_import_process(file, options.memory_limit_bytes, options.time_limit_s, stop);
  if (process.end != ImportProcessResult::End::kFinished) return describe(file, process, options);
  ImportReport& report = result.report;
  ImportRecordResult record = read_import_record(process.output, options, report);
  if (record.broken) return "its reader answered with a broken record";
  result.limit = record.limit;
  if (!record.mesh) return refusal(file, record.refusal);
  const Mesh& mesh = *record.mesh;
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  report.objects = mesh.objects.size();
  report.bounds_m = bounds_of(record);
  report.rounding_m = rounding_m(record, report, options.scale);
  report.surface_error_m = record.surface_error * report.scale;
  if (mesh.triangles.empty()) {
    return record.map ? "holds no occupied voxel" : "holds no triangle with an area";
  }
  result.map = std::move(record.map);
  result.map_origin_m = record.map_origin_m;
  result.mesh = std::move(record.mesh);
  return "";
}

}  // namespace

ImportResult import_mesh(const fs::path& file, const ImportOptions& options,
                         const std::stop_token& stop) {
  ImportResult result;
  result.report.scale = options.scale;
  result.report.up = options.up;
  if (const std::string reason = import_into(result, file, options, stop); !reason.empty()) {
    result.error = file.string() + ": " + reason;
  }
  return result;
}

base::Result<std::vector<SceneFileCamera>> import_cameras(const fs::path& file) {
  const auto failed = [&](const std::string& reason) {
    return base::Failure{file.string() + ": " + reason};
  };
  if (const std::string reason = reason_not_to_read(file); !reason.empty()) return failed(reason);
  const ImportOptions options;
  const ImportProcessResult process = run_import_process(
      file, options.memory_limit_bytes, options.time_limit_s, {}, ImportTask::kCameras);
  if (process.end != ImportProcessResult::End::kFinished) {
    return failed(describe(file, process, options));
  }
  const CameraRecordResult record = read_camera_record(process.output);
  if (record.broken) return failed("its reader answered with a broken record");
  if (!record.refusal.empty()) return failed(refusal(file, record.refusal));
  auto cameras = cameras_from(record.cameras, record.unit_m);
  if (!cameras) return failed(cameras.error);
  return cameras;
}

}  // namespace camway::scene
