// SPDX-License-Identifier: MIT
#include "daemon/service/transport/lcm_url.h"

#include <gtest/gtest.h>

#include <utility>

namespace camway::service {
namespace {

TEST(LcmUrl, ReadsEveryPart) {
  const LcmNetwork plain = parse_lcm_url("udpm://");
  EXPECT_TRUE(plain.multicast);
  EXPECT_EQ(plain.fault, "");
  EXPECT_EQ(plain.group, "239.255.76.67");
  EXPECT_EQ(plain.port, 7667);
  EXPECT_EQ(plain.ttl, 0) << "LCM's default";
  const LcmNetwork full = parse_lcm_url("udpm://224.1.2.3:1234?recv_buf_size=2000000&ttl=2");
  EXPECT_EQ(full.fault, "");
  EXPECT_EQ(full.group, "224.1.2.3");
  EXPECT_EQ(full.port, 1234);
  EXPECT_EQ(full.ttl, 2);
  EXPECT_EQ(full.receive_buffer_bytes, 2'000'000);
}

TEST(LcmUrl, TakesWhatLcmCanSendAndReceiveWith) {
  for (const char* url : {"udpm://?ttl=1", "udpm://239.1.1.1", "udpm://239.1.1.1:1?", "memq://",
                          "tcpq://localhost:7700", "mpudpm://239.255.76.67:7667",
                          "udpm://239.1.1.1:65535?transmit_only=1&ttl=255"}) {
    EXPECT_EQ(parse_lcm_url(url).fault, "") << url;
  }
}

TEST(LcmUrl, SaysWhatMakesNoSense) {
  const std::vector<std::pair<std::string, std::string>> table{
      {"", "must begin with a provider"},
      {"239.255.76.67:7667", "must begin with a provider"},
      {"bogus://", "(udpm, mpudpm, tcpq, memq)"},
      {"file://some.log?mode=r", "that sends and receives"},
      {"udpm://10.0.0.1:7667?ttl=0", "'10.0.0.1' is no multicast group"},
      {"udpm://223.255.255.255", "no multicast group"},
      {"udpm://240.0.0.0", "no multicast group"},
      {"udpm://localhost:7667", "'localhost' is no multicast group"},
      {"udpm://:7667", "'' is no multicast group"},
      {"udpm://239.255.76.67:99999", "port '99999' must be a whole number from 1 to 65535"},
      {"udpm://239.255.76.67:0", "port '0'"},
      {"udpm://239.255.76.67:", "port ''"},
      {"udpm://239.255.76.67:7667?ttl=abc", "ttl 'abc' must be a whole number from 0 to 255"},
      {"udpm://?ttl=256", "ttl '256'"},
      {"udpm://?ttl", "ttl ''"},
      {"udpm://?ttl=-1", "ttl '-1'"},
      {"udpm://?ttl=1x", "ttl '1x'"},
      {"udpm://?recv_buf_size=0&ttl=0", "recv_buf_size '0'"},
      {"udpm://?tll=1", "'tll' is no option of udpm"},
  };
  for (const auto& [url, fault] : table) {
    EXPECT_NE(parse_lcm_url(url).fault.find(fault), std::string::npos)
        << url << ": " << parse_lcm_url(url).fault;
  }
}

}  // namespace
}  // namespace camway::service
