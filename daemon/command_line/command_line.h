// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

/// What the command lines of `camway` and `camwayd` have in common: what their errors say.
namespace camway::service {

/// Returns the one of `words` that `word` was probably meant to be: the fewest letters left out,
/// added, changed or swapped, at most a third of its length or 2. Empty if none is so near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& words);

/// The first word of the command line that `app` does not know, in a sentence that names the
/// nearest right one and the help to look at. Empty if it knows all that it came to. To be called
/// after `app.parse`, whether it threw or not.
std::string unknown_word(const CLI::App& app);

/// What to say of a command line that `app` did not take: the unknown word, or `error`; with the
/// help to look at.
std::string command_line_fault(const CLI::App& app, const CLI::ParseError& error);

/// Checks of values, whose errors say what a value must be, in words and short numbers.
CLI::Validator above_0();
CLI::Validator at_least_0();
CLI::Validator between(double least, double most);
CLI::Validator whole_number(std::int64_t least,
                            std::int64_t most = std::numeric_limits<std::int64_t>::max());
CLI::Validator one_of(const std::vector<std::string>& words);

/// An option whose value is one of `names`, pairs of a word and what it stands for. `value` is set
/// when the option is given, and must outlive `command`.
template <class Target, class Names>
CLI::Option* add_choice(CLI::App& command, const std::string& flag, Target& value,
                        const Names& names, const std::string& description) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : names) words.emplace_back(word);
  const auto set = [&value, names](const std::string& given) {
    for (const auto& [word, meaning] : names) {
      if (word == given) value = meaning;
    }
  };
  return command.add_option_function<std::string>(flag, set, description)->check(one_of(words));
}

}  // namespace camway::service
