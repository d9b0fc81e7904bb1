// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>

#include "daemon/base/deadline.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::service {

/// Returns an error about the values of a batch, which names list and index, or an empty text.
/// Every number must be finite. A range, radius or distance of interest must not be negative, but
/// may be infinite; a box's minimum must not exceed its maximum; a ray needs a direction; the
/// length of a path must be a finite number.
std::string batch_fault(const occupancy_request_t& request);

/// Answers a batch on the scene's occupancy map, with `utime` 0. If `deadline` strikes, begins no
/// further query, and answers that it struck. A pure function otherwise.
occupancy_response_t answer_batch(const scene::Snapshot& snapshot,
                                  const occupancy_request_t& request,
                                  const base::Deadline& deadline);

/// Returns the number of queries of all kinds in a batch, or in an answer.
template <class Message>
std::int32_t queries_of(const Message& message) {
  return message.num_points + message.num_boxes + message.num_spheres + message.num_rays +
         message.num_distances + message.num_sphere_paths;
}

/// Returns an answer to `request` that holds only a status and a message.
occupancy_response_t plain_occupancy_answer(const occupancy_request_t& request, std::int32_t status,
                                            std::string_view message);

}  // namespace camway::service
