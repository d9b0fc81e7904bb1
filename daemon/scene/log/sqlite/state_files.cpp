// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/state_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

std::string system_fault(const fs::path& path) {
  return path.string() + ": " + std::strerror(errno);
}

fs::path folder_of(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// Renames unless the new name is taken. Returns false with `errno` set otherwise.
bool rename_to_free_name(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // Network file systems know no such flag.
  if (access(to.c_str(), F_OK) == 0) {
    errno = EEXIST;
    return false;
  }
  return std::rename(from.c_str(), to.c_str()) == 0;
}

}  // namespace

bool is_synced(const fs::path& path) {
  const base::FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  return file.is_open() && fsync(file.get()) == 0;
}

std::string make_state_folder(const fs::path& folder) {
  std::error_code failed;
  if (fs::is_directory(folder, failed)) return "";
  const fs::path parent = folder_of(folder);
  if (!fs::is_directory(parent, failed)) {
    std::string fault = make_state_folder(parent);
    if (!fault.empty()) return fault;
  }
  // A name that ends with a slash is its own parent's.
  if (fs::is_directory(folder, failed)) return "";
  if (mkdir(folder.c_str(), S_IRWXU) != 0) return system_fault(folder);
  return is_synced(parent) ? "" : system_fault(parent);
}

base::Result<base::FileDescriptor> lock_state_folder(const fs::path& folder) {
  const fs::path path = folder / "lock";
  base::FileDescriptor file(
      open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR));
  if (!file.is_open()) return base::Failure{system_fault(path)};
  if (flock(file.get(), LOCK_EX | LOCK_NB) == 0) return file;
  if (errno != EWOULDBLOCK) return base::Failure{system_fault(path)};
  return base::Failure{"the state in " + folder.string() +
                       " is in use by another process: only one camwayd can have it"};
}

std::string make_empty_file(const fs::path& file) {
  for (const char* const suffix : {"", "-journal", "-wal", "-shm"}) {
    const fs::path left = file.string() + suffix;
    if (unlink(left.c_str()) != 0 && errno != ENOENT) return system_fault(left);
  }
  const base::FileDescriptor made(
      open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
  return made.is_open() ? "" : system_fault(file);
}

std::string publish_file(const fs::path& finished, const fs::path& file) {
  const fs::path folder = folder_of(file);
  std::string fault;
  if (!is_synced(finished)) {
    fault = system_fault(finished);
  } else if (!rename_to_free_name(finished, file)) {
    fault = system_fault(file);
  } else {
    return is_synced(folder) ? "" : system_fault(folder);
  }
  unlink(finished.c_str());
  return fault;
}

}  // namespace camway::scene
