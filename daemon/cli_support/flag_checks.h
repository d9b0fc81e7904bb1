// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

/// Parts that the command lines of `camway` and `camwayd` share: the wording of their errors.
namespace camway::cli_support {

/// Returns the one of `words` that `word` was probably meant to be: the one that needs the fewest
/// letters left out, added, changed or swapped, at most 2 or, if that is more, a third of its
/// length. Returns an empty text if none is so near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& words);

/// Returns a sentence about the first flag, or else word, that `app` does not know, which names the
/// nearest right one, or the needed flag that a word may be the value of, and the help. Empty if
/// all words that it read are known. Requires that `app.parse` was called, whether it threw or not.
std::string unknown_word(const CLI::App& app);

/// Makes `app.parse` throw `CLI::ValidationError`, before the command runs, where a flag of the
/// called command has another one of its flags as its value, or an empty text as the name of a file
/// or folder: `--response --no-timing` would write a file named `--no-timing`. Such a file can be
/// given as `./--no-timing`. `app` must outlive its calls of `parse`.
void refuse_missing_values(CLI::App& app);

/// Returns the message for a command line that `app` refused, with a reference to the help: about a
/// flag without its value, else about the unknown word, else about `error`.
std::string command_line_fault(const CLI::App& app, const CLI::ParseError& error);

/// Finite numbers: those that `holds` accepts.
struct NumberRange {
  std::string words;  ///< names them: "from 1 to 5"; empty for all finite numbers
  std::function<bool(double)> holds = [](double) { return true; };
};

/// Checks of values. Their errors say in words and short numbers what a value must be.
CLI::Validator above_0();
CLI::Validator at_least_0();
CLI::Validator between(double least, double most);
CLI::Validator number_in(const NumberRange& range);
/// Checks each number of a list. `form` names the numbers: "X,Y,Z".
CLI::Validator numbers_in(const std::string& form, const NumberRange& range);
CLI::Validator whole_number(std::int64_t least,
                            std::int64_t most = std::numeric_limits<std::int64_t>::max());
CLI::Validator one_of(const std::vector<std::string>& words);

/// Adds an option that takes a number for each name in `form`, "X,Y,Z", with commas between them.
CLI::Option* add_numbers(CLI::App& command, const std::string& flag, std::vector<double>& numbers,
                         const std::string& form, const std::string& description,
                         const NumberRange& range = {});

/// Adds an option whose value is one of `names`, which are pairs of a word and its meaning. Sets
/// `value` when the option is given; `value` must outlive `command`.
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

}  // namespace camway::cli_support
