// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <list>
#include <string>
#include <unordered_map>

namespace camway::service {

/// The ids of clients that were served, up to a limit. One half of the places is for clients that
/// were served once, the other half for clients that were served again since then. So a client that
/// invents ids displaces only ids that were served once. Each half drops its oldest id; one from
/// the second half returns to the first (segmented LRU; Karedla, Love and Wherry, 1994). Not
/// thread-safe.
class KnownClients {
 public:
  /// [Limit: 2 <= most]
  explicit KnownClients(std::size_t most) : most_of_a_half_(most / 2) {}

  void note_served(const std::string& id);
  [[nodiscard]] bool contains(const std::string& id) const { return places_.contains(id); }
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  using Ids = std::list<std::string>;  ///< newest first
  struct Place {
    bool again = false;
    Ids::iterator position;
  };

  [[nodiscard]] Ids& half(bool again) { return halves_[again ? 1 : 0]; }

  std::size_t most_of_a_half_;
  std::array<Ids, 2> halves_;
  std::unordered_map<std::string, Place> places_;
};

}  // namespace camway::service
