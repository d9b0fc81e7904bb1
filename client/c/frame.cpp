// SPDX-License-Identifier: MIT
#include "client/c/frame.h"

#include <algorithm>

#include "client/c/handles.h"

namespace camway::c {
namespace {

camway_path_end end_of(const PathEnd& from) {
  camway_path_end end{};
  std::copy(from.velocity_m_per_s.begin(), from.velocity_m_per_s.end(), end.velocity_m_per_s);
  std::copy(from.image_rate_per_s.begin(), from.image_rate_per_s.end(), end.image_rate_per_s);
  return end;
}

PathEnd end_of(const camway_path_end& from) {
  PathEnd end;
  std::copy_n(from.velocity_m_per_s, 3, end.velocity_m_per_s.begin());
  std::copy_n(from.image_rate_per_s, 4, end.image_rate_per_s.begin());
  return end;
}

}  // namespace

PathFrame frame_of(const camway_path_frame& from) {
  PathFrame frame;
  std::copy_n(from.reference_wxyz, 4, frame.reference_wxyz.begin());
  frame.begin = end_of(from.begin);
  frame.end = end_of(from.end);
  return frame;
}

}  // namespace camway::c

using namespace camway::c;

camway_status camway_answer_frame(const camway_answer* answer, camway_path_frame* frame) {
  return guarded([&]() -> camway_status {
    const auto found = Handles::all().find(answer);
    require(frame, "frame");
    if (!found->frame) throw Refusal{CAMWAY_INVALID, "the answer has no frame"};
    const camway::PathFrame& from = *found->frame;
    std::copy(from.reference_wxyz.begin(), from.reference_wxyz.end(), frame->reference_wxyz);
    frame->begin = end_of(from.begin);
    frame->end = end_of(from.end);
    return CAMWAY_OK;
  });
}

camway_status camway_answer_images(const camway_answer* answer, double* images, size_t capacity,
                                   size_t* count) {
  return guarded([&] {
    const auto found = Handles::all().find(answer);
    require(count, "count");
    *count = 0;
    require_array(images, capacity, "the array");
    const std::size_t written = std::min(capacity, found->keyframes.size());
    for (std::size_t i = 0; i < written; ++i) {
      std::copy_n(found->keyframes[i].image.begin(), 4, images + 4 * i);
    }
    *count = found->keyframes.size();
    return CAMWAY_OK;
  });
}
