// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// The record that the import process returns to the process that started it: flat, in the byte
/// order of the machine, since both are the same build on the same machine.
///
///     Header · text · notes · vertices · triangles · objects · names · occupied cubes · free cubes
///
/// A hostile file may have taken over its reader, so the receiver trusts no count.
namespace camway::scene::import_record {

inline constexpr std::uint64_t kMagic = 0x374D'5941'574D'4143;  // "CAMWAYM7"
inline constexpr int kOutputFd = 3;

/// The last argument of `camway-import` if it is to read cameras: then `names` is the text of
/// `scene/import/camera_import.h`, and there are no triangles.
inline constexpr const char* kCamerasArgument = "cameras";

/// Begins a note that belongs into the warnings of every answer.
inline constexpr std::string_view kWarningMark = "warning: ";

/// Exit codes of `camway-import`. Any other is a crash: sanitizers and abort handlers use small
/// ones.
inline constexpr int kExitOk = 0;            ///< a mesh was written
inline constexpr int kExitRefused = 40;      ///< `text` says why the file cannot be read
inline constexpr int kExitOutOfMemory = 41;  ///< nothing was written
inline constexpr int kExitInternal = 42;     ///< bad arguments, or writing failed
inline constexpr int kExitNotConfined = 43;  ///< seccomp does not work here, so nothing was read

/// Units of length that a file may state: from the picometre to the parsec.
inline constexpr double kSmallestUnit_m = 1e-12;
inline constexpr double kLargestUnit_m = 1e17;

struct Header {
  std::uint64_t magic = kMagic;
  std::uint64_t text_bytes = 0;  ///< size of the format's name, or of the error
  std::uint64_t note_bytes = 0;  ///< size of the notes
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t objects = 0;
  std::uint64_t name_bytes = 0;  ///< size of all names, one after the other
  std::uint64_t dropped_points_and_lines = 0;
  std::uint64_t dropped_freeform = 0;    ///< curved surfaces that the reader does not know
  std::uint64_t ignored_statements = 0;  ///< statements that no reader knows
  /// Coordinates differ from the numbers in the file by up to `relative_rounding` times their
  /// magnitude and, in file units, `absolute_rounding`.
  double relative_rounding = 0.0;
  double absolute_rounding = 0.0;
  /// Smooth surfaces are within this of their triangles, in file units.
  double surface_error = 0.0;
  double unit_m = 0.0;                 ///< metres per file unit as the file says; 0 if it does not
  std::uint64_t single_precision = 0;  ///< 1 if the reader keeps coordinates as floats
  /// Edge of a voxel in file units for an occupancy map, which has nothing but cubes; else 0.
  double map_resolution = 0.0;
  /// Origin of the voxels: the lowest corner of voxel (0, 0, 0), in file units.
  std::array<double, 3> map_origin{};
  /// 1 if the free cubes matter only where unknown space counts as occupied, for files that do not
  /// tell it from free space.
  std::uint64_t is_free_optional = 0;
  /// 1 for a cloud of points, which are the vertices, and nothing else.
  std::uint64_t is_cloud = 0;
  std::uint64_t occupied = 0;
  std::uint64_t free = 0;
};

using Vertex = std::array<double, 3>;  ///< node transforms applied, in file units
using Triangle = std::array<std::uint32_t, 3>;

struct Object {
  std::uint32_t triangles = 0;  ///< number, following those of the object before
  std::uint32_t name_bytes = 0;
};

/// Voxels of an occupancy map, numbered as in `VoxelGrid` from `Header::map_origin`.
struct Cube {
  std::array<std::int32_t, 3> min{};
  std::int32_t size = 1;  ///< voxels per edge
};

/// A record in memory, its members in the order in which they are written. The header's counts
/// equal the sizes of the members only after it was written or read.
struct Record {
  Header header;
  std::string text;
  std::string notes;  ///< sentences for the user about what was read and assumed, one on each line
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<Object> objects;
  std::string names;
  std::vector<Cube> occupied;
  std::vector<Cube> free;
};

/// Sets the counts of the header to the sizes of the members.
inline void set_counts(Record& record) {
  record.header.text_bytes = record.text.size();
  record.header.note_bytes = record.notes.size();
  record.header.vertices = record.vertices.size();
  record.header.triangles = record.triangles.size();
  record.header.objects = record.objects.size();
  record.header.name_bytes = record.names.size();
  record.header.occupied = record.occupied.size();
  record.header.free = record.free.size();
}

}  // namespace camway::scene::import_record
