// SPDX-License-Identifier: MIT
#include "daemon/scene/import/upload_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <system_error>

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

constexpr char kNameBegin[] = "camway_upload_";

bool write_all(int file, const std::uint8_t* at, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(file, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

/// Waits if necessary: a process that removes abandoned files holds a lock for a moment.
bool lock(int file) {
  while (flock(file, LOCK_EX) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

/// Returns whether another process removed the file between its creation and its locking.
bool is_gone(int file) {
  struct stat status {};
  return fstat(file, &status) != 0 || status.st_nlink == 0;
}

/// Removes a file of this user that no process has locked. Returns whether it did.
bool remove_if_left(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  struct stat status {};
  const bool is_left = fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
                       status.st_uid == geteuid() && flock(file, LOCK_EX | LOCK_NB) == 0;
  const bool is_removed = is_left && unlink(path.c_str()) == 0;
  close(file);
  return is_removed;
}

}  // namespace

UploadFile::UploadFile(std::span<const std::uint8_t> bytes, const std::string& extension) {
  constexpr int kTries = 10;
  std::error_code failed;
  const fs::path folder = fs::temp_directory_path(failed);
  if (failed) return;
  for (int i = 0; i < kTries && path_.empty(); ++i) {
    std::string name = (folder / (std::string(kNameBegin) + "XXXXXX." + extension)).string();
    file_ = mkostemps(name.data(), static_cast<int>(extension.size()) + 1, O_CLOEXEC);
    if (file_ < 0) return;
    if (lock(file_) && !is_gone(file_)) {
      path_ = name;
    } else {
      close(file_);
      file_ = -1;
    }
  }
  is_good_ = !path_.empty() && write_all(file_, bytes.data(), bytes.size());
}

UploadFile::~UploadFile() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove(path_, ignored);
  if (file_ >= 0) close(file_);
}

std::size_t remove_left_upload_files() {
  std::size_t removed = 0;
  std::error_code failed;
  fs::directory_iterator files(fs::temp_directory_path(failed), failed);
  for (; !failed && files != fs::directory_iterator(); files.increment(failed)) {
    if (!files->path().filename().string().starts_with(kNameBegin)) continue;
    if (remove_if_left(files->path())) ++removed;
  }
  return removed;
}

}  // namespace camway::scene
