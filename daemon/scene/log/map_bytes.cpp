// SPDX-License-Identifier: MIT
#include "daemon/scene/log/map_bytes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace camway::scene {
namespace {

using BlockBits = VoxelSet::Bits;
using MapOrFault = base::Result<std::shared_ptr<const VoxelMap>>;

// The contents of a block in a record, of which those that are there follow its head in this order.
constexpr unsigned kHasOccupied = 1;
constexpr unsigned kHasFree = 2;
constexpr unsigned kHasBeliefs = 4;
constexpr std::size_t kBlockHeadBytes = 9;  ///< key and contents
constexpr std::size_t kLeastBlockBytes = kBlockHeadBytes + sizeof(BlockBits);

unsigned content_of_block(const ScannedBlock& block) {
  return (block.occupied != BlockBits{} ? kHasOccupied : 0U) |
         (block.free != BlockBits{} ? kHasFree : 0U) | (block.beliefs ? kHasBeliefs : 0U);
}

std::size_t block_bytes(const ScannedBlock& block) {
  const unsigned content = content_of_block(block);
  return kBlockHeadBytes + ((content & kHasOccupied) != 0 ? sizeof(BlockBits) : 0) +
         ((content & kHasFree) != 0 ? sizeof(BlockBits) : 0) +
         ((content & kHasBeliefs) != 0 ? sizeof(Beliefs) : 0);
}

std::size_t block_bytes(const std::vector<ScannedBlock>& blocks) {
  std::size_t bytes = 0;
  for (const ScannedBlock& block : blocks) bytes += block_bytes(block);
  return bytes;
}

void put_blocks(ByteWriter& writer, const std::vector<ScannedBlock>& blocks) {
  writer.put_count(blocks.size());
  for (const ScannedBlock& block : blocks) {
    const unsigned content = content_of_block(block);
    writer.put(block.key);
    writer.put(static_cast<std::uint8_t>(content));
    if ((content & kHasOccupied) != 0) writer.put_array<std::uint64_t>(block.occupied);
    if ((content & kHasFree) != 0) writer.put_array<std::uint64_t>(block.free);
    if ((content & kHasBeliefs) != 0) writer.put_array<float>(*block.beliefs);
  }
}

/// Whether the block lies in the root of OctoMap's tree.
bool is_block_of_a_map(std::uint64_t key) {
  const Voxel low = BlockKey::low_of(key);
  return BlockKey::of(low) == key && std::ranges::all_of(low, [](std::int32_t at) {
           return at >= VoxelGrid::kMinVoxel && at <= VoxelGrid::kMaxVoxel;
         });
}

std::shared_ptr<const Beliefs> get_beliefs(ByteReader& reader) {
  const auto beliefs = std::make_shared<Beliefs>();
  reader.get_array(std::span<float>(*beliefs));
  if (!std::ranges::all_of(*beliefs, [](float belief) { return std::isfinite(belief); })) {
    reader.fail();
  }
  return beliefs;
}

/// Accepts only what `put_blocks` writes, so that equal blocks have equal bytes.
ScannedBlock get_block(ByteReader& reader) {
  ScannedBlock block;
  block.key = reader.get<std::uint64_t>();
  const unsigned content = reader.get<std::uint8_t>();
  if ((content & kHasOccupied) != 0) reader.get_array(std::span<std::uint64_t>(block.occupied));
  if ((content & kHasFree) != 0) reader.get_array(std::span<std::uint64_t>(block.free));
  if ((content & kHasBeliefs) != 0 && !reader.has_failed()) block.beliefs = get_beliefs(reader);
  if (content == 0 || content != content_of_block(block) || !is_block_of_a_map(block.key))
    reader.fail();
  return block;
}

/// Reads blocks in order of their keys, each once.
std::vector<ScannedBlock> get_blocks(ByteReader& reader) {
  std::vector<ScannedBlock> blocks;
  for (std::size_t left = reader.get_count(kLeastBlockBytes); left > 0; --left) {
    ScannedBlock block = get_block(reader);
    if (!blocks.empty() && block.key <= blocks.back().key) reader.fail();
    if (reader.has_failed()) return {};
    blocks.push_back(std::move(block));
  }
  return blocks;
}

/// The numbers of a map beside its blocks.
struct MapSettings {
  double resolution_m = 0.0;
  UnknownSpace unknown = UnknownSpace::kFree;
  VoxelMapLimits limits;
  SensorModel sensor;

  bool operator==(const MapSettings&) const = default;
};

MapSettings settings_of(const VoxelMap& map) {
  return {map.resolution_m(), map.unknown(), map.limits(), map.sensor()};
}

/// Calls `visit` for each number, in the order of the record.
template <class OfMap, class Visit>
void visit_settings(OfMap& settings, const Visit& visit) {
  visit(settings.resolution_m);
  visit(settings.limits.voxels);
  visit(settings.limits.triangles);
  visit(settings.sensor.hit_probability);
  visit(settings.sensor.miss_probability);
  visit(settings.sensor.least_probability);
  visit(settings.sensor.most_probability);
  visit(settings.sensor.max_range_m);
}

base::Result<MapSettings> get_settings(ByteReader& reader, const VoxelMapLimits& largest) {
  MapSettings settings;
  settings.unknown = reader.get_flag() ? UnknownSpace::kOccupied : UnknownSpace::kFree;
  visit_settings(settings,
                 [&](auto& number) { number = reader.get<std::decay_t<decltype(number)>>(); });
  if (reader.has_failed()) return base::Failure{"the map has no numbers"};
  if (!VoxelGrid::valid_resolution(settings.resolution_m)) {
    return base::Failure{"the map has a resolution that is not between 1e-9 and 1e9 m"};
  }
  if (settings.limits.voxels < 1 || settings.limits.triangles < 12) {
    return base::Failure{"the map has limits that allow no map"};
  }
  if (settings.limits.voxels > largest.voxels || settings.limits.triangles > largest.triangles) {
    return base::Failure{"the map has limits beyond those that a map may have here"};
  }
  const std::string fault = fault_in(settings.sensor);
  if (!fault.empty()) return base::Failure{"the map has a wrong sensor: " + fault};
  return settings;
}

VoxelMapResult map_without_blocks(const MapSettings& settings) {
  return VoxelMap::build(settings.resolution_m, {}, {}, settings.unknown, settings.limits,
                         settings.sensor);
}

MapOrFault checked_map(VoxelMapResult result) {
  if (!result.map) return base::Failure{"the map " + result.error};
  if (!result.map->faces()) return base::Failure{"the map has more triangles than its limit"};
  return std::move(result.map);
}

/// Builds the faces before the beliefs, because `build` does it on all processors at once, and
/// `with` has none to change then.
MapOrFault map_of_blocks(const MapSettings& settings, std::vector<ScannedBlock> blocks) {
  VoxelSet occupied;
  VoxelSet free;
  for (const ScannedBlock& block : blocks) {
    occupied.set_block(block.key, block.occupied);
    free.set_block(block.key, block.free);
  }
  MapOrFault built =
      checked_map(VoxelMap::build(settings.resolution_m, std::move(occupied), std::move(free),
                                  settings.unknown, settings.limits, settings.sensor));
  std::erase_if(blocks, [](const ScannedBlock& block) { return !block.beliefs; });
  if (!built || blocks.empty()) return built;
  return checked_map((*built)->with(blocks));
}

/// Whether `VoxelMap::with` may put these blocks into the map, and a record can hold them.
bool can_take(const VoxelMap& map, const std::vector<ScannedBlock>& blocks) {
  return std::ranges::all_of(blocks, [&](const ScannedBlock& block) {
    const BlockBits occupied = map.occupied().block(block.key);
    const BlockBits free = map.free().block(block.key);
    for (std::size_t z = 0; z < free.size(); ++z) {
      const std::uint64_t known = block.occupied[z] | block.free[z];
      if (((occupied[z] | free[z]) & ~known) != 0) return false;
    }
    return content_of_block(block) != 0;
  });
}

}  // namespace

void put_map(ByteWriter& writer, const VoxelMap& map) {
  const MapSettings settings = settings_of(map);
  const std::vector<ScannedBlock> blocks =
      map.blocks_changed_since(*map_without_blocks(settings).map);
  writer.reserve(writer.size() + sizeof settings + block_bytes(blocks) + sizeof(std::uint64_t));
  writer.put_flag(settings.unknown == UnknownSpace::kOccupied);
  visit_settings(settings, [&](const auto& number) { writer.put(number); });
  put_blocks(writer, blocks);
}

MapOrFault get_map(ByteReader& reader, const VoxelMapLimits& largest) {
  const base::Result<MapSettings> settings = get_settings(reader, largest);
  if (!settings) return base::Failure{settings.error};
  std::vector<ScannedBlock> blocks = get_blocks(reader);
  if (!reader.is_at_end()) return base::Failure{"the blocks of the map are wrong"};
  return map_of_blocks(*settings, std::move(blocks));
}

bool put_map_difference(ByteWriter& writer, const VoxelMap& map, const VoxelMap& before,
                        std::uint64_t most_bytes) {
  if (settings_of(map) != settings_of(before)) return false;
  const std::vector<ScannedBlock> blocks = map.blocks_changed_since(before);
  if (block_bytes(blocks) > most_bytes || !can_take(before, blocks)) return false;
  writer.put<std::uint64_t>(map.occupied().size());
  writer.put<std::uint64_t>(map.free().size());
  put_blocks(writer, blocks);
  return true;
}

MapOrFault get_map_difference(ByteReader& reader, const VoxelMap& before) {
  const auto occupied = reader.get<std::uint64_t>();
  const auto free = reader.get<std::uint64_t>();
  const std::vector<ScannedBlock> blocks = get_blocks(reader);
  if (!reader.is_at_end()) return base::Failure{"the changed blocks of the map are wrong"};
  if (!can_take(before, blocks)) return base::Failure{"the changed blocks are of another map"};
  MapOrFault result = checked_map(before.with(blocks));
  if (!result) return result;
  if ((*result)->occupied().size() != occupied || (*result)->free().size() != free) {
    return base::Failure{"the changed blocks are of another map"};
  }
  return result;
}

std::uint64_t approximate_bytes(const VoxelMap& map) {
  const std::uint64_t occupied = map.occupied().blocks();
  const std::uint64_t free = map.free().blocks();
  const std::uint64_t scanned = map.scanned_blocks();
  return kBlockHeadBytes * std::max({occupied, free, scanned}) +
         sizeof(BlockBits) * (occupied + free) + sizeof(Beliefs) * scanned;
}

}  // namespace camway::scene
