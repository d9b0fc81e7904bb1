// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "tools/view/answer.h"

namespace camway::view {

/// A place of the door.
enum class Place {
  kPage,
  kScript,
  kStyle,
  kPicture,
  kVersion,
  kStatus,
  kPlan,
  kCheck,
  kInterpolate,
  kFields,
  kLast,
  kReview,
  kExport,
  kSocket,
  kScenes,
  kScene,
  kObjects,
  kObject,
  kMesh,
  kTriangles,
};

/// The place that a request leads to, or why it leads nowhere.
struct Route {
  Place place = Place::kPage;
  std::string_view scene;    ///< with kScene and what is below
  std::string_view object;   ///< with kObject; the digest with kMesh
  int code = code::kOk;      ///< else `code::kNotFound` or `code::kNotAllowed`
  std::string_view allowed;  ///< methods of the place, for the header `Allow`
};

/// Finds the place of a request. HEAD counts as GET. The result refers to `target`.
Route route_of(std::string_view method, std::string_view target);

}  // namespace camway::view
