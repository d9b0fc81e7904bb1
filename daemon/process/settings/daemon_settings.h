// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/process/settings/daemon_options.h"

namespace camway::process {

/// A setting of the configuration file, bound to its member of the options. `settings_of` is the
/// only list of settings: the reader of the file, the ranges, the sample and reloading all use it.
struct Setting {
  using Target =
      std::variant<std::string*, bool*, int*, std::size_t*, double*, std::chrono::milliseconds*,
                   service::LogLevel*, service::LogFormat*, FleetRole*>;

  std::string_view key;  ///< "queue.requests"; its suffix is its unit, `_s` for durations
  Target target;
  /// Range of a number, both ends included, in the unit of the key.
  double least = 0.0;
  double most = 0.0;
  bool reloads = false;  ///< SIGHUP applies a new value; otherwise it needs a restart
  /// Returns an error about a text, or an empty text. Null if any text is valid.
  std::string (*fault_of_text)(const std::string&) = nullptr;
  /// Whether a text names a file, or folders with ':' between them. A relative path in a
  /// configuration file is relative to the folder of the file. A relative path of a flag is
  /// relative to the working directory of the daemon.
  enum class Path { kNone, kFile, kFolders } path = Path::kNone;

  /// Returns the value as the file would have it.
  [[nodiscard]] std::string text() const;
  /// Sets the value. Returns an error, e.g. "must be within 1 to 256", or an empty text.
  [[nodiscard]] std::string set(std::string_view value) const;
  [[nodiscard]] std::string set(double value) const;
  /// Sets the value from a word of the command line: a number, or a text without quotes. Not for
  /// switches.
  [[nodiscard]] std::string set_word(std::string_view word) const;
  /// Sets a switch. Not called `set`, which would take a text without quotes for a switch.
  void turn(bool on) const;
  /// Returns the words that `set` takes; empty if it takes others as well.
  [[nodiscard]] std::vector<std::string_view> choices() const;
  /// Returns which kind of value `set` takes.
  [[nodiscard]] bool is_text() const;
  /// Returns `value` with every relative path in it put below `folder`; `value` itself if it is no
  /// path.
  [[nodiscard]] std::string below(const std::filesystem::path& folder,
                                  std::string_view value) const;
  [[nodiscard]] bool is_whole_number() const;
  [[nodiscard]] bool is_switch() const;
};

/// Returns every setting except the list of scenes, bound to `options`, in the order of the sample.
std::vector<Setting> settings_of(DaemonOptions& options);

/// A setting whose value differs between two sets of options.
struct SettingChange {
  std::string_view key;
  std::string before;
  std::string after;
  bool reloads = false;
};
std::vector<SettingChange> changes_between(DaemonOptions before, DaemonOptions after);

}  // namespace camway::process
