// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <list>
#include <string>
#include <unordered_map>

namespace camway::service {

/// The ids of clients that were served, as many as there is room for: in one half those that were
/// served once, in the other those that were served again since. So whoever invents ids makes only
/// those forgotten that are as new as his. In each half the oldest goes first; out of the second
/// half it goes back to the first (segmented LRU; Karedla, Love and Wherry, 1994). For one thread.
class KnownClients {
 public:
  /// [Limit: 2 <= most]
  explicit KnownClients(std::size_t most) : most_of_a_half_(most / 2) {}

  void note_served(const std::string& id);
  [[nodiscard]] bool contains(const std::string& id) const { return places_.contains(id); }
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  using Ids = std::list<std::string>;  ///< the newest first
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
