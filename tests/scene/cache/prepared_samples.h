// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/scene/cache/cache_layout.h"
#include "daemon/scene/cache/prepared_scene.h"
#include "daemon/scene/cache/scene_key.h"
#include "daemon/scene/snapshot/snapshot.h"

/// Prepared scenes and their files, for tests and the fuzzer.
namespace camway::testing {

/// Returns what was prepared of a scene with one object.
scene::PreparedScene prepared_of(const scene::Snapshot& snapshot);

/// Returns a scene of 72 triangles with two objects, with a field or without.
scene::PreparedScene small_prepared(bool has_field);

/// The key that `file_of` writes.
inline constexpr scene::SceneKey kSampleKey{{1, 2, 3}};

/// Returns the bytes of the file with this scene.
std::vector<std::uint8_t> file_of(const scene::PreparedScene& prepared);

/// Reads a file from memory.
base::Result<scene::PreparedScene> read_bytes(std::span<const std::uint8_t> bytes);

/// Computes the digests of a forged file anew: those of the sections that lie in the file, and that
/// of the header. Leaves alone what has no header.
void reseal(std::span<std::uint8_t> bytes);

/// Returns the values of a section, to forge them. Requires a file that `file_of` made, and the
/// type that the section has.
template <class Value>
std::span<Value> values_in(std::span<std::uint8_t> bytes, scene::cache_layout::SectionName name) {
  const auto& header = *reinterpret_cast<const scene::cache_layout::Header*>(bytes.data());
  const scene::cache_layout::Section& section = header.sections[name];
  return {reinterpret_cast<Value*>(bytes.data() + section.offset), section.bytes / sizeof(Value)};
}

}  // namespace camway::testing
