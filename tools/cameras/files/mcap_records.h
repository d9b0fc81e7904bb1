// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

/// Records of MCAP files, version 0 (mcap.dev/spec). Numbers are little-endian.
namespace camway::tools {

/// The first and the last bytes of a file.
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

enum class McapOpcode : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kSummaryOffset = 14,
  kDataEnd = 15,
};

/// CRC-32 of ISO-HDLC, as zlib and PNG have it; that of no bytes is 0.
std::uint32_t crc32_of(std::string_view bytes);

/// Appends the members of a record.
class McapBytes {
 public:
  void u16(std::uint16_t number) { append(&number, sizeof number); }
  void u32(std::uint32_t number) { append(&number, sizeof number); }
  void u64(std::uint64_t number) { append(&number, sizeof number); }
  /// Appends the length in 32 bits, and the bytes.
  void text(std::string_view bytes);
  void raw(std::string_view bytes) { bytes_ += bytes; }
  void texts(const std::map<std::string, std::string>& entries);
  /// Appends a whole record.
  void record(McapOpcode opcode, const McapBytes& content);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t size() const { return bytes_.size(); }

 private:
  void append(const void* number, std::size_t size);

  std::string bytes_;
};

/// Reads the members of a record from any bytes. Once it has failed, every read returns 0 or
/// nothing.
class McapCursor {
 public:
  explicit McapCursor(std::string_view bytes) : rest_(bytes) {}

  std::uint8_t u8() { return number<std::uint8_t>(); }
  std::uint16_t u16() { return number<std::uint16_t>(); }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }
  std::string_view text() { return raw(u32()); }
  std::string_view raw(std::uint64_t size);
  std::map<std::string, std::string> texts();

  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  template <class Number>
  Number number();

  std::string_view rest_;
  bool failed_ = false;
};

}  // namespace camway::tools
