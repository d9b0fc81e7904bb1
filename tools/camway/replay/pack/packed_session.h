// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/replay/scenes/scene_sources.h"
#include "tools/camway/replay/session.h"
#include "tools/camway/session/session_files.h"
#include "tools/support/scratch_folder.h"

namespace camway::tools {

/// A session that is to be packed.
struct PackSource {
  const SessionFiles& files;
  const Session& session;       ///< with the selected requests
  bool is_selection = false;    ///< whether only these are packed
  bool is_one_of_many = false;  ///< whether the user named several sessions
  std::string prefix;
  const wire::MessageKeys* keys = nullptr;  ///< may be null
  SceneSourceFlags scenes;
};

/// The files of a pack.
struct PackedSession {
  std::map<std::string, std::filesystem::path> members;  ///< by their names in the pack
  std::vector<std::string> left_out;  ///< sentences about what is not in the pack
  bool is_damaged = false;            ///< whether anything is left out that should be there
  std::vector<std::shared_ptr<const ScratchFolder>> made;  ///< folders of members that were made
};

/// Collects what a pack of `source` holds: its logs or the selected part of them, the contents of
/// scenes that these need and that are sound, and the scenes that answers of plain logs name. Fails
/// if a flag is wrong or a file cannot be read or written.
base::Result<PackedSession> collect_pack(const PackSource& source);

}  // namespace camway::tools
