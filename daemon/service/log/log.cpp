// SPDX-License-Identifier: MIT
#include "daemon/service/log/log.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/base_sink.h>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace camway::service {
namespace {

constexpr char kTextPattern[] = "[%Y-%m-%d %H:%M:%S.%e] [camwayd] [%l] %v";
/// The line itself is the rest of the object.
constexpr char kJsonPattern[] = R"({"time":"%Y-%m-%dT%H:%M:%S.%e%z","level":"%l",%v)";

spdlog::level::level_enum library_level(LogLevel level) {
  switch (level) {
    case LogLevel::kTrace:
      return spdlog::level::trace;
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarn:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
    case LogLevel::kOff:
      break;
  }
  return spdlog::level::off;
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

bool is_beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }

bool needs_quotes(char c) {
  return is_control(c) || is_beyond_ascii(c) || c == ' ' || c == '"' || c == '=' || c == '\\';
}

/// Returns whether a character beyond ASCII may stand in the log: no control of Latin-1 (U+0080 and
/// on), no line separator, and none that changes the direction of writing.
bool is_shown(char32_t c) {
  return c >= 0xA0 && !(c >= 0x2028 && c <= 0x202E) && !(c >= 0x2066 && c <= 0x2069);
}

/// Returns the bytes of the character beyond ASCII that `text` begins with; nothing if it is not
/// well-formed UTF-8 or not to be shown.
std::string_view shown_character(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < size) return {};
  char32_t character = first & (0xFFU >> (size + 1));
  for (const char next : text.substr(1, size - 1)) {
    const auto byte = static_cast<unsigned char>(next);
    if ((byte & 0xC0U) != 0x80) return {};
    character = (character << 6U) | (byte & 0x3FU);
  }
  const bool is_shortest = size == 2 || character >= (size == 3 ? 0x800U : 0x10000U);
  const bool is_surrogate = character >= 0xD800 && character <= 0xDFFF;
  const bool is_right = is_shortest && !is_surrogate && character <= 0x10FFFF;
  return is_right && is_shown(character) ? text.substr(0, size) : std::string_view{};
}

/// Returns `text` without control characters and bytes that are no text; in quotes, and escaped as
/// in C, if it could be taken for several words.
std::string as_value(std::string_view text) {
  if (!text.empty() && std::ranges::none_of(text, needs_quotes)) return std::string(text);
  std::string value = "\"";
  while (!text.empty()) {
    const char c = text.front();
    const std::string_view shown = is_beyond_ascii(c) ? shown_character(text) : text.substr(0, 1);
    if (c == '\n') {
      value += "\\n";
    } else if (is_control(c) || shown.empty()) {
      fmt::format_to(std::back_inserter(value), "\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      if (c == '"' || c == '\\') value += '\\';
      value += shown;
    }
    text.remove_prefix(std::max<std::size_t>(shown.size(), 1));
  }
  return value + '"';
}

std::string as_value(std::int64_t number) { return std::to_string(number); }
std::string as_value(double number) { return fmt::format("{:g}", number); }

std::string text_line(std::string_view event, LogFields fields) {
  std::string line;
  for (const char c : event) line += is_control(c) || is_beyond_ascii(c) ? '?' : c;
  for (const LogField& field : fields) {
    line += fmt::format(" {}={}", field.key,
                        std::visit([](const auto& value) { return as_value(value); }, field.value));
  }
  return line;
}

std::string json_line(std::string_view event, LogFields fields) {
  nlohmann::ordered_json object{{"event", event}};
  for (const LogField& field : fields) {
    std::visit([&](const auto& value) { object[std::string(field.key)] = value; }, field.value);
  }
  using Json = nlohmann::ordered_json;
  constexpr bool kEscapeBeyondAscii = true;
  return object.dump(-1, ' ', kEscapeBeyondAscii, Json::error_handler_t::replace).substr(1);
}

/// Writes each line at once. A line that cannot be written (a full disk) is lost, but later ones
/// are not.
class StreamSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit StreamSink(std::ostream& out) : out_(out) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    out_.clear();
    out_.write(line.data(), static_cast<std::streamsize>(line.size())).flush();
  }
  void flush_() override { out_.flush(); }

 private:
  std::ostream& out_;
};

}  // namespace

struct Log::Library {
  Library(std::ostream& out, LogFormat log_format)
      : format(log_format), logger("camwayd", std::make_shared<StreamSink>(out)) {
    logger.set_pattern(format == LogFormat::kText ? kTextPattern : kJsonPattern);
  }

  LogFormat format;
  spdlog::logger logger;
};

Log::Log(std::ostream& out, LogFormat format, LogLevel level)
    : library_(std::make_unique<Library>(out, format)) {
  set_level(level);
}

Log::~Log() = default;

void Log::write(LogLevel level, std::string_view event, LogFields fields) noexcept {
  try {
    if (!writes(level)) return;
    const std::string line =
        library_->format == LogFormat::kText ? text_line(event, fields) : json_line(event, fields);
    library_->logger.log(library_level(level), spdlog::string_view_t(line));
  } catch (...) {
    // Want of memory must not end the work that the line is about.
  }
}

bool Log::writes(LogLevel level) const { return library_->logger.should_log(library_level(level)); }

void Log::set_level(LogLevel level) { library_->logger.set_level(library_level(level)); }

LogLevel Log::level() const {
  for (const LogLevel level :
       {LogLevel::kTrace, LogLevel::kDebug, LogLevel::kInfo, LogLevel::kWarn, LogLevel::kError}) {
    if (library_level(level) == library_->logger.level()) return level;
  }
  return LogLevel::kOff;
}

}  // namespace camway::service
