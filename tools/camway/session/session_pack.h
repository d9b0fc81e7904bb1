// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace camway::tools {

/// The ending of packed sessions.
inline constexpr char kPackEnding[] = ".camway-session";

/// A file of a session on its way into a pack.
struct PackedFile {
  std::filesystem::path file;
  std::string name;  ///< in the pack: "NAME.lcmlog", or "blobs/" and the digest
};

/// Packs files into one: a tar archive, compressed with zstd, whose first member `session.json`
/// lists the others with their sizes and digests. Writes it completely or not at all. Returns an
/// error, empty on success. Requires names that `is_pack_name` accepts, each once.
std::string write_pack(const std::filesystem::path& pack, const std::vector<PackedFile>& files);

/// Unpacks a file that anybody may have written into a new folder. Fails, with the name of the
/// member, if anything is missing, damaged, or more than the list says, and then leaves nothing.
/// Returns an error, empty on success. Requires that `folder` does not exist.
std::string unpack(const std::filesystem::path& pack, const std::filesystem::path& folder);

/// Returns whether a pack may have a member of this name: no path leads out of the folder.
bool is_pack_name(const std::string& name);

/// Returns whether a file begins as a pack does.
bool looks_like_pack(const std::filesystem::path& file);

}  // namespace camway::tools
