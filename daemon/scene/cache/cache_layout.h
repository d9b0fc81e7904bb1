// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "daemon/base/digest.h"

/// The layout of a file of the cache: a `Header`, then the sections that it lists. Sections begin
/// at multiples of kAlignment and are arrays as they stand in memory.
namespace camway::scene::cache_layout {

static_assert(std::endian::native == std::endian::little, "files hold numbers as in memory");

inline constexpr std::uint64_t kMagic = 0x31454e4543534d43;  ///< "CMSCENE1"
inline constexpr std::uint64_t kAlignment = 64;

enum SectionName : std::size_t {
  kMetadata,    ///< one `Metadata`
  kText,        ///< texts one after the other, their sizes in `Metadata`
  kObjects,     ///< `Object` of each object of the mesh
  kVertices,    ///< `geometry::Vec3`
  kTriangles,   ///< three numbers of vertices each
  kFieldCodes,  ///< a byte for each cell; none without a field
  // Arrays of `IndexArrays`:
  kNodes,       ///< `IndexNode`
  kLeafBegin,   ///< a 32-bit number for each leaf, and one more
  kReferences,  ///< 32-bit numbers of triangles
  kBoxes,       ///< `ByteBoxes`
  kSectionCount,
};

struct Section {
  std::uint64_t offset = 0;  ///< from the start of the file, in bytes
  std::uint64_t bytes = 0;
  base::Digest::Bytes digest{};  ///< digest of these bytes
};

struct Header {
  std::uint64_t magic = kMagic;
  base::Digest::Bytes digest{};  ///< digest of the header with zeros here
  base::Digest::Bytes key{};     ///< `SceneKey`
  /// `scene_build`, which covers this layout: each build of other sources has its own format.
  std::array<char, 32> build{};
  std::array<Section, kSectionCount> sections{};
};

struct Metadata {
  // Sizes of the texts, in their order. After these texts come the names of the objects
  // (`Object::name_bytes`).
  std::uint64_t file_bytes = 0;  ///< name of the scene file, for lists
  std::uint64_t digest_bytes = 0;
  std::uint64_t format_bytes = 0;
  std::uint64_t why_no_field_bytes = 0;
  // How the file was read, for lists: `ImportOptions`.
  double scale = 1.0;
  std::uint64_t up = 0;
  // `ImportReport`; what is not here follows from the mesh and the options.
  std::uint64_t degenerate_triangles = 0;
  std::uint64_t dropped_nonfinite = 0;
  std::uint64_t dropped_bad_index = 0;
  std::uint64_t dropped_points_and_lines = 0;
  std::uint64_t dropped_freeform = 0;
  std::uint64_t ignored_statements = 0;
  std::uint64_t single_precision = 0;  ///< 0 or 1
  double rounding_m = 0.0;
  double surface_error_m = 0.0;
  // Bounds, bit for bit as computed: recomputing them could give 0 in place of -0.
  std::array<double, 6> mesh_bounds_m{};  ///< lowest corner, highest corner
  std::array<double, 6> tree_bounds_m{};
  // `DistanceField`; 0 without one.
  double field_resolution_m = 0.0;
  double field_settled_share = 0.0;
  std::uint64_t tree_depth = 0;
};

struct Object {
  std::uint32_t triangles = 0;
  std::uint32_t name_bytes = 0;
};

// No padding, so that every byte of a file has a value.
static_assert(sizeof(Section) == 32 && sizeof(Header) == 72 + 32 * kSectionCount);
static_assert(sizeof(Metadata) == 30 * sizeof(double));

}  // namespace camway::scene::cache_layout
