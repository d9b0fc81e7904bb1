// SPDX-License-Identifier: MIT
#include "tools/camway/plan/option_flags.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/planning/request/option_table.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using planning::FieldSpec;

constexpr char kOptions[] = "options.";
constexpr char kMaxTurn[] = "options.orientation.max_turn";

char upper(char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }

/// Returns the name of a flag: "--deadline-s" for the member `deadline_s` of request files.
std::string flag_of(const FieldSpec& spec) {
  std::string flag = "--" + std::string(spec.file_name());
  std::ranges::replace(flag, '_', '-');
  return flag;
}

/// Returns the option with its old name in request files as its name there.
FieldSpec by_old_name(FieldSpec spec) {
  spec.file = spec.old_file;
  return spec;
}

/// Returns the meaning of an option without the marks of Markdown.
std::string description_of(const FieldSpec& spec) {
  std::string text(spec.help);
  std::erase(text, '`');
  if (!text.empty()) text[0] = upper(text[0]);
  return text;
}

CLI::Validator check_of(const FieldSpec& spec) {
  const auto holds = [spec](double value) {
    return spec.range.holds(spec.is_angle() ? radians(value) : value);
  };
  return cli_support::number_in({spec.range_text(), holds});
}

/// Adds the flag of one option, which sets `member`. Returns null for an option without a flag.
struct FlagAdder {
  CLI::App& command;

  CLI::Option* operator()(const FieldSpec& spec, double& member) const {
    const auto set = [&member, is_angle = spec.is_angle()](double value) {
      member = is_angle ? radians(value) : value;
    };
    return command.add_option_function<double>(flag_of(spec), set, description_of(spec))
        ->check(check_of(spec));
  }
  CLI::Option* operator()(const FieldSpec& spec, std::optional<double>& member) const {
    return command.add_option(flag_of(spec), member, description_of(spec))->check(check_of(spec));
  }
  template <std::integral Number>
  CLI::Option* operator()(const FieldSpec& spec, Number& member) const {
    constexpr auto kMost = static_cast<std::int64_t>(std::min<std::uint64_t>(
        std::numeric_limits<Number>::max(), std::numeric_limits<std::int64_t>::max()));
    const auto least = spec.range.any() ? static_cast<std::int64_t>(spec.range.least)
                                        : std::int64_t{std::numeric_limits<Number>::min()};
    return command.add_option(flag_of(spec), member, description_of(spec))
        ->check(cli_support::whole_number(least, kMost));
  }
  CLI::Option* operator()(const FieldSpec& spec, bool& member) const {
    return command.add_flag(flag_of(spec), member, description_of(spec));
  }
  template <base::NamedEnum Enum>
  CLI::Option* operator()(const FieldSpec& spec, Enum& member) const {
    std::string type(spec.name);
    std::ranges::transform(type, type.begin(), upper);
    return cli_support::add_choice(command, flag_of(spec), member, base::named_values<Enum>(),
                                   description_of(spec))
        ->type_name(type);
  }
  /// Objects have no flag.
  template <class Object>
  requires std::is_class_v<Object> CLI::Option* operator()(const FieldSpec&, Object&) const {
    return nullptr;
  }
};

}  // namespace

void OptionFlags::add_to(CLI::App& command) {
  const FlagAdder add{command};
  const auto keep = [this](std::string path, CLI::Option* flag) {
    if (flag == nullptr) return;
    flag->group("Options of the request, which these flags override");
    flags_.emplace(std::move(path), flag);
  };
  planning::visit_table(
      [&](const FieldSpec& spec, auto& member) {
        const std::string path = kOptions + std::string(spec.name);
        CLI::Option* const flag = add(spec, member);
        keep(path, flag);
        if (flag == nullptr || spec.old_file.empty()) return;
        CLI::Option* const old = add(by_old_name(spec), member);
        keep(path, old);
        old->excludes(flag)->description("Old name of " + flag->get_name());
      },
      options_);
  keep(kMaxTurn, add(planning::option::kMaxTurn, options_.orientation.max_turn_rad));
}

void OptionFlags::apply(planning::PlanRequest& request) const {
  std::map<std::string, std::string, std::less<>> given;
  for (const auto& [path, flag] : flags_) {
    if (flag->count() > 0) given.emplace(path, flag->get_name());
  }
  planning::visit_table(
      [&](const FieldSpec& spec, auto& member, const auto& flag) {
        if (given.contains(kOptions + std::string(spec.name))) member = flag;
      },
      request.options, options_);
  if (given.contains(kMaxTurn)) {
    request.options.orientation.max_turn_rad = options_.orientation.max_turn_rad;
  }
  request.spelling = [given = std::move(given),
                      otherwise = std::move(request.spelling)](std::string_view path) {
    const auto flag = given.find(path);
    return flag == given.end() ? otherwise(path) : flag->second;
  };
}

}  // namespace camway::tools
