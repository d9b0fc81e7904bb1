// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace camway::testing {

using FuzzBytes = std::vector<std::uint8_t>;

/// A reader of untrusted bytes.
struct FuzzTarget {
  std::string_view name;
  /// Reads the bytes and returns whether they were accepted. Aborts the process if a promise is
  /// broken.
  bool (*exercise)(std::span<const std::uint8_t> bytes);
  /// Returns the corpus to begin with: valid inputs of every kind, and inputs that crashed a
  /// reader.
  std::vector<FuzzBytes> (*seeds)();
  int mutants;  ///< number of mutants in the short run of the tests, one or two seconds
};

/// Returns all targets.
std::span<const FuzzTarget> fuzz_targets();
/// Returns the target of this name, or null.
const FuzzTarget* fuzz_target(std::string_view name);

/// Prints `what` and aborts the process unless `kept`.
void promise(bool kept, const char* what);

/// A file in memory for readers of files. The destructor removes it.
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

// The targets, in the order of their source files.
extern const FuzzTarget kWireTarget;
extern const FuzzTarget kSentMeshTarget;
extern const FuzzTarget kEnvelopeTarget;
extern const FuzzTarget kFleetTarget;
extern const FuzzTarget kFleetPartsTarget;
extern const FuzzTarget kMeshTarget;
extern const FuzzTarget kPointsTarget;
extern const FuzzTarget kBezierTarget;
extern const FuzzTarget kUnigrafixTarget;
extern const FuzzTarget kCameraFileTarget;
extern const FuzzTarget kRequestJsonTarget;
extern const FuzzTarget kResponseJsonTarget;
extern const FuzzTarget kPathJsonTarget;
extern const FuzzTarget kSessionTarget;
extern const FuzzTarget kImportRecordTarget;
extern const FuzzTarget kMapFileTarget;
extern const FuzzTarget kCacheFileTarget;
extern const FuzzTarget kChangeRecordTarget;
extern const FuzzTarget kLogMessageTarget;
extern const FuzzTarget kStreamAnswerTarget;
extern const FuzzTarget kSourceRecordTarget;
extern const FuzzTarget kConfigTarget;
extern const FuzzTarget kKeyFileTarget;
extern const FuzzTarget kDoorMessageTarget;
extern const FuzzTarget kPackTarget;
extern const FuzzTarget kInventorFileTarget;  ///< in builds with `CAMWAY_WITH_INVENTOR` alone

}  // namespace camway::testing
