// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <ostream>
#include <string_view>
#include <type_traits>
#include <variant>

namespace camway::service {

enum class LogLevel : std::uint8_t { kTrace, kDebug, kInfo, kWarn, kError, kOff };
enum class LogFormat : std::uint8_t { kText, kJson };

/// Names for `--log-level` and the configuration, in the order of the values.
inline constexpr std::array<std::string_view, 6> kLogLevels{"trace", "debug", "info",
                                                            "warn",  "error", "off"};
inline constexpr std::array<std::string_view, 2> kLogFormats{"text", "json"};

/// A key with a value in a line of the log. Does not copy its texts, which must outlive the call
/// that logs them. Integers above INT64_MAX wrap to negative numbers.
struct LogField {
  using Value = std::variant<std::string_view, std::int64_t, double>;

  LogField(std::string_view name, std::string_view text) : key(name), value(text) {}
  LogField(std::string_view name, double number) : key(name), value(number) {}
  template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
  LogField(std::string_view name, Integer number)
      : key(name), value(static_cast<std::int64_t>(number)) {}

  std::string_view key;
  Value value;
};
using LogFields = std::initializer_list<LogField>;

/// The daemon's log: one line for each event, with fields that a machine can read. The only place
/// that sees the logging library (spdlog). Nothing here throws.
/// Thread-safe.
///
/// As text: `[time] [camwayd] [info] answered client=a request=7 message="no way"`. As JSON: an
/// object on each line with `time`, `level`, `event` and the fields. No field has one of these
/// three names. Control characters and bytes that are not UTF-8 are written in another form
/// (`\x1b`), so that nobody can forge a line, or make a reader of logs take the log for binary
/// data.
class Log {
 public:
  /// Requires that `out` outlives this object and that nothing else writes to it.
  Log(std::ostream& out, LogFormat format, LogLevel level);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// Writes a line, unless `level` is below that of the log. A line that cannot be written is lost.
  void write(LogLevel level, std::string_view event, LogFields fields = {}) noexcept;
  void info(std::string_view event, LogFields fields = {}) noexcept {
    write(LogLevel::kInfo, event, fields);
  }
  void warn(std::string_view event, LogFields fields = {}) noexcept {
    write(LogLevel::kWarn, event, fields);
  }
  void error(std::string_view event, LogFields fields = {}) noexcept {
    write(LogLevel::kError, event, fields);
  }

  /// Returns whether lines of that level are written.
  [[nodiscard]] bool writes(LogLevel level) const;
  void set_level(LogLevel level);
  [[nodiscard]] LogLevel level() const;

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace camway::service
