// SPDX-License-Identifier: MIT
#include "daemon/base/deadline.h"

#include <gtest/gtest.h>

namespace camway::base {
namespace {

TEST(Deadline, StrikesWhenToldToStopWhateverTheTime) {
  std::stop_source stop;
  const Deadline deadline = Deadline::never().watched(stop.get_token(), nullptr);
  const Deadline later = deadline.not_before_s(100.0);
  EXPECT_FALSE(deadline.passed());
  EXPECT_GT(deadline.remaining_s(), 1e6);
  stop.request_stop();
  EXPECT_TRUE(deadline.passed());
  EXPECT_TRUE(deadline.stopped());
  EXPECT_TRUE(later.passed()) << "copies hear of it too";
  EXPECT_EQ(deadline.remaining_s(), 0.0);
}

TEST(Deadline, CanBePutOffButNotBroughtForward) {
  const Deadline over = Deadline::after_s(0.0);
  EXPECT_TRUE(over.passed());
  EXPECT_FALSE(over.stopped());
  const Deadline later = over.not_before_s(50.0);
  EXPECT_FALSE(later.passed());
  EXPECT_GT(later.remaining_s(), 40.0);
  EXPECT_GT(Deadline::after_s(100.0).not_before_s(1.0).remaining_s(), 90.0);
}

TEST(Deadline, CanBeBroughtForward) {
  EXPECT_LT(Deadline::after_s(100.0).sooner_by_s(60.0).remaining_s(), 41.0);
  EXPECT_TRUE(Deadline::after_s(100.0).sooner_by_s(200.0).passed());
  EXPECT_FALSE(Deadline::never().sooner_by_s(1e6).passed());
}

TEST(Deadline, AfterLooksGoesByLooksAndNoClock) {
  const Deadline deadline = Deadline::after_looks(10);
  EXPECT_EQ(deadline.remaining_s(), 0.010);
  EXPECT_EQ(deadline.elapsed_ms(), 1.0);
  const Deadline copy = deadline.sooner_by_s(0.004);
  EXPECT_EQ(copy.remaining_s(), 0.004);  // the third look, of either
  EXPECT_FALSE(copy.passed());
  for (int i = 4; i < 6; ++i) EXPECT_FALSE(copy.passed()) << i;
  EXPECT_TRUE(copy.passed());
  EXPECT_FALSE(deadline.passed());
}

TEST(Deadline, KnowsWhetherAnybodyWasToldThatItIsOver) {
  const Deadline deadline = Deadline::after_s(1000.0);
  EXPECT_FALSE(deadline.passed());
  EXPECT_TRUE(deadline.leaves_s(900.0));
  EXPECT_FALSE(deadline.struck());
  EXPECT_TRUE(deadline.sooner_by_s(1000.0).share_of_rest(0.5).passed());
  EXPECT_TRUE(deadline.struck()) << "all that are made of one are one";
  const Deadline other = Deadline::after_s(1000.0);
  EXPECT_FALSE(other.leaves_s(2000.0));
  EXPECT_TRUE(other.struck());
}

TEST(Deadline, HandsOnWhatIsReported) {
  const auto progress = std::make_shared<Progress>();
  const Deadline deadline = Deadline::after_s(1.0).watched({}, progress);
  EXPECT_EQ(progress->stage, Progress::Stage::kWaiting);
  deadline.not_before_s(2.0).report(Progress::Stage::kDetecting);
  deadline.report_collisions(7, 3);
  EXPECT_EQ(progress->stage, Progress::Stage::kDetecting);
  EXPECT_EQ(progress->collisions, 7);
  EXPECT_EQ(progress->corrected, 3);
  Deadline::after_s(1.0).report(Progress::Stage::kCertifying);  // nobody listens, nothing happens
}

}  // namespace
}  // namespace camway::base
