// SPDX-License-Identifier: MIT
#include "daemon/service/log.h"

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
/// The rest of the object is what is logged.
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

bool needs_quotes(char c) { return is_control(c) || c == ' ' || c == '"' || c == '=' || c == '\\'; }

/// Text without control characters; in quotes, and escaped as in C, if it could be taken for
/// several words.
std::string as_value(std::string_view text) {
  if (!text.empty() && std::ranges::none_of(text, needs_quotes)) return std::string(text);
  std::string value = "\"";
  for (const char c : text) {
    if (c == '\n') {
      value += "\\n";
    } else if (is_control(c)) {
      fmt::format_to(std::back_inserter(value), "\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      if (c == '"' || c == '\\') value += '\\';
      value += c;
    }
  }
  return value + '"';
}

std::string as_value(std::int64_t number) { return std::to_string(number); }
std::string as_value(double number) { return fmt::format("{:g}", number); }

std::string text_line(std::string_view event, LogFields facts) {
  std::string line;
  for (const char c : event) line += is_control(c) ? '?' : c;
  for (const LogField& fact : facts) {
    line += fmt::format(" {}={}", fact.key,
                        std::visit([](const auto& value) { return as_value(value); }, fact.value));
  }
  return line;
}

std::string json_line(std::string_view event, LogFields facts) {
  nlohmann::ordered_json object{{"event", event}};
  for (const LogField& fact : facts) {
    std::visit([&](const auto& value) { object[std::string(fact.key)] = value; }, fact.value);
  }
  using Json = nlohmann::ordered_json;
  return object.dump(-1, ' ', false, Json::error_handler_t::replace).substr(1);
}

/// Writes each line at once. A line that found no room (a full disk) is lost, but not those after
/// it.
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

void Log::write(LogLevel level, std::string_view event, LogFields facts) noexcept {
  try {
    if (!writes(level)) return;
    const std::string line =
        library_->format == LogFormat::kText ? text_line(event, facts) : json_line(event, facts);
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
