// SPDX-License-Identifier: MIT
#include "daemon/record/event_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <span>
#include <utility>

#include "daemon/base/big_endian.h"
#include "daemon/base/file_descriptor.h"

namespace camway::record {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes = 28;
/// Longest channel name to accept. LCM itself cuts names at 63 characters.
constexpr std::uint64_t kMaxChannelBytes = 1024;
/// Bytes that are read at a time. Messages that are not wanted and longer are not read at all.
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

void append_big_endian(std::uint64_t value, int count, std::vector<std::uint8_t>& bytes) {
  for (int i = count - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

/// The bytes of a file from its beginning, of which any number may be passed over.
class ByteSource {
 public:
  ByteSource(int fd, std::uint64_t size) : fd_(fd), size_(size) {}

  [[nodiscard]] std::uint64_t left() const { return size_ - at_; }
  [[nodiscard]] std::uint64_t position() const { return at_; }
  void skip(std::uint64_t count) { at_ += count; }

  /// Copies the next bytes. Returns false if they cannot be read.
  bool read(std::uint8_t* into, std::size_t count) {
    while (count > 0) {
      const std::uint64_t offset = at_ - chunk_at_;
      if (at_ < chunk_at_ || offset >= chunk_.size()) {
        if (!fill()) return false;
        continue;
      }
      const std::size_t part = std::min(count, chunk_.size() - static_cast<std::size_t>(offset));
      std::copy_n(&chunk_[static_cast<std::size_t>(offset)], part, into);
      at_ += part;
      into += part;
      count -= part;
    }
    return true;
  }

 private:
  bool fill() {
    chunk_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kChunkBytes, left())));
    ssize_t got = -1;
    do {
      got = pread(fd_, chunk_.data(), chunk_.size(), static_cast<off_t>(at_));
    } while (got < 0 && errno == EINTR);
    chunk_.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    chunk_at_ = at_;
    return !chunk_.empty();
  }

  int fd_;
  std::uint64_t size_;
  std::uint64_t at_ = 0;
  std::vector<std::uint8_t> chunk_;
  std::uint64_t chunk_at_ = 0;
};

class LogReader {
 public:
  LogReader(int fd, std::uint64_t size, const WantsChannel& wants)
      : source_(fd, size), wants_(wants) {}

  /// Reads the next event. Returns false at the end and at damage (see `damage`). Sets `wanted` to
  /// the event if its channel is wanted, else to nothing.
  bool next(std::optional<LogEvent>& wanted) {
    wanted.reset();
    good_ = source_.position();
    if (source_.left() == 0) return false;
    if (source_.left() < kHeaderBytes) {
      return damaged("the log breaks off inside the head of the event");
    }
    std::array<std::uint8_t, kHeaderBytes> head;
    const auto number_at = [&](std::size_t offset, std::size_t count) {
      return base::big_endian(std::span(head).subspan(offset, count));
    };
    const std::uint64_t left = source_.left();
    if (!source_.read(head.data(), kHeaderBytes)) return damaged("the file cannot be read");
    if (number_at(0, 4) != kSyncWord) return damaged("there is no event here");
    // A negative length becomes a huge one and fails the same checks.
    const std::uint64_t channel_bytes = number_at(20, 4);
    const std::uint64_t data_bytes = number_at(24, 4);
    if (channel_bytes == 0 || channel_bytes > kMaxChannelBytes || data_bytes > kMaxLogDataBytes) {
      return damaged(
          fmt::format("impossible lengths (channel {}, data {} bytes)", channel_bytes, data_bytes));
    }
    if (channel_bytes + data_bytes > left - kHeaderBytes) {
      return damaged(fmt::format("the log breaks off: the event needs {} bytes, {} are there",
                                 kHeaderBytes + channel_bytes + data_bytes, left));
    }
    channel_.resize(channel_bytes);
    if (!read(channel_)) return damaged("the file cannot be read");
    if (!wants_(channel_)) {
      source_.skip(data_bytes);
      return true;
    }
    LogEvent& event = wanted.emplace();
    event.number = static_cast<std::int64_t>(number_at(4, 8));
    event.utime = static_cast<std::int64_t>(number_at(12, 8));
    event.channel = channel_;
    event.data.resize(data_bytes);
    return read(event.data) || damaged("the file cannot be read");
  }

  [[nodiscard]] const std::string& damage() const { return damage_; }
  /// The end of the last good event.
  [[nodiscard]] std::uint64_t good() const { return good_; }

 private:
  template <class Bytes>
  bool read(Bytes& into) {
    return source_.read(reinterpret_cast<std::uint8_t*>(into.data()), into.size());
  }

  bool damaged(std::string reason) {
    damage_ = std::move(reason);
    return false;
  }

  ByteSource source_;
  const WantsChannel& wants_;
  std::string channel_;
  std::uint64_t good_ = 0;
  std::string damage_;
};

}  // namespace

LogSummary read_event_log(const std::filesystem::path& file, const WantsChannel& wants,
                          const VisitEvent& visit) {
  LogSummary summary;
  // A pipe would be waited for without O_NONBLOCK.
  const base::FileDescriptor fd(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat state {};
  if (!fd.is_open() || fstat(fd.get(), &state) != 0 || !S_ISREG(state.st_mode)) {
    const bool is_missing = !fd.is_open() && errno == ENOENT;
    summary.damage = fmt::format("{}: {}", file.string(),
                                 is_missing ? "does not exist" : "cannot be read as a file");
    return summary;
  }
  summary.bytes = static_cast<std::uint64_t>(state.st_size);
  LogReader reader(fd.get(), summary.bytes, wants);
  std::optional<LogEvent> event;
  while (reader.next(event)) {
    ++summary.events;
    if (event) visit(*std::move(event));
  }
  summary.bytes_used = reader.good();
  if (!reader.damage().empty()) {
    summary.damage = fmt::format("{}: at byte {} of {}: {}; {} good {} before it", file.string(),
                                 summary.bytes_used, summary.bytes, reader.damage(), summary.events,
                                 summary.events == 1 ? "event" : "events");
  }
  return summary;
}

LogSummary read_event_log(const std::filesystem::path& file, const VisitEvent& visit) {
  return read_event_log(
      file, [](std::string_view) { return true; }, visit);
}

void append_event(std::int64_t number, std::int64_t utime, std::string_view channel,
                  std::span<const std::uint8_t> data, std::vector<std::uint8_t>& log) {
  append_big_endian(kSyncWord, 4, log);
  append_big_endian(static_cast<std::uint64_t>(number), 8, log);
  append_big_endian(static_cast<std::uint64_t>(utime), 8, log);
  append_big_endian(channel.size(), 4, log);
  append_big_endian(data.size(), 4, log);
  log.insert(log.end(), channel.begin(), channel.end());
  log.insert(log.end(), data.begin(), data.end());
}

}  // namespace camway::record
