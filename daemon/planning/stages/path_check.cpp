// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/path_check.h"

#include <algorithm>
#include <utility>

#include "daemon/collision/clearance.h"

namespace camway::planning {

collision::DetectOptions detect_options(const PlanOptions& options) {
  collision::DetectOptions detect;
  detect.tolerance_m = options.interval_tolerance_m;
  detect.joining_distance_m = std::max(detect.joining_distance_m, detect.tolerance_m);
  detect.clearance_m = options.clearance_m;
  return detect;
}

PathCheck check_path(const collision::Query& query, const motion::Path& path,
                     const base::Deadline& deadline, const base::Deadline& clearance_deadline) {
  PathCheck check;
  auto found = collision::detect_collisions(query, path, path.begin_s(), path.end_s(), deadline);
  if (!found) return check;
  check.complete = true;
  check.collisions = std::move(*found);
  if (check.collisions.empty()) {
    check.certificate = certificate_of_free(query, path, clearance_deadline);
  }
  return check;
}

Certificate certificate_of_free(const collision::Query& query, const motion::Path& path,
                                const base::Deadline& clearance_deadline) {
  // The proof shows the required clearance, whatever the bound comes to.
  Certificate certificate{true, query.options.clearance_m};
  const auto clearance =
      collision::path_clearance(query.obstacles, path, query.body, clearance_deadline);
  if (clearance) {
    certificate.clearance_lower_bound_m =
        std::max(certificate.clearance_lower_bound_m, clearance->lower_bound_m);
  }
  return certificate;
}

}  // namespace camway::planning
