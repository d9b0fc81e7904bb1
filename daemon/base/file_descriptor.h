// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <utility>

namespace camway::base {

/// Owns a file descriptor; a negative number is none.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (fd_ >= 0) close(fd_);
  }

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  /// Returns the descriptor, which the caller has to close.
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

}  // namespace camway::base
