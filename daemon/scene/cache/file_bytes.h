// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace camway::scene {

/// The bytes of a file, at an address that is a multiple of a page. A file on a disk of this
/// machine is mapped, because reading 16 MB takes 17 ms, of which most go to the new pages, and
/// mapping them 1 ms. (A disk that fails then ends the process, as it does where a page of the
/// program is read.) For long use, files on other file systems are read: another machine may remove
/// a file there, and then a mapping of it ends the process. Immutable. Thread-safe.
class FileBytes {
 public:
  enum class Use { kBrief, kLong };

  /// Returns null if the file is empty or cannot be read. Requires that nobody writes into it any
  /// more; it may be removed.
  static std::shared_ptr<const FileBytes> of(int fd, Use use);
  static std::shared_ptr<const FileBytes> mapped(int fd);
  static std::shared_ptr<const FileBytes> read(int fd);

  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const {
    return {static_cast<const std::byte*>(begin_), size_};
  }

 private:
  FileBytes(void* begin, std::size_t size) : begin_(begin), size_(size) {}

  void* begin_;
  std::size_t size_;
};

/// Asks the system for the memory of an array in large pages, and all of it at once, since most of
/// the time to fill a new array goes to page faults. Has no other effect.
void prepare_pages(void* begin, std::size_t bytes);

}  // namespace camway::scene
