// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "tools/camway/replay/compare/report_page.h"

namespace camway::tools {

struct ReviewsOptions {
  Reviewed reviewed = Reviewed::kDiffering;
  std::size_t most_bytes = 0;  ///< most bytes of `ShelvedReviews::elements`
  const view::PageFiles& page;
};

/// Reviews of compared requests in the elements of a page (`view::ReviewShelf`).
struct ShelvedReviews {
  std::set<std::size_t> shown;  ///< indices of compared requests, which are numbers of reviews
  std::string elements;
  std::size_t wanted = 0;     ///< number of requests that the options ask for
  std::size_t too_large = 0;  ///< number of those that did not fit
  std::size_t failed = 0;     ///< number of those that cannot be shown
  std::string first_failure;  ///< the reason of the first one, a sentence
  std::string why_none;       ///< the reason why nothing can be shown, a sentence
};

/// Makes reviews of requests, the worst verdicts first. A review has both answers, the later one as
/// its answer and the earlier one to compare with; if they are the same, or there is but one, it
/// has one.
ShelvedReviews reviews_of(const std::vector<ComparedRequest>& compared, const SceneOf& scene_of,
                          const ReportHead& head, const ReviewsOptions& options);

}  // namespace camway::tools
