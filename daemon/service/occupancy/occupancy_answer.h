// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>

#include "daemon/base/deadline.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::service {

/// What is wrong with the values of a batch, naming list and index, or an empty text: every number
/// must be finite, but a range, radius or distance of interest may be infinite and must not be
/// negative; a box's minimum must not pass its maximum; a ray needs a direction; the length of a
/// path must be a number.
std::string batch_fault(const occupancy_request_t& request);

/// Answers a batch on the scene's occupancy map, or says that `deadline` struck first; no query is
/// begun later. `utime` is left 0. A pure function but for that.
occupancy_response_t answer_batch(const scene::Snapshot& snapshot,
                                  const occupancy_request_t& request,
                                  const collision::Deadline& deadline);

/// How many queries a batch, or an answer to one, has of all kinds.
template <class Message>
std::int32_t queries_of(const Message& message) {
  return message.num_points + message.num_boxes + message.num_spheres + message.num_rays +
         message.num_distances + message.num_sphere_paths;
}

/// An answer to `request` that holds nothing but a status and a message.
occupancy_response_t plain_occupancy_answer(const occupancy_request_t& request, std::int32_t status,
                                            std::string_view message);

}  // namespace camway::service
