// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/motion/spline/cubic_path.h"
#include "tests/bench/fidelity/shot.h"

namespace camway::bench {

/// The cheapest paths that earlier runs found, in a JSON file. They are starts of the slow
/// reference, so every run with the file finds paths as cheap as the runs before it. Nothing in the
/// file is trusted to be free or to be cheap: runs prove and evaluate it again.
///
/// Not thread-safe.
class KnownPaths {
 public:
  /// Reads `file`, if it exists. Without a name nothing is read or written. Ends the program with a
  /// message if the file cannot be read.
  explicit KnownPaths(std::string file);

  /// Returns the paths that are known for a shot in a scene of this name: those with its reference,
  /// its times and its keyframes.
  [[nodiscard]] std::vector<motion::CubicPath> of(const std::string& scene, const Shot& shot) const;

  /// Keeps the path that one way of correction found, in place of that of a run before.
  void keep(const std::string& scene, const Shot& shot, const std::string& way,
            const motion::CubicPath& path);

  /// Writes the file. Returns an error text, empty on success.
  [[nodiscard]] std::string write() const;

 private:
  std::string file_;
  nlohmann::json document_;
};

}  // namespace camway::bench
