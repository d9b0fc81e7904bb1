// SPDX-License-Identifier: MIT
#include "daemon/planning/request/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "daemon/planning/request/body_members.h"
#include "daemon/planning/request/option_table.h"

namespace camway::planning {
namespace {

/// `direction_of` for a vector of any size.
template <class Vector>
Vector unit_of(const Vector& vector) {
  // Scaled first, so that squares neither overflow nor vanish.
  const double largest = vector.cwiseAbs().maxCoeff();
  if (!vector.allFinite() || largest == 0.0) return vector;
  if (std::abs(vector.squaredNorm() - 1.0) <= kUnitLengthError) return vector;
  const Vector scaled = vector / largest;
  return scaled / scaled.norm();
}

}  // namespace

const motion::Camera* moving_camera(const PlanRequest& request) {
  return request.body ? std::get_if<motion::Camera>(&*request.body) : &request.camera;
}

motion::Camera* moving_camera(PlanRequest& request) {
  return request.body ? std::get_if<motion::Camera>(&*request.body) : &request.camera;
}

motion::BodyShape body_shape(const PlanRequest& request, double near_scale) {
  const motion::Camera* camera = moving_camera(request);
  if (camera == nullptr) return *request.body;
  motion::Camera scaled = *camera;
  scaled.near_m *= near_scale;
  return scaled;
}

bool may_shrink(const PlanRequest& request) {
  const PlanOptions& options = request.options;
  return options.max_shrink > 0.0 && moving_camera(request) != nullptr &&
         options.max_inserted_keyframes != 0;
}

std::string PlanRequest::name_of(std::string_view path) const {
  return spelling ? spelling(path) : std::string(path);
}

geometry::Vec3 direction_of(const geometry::Vec3& vector) { return unit_of(vector); }

geometry::Vec4 direction_of(const geometry::Vec4& wxyz) { return unit_of(wxyz); }

std::string spell(std::string_view path, Spelling spelling) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return std::string(path);
  const std::string_view group = path.substr(0, dot);
  const std::string_view indices = path.substr(std::min(path.find('[', dot), path.size()));
  const std::string_view name = path.substr(dot + 1, path.size() - dot - 1 - indices.size());
  std::string_view spelled = name;
  const auto visit = [&](const FieldSpec& spec) {
    if (spec.name != name) return;
    spelled = spelling == Spelling::kWire ? spec.wire_name() : spec.file_name();
  };
  if (group == "options") visit_specs<PlanOptions>(visit);
  if (group == "options.orientation") visit_specs<correction::OrientationPolicy>(visit);
  if (group == "options.limits") visit_specs<correction::MotionLimits>(visit);
  if (group == "options.bounds") visit_specs<geometry::OptionalBounds>(visit);
  if (group == "camera") visit_specs<motion::Camera>(visit);
  if (group == "body") visit_body(visit);
  if (group == "frame") visit_frame(visit);
  if (group.starts_with("keyframes[")) visit_keyframe(visit);
  return std::string(group) + "." + std::string(spelled) + std::string(indices);
}

}  // namespace camway::planning
