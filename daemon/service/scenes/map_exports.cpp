// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/map_exports.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/layout.h"

namespace camway::service {

Pages map_pages(const RequestKey& key, const std::vector<std::uint8_t>& bytes) {
  const std::size_t count =
      std::max<std::size_t>(1, (bytes.size() + wire::kMapPageBytes - 1) / wire::kMapPageBytes);
  std::vector<Bytes> pages;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * wire::kMapPageBytes;
    const std::size_t end = std::min(begin + wire::kMapPageBytes, bytes.size());
    map_page_t page{};
    page.client_id = key.client_id;
    page.request_id = key.request_id;
    page.page = static_cast<std::int32_t>(i);
    page.num_pages = static_cast<std::int32_t>(count);
    page.bytes.assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                      bytes.begin() + static_cast<std::ptrdiff_t>(end));
    page.num_bytes = static_cast<std::int32_t>(page.bytes.size());
    page.page_checksum = wire::crc64(page.bytes.data(), page.bytes.size());
    pages.push_back(wire::encode(page));
  }
  return std::make_shared<const std::vector<Bytes>>(std::move(pages));
}

map_page_t no_such_map(const RequestKey& key) {
  map_page_t page{};
  page.client_id = key.client_id;
  page.request_id = key.request_id;
  page.status = map_page_t::STATUS_INVALID;
  page.message = "what was exported is not there any more; ask for it again";
  return page;
}

bool MapExports::keep(const RequestKey& key, Pages pages, Clock::time_point now) {
  if (const auto found = exports_.find(key); found != exports_.end()) forget(found);
  std::size_t bytes = 0;
  for (const Bytes& page : *pages) bytes += page.size();
  if (bytes > limits_.bytes) return false;
  for (auto each = exports_.begin(); each != exports_.end();) {
    const auto next = std::next(each);
    if (now - each->second.touched > limits_.idle) forget(each);
    each = next;
  }
  while (!exports_.empty() &&
         (exports_.size() >= limits_.exports || bytes_ + bytes > limits_.bytes)) {
    forget(std::ranges::min_element(
        exports_, {}, [](const Map::value_type& each) { return each.second.touched; }));
  }
  bytes_ += bytes;
  exports_.insert_or_assign(key, Export{std::move(pages), bytes, now});
  return true;
}

Pages MapExports::find(const RequestKey& key, Clock::time_point now) {
  const auto found = exports_.find(key);
  if (found == exports_.end()) return nullptr;
  found->second.touched = now;
  return found->second.pages;
}

void MapExports::forget(Map::iterator position) {
  bytes_ -= position->second.bytes;
  exports_.erase(position);
}

}  // namespace camway::service
