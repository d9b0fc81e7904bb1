// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <camway/upload_page_t.hpp>
#include <camway/upload_status_t.hpp>

namespace camway::service {

/// Memory for bytes that arrive in any order. It is not initialised. So its allocation takes no
/// time, and the system provides only the memory pages to which bytes were written.
class UploadRoom {
 public:
  explicit UploadRoom(std::size_t size)
      : bytes_(std::make_unique_for_overwrite<std::uint8_t[]>(size)), size_(size) {}

  [[nodiscard]] std::uint8_t* data() { return bytes_.get(); }
  [[nodiscard]] const std::uint8_t* data() const { return bytes_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::unique_ptr<std::uint8_t[]> bytes_;
  std::size_t size_;
};

/// A complete upload. It is shared, so that it can be read after `Uploads` has dropped it.
using UploadedBytes = std::shared_ptr<const UploadRoom>;

/// Identifies an upload by its sender and content. So an interrupted upload continues where it was
/// interrupted, even if the client was restarted.
struct UploadKey {
  std::string client_id;
  std::int64_t total_bytes = 0;
  std::int64_t checksum = 0;

  auto operator<=>(const UploadKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Joins the pages of uploads. Pages arrive in any order and any number of times. To make room,
/// chooses the client with the most uploads, or the most bytes of uploads, and drops that of its
/// uploads to which no page came for the longest time. So a client that begins many uploads
/// displaces only its own. Not thread-safe.
class Uploads {
 public:
  using Clock = std::chrono::steady_clock;

  struct Limits {
    std::size_t uploads = 16;                   ///< number of uploads, incomplete or complete
    std::size_t bytes = std::size_t{64} << 20;  ///< size of one upload
    /// Size of all uploads, including dropped ones that are still read.
    std::size_t total_bytes = std::size_t{256} << 20;
    std::chrono::milliseconds idle{
        600'000};  ///< time without a page after which an upload is dropped
  };

  explicit Uploads(const Limits& limits) : limits_(limits) {}

  /// Takes a page. Returns whether the caller must answer it, and the answer. Requires a valid
  /// client id (`wire::is_client_id`).
  struct Taken {
    bool answer = false;
    upload_status_t status;
  };
  Taken take(const upload_page_t& page, Clock::time_point now);

  /// Returns the complete upload, or null.
  [[nodiscard]] UploadedBytes find(const UploadKey& key) const;

  /// Returns the size of all uploads that are not dropped, incomplete or complete. [Units: bytes]
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Upload {
    std::shared_ptr<UploadRoom> bytes;
    std::vector<bool> has_page;
    std::vector<std::int64_t> checksums;  ///< checksums of the pages
    std::size_t missing = 0;
    Clock::time_point touched;
  };
  using Map = std::map<UploadKey, Upload>;
  struct Refusal {
    std::int32_t status = 0;
    std::string message;
  };

  std::optional<Refusal> put(const upload_page_t& page, Clock::time_point now, Taken& taken);
  static bool add(const upload_page_t& page, Upload& upload);
  [[nodiscard]] std::optional<Refusal> refusal_of(const upload_page_t& page) const;
  [[nodiscard]] std::string fault_of(const upload_page_t& page) const;
  Upload* find_or_begin(const UploadKey& key, Clock::time_point now);
  void forget(Map::iterator upload);
  [[nodiscard]] bool make_room(std::size_t bytes, Clock::time_point now);
  [[nodiscard]] static bool is_read(const Upload& upload);
  [[nodiscard]] std::size_t held_bytes();
  [[nodiscard]] std::size_t read_bytes();
  [[nodiscard]] Map::iterator next_to_forget(bool by_number);
  static void report(const Upload& upload, upload_status_t& status);
  static std::int64_t checksum_of(const Upload& complete);

  Limits limits_;
  Map uploads_;
  std::size_t bytes_ = 0;
  std::vector<std::weak_ptr<const UploadRoom>> held_;  ///< dropped uploads that may still be read
};

}  // namespace camway::service
