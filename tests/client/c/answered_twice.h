// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/client.h>
#include <camway/members.h>
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"

namespace camway::testing_support {

/// An answer of a daemon as the clients of C and of C++ have it.
class AnsweredTwice {
 public:
  /// `change` sets what the answer has beside a path of two seconds.
  explicit AnsweredTwice(const std::function<void(plan_response_t&)>& change) {
    daemon_.on_plan = [change](const plan_request_t& asked) {
      std::vector<plan_response_t> pages = answer_pages(asked, 2, 2);
      change(pages[0]);
      wire::set_counts(pages[0]);
      return encode_all(pages);
    };
    daemon_.start();
    in_cxx_ = Client(quick()).plan(small_request());
    EXPECT_EQ(camway_plan(client_.get(), &request_, 10.0, &in_c_),
              static_cast<camway_status>(in_cxx_.status));
    EXPECT_NE(in_c_, nullptr) << camway_last_error();
  }
  ~AnsweredTwice() { camway_answer_free(in_c_); }
  AnsweredTwice(const AnsweredTwice&) = delete;
  AnsweredTwice& operator=(const AnsweredTwice&) = delete;

  const camway_answer* in_c() const { return in_c_; }
  const PlanResponse& in_cxx() const { return in_cxx_; }

  /// Plans again by the client of C, and returns the last request that the daemon got. Ends the
  /// daemon.
  plan_request_t sent(const camway_plan_request& request) {
    camway_answer* again = nullptr;
    camway_plan(client_.get(), &request, 10.0, &again);
    EXPECT_EQ(camway_answer_free(again), CAMWAY_OK);
    daemon_.stop();
    return daemon_.plan_requests().back();
  }

 private:
  CClient client_;
  const CRequest request_;
  FakeDaemon daemon_;
  PlanResponse in_cxx_;
  camway_answer* in_c_ = nullptr;
};

}  // namespace camway::testing_support
