// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/uploads.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/layout.h"

namespace camway::service {
namespace {

constexpr auto kPage = static_cast<std::int64_t>(wire::kUploadPageBytes);

std::int64_t pages_of(std::int64_t total_bytes) { return (total_bytes + kPage - 1) / kPage; }

}  // namespace

/// Requires that `total_bytes` is within the limits.
std::string Uploads::fault_of(const upload_page_t& page) const {
  const std::int64_t pages = pages_of(page.total_bytes);
  if (page.num_bytes == 0) return {};
  if (page.page < 0 || page.page >= pages) {
    return fmt::format("page: {} is not one of {}", page.page, pages);
  }
  const std::int64_t expected = std::min(kPage, page.total_bytes - page.page * kPage);
  if (page.num_bytes != expected) {
    return fmt::format("num_bytes: page {} has {} bytes, not {}", page.page, expected,
                       page.num_bytes);
  }
  if (wire::crc64(page.bytes.data(), page.bytes.size()) != page.page_checksum) {
    return fmt::format("page_checksum: is not that of the bytes of page {}", page.page);
  }
  return {};
}

Uploads::Taken Uploads::take(const upload_page_t& page, Clock::time_point now) {
  Taken taken{.answer = true, .status = {}};
  taken.status.client_id = page.client_id;
  taken.status.request_id = page.request_id;
  taken.status.total_bytes = page.total_bytes;
  taken.status.checksum = page.checksum;
  if (std::optional<Refusal> refusal = put(page, now, taken)) {
    taken.status.status = refusal->status;
    taken.status.message = std::move(refusal->message);
  }
  return taken;
}

/// Puts a page into its upload, and into `taken` whether to answer it, and with what. Returns why
/// it was refused; nothing if it was not.
std::optional<Uploads::Refusal> Uploads::put(const upload_page_t& page, Clock::time_point now,
                                             Taken& taken) {
  if (std::optional<Refusal> refusal = refusal_of(page)) return refusal;
  const UploadKey key{page.client_id, page.total_bytes, page.checksum};
  Upload* const upload = find_or_begin(key, now);
  if (upload == nullptr) {
    return Refusal{upload_status_t::STATUS_LIMIT,
                   fmt::format("total_bytes: changes that wait read {} bytes of uploads, and {} "
                               "are all that there may be (scenes.all_uploads_bytes); send it "
                               "again later",
                               read_bytes(), limits_.total_bytes)};
  }
  const bool is_last = add(page, *upload) && upload->missing == 0;
  if (is_last && checksum_of(*upload) != page.checksum) {
    forget(uploads_.find(key));
    return Refusal{upload_status_t::STATUS_INVALID,
                   "checksum: is not that of the pages together; send all of them again"};
  }
  taken.answer = page.num_bytes == 0 || is_last;
  report(*upload, taken.status);
  return std::nullopt;
}

/// Returns why a page is refused, whatever was uploaded before; nothing if it is not.
std::optional<Uploads::Refusal> Uploads::refusal_of(const upload_page_t& page) const {
  if (page.total_bytes < 1) {
    return Refusal{upload_status_t::STATUS_INVALID, "total_bytes: must be at least 1"};
  }
  if (static_cast<std::size_t>(page.total_bytes) > limits_.bytes) {
    return Refusal{upload_status_t::STATUS_LIMIT,
                   fmt::format("total_bytes: {} are more than the {} that an upload may have "
                               "(scenes.upload_bytes)",
                               page.total_bytes, limits_.bytes)};
  }
  std::string fault = fault_of(page);
  if (fault.empty()) return std::nullopt;
  return Refusal{upload_status_t::STATUS_INVALID, std::move(fault)};
}

/// Copies a page into its upload. Returns false if the page has no bytes, or is there already.
bool Uploads::add(const upload_page_t& page, Upload& upload) {
  const auto number = static_cast<std::size_t>(page.page);
  if (page.num_bytes == 0 || upload.has_page[number]) return false;
  std::ranges::copy(page.bytes, upload.bytes->data() + page.page * kPage);
  upload.has_page[number] = true;
  upload.checksums[number] = page.page_checksum;
  --upload.missing;
  return true;
}

/// Combines the checksums of the pages, which were checked: reading all bytes again could take a
/// tenth of a second.
std::int64_t Uploads::checksum_of(const Upload& complete) {
  const std::size_t last = complete.checksums.size() - 1;
  const wire::Crc64Joint whole_page(wire::kUploadPageBytes);
  std::int64_t checksum = complete.checksums.front();
  for (std::size_t i = 1; i < last; ++i) checksum = whole_page(checksum, complete.checksums[i]);
  if (last == 0) return checksum;
  const wire::Crc64Joint last_page(complete.bytes->size() - last * wire::kUploadPageBytes);
  return last_page(checksum, complete.checksums[last]);
}

void Uploads::report(const Upload& upload, upload_status_t& status) {
  status.total_missing = static_cast<std::int32_t>(upload.missing);
  for (std::size_t i = 0; i < upload.has_page.size(); ++i) {
    if (status.missing.size() == wire::kMaxMissingPages) break;
    if (!upload.has_page[i]) status.missing.push_back(static_cast<std::int32_t>(i));
  }
  status.num_missing = static_cast<std::int32_t>(status.missing.size());
}

/// Returns null if there is no room.
Uploads::Upload* Uploads::find_or_begin(const UploadKey& key, Clock::time_point now) {
  auto found = uploads_.find(key);
  if (found == uploads_.end()) {
    const auto size = static_cast<std::size_t>(key.total_bytes);
    const auto pages = static_cast<std::size_t>(pages_of(key.total_bytes));
    if (!make_room(size, now)) return nullptr;
    // The upload is entered last: the allocations before may throw.
    Upload upload;
    upload.bytes = std::make_shared<UploadRoom>(size);
    upload.has_page.resize(pages);
    upload.checksums.resize(pages);
    upload.missing = pages;
    found = uploads_.try_emplace(key, std::move(upload)).first;
    bytes_ += size;
  }
  found->second.touched = now;
  return &found->second;
}

void Uploads::forget(Map::iterator upload) {
  bytes_ -= static_cast<std::size_t>(upload->first.total_bytes);
  if (is_read(upload->second)) held_.push_back(upload->second.bytes);
  uploads_.erase(upload);
}

bool Uploads::is_read(const Upload& upload) { return upload.bytes.use_count() > 1; }

/// Returns the size of forgotten uploads that a change still reads, or waits to read.
std::size_t Uploads::held_bytes() {
  std::erase_if(held_, [](const std::weak_ptr<const UploadRoom>& room) { return room.expired(); });
  std::size_t bytes = 0;
  for (const std::weak_ptr<const UploadRoom>& each : held_) {
    if (const UploadedBytes room = each.lock()) bytes += room->size();
  }
  return bytes;
}

/// Returns the size of all uploads that changes read, or wait to read.
std::size_t Uploads::read_bytes() {
  std::size_t bytes = held_bytes();
  for (const auto& [key, upload] : uploads_) bytes += is_read(upload) ? upload.bytes->size() : 0;
  return bytes;
}

/// Returns the upload that was not touched during the longest time, of the client that has the
/// most, in number or in bytes.
Uploads::Map::iterator Uploads::next_to_forget(bool by_number) {
  std::map<std::string_view, std::int64_t> shares;
  for (const auto& [key, upload] : uploads_) {
    shares[key.client_id] += by_number ? 1 : key.total_bytes;
  }
  return std::ranges::min_element(
      uploads_, [&](const Map::value_type& left, const Map::value_type& right) {
        const std::int64_t left_share = shares[left.first.client_id];
        const std::int64_t right_share = shares[right.first.client_id];
        return left_share != right_share ? left_share > right_share
                                         : left.second.touched < right.second.touched;
      });
}

/// Forgets uploads to make room. Returns false if that is impossible; then only idle ones are
/// forgotten.
bool Uploads::make_room(std::size_t bytes, Clock::time_point now) {
  for (auto upload = uploads_.begin(); upload != uploads_.end();) {
    const auto next = std::next(upload);
    if (now - upload->second.touched > limits_.idle) forget(upload);
    upload = next;
  }
  // Forgetting an upload that is read makes no room.
  if (read_bytes() + bytes > limits_.total_bytes) return false;
  while (uploads_.size() >= limits_.uploads ||
         bytes_ + held_bytes() + bytes > limits_.total_bytes) {
    forget(next_to_forget(uploads_.size() >= limits_.uploads));
  }
  return true;
}

UploadedBytes Uploads::find(const UploadKey& key) const {
  const auto found = uploads_.find(key);
  return found != uploads_.end() && found->second.missing == 0 ? found->second.bytes : nullptr;
}

}  // namespace camway::service
