// SPDX-License-Identifier: MIT
#include "daemon/service/transport/metered_transport.h"

#include <gtest/gtest.h>

#include "tests/service/fake_transport.h"

namespace camway::service {
namespace {

TEST(MeteredTransport, CountsWhatGoesThroughAndWhatIsNotTaken) {
  testing::FakeTransport inner;
  MeteredTransport metered(inner);
  std::size_t heard = 0;
  ASSERT_TRUE(metered.subscribe("IN", 10, [&](auto message) { heard += message.size(); }));
  inner.deliver("IN", wire::Bytes(7));
  inner.deliver("IN", wire::Bytes(5));
  inner.deliver("ELSEWHERE", wire::Bytes(100));
  ASSERT_TRUE(metered.poll(std::chrono::milliseconds(0)));
  EXPECT_EQ(heard, 12U);
  EXPECT_EQ(metered.traffic().received_messages, 2);
  EXPECT_EQ(metered.traffic().received_bytes, 12);

  EXPECT_TRUE(metered.publish("OUT", wire::Bytes(3)));
  inner.fail_publish();
  EXPECT_FALSE(metered.publish("OUT", wire::Bytes(3)));
  EXPECT_EQ(metered.traffic().sent_messages, 1);
  EXPECT_EQ(metered.traffic().sent_bytes, 3);
  EXPECT_EQ(metered.traffic().unsent_messages, 1);
}

}  // namespace
}  // namespace camway::service
