// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <camway/upload_page_t.hpp>
#include <camway/upload_status_t.hpp>

namespace camway::service {

/// Room for bytes that come in any order. It is not written to before they come, so it takes the
/// memory of what is there, and beginning it takes no time.
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

/// What was uploaded, complete. Shared, so that it may go from the store while it is read.
using UploadedBytes = std::shared_ptr<const UploadRoom>;

/// What names an upload: who sent it, and what it is. So sending again what was interrupted goes on
/// where it stopped, whoever was started anew on the client's side.
struct UploadKey {
  std::string client_id;
  std::int64_t total_bytes = 0;
  std::int64_t checksum = 0;

  auto operator<=>(const UploadKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Puts uploads together from their pages, which come in any order and any number of times. Who
/// takes the most makes room for what is new: his upload that was not touched for the longest. So
/// nobody's is driven out by somebody who begins many. For one thread.
class Uploads {
 public:
  using Clock = std::chrono::steady_clock;

  struct Limits {
    std::size_t uploads = 16;                   ///< begun or complete
    std::size_t bytes = std::size_t{64} << 20;  ///< of one upload
    /// Of all, and of those that are forgotten but still read.
    std::size_t total_bytes = std::size_t{256} << 20;
    std::chrono::milliseconds idle{600'000};  ///< then it is forgotten
  };

  explicit Uploads(const Limits& limits) : limits_(limits) {}

  /// Takes a page. Whether to answer it, and with what: see `upload_status_t`.
  /// Precondition: the client id is right.
  struct Taken {
    bool answer = false;
    upload_status_t status;
  };
  Taken take(const upload_page_t& page, Clock::time_point now);

  /// The complete upload, or null.
  [[nodiscard]] UploadedBytes find(const UploadKey& key) const;

  /// Of all uploads that can be found, begun or complete.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Upload {
    std::shared_ptr<UploadRoom> bytes;
    std::vector<bool> has_page;
    std::vector<std::int64_t> checksums;  ///< of the pages
    std::size_t missing = 0;
    Clock::time_point touched;
  };
  using Map = std::map<UploadKey, Upload>;

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
  std::vector<std::weak_ptr<const UploadRoom>> held_;  ///< forgotten, but perhaps still read
};

}  // namespace camway::service
