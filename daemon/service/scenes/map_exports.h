// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <camway/map_page_t.hpp>

#include "daemon/service/transport/answer_pages.h"

namespace camway::service {

/// Divides `bytes` into the pages of the export that `key` asked for. Returns at least one page.
Pages map_pages(const RequestKey& key, const std::vector<std::uint8_t>& bytes);

/// Returns the answer to a client that asks for pages of an export that is not there.
map_page_t no_such_map(const RequestKey& key);

/// Exported maps that clients fetch page by page. To make room, forgets the map that was not used
/// for the longest time. Not thread-safe.
class MapExports {
 public:
  using Clock = std::chrono::steady_clock;

  struct Limits {
    std::size_t exports = 16;
    std::size_t bytes = std::size_t{256} << 20;  ///< size of all exports
    std::chrono::milliseconds idle{600'000};     ///< time after which an unused one is forgotten
  };

  MapExports() : MapExports(Limits{}) {}
  explicit MapExports(const Limits& limits) : limits_(limits) {}

  /// Keeps an export. Returns false if there is no room for it even without all others.
  [[nodiscard]] bool keep(const RequestKey& key, Pages pages, Clock::time_point now);

  /// Returns the pages; null if they are not there, or no longer.
  [[nodiscard]] Pages find(const RequestKey& key, Clock::time_point now);

  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  struct Export {
    Pages pages;
    std::size_t bytes = 0;
    Clock::time_point touched;
  };
  using Map = std::map<RequestKey, Export>;

  void forget(Map::iterator position);

  Limits limits_;
  Map exports_;
  std::size_t bytes_ = 0;
};

}  // namespace camway::service
