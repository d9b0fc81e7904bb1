// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/commit_count.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "daemon/base/digest.h"

namespace camway::scene {
namespace {

/// A number with its digest. Two of them take turns, each in a sector of its own, so that a write
/// which is cut off leaves the other one.
struct CountSlot {
  std::uint64_t count;
  base::Digest::Bytes digest;
};
constexpr off_t kSlotSpacing = 4096;

CountSlot slot_of(std::uint64_t count) {
  base::Digest digest;
  digest.add(&count, sizeof count);
  return {count, digest.bytes()};
}

}  // namespace

std::optional<std::uint64_t> CommitCount::read(const std::filesystem::path& folder) {
  const base::FileDescriptor file(open((folder / kFile).c_str(), O_RDONLY | O_CLOEXEC));
  std::optional<std::uint64_t> highest;
  for (const off_t place : {off_t{0}, kSlotSpacing}) {
    CountSlot slot{};
    if (!file.is_open() || pread(file.get(), &slot, sizeof slot, place) != sizeof slot) continue;
    if (slot.digest != slot_of(slot.count).digest) continue;
    highest = std::max(highest.value_or(0), slot.count);
  }
  return highest;
}

CommitCount::CommitCount(const std::filesystem::path& folder)
    : file_(open((folder / kFile).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW,
                 S_IRUSR | S_IWUSR)) {
  // So that a full disk does not keep a number out. If there is no room, the write will say so.
  static_cast<void>(posix_fallocate(file_.get(), 0, kSlotSpacing + off_t{sizeof(CountSlot)}));
}

bool CommitCount::write(std::uint64_t count) const {
  const CountSlot slot = slot_of(count);
  const off_t place = count % 2 == 0 ? 0 : kSlotSpacing;
  return pwrite(file_.get(), &slot, sizeof slot, place) == sizeof slot &&
         fdatasync(file_.get()) == 0;
}

}  // namespace camway::scene
