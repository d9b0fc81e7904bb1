// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace camway::tools {

/// The member that says, in a sentence a line, what of the session is not in the pack.
inline constexpr char kLeftOutName[] = "left-out.txt";
/// Most bytes that a pack may hold unpacked, unless the user allows more: as many as a recording
/// with the default of `record.most_bytes`.
inline constexpr std::uint64_t kMostUnpackedBytes = std::uint64_t{8} << 30;

/// A file of a session on its way into a pack.
struct PackedFile {
  std::filesystem::path file;
  std::string name;  ///< in the pack: "NAME.lcmlog", "blobs/" and the digest, or `kLeftOutName`
};

/// Packs files into one: a tar archive, compressed with zstd, whose first member `session.json`
/// lists the others with their sizes and digests. Writes it completely or not at all. Returns an
/// error, also where the pack is one of the files; empty on success. Requires names that
/// `is_pack_name` accepts, each once.
std::string write_pack(const std::filesystem::path& pack, const std::vector<PackedFile>& files);

/// Unpacks a file that anybody may have written into a new folder. Fails, with the name of the
/// member, if anything is missing, damaged, no plain file, or more than the list says, and before
/// it writes anything if the list says more than `most_bytes`, or more than the disk has room for.
/// Then leaves nothing. Returns an error, empty on success. Requires that `folder` does not exist.
std::string unpack(const std::filesystem::path& pack, const std::filesystem::path& folder,
                   std::uint64_t most_bytes = kMostUnpackedBytes);

/// Returns whether a pack may have a member of this name: no path leads out of the folder.
bool is_pack_name(const std::string& name);

/// Returns whether a file begins as a pack does.
bool looks_like_pack(const std::filesystem::path& file);

}  // namespace camway::tools
