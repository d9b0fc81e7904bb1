// SPDX-License-Identifier: MIT
#include <utility>

#include "daemon/planning/result/members.h"
#include "tools/json/json_io.h"
#include "tools/json/json_path.h"
#include "tools/json/json_reader.h"
#include "tools/json/json_writer.h"

namespace camway::tools {

using planning::PlanResult;

void read_value(const Field& root, PlanResult& result) {
  const JsonReader io(root);
  planning::head_members(io, result);
  std::vector<motion::Segment> segments;
  if (const auto list = root.optional_member("segments")) segments = read_segments(*list);
  // A path requires valid segments.
  if (!root.failed()) result.path = motion::Path(std::move(segments));
  io.may("keyframes", true, result.keyframes);
  planning::report_members(io, result);
  io.may("timing_ms", true, result.timing);
}

base::Result<std::string> write_plan_response(const PlanResult& result,
                                              const ResponseFormat& format) {
  std::string out;
  JsonWriter io(out);
  io.object(2, [&] {
    planning::head_members(io, result);
    io.may("scene", !format.scene.empty(), format.scene);
    io.may("scene_digest", !format.scene_digest.empty(), format.scene_digest);
    io.may("warnings", !format.warnings.empty(), format.warnings);
    io.need("segments", result.path.segments());
    io.need("keyframes", result.keyframes);
    planning::report_members(io, result);
    io.may("timing_ms", format.timing == TimingField::kWritten, result.timing);
  });
  out += '\n';
  if (!io.error().empty()) return base::Failure{io.error()};
  return out;
}

}  // namespace camway::tools
