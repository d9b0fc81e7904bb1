// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <camway/map_page_t.hpp>

#include "daemon/messages/answer_pages.h"

namespace camway::service {

/// The pages of `bytes`, as the export that `key` asked for sends them: at least one.
Pages map_pages(const RequestKey& key, const std::vector<std::uint8_t>& bytes);

/// What a client is told that asks for pages of an export that is not there.
map_page_t no_such_map(const RequestKey& key);

/// Exported maps that clients fetch, page by page. The one that nobody asked for the longest makes
/// room. For one thread.
class MapExports {
 public:
  using Clock = std::chrono::steady_clock;

  struct Limits {
    std::size_t exports = 16;
    std::size_t bytes = std::size_t{256} << 20;  ///< of all
    std::chrono::milliseconds idle{600'000};     ///< then it is forgotten
  };

  MapExports() : MapExports(Limits{}) {}
  explicit MapExports(const Limits& limits) : limits_(limits) {}

  /// Whether there is room for it, once all others made way.
  [[nodiscard]] bool keep(const RequestKey& key, Pages pages, Clock::time_point now);

  /// Null if it is not there, or not any more.
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
