// SPDX-License-Identifier: MIT
#include "daemon/cli_support/flag_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace camway::cli_support {
namespace {

constexpr std::size_t kMostChanges = 2;

/// Returns the least number of letters to leave out, add, change or swap with a neighbour that turn
/// `b` into `a` (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, change});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

/// Returns the innermost command that was named.
const CLI::App& called(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return *command;
}

/// "camway scene put".
std::string full_name(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return (parent == nullptr ? "" : full_name(*parent) + " ") + command.get_name();
}

std::string see_help(const CLI::App& command) {
  return fmt::format(" (see {} --help)", full_name(command));
}

std::vector<std::string> flags_of(const CLI::App& command) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  }
  return flags;
}

std::vector<std::string> commands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(sub->get_name());
  }
  return names;
}

bool is_flag(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

/// Returns the flag in a word: "--length" in "--length=2".
std::string flag_in(const std::string& word) { return word.substr(0, word.find('=')); }

bool has_flag(const CLI::App& command, const std::string& flag) {
  return std::ranges::any_of(command.get_options(),
                             [&](const CLI::Option* option) { return option->check_name(flag); });
}

/// Returns a sentence about the first flag whose value was left out: it is another flag of the
/// command, or the empty name of a file or folder. Empty if there is none.
std::string missing_value(const CLI::App& app) {
  const CLI::App& command = called(app);
  for (const CLI::Option* option : command.get_options()) {
    if (!option->nonpositional()) continue;
    const std::string form = option->get_type_name();
    const bool is_path = form.starts_with("FILE") || form.starts_with("DIR");
    for (const std::string& word : option->results()) {
      if (is_path && word.empty()) {
        return option->get_name() + ": needs a value; it is empty" + see_help(command);
      }
      if (!is_flag(word) || !has_flag(command, flag_in(word))) continue;
      return fmt::format("{}: needs a value; '{}' is a flag", option->get_name(), flag_in(word)) +
             see_help(command);
    }
  }
  return {};
}

/// Returns the form of an option's values: "X,Y,Z". The library appends the ranges.
std::string form_of(const CLI::Option& option) {
  const std::string form = option.get_type_name();
  return form.substr(0, form.find(':'));
}

/// Returns what is wrong with the number of values of `option`, about which the library said
/// `text`.
std::string count_fault(const CLI::App& command, const CLI::Option& option,
                        const std::string& text) {
  const std::size_t given = option.results().size();
  if (given == 0 || text.ends_with("missing")) return "needs a value";
  const auto wanted = static_cast<std::size_t>(std::max(option.get_items_expected_max(), 1));
  if (std::ranges::count(command.parse_order(), &option) > 1 && given % wanted == 0) {
    const std::size_t times = given / wanted;
    return times == 2 ? "given twice" : fmt::format("given {} times", times);
  }
  return fmt::format("takes {} values ({}), not {}", wanted, form_of(option), given);
}

/// Returns the words about an error of the library.
std::string worded(const CLI::App& command, const CLI::ParseError& error) {
  const std::string text = error.what();
  if (error.get_name() != "ArgumentMismatch") return text;
  for (const CLI::Option* option : command.get_options()) {
    const std::string head = option->get_name() + ": ";
    if (text.starts_with(head)) return head + count_fault(command, *option, text);
  }
  return text;
}

std::string or_nearest(const std::string& word, const std::vector<std::string>& words) {
  const std::string nearest = nearest_word(word, words);
  return nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
}

/// Returns a question about the one flag that the command needs and did not get, if `word` may be
/// its value.
std::string or_flag_of(const std::string& word, const CLI::App& command) {
  const CLI::Option* needed = nullptr;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required() || option->count() > 0 || !option->nonpositional()) continue;
    if (needed != nullptr) return {};
    needed = option;
  }
  return needed == nullptr ? "" : fmt::format("; did you mean {} {}?", needed->get_name(), word);
}

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool is_whole_text = !text.empty() && end == text.c_str() + text.size();
  return is_whole_text && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// A check that `rule` names: "must be above 0, not '-1'".
template <class Passes>
CLI::Validator number_that(const std::string& rule, const std::string& in_help, Passes passes) {
  const auto check = [=](const std::string& text) {
    const std::optional<double> number = number_of(text);
    if (number && passes(*number)) return std::string();
    return fmt::format("must be {}, not '{}'", rule, text);
  };
  return CLI::Validator(check, in_help);
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& words) {
  std::size_t least = std::max(kMostChanges, word.size() / 3) + 1;
  std::string nearest;
  for (const std::string& candidate : words) {
    const std::size_t changes = edit_distance(word, candidate);
    // Otherwise any two words of two letters would be near.
    if (changes >= least || changes >= candidate.size()) continue;
    least = changes;
    nearest = candidate;
  }
  return nearest;
}

std::string unknown_word(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining(/*recurse=*/true);
  if (left.empty()) return {};
  const CLI::App& command = called(app);
  const std::vector<std::string> commands = commands_of(command);
  if (!commands.empty() && !is_flag(left.front())) {
    return fmt::format("'{}' is no command of {}{}", left.front(), full_name(command),
                       or_nearest(left.front(), commands)) +
           see_help(command);
  }
  const auto flag = std::ranges::find_if(left, is_flag);
  if (flag == left.end()) {
    return fmt::format("'{}' is a word too many for {}{}", left.front(), full_name(command),
                       or_flag_of(left.front(), command)) +
           see_help(command);
  }
  const std::string name = flag_in(*flag);
  return fmt::format("'{}' is no flag of {}{}", name, full_name(command),
                     or_nearest(name, flags_of(command))) +
         see_help(command);
}

void refuse_missing_values(CLI::App& app) {
  // The library calls this before the commands run.
  app.parse_complete_callback([&app] {
    const std::string fault = missing_value(app);
    if (!fault.empty()) throw CLI::ValidationError(fault);
  });
}

std::string command_line_fault(const CLI::App& app, const CLI::ParseError& error) {
  // First, because the value of that flag may have become a word too many.
  std::string without_value = missing_value(app);
  if (!without_value.empty()) return without_value;
  std::string unknown = unknown_word(app);
  if (!unknown.empty()) return unknown;
  const CLI::App& command = called(app);
  const std::vector<std::string> commands = commands_of(command);
  const bool misses_command = error.get_name() == "RequiredError" && !commands.empty();
  return (misses_command ? fmt::format("a command is missing: {}", fmt::join(commands, ", "))
                         : worded(command, error)) +
         see_help(command);
}

CLI::Validator above_0() {
  return number_that("a number above 0", "above 0", [](double value) { return value > 0.0; });
}

CLI::Validator at_least_0() {
  return number_that("a number, 0 or more", "0 or more", [](double value) { return value >= 0.0; });
}

CLI::Validator between(double least, double most) {
  return number_that(fmt::format("a number from {:g} to {:g}", least, most),
                     fmt::format("{:g} to {:g}", least, most),
                     [=](double value) { return value >= least && value <= most; });
}

CLI::Validator number_in(const NumberRange& range) {
  return number_that("a number " + range.words, range.words, range.holds);
}

CLI::Validator numbers_in(const std::string& form, const NumberRange& range) {
  const std::string& words = range.words;
  return number_that(fmt::format("{}, each a number{}{}", form, words.empty() ? "" : " ", words),
                     words, range.holds);
}

CLI::Option* add_numbers(CLI::App& command, const std::string& flag, std::vector<double>& numbers,
                         const std::string& form, const std::string& description,
                         const NumberRange& range) {
  const auto count = static_cast<int>(1 + std::ranges::count(form, ','));
  return command.add_option(flag, numbers, description)
      ->type_name(form)
      ->delimiter(',')
      ->expected(count)
      ->allow_extra_args(false)
      ->check(numbers_in(form, range));
}

CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
  const bool is_open = most == std::numeric_limits<std::int64_t>::max();
  const std::string range =
      is_open ? fmt::format("{} or more", least) : fmt::format("{} to {}", least, most);
  const auto check = [=](const std::string& text) {
    errno = 0;
    char* end = nullptr;
    const long long value = std::strtoll(text.c_str(), &end, 10);
    const bool is_number = !text.empty() && end == text.c_str() + text.size() && errno == 0;
    if (is_number && value >= least && value <= most) return std::string();
    // A number that is too large has to be told of the end that is left out.
    return errno == ERANGE
               ? fmt::format("must be a whole number, {} to {}, not '{}'", least, most, text)
               : fmt::format("must be a whole number, {}, not '{}'", range, text);
  };
  return CLI::Validator(check, range);
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto check = [=](const std::string& text) {
    if (std::ranges::find(words, text) != words.end()) return std::string();
    return fmt::format("must be one of {}, not '{}'{}", fmt::join(words, ", "), text,
                       or_nearest(text, words));
  };
  return CLI::Validator(check, fmt::format("{}", fmt::join(words, "|")));
}

}  // namespace camway::cli_support
