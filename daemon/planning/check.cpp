// SPDX-License-Identifier: MIT
#include "daemon/planning/check.h"

#include <algorithm>
#include <utility>

#include "daemon/collision/clearance.h"

namespace camway::planning {

collision::DetectOptions detect_options(const PlanOptions& options) {
  collision::DetectOptions detect;
  detect.tolerance_m = options.interval_tolerance_m;
  detect.gap_m = std::max(detect.gap_m, detect.tolerance_m);
  detect.clearance_m = options.clearance_m;
  return detect;
}

PathCheck check_path(const collision::Obstacles& obstacles, const motion::Path& path,
                     const motion::Body& body, const collision::DetectOptions& options,
                     const collision::Deadline& deadline,
                     const collision::Deadline& clearance_deadline) {
  PathCheck check;
  auto found = collision::detect_collisions(obstacles, path, body, path.begin_s(), path.end_s(),
                                            options, deadline);
  if (!found) return check;
  check.complete = true;
  check.collisions = std::move(*found);
  if (check.collisions.empty()) {
    check.certificate = certificate_of_free(obstacles, path, body, options, clearance_deadline);
  }
  return check;
}

Certificate certificate_of_free(const collision::Obstacles& obstacles, const motion::Path& path,
                                const motion::Body& body, const collision::DetectOptions& options,
                                const collision::Deadline& clearance_deadline) {
  // The proof shows the required clearance, whatever the bound comes to.
  Certificate certificate{true, options.clearance_m};
  const auto clearance = collision::path_clearance(obstacles, path, body, clearance_deadline);
  if (clearance) {
    certificate.clearance_lower_bound_m =
        std::max(certificate.clearance_lower_bound_m, clearance->lower_bound_m);
  }
  return certificate;
}

}  // namespace camway::planning
