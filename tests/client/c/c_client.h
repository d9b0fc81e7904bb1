// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <gtest/gtest.h>

namespace camway::testing_support {

/// A client of the C interface that repeats its requests quickly, as `quick()` does.
class CClient {
 public:
  CClient() {
    camway_client_options options;
    camway_client_options_init(&options, sizeof options);
    options.try_timeout_s = 0.1;
    options.max_try_timeout_s = 0.2;
    options.retries = 3;
    options.deadline_s = 20.0;
    EXPECT_EQ(camway_client_create(&options, &handle_), CAMWAY_OK) << camway_last_error();
  }
  ~CClient() { free(); }
  CClient(const CClient&) = delete;
  CClient& operator=(const CClient&) = delete;

  camway_client* get() const { return handle_; }
  void free() {
    camway_client_free(handle_);
    handle_ = nullptr;
  }

 private:
  camway_client* handle_ = nullptr;
};

/// A request that is valid in form; `small_request()` in C.
struct CRequest : camway_plan_request {
  CRequest() {
    EXPECT_EQ(camway_plan_request_init(this, sizeof(camway_plan_request)), CAMWAY_OK);
    scene = "office";
    for (camway_keyframe& keyframe : given) keyframe.orientation_wxyz[0] = 1.0;
    keyframes = given;
    num_keyframes = 2;
    untimed = 1;
  }
  CRequest(const CRequest&) = delete;
  CRequest& operator=(const CRequest&) = delete;

  camway_keyframe given[2] = {};
};

}  // namespace camway::testing_support
