// SPDX-License-Identifier: MIT
#include "daemon/record/blob_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "daemon/base/file_descriptor.h"
#include "daemon/record/session_events.h"

namespace camway::record {
namespace {

namespace fs = std::filesystem;
using scene::AppendFault;
using scene::AppendResult;

/// Calls `look` with the path and state of each blob.
template <class Look>
void for_each_blob(const fs::path& folder, Look look) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    struct stat state {};
    if (lstat(entry.path().c_str(), &state) == 0 && S_ISREG(state.st_mode)) {
      look(entry.path(), state);
    }
  }
}

/// Writes a file of this name, which is removed if that fails. Returns the system's error, or 0.
int write_new(const fs::path& file, const scene::Bytes& bytes) {
  const base::FileDescriptor fd(
      open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, S_IRUSR | S_IWUSR | S_IRGRP));
  if (!fd.is_open()) return errno;
  const int why = write_all(fd.get(), bytes.data(), bytes.size());
  if (why != 0) unlink(file.c_str());
  return why;
}

}  // namespace

int write_all(int fd, const void* bytes, std::size_t count) {
  const auto* from = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t wrote = write(fd, from, count);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return wrote == 0 ? EIO : errno;
    from += wrote;
    count -= static_cast<std::size_t>(wrote);
  }
  return 0;
}

AppendResult append_result(const fs::path& file, int why) {
  if (why == 0) return {};
  const bool is_full = why == ENOSPC || why == EDQUOT || why == EFBIG;
  return {is_full ? AppendFault::kFull : AppendFault::kBroken,
          file.string() + ": cannot be written: " + std::generic_category().message(why)};
}

fs::path BlobFolder::file_of(const scene::BlobId& id) const { return folder_ / hex_of(id); }

AppendResult BlobFolder::put(const scene::BlobId& id, const scene::Bytes& bytes,
                             std::uint64_t& written) {
  written = 0;
  if (touch(id)) return {};
  const fs::path file = file_of(id);
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return append_result(folder_, error.value());
  const fs::path unfinished = file.string() + ".unfinished";
  int why = write_new(unfinished, bytes);
  if (why == 0 && std::rename(unfinished.c_str(), file.c_str()) != 0) {
    why = errno;
    unlink(unfinished.c_str());
  }
  if (why == 0) written = bytes.size();
  return append_result(file, why);
}

bool BlobFolder::touch(const scene::BlobId& id) const {
  return utimensat(AT_FDCWD, file_of(id).c_str(), nullptr, AT_SYMLINK_NOFOLLOW) == 0;
}

base::Result<scene::Bytes> BlobFolder::get(const scene::BlobId& id) const {
  const fs::path file = file_of(id);
  std::error_code error;
  if (!fs::exists(file, error)) return base::Failure{file.string() + ": is missing"};
  const std::uintmax_t size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) return base::Failure{file.string() + ": cannot be read"};
  scene::Bytes bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size || scene::blob_id_of(bytes) != id) {
    return base::Failure{file.string() + ": is damaged: its bytes have another digest"};
  }
  return bytes;
}

std::uint64_t BlobFolder::remove_unused_since(Clock::time_point time) {
  std::uint64_t removed = 0;
  for_each_blob(folder_, [&](const fs::path& file, const struct stat& state) {
    const auto used = Clock::time_point(std::chrono::duration_cast<Clock::duration>(
        std::chrono::seconds(state.st_mtim.tv_sec) +
        std::chrono::nanoseconds(state.st_mtim.tv_nsec)));
    if (used < time && unlink(file.c_str()) == 0) {
      removed += static_cast<std::uint64_t>(state.st_size);
    }
  });
  return removed;
}

std::uint64_t BlobFolder::bytes() const {
  std::uint64_t bytes = 0;
  for_each_blob(folder_, [&](const fs::path&, const struct stat& state) {
    bytes += static_cast<std::uint64_t>(state.st_size);
  });
  return bytes;
}

}  // namespace camway::record
