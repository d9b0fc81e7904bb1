// SPDX-License-Identifier: MIT
#include "tools/camway/replay/event_log.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <optional>
#include <utility>

namespace camway::tools {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes = 28;
/// Longest channel name to accept. LCM itself cuts names at 63 characters.
constexpr std::uint64_t kMaxChannelBytes = 1024;

std::uint64_t big_endian(const unsigned char* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

class LogReader {
 public:
  LogReader(std::ifstream& stream, std::uint64_t size) : stream_(stream), left_(size) {}

  /// Returns the next event, or nothing at the end and at damage (see `damage`).
  std::optional<LogEvent> next() {
    if (left_ == 0) return std::nullopt;
    if (left_ < kHeaderBytes) return damaged("the log breaks off inside the head of the event");
    std::array<unsigned char, kHeaderBytes> head{};
    if (!read(head.data(), head.size())) return damaged("the file cannot be read");
    if (big_endian(head.data(), 4) != kSyncWord) return damaged("there is no event here");
    // A negative length becomes a huge one and fails the same checks.
    const std::uint64_t channel_bytes = big_endian(&head[20], 4);
    const std::uint64_t data_bytes = big_endian(&head[24], 4);
    if (channel_bytes == 0 || channel_bytes > kMaxChannelBytes || data_bytes > kMaxLogDataBytes) {
      return damaged(
          fmt::format("impossible lengths (channel {}, data {} bytes)", channel_bytes, data_bytes));
    }
    if (channel_bytes + data_bytes > left_ - kHeaderBytes) {
      return damaged(fmt::format("the log breaks off: the event needs {} bytes, {} are there",
                                 kHeaderBytes + channel_bytes + data_bytes, left_));
    }
    LogEvent event;
    event.number = static_cast<std::int64_t>(big_endian(&head[4], 8));
    event.utime = static_cast<std::int64_t>(big_endian(&head[12], 8));
    event.channel.resize(channel_bytes);
    event.data.resize(data_bytes);
    if (!read(event.channel.data(), channel_bytes) || !read(event.data.data(), data_bytes)) {
      return damaged("the file cannot be read");
    }
    left_ -= kHeaderBytes + channel_bytes + data_bytes;
    return event;
  }

  [[nodiscard]] const std::string& damage() const { return damage_; }
  [[nodiscard]] std::uint64_t bytes_left() const { return left_; }

 private:
  bool read(void* into, std::size_t count) {
    stream_.read(static_cast<char*>(into), static_cast<std::streamsize>(count));
    return static_cast<std::size_t>(stream_.gcount()) == count;
  }

  std::nullopt_t damaged(std::string reason) {
    damage_ = std::move(reason);
    return std::nullopt;
  }

  std::ifstream& stream_;
  std::uint64_t left_;
  std::string damage_;
};

}  // namespace

LogSummary read_event_log(const std::filesystem::path& file,
                          const std::function<void(LogEvent&&)>& visit) {
  LogSummary summary;
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(file, error);
  const std::uintmax_t size = regular ? std::filesystem::file_size(file, error) : 0;
  std::ifstream stream;
  if (regular && !error) stream.open(file, std::ios::binary);
  if (!regular || error || !stream) {
    summary.damage = fmt::format(
        "{}: {}", file.string(),
        std::filesystem::exists(file, error) ? "cannot be read as a file" : "does not exist");
    return summary;
  }
  summary.bytes = size;
  LogReader reader(stream, size);
  while (std::optional<LogEvent> event = reader.next()) {
    ++summary.events;
    visit(std::move(*event));
  }
  summary.bytes_used = size - reader.bytes_left();
  if (!reader.damage().empty()) {
    summary.damage = fmt::format("{}: at byte {} of {}: {}; {} good {} before it", file.string(),
                                 summary.bytes_used, size, reader.damage(), summary.events,
                                 summary.events == 1 ? "event" : "events");
  }
  return summary;
}

}  // namespace camway::tools
