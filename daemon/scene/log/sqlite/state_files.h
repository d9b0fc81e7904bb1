// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "daemon/base/file_descriptor.h"
#include "daemon/base/result.h"

namespace camway::scene {

/// Makes the content of a file, or the names in a folder, durable. Returns whether it did, and sets
/// `errno` if not.
[[nodiscard]] bool is_synced(const std::filesystem::path& path);

/// Makes a folder with mode 0700 if it is missing, with the folders above it, durably. Returns why
/// that failed; empty otherwise.
std::string make_state_folder(const std::filesystem::path& folder);

/// Returns the lock of a state folder, which no other process has until it is closed. Fails if
/// another one has it.
base::Result<base::FileDescriptor> lock_state_folder(const std::filesystem::path& folder);

/// Makes an empty file with mode 0600 in place of one that an interrupted process left, with what
/// SQLite wrote beside it. Returns why that failed; empty otherwise.
std::string make_empty_file(const std::filesystem::path& file);

/// Makes a finished file durable, then gives it its name, unless a file of that name is there.
/// Removes the file on failure. Returns why that failed; empty otherwise.
std::string publish_file(const std::filesystem::path& finished, const std::filesystem::path& file);

}  // namespace camway::scene
