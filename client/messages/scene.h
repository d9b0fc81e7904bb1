// SPDX-License-Identifier: MIT
#pragma once

#include <camway/scene.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <camway/scene_request_t.hpp>
#include <camway/scene_response_t.hpp>
#include <camway/upload_page_t.hpp>
#include <camway/upload_status_t.hpp>

#include "client/messages/convert.h"

namespace camway {

/// Reads an object. Other structs of scenes follow from their names (`convert.h`).
void convert(const scene_object_t& wire, SceneObject& mine);

/// Writes the description of `shape` into `request`. Returns the bytes to upload; empty if none.
std::vector<std::uint8_t> put_shape(const SceneShape& shape, scene_request_t& request);

/// Writes the description of `mesh` into `request`. Returns the bytes to upload; empty if none.
std::vector<std::uint8_t> put_mesh(const SceneMesh& mesh, scene_request_t& request);

/// Returns the upload of points, and writes its size and checksum into `request`.
std::vector<std::uint8_t> put_points(const std::vector<std::array<double, 3>>& points,
                                     scene_request_t& request);

/// Writes a pose into `request`.
void put_pose(const Pose& pose, scene_request_t& request);

/// Returns a page of an upload. A negative `page` makes the page without bytes, which asks for the
/// state of the upload.
upload_page_t page_of(const std::vector<std::uint8_t>& bytes, std::int64_t checksum,
                      std::int32_t page);

}  // namespace camway
