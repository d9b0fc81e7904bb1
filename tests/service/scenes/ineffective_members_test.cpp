// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/ineffective_members.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace camway::service {
namespace {

using ::testing::StartsWith;
using Request = scene_request_t;

Request request(std::int8_t operation, std::int8_t kind = Request::MESH) {
  Request request{};
  request.operation = operation;
  request.kind = kind;
  return request;
}

TEST(SceneIdle, NothingIsIdleInAZeroRequestOfAnyOperation) {
  for (std::int8_t operation = 0; operation < 20; ++operation) {
    EXPECT_EQ(ineffective_member(request(operation)), "") << int{operation};
  }
}

TEST(SceneIdle, WhatTheOperationNamesCounts) {
  Request load = request(Request::LOAD);
  load.file = "a.obj";
  load.scale = 0.0254;
  load.up = Request::UP_Z_TO_Y;
  load.unknown = Request::UNKNOWN_OCCUPIED;
  load.occupancy_resolution_m = 0.1;
  load.body_bounds.has_min[1] = 1;
  load.cell_m = 0.02;
  EXPECT_EQ(ineffective_member(load), "");
  Request put = request(Request::PUT, Request::CYLINDER);
  put.object = "pillar";
  put.radius_m = put.height_m = put.chord_error_m = 1.0;
  put.position_m[0] = put.orientation_wxyz[3] = 1.0;
  EXPECT_EQ(ineffective_member(put), "");
  Request scan = request(Request::SCAN);
  scan.object = "map";
  scan.position_m[2] = 1.0;
  scan.orientation_wxyz[0] = 1.0;  // not turned
  scan.upload_bytes = scan.upload_checksum = 24;
  EXPECT_EQ(ineffective_member(scan), "");
  Request restore = request(Request::RESTORE);
  restore.revision = 4;
  restore.restore_as = "before";
  EXPECT_EQ(ineffective_member(restore), "");
  Request triangles = request(Request::TRIANGLES);
  triangles.digest = "0123";
  EXPECT_EQ(ineffective_member(triangles), "");
}

TEST(SceneIdle, WhatWouldNotCountIsNamed) {
  Request move = request(Request::MOVE);
  move.object = "chair";
  move.scale = 2.0;
  EXPECT_EQ(ineffective_member(move),
            "scale: does not count with this operation; leave it zero or empty");
  Request bounded = request(Request::PUT, Request::SPHERE);
  bounded.body_bounds.has_max[2] = 1;
  EXPECT_THAT(ineffective_member(bounded), StartsWith("body_bounds: "));
  bounded = request(Request::MOVE);
  bounded.body_bounds.min_m[0] = -1.0;
  EXPECT_THAT(ineffective_member(bounded), StartsWith("body_bounds: "));
  Request box = request(Request::PUT, Request::BOX);
  box.radius_m = 1.0;
  EXPECT_EQ(ineffective_member(box),
            "radius_m: does not count with this kind of object; leave it zero or empty");
  Request sphere = request(Request::PUT, Request::SPHERE);
  sphere.size_m[1] = 1.0;
  EXPECT_THAT(ineffective_member(sphere), StartsWith("size_m: "));
  Request load = request(Request::LOAD);
  load.object = "chair";
  EXPECT_THAT(ineffective_member(load), StartsWith("object: "));
  load = request(Request::LOAD, Request::BOX);
  EXPECT_THAT(ineffective_member(load), StartsWith("kind: "));
  load = request(Request::LOAD);
  load.orientation_wxyz[2] = 1.0;
  EXPECT_THAT(ineffective_member(load), StartsWith("orientation_wxyz: "));
  Request remove = request(Request::REMOVE);
  remove.revision = 3;
  EXPECT_THAT(ineffective_member(remove), StartsWith("revision: "));
}

}  // namespace
}  // namespace camway::service
