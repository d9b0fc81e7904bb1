// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "tools/lcm_types/type_file.h"

namespace camway::tools {

/// Numbers of a message, chosen by name: "pos" is all that an array holds, "pose.pos[2]" one
/// number, "poses.pos" those of all structs in an array, in order.
class LcmSelector {
 public:
  /// Requires `text` to name numbers of the struct `type`; else fails with the name that is none.
  static base::Result<LcmSelector> make(const LcmTypes& types, const std::string& type,
                                        std::string_view text);

  /// A member, and for each of its sizes the index that counts; without one, all do.
  struct Step {
    std::string name;
    std::vector<std::optional<std::uint64_t>> indices;
  };
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  /// Returns whether the numbers are of an integer type, as times in microseconds are.
  [[nodiscard]] bool is_whole() const { return is_whole_; }

 private:
  std::vector<Step> steps_;
  bool is_whole_ = false;
};

/// Returns the names of the members of the struct that `text` names in the struct `type`, if all of
/// them are single numbers: x, y and z of "pose.pos". Empty if it names numbers or nothing.
std::vector<std::string> lcm_number_members(const LcmTypes& types, const std::string& type,
                                            std::string_view text);

/// Reads chosen numbers of messages of one struct. A value type; `types` must outlive it.
class LcmMessageReader {
 public:
  /// Fails if a struct in `type` is not defined.
  static base::Result<LcmMessageReader> make(const LcmTypes& types, const std::string& type);

  [[nodiscard]] std::uint64_t fingerprint() const { return fingerprint_; }
  [[nodiscard]] const LcmStruct& type() const { return *type_; }

  /// Returns the numbers of each selector. Whole numbers above 2^53 are rounded. Fails if the
  /// message has another fingerprint, breaks off, has bytes behind its end, or a count below 0.
  /// Takes time and memory bounded by the size of the message, whatever the counts in it say.
  [[nodiscard]] base::Result<std::vector<std::vector<double>>> read(
      std::span<const std::uint8_t> message, std::span<const LcmSelector> selectors) const;

 private:
  const LcmTypes* types_ = nullptr;
  const LcmStruct* type_ = nullptr;
  std::uint64_t fingerprint_ = 0;
};

/// Returns the fingerprint of a message; nothing if it is shorter.
std::optional<std::uint64_t> lcm_fingerprint_of(std::span<const std::uint8_t> message);

}  // namespace camway::tools
