// SPDX-License-Identifier: MIT
#include "tools/camway/cameras/log_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <utility>

#include "tools/json/json_document.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;
using base::Failure;

/// The structs of all given files.
base::Result<LcmTypes> read_types(const std::vector<std::string>& files) {
  LcmTypes types;
  for (const std::string& file : files) {
    const auto text = read_text(file);
    if (!text) return Failure{"--type: " + text.error};
    const std::string fault = read_lcm_types(*text, types);
    if (!fault.empty()) return Failure{"--type: " + file + ": " + fault};
  }
  return types;
}

/// A struct that one of `types` has a member of, which neither a file defined nor is in `lost`;
/// empty if there is none.
std::string missing_type(const LcmTypes& types, const std::set<std::string>& lost) {
  for (const auto& [name, type] : types) {
    for (const LcmMember& member : type.members) {
      if (!is_lcm_primitive(member.type) && !types.contains(member.type) &&
          !lost.contains(member.type)) {
        return member.type;
      }
    }
  }
  return "";
}

/// The two usual names of a struct's file.
std::array<std::string, 2> files_of(const std::string& name) {
  std::string full = name;
  std::ranges::replace(full, '.', '_');
  return {full + ".lcm", name.substr(name.rfind('.') + 1) + ".lcm"};
}

/// Looks for a struct in the files beside the given ones.
bool find_beside(const std::vector<std::string>& files, const std::string& name, LcmTypes& types) {
  for (const std::string& file : files) {
    for (const std::string& beside : files_of(name)) {
      const auto text = read_text((fs::path(file).parent_path() / beside).string());
      if (text && read_lcm_types(*text, types).empty() && types.contains(name)) return true;
    }
  }
  return false;
}

}  // namespace

base::Result<LogTypes> read_log_types(const std::vector<std::string>& files) {
  auto structs = read_types(files);
  if (!structs) return Failure{structs.error};
  LogTypes types{*std::move(structs), {}};
  std::set<std::string> lost;
  for (;;) {
    const std::string name = missing_type(types.structs, lost);
    if (name.empty()) return types;
    if (find_beside(files, name, types.structs)) continue;
    lost.insert(name);
    const auto [full, plain] = files_of(name);
    types.missing.push_back(
        fmt::format("{} is neither in the files of --type nor beside them in {}{}; another --type "
                    "names its file",
                    name, full, plain == full ? "" : " or " + plain));
  }
}

}  // namespace camway::tools
