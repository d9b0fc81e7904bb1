// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "daemon/base/result.h"
#include "daemon/scene/log/byte_stream.h"
#include "daemon/scene/voxels/voxel_map.h"

/// The part of a record that is an occupancy map: all of it, or the blocks that differ from those
/// of an earlier one. What follows from them (faces, solid) is not contained.
namespace camway::scene {

void put_map(ByteWriter& writer, const VoxelMap& map);
/// Fails if the bytes are no map, if its limits exceed `largest`, or if it has more voxels or
/// triangles than its own limits allow.
base::Result<std::shared_ptr<const VoxelMap>> get_map(ByteReader& reader,
                                                      const VoxelMapLimits& largest);

/// Writes the blocks of `map` that differ from those of `before`. Returns false, and may have
/// written something, if that takes more than `most_bytes`, or if `before` cannot become `map`
/// through `VoxelMap::with`.
bool put_map_difference(ByteWriter& writer, const VoxelMap& map, const VoxelMap& before,
                        std::uint64_t most_bytes);
/// Returns the map that `before` becomes. Fails as `get_map` does, or if `before` is another map
/// than the one that the blocks were compared with, as far as the numbers of voxels show.
base::Result<std::shared_ptr<const VoxelMap>> get_map_difference(ByteReader& reader,
                                                                 const VoxelMap& before);

/// Returns about the number of bytes that `put_map` writes. Takes no time.
std::uint64_t approximate_bytes(const VoxelMap& map);

}  // namespace camway::scene
