// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/replay/session.h"

namespace camway::tools {

/// The requests of a session that a part of it keeps, and the revisions of scenes that they need.
struct CutPlan {
  std::set<std::pair<std::string, std::int64_t>> requests;  ///< client and request id
  /// Revisions by recording and scene.
  std::map<std::pair<std::string, std::string>, std::set<std::uint64_t>> revisions;
};

/// Returns the plan for the requests that `session` has, after a selection.
CutPlan plan_cut(const Session& session);

/// Copies the part of a log that `plan` keeps: requests with their answers, beginnings of files and
/// omissions, and each needed revision as a whole scene, which names only the contents that it
/// needs. Another omission, with the time of the first event, counts what is left out. Events
/// behind damage are not read. With `keys`, messages must be signed with one of them. Returns an
/// error, empty on success.
std::string cut_log(const std::filesystem::path& log, const std::string& prefix,
                    const wire::MessageKeys* keys, const CutPlan& plan,
                    const std::filesystem::path& file);

}  // namespace camway::tools
