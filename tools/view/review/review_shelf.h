// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/view/page_files.h"
#include "tools/view/review/review.h"

namespace camway::view {

/// Reviews of many plans for one file of HTML, which holds the page of a review once, and so each
/// scene and each mesh. The script of a report (tools/view/page/src/report) joins these parts into
/// pages as `make_review` makes them. Not thread-safe.
class ReviewShelf {
 public:
  /// Holds reviews whose elements of HTML have no more than `most_bytes` together.
  ReviewShelf(const PageFiles& page, std::size_t most_bytes);

  /// The outcome of `put`.
  struct Put {
    int code = code::kOk;    ///< `code::kTooLarge` if the review does not fit
    std::string error = {};  ///< a sentence; empty with `code::kOk`
  };
  /// Adds a review under a number that it has alone. The scene is as `backend` has it now. Adds
  /// nothing if that fails. Waits for the backend, so it is not for threads of it.
  Put put(std::size_t number, const ReviewOrder& order, Backend& backend, MeshDesk& meshes);

  [[nodiscard]] bool holds(std::size_t number) const { return reviews_.contains(number); }
  [[nodiscard]] std::size_t size() const { return reviews_.size(); }

  /// Returns the elements of HTML that hold the reviews; empty if there are none.
  [[nodiscard]] std::string elements() const;
  /// Size of `elements()`.
  [[nodiscard]] std::size_t bytes() const { return reviews_.empty() ? 0 : bytes_; }

 private:
  /// The parts that a review needs and that are not here yet.
  struct Added {
    std::size_t scene = 0;
    std::string description;  ///< empty if the scene is here
    std::map<std::string, std::string> meshes;
    std::size_t bytes = 0;
  };
  [[nodiscard]] bool has_room(std::size_t bytes) const { return bytes_ + bytes <= most_bytes_; }
  /// Returns what a scene adds; nothing if a mesh cannot be made.
  [[nodiscard]] std::optional<Added> added_by(const std::string& name, ReviewScene scene,
                                              ReviewSource& source) const;

  const std::size_t most_bytes_;
  std::string page_element_;         ///< empty: there is no page
  std::vector<std::string> scenes_;  ///< as JSON that can stand in HTML, as all that follows
  std::map<std::string, std::string> meshes_;   ///< in base64, by their keys
  std::map<std::size_t, std::string> reviews_;  ///< by number
  std::set<std::string> too_large_;             ///< scenes that do not fit
  std::size_t bytes_ = 0;
};

}  // namespace camway::view
