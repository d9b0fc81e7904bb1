// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/file_bytes.h"

#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>

namespace camway::scene {
namespace {

/// File systems that only this machine writes to. ext2 stands for ext3 and ext4, too.
constexpr std::array<std::uint32_t, 7> kLocal = {
    EXT2_SUPER_MAGIC, XFS_SUPER_MAGIC, BTRFS_SUPER_MAGIC,    F2FS_SUPER_MAGIC,
    TMPFS_MAGIC,      RAMFS_MAGIC,     OVERLAYFS_SUPER_MAGIC};

bool is_local(int fd) {
  struct statfs status {};
  return fstatfs(fd, &status) == 0 &&
         std::ranges::find(kLocal, static_cast<std::uint32_t>(status.f_type)) != kLocal.end();
}

/// Returns 0, which `mmap` refuses, if there is no size.
std::size_t size_of(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

bool read_all(int fd, std::byte* bytes, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = pread(fd, bytes + done, size - done, static_cast<off_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

std::shared_ptr<const FileBytes> FileBytes::of(int fd, Use use) {
  return use == Use::kBrief || is_local(fd) ? mapped(fd) : read(fd);
}

std::shared_ptr<const FileBytes> FileBytes::mapped(int fd) {
  const std::size_t size = size_of(fd);
  void* const memory = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  if (memory == MAP_FAILED) return nullptr;
  return std::shared_ptr<const FileBytes>(new FileBytes(memory, size));
}

std::shared_ptr<const FileBytes> FileBytes::read(int fd) {
  const std::size_t size = size_of(fd);
  void* const memory =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return nullptr;
  const std::shared_ptr<const FileBytes> bytes(new FileBytes(memory, size));
  prepare_pages(memory, size);
  return read_all(fd, static_cast<std::byte*>(memory), size) ? bytes : nullptr;
}

FileBytes::~FileBytes() { munmap(begin_, size_); }

void prepare_pages(void* begin, std::size_t bytes) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + page - 1) / page * page;
  const std::uintptr_t end = (address + bytes) / page * page;
  if (end <= first) return;
  void* const at = reinterpret_cast<void*>(first);
  madvise(at, end - first, MADV_HUGEPAGE);
  madvise(at, end - first, MADV_POPULATE_WRITE);
}

}  // namespace camway::scene
