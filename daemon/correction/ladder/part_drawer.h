// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "daemon/base/budget.h"
#include "daemon/base/deadline.h"
#include "daemon/correction/ladder/corrected_path.h"
#include "daemon/correction/ladder/knot_choice.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/smoothing/relaxation.h"

namespace camway::correction {

/// A changed part of a path, drawn as one row of bumps on `knots_s`.
struct Drawing {
  std::vector<double> knots_s;
  Relaxed drawn;
  double cost = 0.0;  ///< value of the objective for the part alone (`ObjectiveCost::value`)
};

/// Draws a changed part of a path on other knots. Every drawing is proved free.
/// Not thread-safe.
class PartDrawer {
 public:
  /// Refers to all arguments, which must outlive it. `problem`: as `CorrectedPath::restored`
  /// returns it for `part`. `changed`: the part that is drawn again. `part`: where rows may change
  /// the path. `space`: where drawings are proved free. `measured`: where costs are measured; it
  /// may require less clearance.
  PartDrawer(const Problem& problem, const ChangedPart& changed, const ChangedPart& part,
             Objective objective, FreeSpace& space, FreeSpace& measured,
             const base::Deadline& deadline);

  [[nodiscard]] const KnotChoice& choice() const { return choice_; }

  /// Value of the objective for the part of `path` alone.
  [[nodiscard]] double cost(const motion::CubicPath& path) const;

  /// Returns the drawing on `knots_s` that is nearest to `wanted`; nothing if it collides.
  [[nodiscard]] std::optional<Drawing> drawing(std::vector<double> knots_s,
                                               const motion::CubicPath& wanted) const;

  /// Relaxes a drawing for the objective. `makes_room`: as in `Improvement`.
  void relax(Drawing& drawing, bool makes_room, base::Budget& budget) const;

  /// Sets the largest cost of other drawings. Without it, none is too dear.
  void limit_cost(double most_cost) { most_cost_ = most_cost; }
  [[nodiscard]] bool is_worth(const Drawing& drawing) const { return drawing.cost <= most_cost_; }

  /// Ends the part at keyframes that it crosses for little, if that is worth it.
  void cut_at_keyframes(Drawing& best);

  /// Removes knots in batches, halved where that is too much at once. A knot without which the path
  /// collides stays.
  void thin_out(Drawing& best);

 private:
  /// A drawing, or the time of a collision that prevents it, if there is one.
  struct Tried {
    std::optional<Drawing> drawing;
    std::optional<double> collides_s;
  };
  /// Whether other knots were taken, or the time of a collision that prevents it, if there is one.
  struct Redrawn {
    bool is_taken = false;
    std::optional<double> collides_s = {};
  };

  [[nodiscard]] Tried try_drawing(std::vector<double> knots_s,
                                  const motion::CubicPath& wanted) const;
  Redrawn redraw_on(std::vector<double> knots_s, Drawing& best);
  [[nodiscard]] std::vector<double> spared(const Drawing& best,
                                           const std::vector<double>& needed_s) const;

  const Problem& problem_;
  const ChangedPart& part_;
  const Objective objective_;
  FreeSpace& space_;
  FreeSpace& measured_;
  const base::Deadline& deadline_;
  const KnotChoice choice_;
  base::Budget budget_;  ///< steps of all drawings on other knots
  double most_cost_ = std::numeric_limits<double>::infinity();
};

}  // namespace camway::correction
