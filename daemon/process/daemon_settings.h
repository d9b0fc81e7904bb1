// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/process/options.h"

namespace camway::service {

/// A setting of the configuration file, bound to where its value goes. This list is all there is:
/// the file's reader, the range of each value, the sample and what a reload may change follow it.
struct Setting {
  using Target = std::variant<std::string*, bool*, int*, std::size_t*, double*,
                              std::chrono::milliseconds*, LogLevel*, LogFormat*>;

  std::string_view key;  ///< "queue.requests"; its unit is its suffix: durations are seconds (`_s`)
  Target target;
  /// Of numbers, both included, in the unit of the key.
  double least = 0.0;
  double most = 0.0;
  bool reloads = false;  ///< whether SIGHUP takes it over; else it needs a restart
  /// Of a text: what is wrong with it, or nothing. Null if any text will do.
  std::string (*fault_of_text)(const std::string&) = nullptr;
  /// Of a text: whether it names a file, or folders with ':' between them. A relative one in a
  /// configuration file is relative to that file's folder, one of a flag to the folder that the
  /// daemon is started in.
  enum class Path { kNone, kFile, kFolders } path = Path::kNone;

  /// The value as the file says it.
  [[nodiscard]] std::string text() const;
  /// Takes `value`; returns what is wrong with it, e.g. "must be within 1 to 256", or nothing.
  [[nodiscard]] std::string set(std::string_view value) const;
  [[nodiscard]] std::string set(double value) const;
  /// Takes `word` as a command line has it: a number or a text without quotes. Not of a switch.
  [[nodiscard]] std::string set_word(std::string_view word) const;
  /// Of a switch. Not `set`, which would take it for a text in quotes without a word.
  void turn(bool on) const;
  /// The kind of value that `set` takes.
  [[nodiscard]] bool is_text() const;
  /// `value` with every relative path in it below `folder`, where it has paths; else `value`.
  [[nodiscard]] std::string below(const std::filesystem::path& folder,
                                  std::string_view value) const;
  [[nodiscard]] bool is_whole_number() const;
  [[nodiscard]] bool is_switch() const;
};

/// Every setting but the list of scenes, bound to `options`, in the order of the sample.
std::vector<Setting> settings_of(DaemonOptions& options);

/// A setting that two sets of options do not have in common.
struct SettingChange {
  std::string_view key;
  std::string before;
  std::string after;
  bool reloads = false;
};
std::vector<SettingChange> changes_between(DaemonOptions before, DaemonOptions after);

}  // namespace camway::service
