// SPDX-License-Identifier: MIT
#include "daemon/record/log_files.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

namespace camway::record {
namespace {

namespace fs = std::filesystem;
using scene::AppendFault;
using scene::AppendResult;
using Clock = BlobFolder::Clock;

constexpr char kNameBegin[] = "camway-";
constexpr char kTimeForm[] = "%Y%m%dT%H%M%SZ";

/// Names sort by the time when their files were begun.
std::string file_name(Clock::time_point begun, const std::string& recording, std::uint64_t part) {
  return fmt::format("{}{:%Y%m%dT%H%M%SZ}-{}-{:04}{}", kNameBegin,
                     fmt::gmtime(Clock::to_time_t(begun)), recording, part, kLogEnding);
}

/// Returns when a file was begun; nothing for a file that no recorder has written.
std::optional<Clock::time_point> begun_of(const fs::path& file) {
  const std::string name = file.filename();
  if (!name.starts_with(kNameBegin) || !name.ends_with(kLogEnding)) return std::nullopt;
  std::tm time{};
  if (strptime(name.c_str() + sizeof kNameBegin - 1, kTimeForm, &time) == nullptr) {
    return std::nullopt;
  }
  return Clock::from_time_t(timegm(&time));
}

/// Returns the files of recorders in a folder, the oldest first.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (begun_of(entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::uint64_t size_of(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace

std::string folder_fault(const fs::path& folder) {
  std::error_code error;
  fs::path there = fs::absolute(folder, error);
  while (!fs::exists(there, error) && !error && there.has_relative_path()) {
    there = there.parent_path();
  }
  const std::string begin =
      folder.string() +
      (there == fs::absolute(folder, error) ? " cannot be written: " : " cannot be made: ");
  if (!fs::is_directory(there, error)) return begin + there.string() + " is no folder";
  if (access(there.c_str(), W_OK | X_OK) == 0) return "";
  return begin + there.string() + ": " + std::generic_category().message(errno);
}

LogFiles::LogFiles(fs::path folder, std::string recording, const RecordLimits& limits,
                   base::FileDescriptor lock)
    : folder_(std::move(folder)),
      recording_(std::move(recording)),
      limits_(limits),
      lock_(std::move(lock)),
      blobs_(folder_ / kBlobFolder),
      all_bytes_(blobs_.bytes()) {
  for (const fs::path& file : files_in(folder_)) all_bytes_ += size_of(file);
}

base::Result<LogFiles> LogFiles::open(const fs::path& folder, std::string recording,
                                      const RecordLimits& limits) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return base::Failure{folder.string() + ": cannot be made: " + error.message()};
  const fs::path lock_file = folder / ".lock";
  base::FileDescriptor lock(
      ::open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (!lock.is_open()) {
    return base::Failure{lock_file.string() +
                         ": cannot be written: " + std::generic_category().message(errno)};
  }
  if (flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    return base::Failure{folder.string() + ": another daemon records into it"};
  }
  return LogFiles(folder, std::move(recording), limits, std::move(lock));
}

bool LogFiles::is_over(std::size_t waiting_bytes) const {
  return !fd_ || file_bytes_ + waiting_bytes >= limits_.file_bytes ||
         Steady::now() - begun_ >= limits_.file_time;
}

AppendResult LogFiles::begin_next() {
  const fs::path file = folder_ / file_name(Clock::now(), recording_, part_ + 1);
  constexpr mode_t kMode = S_IRUSR | S_IWUSR | S_IRGRP;
  base::FileDescriptor fd(
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, kMode));
  if (!fd.is_open()) return append_result(file, errno);
  fd_.emplace(std::move(fd));
  file_ = file;
  file_bytes_ = 0;
  ++part_;
  begun_ = Steady::now();
  return {};
}

AppendResult LogFiles::append(std::span<const std::uint8_t> events) {
  if (!make_room(events.size())) {
    return {AppendFault::kFull, folder_.string() + ": has reached record.most_bytes"};
  }
  if (const int why = write_all(fd_->get(), events.data(), events.size()); why != 0) {
    // A torn event would end the reading of the file, with all events behind it.
    if (ftruncate(fd_->get(), static_cast<off_t>(file_bytes_)) != 0) fd_.reset();
    return append_result(file_, why);
  }
  file_bytes_ += events.size();
  all_bytes_ += events.size();
  return {};
}

AppendResult LogFiles::put_blob(const scene::BlobId& id, const scene::Bytes& bytes) {
  if (blobs_.touch(id)) return {};
  if (!make_room(bytes.size())) {
    return {AppendFault::kFull, folder_.string() + ": has reached record.most_bytes"};
  }
  std::uint64_t written = 0;
  AppendResult done = blobs_.put(id, bytes, written);
  all_bytes_ += written;
  return done;
}

bool LogFiles::make_room(std::uint64_t bytes) {
  while (all_bytes_ + bytes > limits_.most_bytes) {
    if (!remove_oldest()) return false;
  }
  return true;
}

bool LogFiles::remove_oldest() {
  const std::vector<fs::path> files = files_in(folder_);
  const auto oldest =
      std::ranges::find_if(files, [&](const fs::path& file) { return file != file_; });
  if (oldest == files.end()) return false;
  const std::uint64_t size = size_of(*oldest);
  if (unlink(oldest->c_str()) != 0) return false;
  all_bytes_ -= std::min(all_bytes_, size);
  // A file marks a blob as used when it begins or when a change needs it, so no remaining file
  // needs a blob that was last used before the first of them began.
  std::optional<Clock::time_point> first;
  for (const fs::path& file : files) {
    if (file == *oldest) continue;
    const auto begun = begun_of(file);
    first = first ? std::min(first, begun) : begun;
  }
  const std::uint64_t removed = first ? blobs_.remove_unused_since(*first) : 0;
  all_bytes_ -= std::min(all_bytes_, removed);
  return true;
}

}  // namespace camway::record
