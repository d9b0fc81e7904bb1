// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"
#include "daemon/scene/snapshot/scene_object.h"

namespace camway::scene {

/// Returns the bytes from which `source_from` makes an equal source: its kind, its mesh or its map
/// with beliefs, and its import report. What the options determine (tree, field) is not contained.
/// Equal sources have equal bytes, whatever changes made them.
Bytes record_of(const ObjectSource& source);

/// Returns bytes that hold only the blocks of an occupancy map that differ from those of `before`,
/// whose record has the id `base`. Returns nothing if the blocks would take more than about half as
/// many bytes as in `record_of`, or if they are not enough: because resolution, limits, sensor or
/// the state of unknown space differ, or because a voxel is unknown that was known. Requires that
/// both sources are maps. The cost depends on the difference, where one map was made from the other
/// by scans.
std::optional<Bytes> record_of_difference(const ObjectSource& source, const ObjectSource& before,
                                          const BlobId& base);

/// Returns the id of the record that a difference refers to; nothing for a whole record.
base::Result<std::optional<BlobId>> base_of_record(const Bytes& record);

/// The largest limits that the daemon's settings let a map have.
inline constexpr VoxelMapLimits kLargestMapLimits{.voxels = 1'000'000'000'000,
                                                  .triangles = 4'000'000'000};

/// Returns the source of a record. `base`: the source of `base_of_record`, null for a whole record.
/// Fails, with what is wrong, for bytes that are not a record, whatever they are: no size is used
/// before it was compared with the number of bytes, and mesh and map are checked as an import is.
/// Only the space that is unknown, and counts as occupied, may be much larger than the bytes. The
/// limits of the map bound it, so maps with limits beyond `largest_map` are refused.
base::Result<std::shared_ptr<const ObjectSource>> source_from(
    const Bytes& record, const std::shared_ptr<const ObjectSource>& base,
    const ObjectOptions& options, const VoxelMapLimits& largest_map = kLargestMapLimits);

}  // namespace camway::scene
