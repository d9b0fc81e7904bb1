// SPDX-License-Identifier: MIT
#include "tests/client/fake_daemon.h"

#include <algorithm>

namespace camway::testing_support {

std::vector<plan_response_t> answer_pages(const plan_request_t& request, int segments,
                                          int per_page) {
  plan_response_t head{};
  head.client_id = request.client_id;
  head.request_id = request.request_id;
  head.utime = 1;
  head.num_pages = std::max(1, (segments + per_page - 1) / per_page);
  head.keyframe = -1;
  head.message = "all is well";
  head.scene = request.scene;
  head.scene_revision = 3;
  head.total_ms = 1.5;
  std::vector<plan_response_t> pages(static_cast<std::size_t>(head.num_pages), head);
  for (int i = 0; i < head.num_pages; ++i) pages[std::size_t(i)].page = i;
  for (int i = 0; i < segments; ++i) {
    segment_t segment{};
    segment.t0_s = i;
    segment.t1_s = i + 1;
    for (int k = 0; k < 4; ++k) segment.position_m[k][0] = i + k / 3.0;
    for (auto& point : segment.orientation_wxyz) point[0] = 1.0;
    plan_response_t& page = pages[std::size_t(i / per_page)];
    page.segments.push_back(segment);
    page.num_segments = static_cast<std::int32_t>(page.segments.size());
  }
  return pages;
}

std::vector<Bytes> encode_all(const std::vector<plan_response_t>& pages) {
  std::vector<Bytes> messages;
  for (const plan_response_t& page : pages) messages.push_back(wire::encode(page));
  return messages;
}

}  // namespace camway::testing_support
