// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace camway::scene::import_process {

/// The bytes of a file, mapped. If the file shrinks meanwhile this process crashes, as an import
/// process may.
class MappedFile {
 public:
  /// Sets `errno` if the file cannot be mapped. Requires a file that is not empty.
  explicit MappedFile(const std::string& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] bool is_open() const { return data_ != nullptr; }
  [[nodiscard]] std::string_view bytes() const { return {static_cast<const char*>(data_), size_}; }

 private:
  int fd_;
  std::size_t size_ = 0;
  void* data_ = nullptr;
};

}  // namespace camway::scene::import_process
