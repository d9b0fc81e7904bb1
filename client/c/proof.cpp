// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/plan.h>

#include <algorithm>
#include <vector>

#include "client/c/handles.h"
#include "client/c/lists.h"
#include "client/c/sized.h"

namespace camway::c {
namespace {

camway_cage cage_of(const Cage& from) {
  camway_cage cage{};
  std::copy(from.orientation_wxyz.begin(), from.orientation_wxyz.end(), cage.orientation_wxyz);
  std::copy(from.min_m.begin(), from.min_m.end(), cage.min_m);
  std::copy(from.max_m.begin(), from.max_m.end(), cage.max_m);
  cage.widest_hole_m = from.widest_hole_m;
  cage.shortest_chord_m = from.shortest_chord_m;
  return cage;
}

camway_infeasibility infeasibility_of(const Infeasibility& from) {
  camway_infeasibility infeasibility{};
  infeasibility.proof = from.cage ? CAMWAY_PROOF_CAGE : CAMWAY_PROOF_SURFACE;
  infeasibility.keyframe_inside = from.keyframe_inside;
  infeasibility.keyframe_outside = from.keyframe_outside;
  if (from.cage) infeasibility.cage = cage_of(*from.cage);
  return infeasibility;
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_answer_infeasibility(const camway_answer* answer,
                                          camway_infeasibility* infeasibility, size_t struct_size) {
  return guarded([&]() -> camway_status {
    const auto found = Handles::all().find(answer);
    if (!found->infeasibility)
      throw Refusal{CAMWAY_INVALID, "the answer has no proof that there is no path"};
    write_sized(infeasibility_of(*found->infeasibility), infeasibility, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_answer_proof_triangles(const camway_answer* answer, int32_t* triangles,
                                            size_t capacity, size_t* count) {
  return guarded([&] {
    const auto found = Handles::all().find(answer);
    const std::vector<std::int32_t> none;
    return write_list(found->infeasibility ? found->infeasibility->triangles : none, triangles,
                      capacity, count, [](std::int32_t triangle) { return triangle; });
  });
}
