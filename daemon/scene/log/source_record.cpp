// SPDX-License-Identifier: MIT
#include "daemon/scene/log/source_record.h"

#include <span>
#include <string>
#include <utility>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/log/byte_stream.h"
#include "daemon/scene/log/map_bytes.h"
#include "daemon/scene/log/mesh_bytes.h"

namespace camway::scene {
namespace {

using SourceResult = base::Result<std::shared_ptr<const ObjectSource>>;

/// A record is: magic · version · kind · whether it is a difference · id of its base, if it is one
/// · report · origin of the map, if it has one · mesh or map.
constexpr std::uint64_t kSourceMagic = 0x4352'5359'4157'4D43;  // "CMWAYSRC"
/// Changes with anything that is written, the numbers of `ObjectKind` and `UpAxis` included.
constexpr std::uint32_t kSourceVersion = 1;
/// The version whose report ends with the error of smooth surfaces. Sources without such an error
/// are written as before, so that their records, and the ids of these, stay what they were, and
/// earlier builds read them.
constexpr std::uint32_t kVersionWithSurfaceError = 2;
/// The version of maps whose frame does not begin where their object's does: the origin follows the
/// report. Others are written as before, for the same reason.
constexpr std::uint32_t kVersionWithOrigin = 3;
static_assert(static_cast<int>(ObjectKind::kMap) == 5 && static_cast<int>(UpAxis::kYToZ) == 2);

/// Room for all of a record but its mesh or its map.
constexpr std::size_t kUsualReportBytes = 256;

struct SourceHeader {
  ObjectKind kind = ObjectKind::kMesh;
  bool has_surface_error = false;
  bool has_origin = false;
  std::optional<BlobId> base;  ///< set for a difference
};

void put_source_header(ByteWriter& writer, const SourceHeader& header) {
  writer.put(kSourceMagic);
  writer.put(header.has_origin          ? kVersionWithOrigin
             : header.has_surface_error ? kVersionWithSurfaceError
                                        : kSourceVersion);
  writer.put(static_cast<std::uint8_t>(header.kind));
  writer.put_flag(header.base.has_value());
  if (header.base) writer.put_array<std::byte>(*header.base);
}

base::Result<SourceHeader> get_source_header(ByteReader& reader) {
  const auto magic = reader.get<std::uint64_t>();
  const auto version = reader.get<std::uint32_t>();
  if (reader.has_failed() || magic != kSourceMagic) {
    return base::Failure{"the record is no content of an object"};
  }
  if (version < kSourceVersion || version > kVersionWithOrigin) {
    return base::Failure{"the record is of version " + std::to_string(version) +
                         ", and this build reads versions " + std::to_string(kSourceVersion) +
                         " to " + std::to_string(kVersionWithOrigin)};
  }
  SourceHeader header;
  header.has_surface_error = version == kVersionWithSurfaceError;
  header.has_origin = version == kVersionWithOrigin;
  const auto kind = reader.get<std::uint8_t>();
  header.kind = static_cast<ObjectKind>(kind);
  if (reader.get_flag()) reader.get_array(std::span<std::byte>(header.base.emplace()));
  const bool is_of_map = header.base || header.has_origin;
  if (reader.has_failed() || header.kind > ObjectKind::kMap ||
      (is_of_map && header.kind != ObjectKind::kMap)) {
    return base::Failure{"the header of the record is wrong"};
  }
  return header;
}

SourceHeader header_of(const ObjectSource& source, const std::optional<BlobId>& base) {
  return {source.kind, has_surface_error(source.report), !source.map_origin_O.isZero(0.0), base};
}

void put_origin(ByteWriter& writer, const ObjectSource& source) {
  if (source.map_origin_O.isZero(0.0)) return;
  writer.put_array(std::span<const double>(source.map_origin_O.data(), 3));
}

/// Reads what `put_origin` writes, and nothing else: a source has one record.
std::optional<geometry::Vec3> get_origin(ByteReader& reader, const SourceHeader& header) {
  geometry::Vec3 origin = geometry::Vec3::Zero();
  if (!header.has_origin) return origin;
  reader.get_array(std::span<double>(origin.data(), 3));
  const bool is_sound = (origin.array().abs() < geometry::kLargestCoordinate_m).all();
  if (reader.has_failed() || !is_sound || origin.isZero(0.0)) return std::nullopt;
  return origin;
}

SourceResult map_source_from(ByteReader& reader, const SourceHeader& header, ImportReport report,
                             const ObjectSource* base, const ObjectOptions& options,
                             const VoxelMapLimits& largest_map) {
  if (header.base && (base == nullptr || !base->map_O)) {
    return base::Failure{"the record is a difference, and the map that it refers to is missing"};
  }
  const std::optional<geometry::Vec3> origin = get_origin(reader, header);
  if (!origin) return base::Failure{"the origin of the map is wrong"};
  base::Result<std::shared_ptr<const VoxelMap>> map =
      header.base ? get_map_difference(reader, *base->map_O) : get_map(reader, largest_map);
  if (!map) return base::Failure{std::move(map.error)};
  return make_map_source(*std::move(map), std::move(report), options, *origin);
}

SourceResult mesh_source_from(ByteReader& reader, ObjectKind kind, ImportReport report,
                              const ObjectOptions& options) {
  base::Result<Mesh> mesh = get_mesh(reader, kind != ObjectKind::kMesh);
  if (!mesh) return base::Failure{std::move(mesh.error)};
  if (!reader.is_at_end()) return base::Failure{"the record is longer than its mesh"};
  return make_source(kind, *std::move(mesh), std::move(report), options);
}

}  // namespace

Bytes record_of(const ObjectSource& source) {
  ByteWriter writer;
  const Mesh* const mesh = source.map_O ? nullptr : source.parts_O.front().mesh.get();
  if (mesh != nullptr) {
    writer.reserve(kUsualReportBytes + mesh->vertices.size() * sizeof mesh->vertices[0] +
                   mesh->triangles.size() * sizeof mesh->triangles[0]);
  }
  put_source_header(writer, header_of(source, std::nullopt));
  put_report(writer, source.report);
  put_origin(writer, source);
  if (mesh != nullptr) {
    put_mesh(writer, *mesh);
  } else {
    put_map(writer, *source.map_O);
  }
  return std::move(writer).take();
}

std::optional<Bytes> record_of_difference(const ObjectSource& source, const ObjectSource& before,
                                          const BlobId& base) {
  ByteWriter writer;
  put_source_header(writer, header_of(source, base));
  put_report(writer, source.report);
  put_origin(writer, source);
  const bool is_small = put_map_difference(writer, *source.map_O, *before.map_O,
                                           approximate_bytes(*source.map_O) / 2);
  if (!is_small) return std::nullopt;
  return std::move(writer).take();
}

base::Result<std::optional<BlobId>> base_of_record(const Bytes& record) {
  ByteReader reader(record);
  const base::Result<SourceHeader> header = get_source_header(reader);
  if (!header) return base::Failure{header.error};
  return header->base;
}

SourceResult source_from(const Bytes& record, const std::shared_ptr<const ObjectSource>& base,
                         const ObjectOptions& options, const VoxelMapLimits& largest_map) {
  ByteReader reader(record);
  const base::Result<SourceHeader> header = get_source_header(reader);
  if (!header) return base::Failure{header.error};
  std::optional<ImportReport> report = get_report(reader, header->has_surface_error);
  if (!report) return base::Failure{"the report of the record is wrong"};
  return header->kind == ObjectKind::kMap
             ? map_source_from(reader, *header, *std::move(report), base.get(), options,
                               largest_map)
             : mesh_source_from(reader, header->kind, *std::move(report), options);
}

}  // namespace camway::scene
