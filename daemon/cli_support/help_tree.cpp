// SPDX-License-Identifier: MIT
#include "daemon/cli_support/help_tree.h"

#include <set>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace camway::cli_support {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the flags of an option, short ones first; none for a positional.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& letter : option.get_snames()) names.push_back("-" + letter);
  for (const std::string& word : option.get_lnames()) names.push_back("--" + word);
  return names;
}

/// Returns the names in alphabetical order, as the library keeps options by their addresses.
std::set<std::string> sorted_names(const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* option : options) names.insert(option->get_name());
  return names;
}

Json described(const CLI::Option& option) {
  const bool takes_value = option.get_items_expected_max() > 0;
  const std::string type = takes_value ? option.get_type_name() : "";
  const std::size_t end = type.find(':');
  return {
      {"names", names_of(option)},
      {"word", option.get_positional() ? option.get_name(/*positional=*/true) : ""},
      {"form", type.substr(0, end)},
      {"check", end == std::string::npos ? "" : type.substr(end + 1)},
      {"description", option.get_description()},
      {"default", option.get_default_str()},
      {"group", option.get_group()},
      {"required", option.get_required()},
      {"repeats", option.get_expected_max() > 1},
      {"needs", sorted_names(option.get_needs())},
      {"excludes", sorted_names(option.get_excludes())},
  };
}

Json described(const CLI::App& app) {
  Json options = Json::array();
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_group().empty()) options.push_back(described(*option));  // "": hidden
  }
  Json commands = Json::array();
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(described(*command));
  }
  return {
      {"name", app.get_name()},          {"description", app.get_description()},
      {"footer", app.get_footer()},      {"options", std::move(options)},
      {"commands", std::move(commands)},
  };
}

}  // namespace

bool asks_for_help_tree(int argc, const char* const* argv) {
  return argc == 2 && std::string_view(argv[1]) == "--help-tree";
}

std::string help_tree(const CLI::App& app) { return described(app).dump() + "\n"; }

}  // namespace camway::cli_support
