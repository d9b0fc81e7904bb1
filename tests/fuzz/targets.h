// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace camway::testing {

using FuzzBytes = std::vector<std::uint8_t>;

/// Something of ours that reads bytes that a stranger may have written.
struct FuzzTarget {
  std::string_view name;
  /// Reads the bytes, and ends the process (abort) where a promise is broken. Returns whether they
  /// were taken for right.
  bool (*exercise)(std::span<const std::uint8_t> bytes);
  /// What to begin with: right ones of every kind, and such as once were the end of a reader.
  std::vector<FuzzBytes> (*seeds)();
  int mutants;  ///< for the short run of the tests: a second or two
};

/// All of them.
std::span<const FuzzTarget> fuzz_targets();
/// The one of that name, or null.
const FuzzTarget* fuzz_target(std::string_view name);

/// Says what and aborts unless `kept`.
void promise(bool kept, const char* what);

/// A file in memory that goes when this does, for readers of files.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::string path() const;

 private:
  int fd_;
};

inline FuzzBytes fuzz_bytes(std::string_view text) { return {text.begin(), text.end()}; }
inline std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// In the order of their files.
extern const FuzzTarget kWireTarget;
extern const FuzzTarget kEnvelopeTarget;
extern const FuzzTarget kMeshTarget;
extern const FuzzTarget kRequestJsonTarget;
extern const FuzzTarget kResponseJsonTarget;
extern const FuzzTarget kPathJsonTarget;
extern const FuzzTarget kSessionTarget;
extern const FuzzTarget kImportRecordTarget;
extern const FuzzTarget kMapFileTarget;
extern const FuzzTarget kConfigTarget;
extern const FuzzTarget kKeyFileTarget;

}  // namespace camway::testing
