// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// A free pose and the gap of the body there, as computed, at most the one that was enough.
struct Centered {
  motion::Pose pose;
  double gap_m = 0.0;
};

/// Moves the body from a free pose to where its gap is larger, to a local maximum or up to
/// `enough_m`, and turns it if the policy of `space` allows any turn. It does not move along
/// `along_W`, a unit vector; zero permits all moves.
///
/// Each step asks for a larger gap: the shortest change of the pose with which all near pairs
/// (`near_pairs.h`) have it to first order. It is taken if the gap grew indeed, and halved
/// otherwise.
/// The deadline ends it early.
Centered centered(FreeSpace& space, const motion::Pose& pose, double enough_m,
                  const geometry::Vec3& along_W, const base::Deadline& deadline);

/// Fits the body into narrow places: finds free poses near places at which it collides.
///
/// Begins with a copy of the body that is scaled down about its centre until it is free, centres
/// it, and lets it grow by as much as its gap permits, until it has its own size. After Saha,
/// Latombe, Chang & Prinz 2005 ("Finding narrow passages with probabilistic roadmaps: the
/// small-step retraction method"), who thin obstacles and retract samples; deviation: the body is
/// scaled, and it is centred by its contacts instead of by random moves.
/// Not thread-safe.
class Fitter {
 public:
  /// Refers to both arguments, which must outlive it. From the deadline on nothing fits.
  Fitter(FreeSpace& space, const base::Deadline& deadline);
  ~Fitter();
  Fitter(const Fitter&) = delete;
  Fitter& operator=(const Fitter&) = delete;

  /// Returns the largest of a few scales at which the body is free at `place`; 0 if there is none.
  [[nodiscard]] double free_scale(const motion::Pose& place);

  /// Returns a free pose near `place` at which the gap is about as large as it can be there;
  /// nothing if none was found.
  [[nodiscard]] std::optional<Centered> fitted(const motion::Pose& place);

 private:
  struct Thin;

  FreeSpace& space_;
  const base::Deadline& deadline_;
  /// The scaled-down bodies that growth begins with, the largest first; null until one is needed.
  std::vector<std::unique_ptr<Thin>> thin_;
};

}  // namespace camway::correction
