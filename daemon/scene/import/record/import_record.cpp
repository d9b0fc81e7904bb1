// SPDX-License-Identifier: MIT
#include "daemon/scene/import/record/import_record.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

#include "daemon/geometry/exact_triangles.h"
#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/record/axes.h"
#include "daemon/scene/import/record/record_layout.h"
#include "daemon/scene/import/record/record_map.h"

namespace camway::scene {
namespace {

namespace layout = import_record;
using geometry::Vec3;
using layout::Record;

constexpr std::size_t kMostNotes = 50;
constexpr std::size_t kLongestNote = 500;

/// Parses a record. Checks every count against the remaining bytes before it allocates anything.
class RecordReader {
 public:
  explicit RecordReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  bool read(T& value) {
    if (rest_.size() < sizeof(T)) return false;
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_ = rest_.subspan(sizeof(T));
    return true;
  }

  template <class Container>
  bool read(Container& values, std::uint64_t count) {
    using T = typename Container::value_type;
    if (count > rest_.size() / sizeof(T)) return false;
    values.resize(static_cast<std::size_t>(count));
    if (count > 0) std::memcpy(values.data(), rest_.data(), values.size() * sizeof(T));
    rest_ = rest_.subspan(values.size() * sizeof(T));
    return true;
  }

  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

/// False for NaN.
bool is_sound_unit(double unit_m) {
  return unit_m == 0.0 || (unit_m >= layout::kSmallestUnit_m && unit_m <= layout::kLargestUnit_m);
}

bool parse(std::span<const std::byte> bytes, Record& record) {
  RecordReader reader(bytes);
  return reader.read(record.header) && record.header.magic == layout::kMagic &&
         record.header.relative_rounding >= 0.0 && record.header.absolute_rounding >= 0.0 &&
         record.header.surface_error >= 0.0 && is_sound_unit(record.header.unit_m) &&
         reader.read(record.text, record.header.text_bytes) &&
         reader.read(record.notes, record.header.note_bytes) &&
         reader.read(record.vertices, record.header.vertices) &&
         reader.read(record.triangles, record.header.triangles) &&
         reader.read(record.objects, record.header.objects) &&
         reader.read(record.names, record.header.name_bytes) &&
         reader.read(record.occupied, record.header.occupied) &&
         reader.read(record.free, record.header.free) && reader.at_end();
}

/// Texts from a file reach logs and JSON: characters other than printable ASCII become '?'.
std::string printable(std::string text) {
  for (char& c : text) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return text;
}

/// The lines of the notes, no more than a user reads.
std::vector<std::string> notes_of(const std::string& text) {
  std::vector<std::string> notes;
  for (std::size_t at = 0; at < text.size() && notes.size() < kMostNotes;) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    notes.push_back(printable(text.substr(at, std::min(end - at, kLongestNote))));
    at = end + 1;
  }
  return notes;
}

/// File coordinates to metres in the asked orientation.
Vec3 to_scene(const layout::Vertex& v, double scale, UpAxis up) {
  return turned(scale * Vec3(v[0], v[1], v[2]), up);
}

bool usable(const Vec3& p) {
  // False for NaN.
  return (p.array().abs() < geometry::kLargestCoordinate_m).all();
}

/// Builds the mesh of the valid triangles of a record, and counts the others.
class MeshBuilder {
 public:
  MeshBuilder(const Record& record, const ImportOptions& options, ImportReport& report)
      : record_(record),
        scale_(report.scale),
        up_(options.up),
        report_(report),
        new_index_(record.vertices.size(), kUnused) {}

  Mesh build() {
    std::size_t next = 0;
    std::size_t name_at = 0;
    for (const layout::Object& object : record_.objects) {
      const auto first = static_cast<std::uint32_t>(mesh_.triangles.size());
      const std::size_t end =
          std::min<std::size_t>(record_.triangles.size(), next + object.triangles);
      for (; next < end; ++next) add(record_.triangles[next]);
      const auto count = static_cast<std::uint32_t>(mesh_.triangles.size()) - first;
      const std::size_t at = std::min(name_at, record_.names.size());
      name_at += object.name_bytes;
      if (count == 0) continue;
      mesh_.objects.push_back(
          {printable(record_.names.substr(at, object.name_bytes)), first, count});
    }
    add_unclaimed(next);
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

  /// Objects cover all triangles, whatever the record says of them.
  void add_unclaimed(std::size_t next) {
    const auto first = static_cast<std::uint32_t>(mesh_.triangles.size());
    for (; next < record_.triangles.size(); ++next) add(record_.triangles[next]);
    const auto count = static_cast<std::uint32_t>(mesh_.triangles.size()) - first;
    if (count > 0) mesh_.objects.push_back({"", first, count});
  }

  void add(const layout::Triangle& indices) {
    geometry::Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      if (indices[k] >= record_.vertices.size()) {
        ++report_.dropped_bad_index;
        return;
      }
      triangle[k] = to_scene(record_.vertices[indices[k]], scale_, up_);
    }
    if (!usable(triangle[0]) || !usable(triangle[1]) || !usable(triangle[2])) {
      ++report_.dropped_nonfinite;
      return;
    }
    if (geometry::has_no_area_exactly(triangle)) {
      ++report_.degenerate_triangles;
      return;
    }
    std::array<std::uint32_t, 3> kept{};
    for (std::size_t k = 0; k < 3; ++k) kept[k] = keep_vertex(indices[k], triangle[k]);
    mesh_.triangles.push_back(kept);
  }

  /// Only vertices that a triangle uses are kept, in the order of their first use.
  std::uint32_t keep_vertex(std::uint32_t old_index, const Vec3& position) {
    std::uint32_t& index = new_index_[old_index];
    if (index == kUnused) {
      index = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(position);
    }
    return index;
  }

  const Record& record_;
  const double scale_;
  const UpAxis up_;
  ImportReport& report_;
  std::vector<std::uint32_t> new_index_;
  Mesh mesh_;
};

/// Makes the map and the mesh of a record without triangles. Returns why not, or an empty text.
std::string read_map(const Record& record, const ImportOptions& options, ImportReport& report,
                     ImportRecordResult& result) {
  const bool is_cloud = record.header.is_cloud != 0;
  RecordMap read = is_cloud ? map_of_cloud(record, options, report.scale)
                            : map_of_cubes(record, options, report.scale);
  result.limit = read.limit;
  std::ranges::move(read.notes, std::back_inserter(report.notes));
  if (!read.map) return std::move(read.refusal);
  if (!read.origin_m.isZero(0.0)) result.relative_rounding += geometry::kUnitRoundoff;
  result.mesh = joined(read.map->faces()->parts());
  result.map = std::move(read.map);
  result.map_origin_m = read.origin_m;
  return {};
}

}  // namespace

ImportRecordResult read_import_record(std::span<const std::byte> bytes,
                                      const ImportOptions& options, ImportReport& report) {
  Record record;
  ImportRecordResult result;
  result.broken = !parse(bytes, record);
  if (result.broken) return result;
  const bool is_map = record.header.map_resolution != 0.0 || record.header.is_cloud != 0;
  if (record.header.objects == 0 && !is_map) {
    result.refusal = printable(record.text);
    return result;
  }
  report.format = printable(record.text);
  report.notes = notes_of(record.notes);
  report.unit_m = record.header.unit_m;
  report.scale = options.scale * (report.unit_m == 0.0 ? 1.0 : report.unit_m);
  report.dropped_points_and_lines = record.header.dropped_points_and_lines;
  report.dropped_freeform = record.header.dropped_freeform;
  report.ignored_statements = record.header.ignored_statements;
  report.single_precision = record.header.single_precision != 0;
  result.relative_rounding = record.header.relative_rounding;
  result.absolute_rounding = record.header.absolute_rounding;
  result.surface_error = record.header.surface_error;
  if (is_map) {
    result.refusal = read_map(record, options, report, result);
  } else {
    result.mesh = MeshBuilder(record, options, report).build();
  }
  return result;
}

CameraRecordResult read_camera_record(std::span<const std::byte> bytes) {
  Record record;
  CameraRecordResult result;
  result.broken = !parse(bytes, record);
  if (result.broken) return result;
  if (record.header.unit_m != 0.0) result.unit_m = record.header.unit_m;
  result.cameras = std::move(record.names);
  if (result.cameras.empty()) result.refusal = printable(record.text);
  return result;
}

}  // namespace camway::scene
