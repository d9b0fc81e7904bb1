// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>
#include <gtest/gtest.h>

namespace camway::testing_support {

/// Returns options for a client that repeats its requests quickly, to keep tests short.
inline ClientOptions quick() {
  ClientOptions options;
  options.try_timeout_s = 0.1;
  options.max_try_timeout_s = 0.2;
  options.retries = 3;
  options.deadline_s = 20.0;
  return options;
}

/// Returns a request that is valid in form.
inline PlanRequest small_request() {
  PlanRequest request;
  request.scene = "office";
  request.keyframes.resize(2);
  return request;
}

class ClientTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Client probe(quick());
    ASSERT_TRUE(probe.good()) << "LCM does not work here, so nothing can be tested: "
                              << probe.error();
  }
};

}  // namespace camway::testing_support
