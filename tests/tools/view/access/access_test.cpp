// SPDX-License-Identifier: MIT
#include "tools/view/access/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/tools/view/door_client.h"
#include "tests/tools/view/fake_backend.h"
#include "tools/view/access/token.h"
#include "tools/view/door.h"

namespace camway::view {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr char kLongToken[] = "0123456789abcdef0123456789abcdef";
constexpr int kPort = 4711;

using Headers = std::vector<std::pair<std::string, std::string>>;

struct AccessCase {
  const char* what;
  const char* target;
  Headers headers;
  bool passes;
};

const Headers kBearer{{"host", "127.0.0.1:4711"},
                      {"authorization", "Bearer 0123456789abcdef0123456789abcdef"}};

Headers with(Headers headers, const char* name, const char* value) {
  for (auto& [each, old] : headers) {
    if (each == name) {
      old = value;
      return headers;
    }
  }
  headers.emplace_back(name, value);
  return headers;
}

Headers twice(Headers headers, const char* name, const char* value) {
  headers.emplace_back(name, value);
  return headers;
}

std::vector<AccessCase> access_cases() {
  const Headers bare{{"host", "localhost:4711"}};
  const char* const with_token = "/?token=0123456789abcdef0123456789abcdef";
  const char* const cookie = "a=b; camway_4711=0123456789abcdef0123456789abcdef";
  return {
      {"bearer", "/v1/status", kBearer, true},
      {"localhost", "/v1/status", with(kBearer, "host", "localhost:4711"), true},
      {"another port", "/v1/status", with(kBearer, "host", "127.0.0.1:4712"), false},
      {"no port", "/v1/status", with(kBearer, "host", "127.0.0.1"), false},
      {"a name that leads here", "/v1/status", with(kBearer, "host", "evil.example:4711"), false},
      {"a longer name", "/v1/status", with(kBearer, "host", "localhost:4711.evil"), false},
      {"IPv6", "/v1/status", with(kBearer, "host", "[::1]:4711"), false},
      {"two hosts", "/v1/status", twice(kBearer, "host", "127.0.0.1:4711"), false},
      {"no host", "/v1/status", {kBearer[1]}, false},
      {"same origin", "/v1/status", with(kBearer, "origin", "http://127.0.0.1:4711"), true},
      {"origin of the other name", "/v1/status", with(kBearer, "origin", "http://localhost:4711"),
       false},
      {"https", "/v1/status", with(kBearer, "origin", "https://127.0.0.1:4711"), false},
      {"foreign origin", "/v1/status", with(kBearer, "origin", "http://evil.example"), false},
      {"another port's origin", "/v1/status", with(kBearer, "origin", "http://127.0.0.1:80"),
       false},
      {"null origin", "/v1/status", with(kBearer, "origin", "null"), false},
      {"a foreign origin beside the own", "/v1/status",
       twice(with(kBearer, "origin", "http://127.0.0.1:4711"), "origin", "http://evil.example"),
       false},
      {"no token", "/v1/status", bare, false},
      {"wrong token", "/v1/status",
       with(kBearer, "authorization", "Bearer 0123456789abcdef0123456789abcdee"), false},
      {"half a token", "/v1/status", with(kBearer, "authorization", "Bearer 0123456789abcdef"),
       false},
      {"empty token", "/v1/status", with(kBearer, "authorization", "Bearer "), false},
      {"another scheme", "/v1/status",
       with(kBearer, "authorization", "Basic 0123456789abcdef0123456789abcdef"), false},
      {"token of the first page", with_token, bare, true},
      {"token of the socket", "/v1/socket?token=0123456789abcdef0123456789abcdef", bare, true},
      {"token second", "/?a=b&token=0123456789abcdef0123456789abcdef", bare, true},
      {"token in another place", "/v1/status?token=0123456789abcdef0123456789abcdef", bare, false},
      {"wrong token of the first page", "/?token=1123456789abcdef0123456789abcdef", bare, false},
      {"cookie", "/v1/status", with(bare, "cookie", cookie), true},
      {"cookie of another port", "/v1/status",
       with(bare, "cookie", "camway_4712=0123456789abcdef0123456789abcdef"), false},
      {"cookie and foreign origin", "/v1/status",
       with(with(bare, "cookie", cookie), "origin", "http://evil.example"), false},
  };
}

TEST(ViewAccess, IsForWhoHasTheTokenAndCameByTheRightName) {
  for (const AccessCase& each : access_cases()) {
    const http::Request request{"GET", each.target, each.headers, ""};
    EXPECT_EQ(why_refused(request, {kPort, kLongToken}).empty(), each.passes) << each.what;
  }
}

TEST(ViewAccess, NobodyPassesADoorWithoutAToken) {
  const http::Request request{
      "GET", "/v1/status", {{"host", "127.0.0.1:4711"}, {"authorization", "Bearer "}}, ""};
  EXPECT_FALSE(why_refused(request, {kPort, ""}).empty());
}

TEST(ViewAccess, TokensAreLongAndDiffer) {
  std::set<std::string> tokens;
  constexpr int kCount = 1000;
  for (int i = 0; i < kCount; ++i) tokens.insert(random_token());
  EXPECT_EQ(tokens.size(), std::size_t{kCount});
  for (const std::string& token : tokens) {
    EXPECT_EQ(token.size(), 32U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  }
}

TEST(ViewAccess, SecretsAreEqualInEveryCharacterOrNotAtAll) {
  EXPECT_TRUE(is_same_secret("abc", "abc"));
  EXPECT_TRUE(is_same_secret("", ""));
  for (const char* const other : {"abd", "xbc", "axc", "ab", "abcd", "", "ABC"}) {
    EXPECT_FALSE(is_same_secret("abc", other)) << other;
  }
}

/// The same over a connection.
class ViewAccessDoor : public ::testing::Test {
 protected:
  void SetUp() override {
    auto opened = Door::open(
        {.token = kLongToken, .page = {{"html", "gz"}, {"script", "gz"}, {"style", "gz"}, ""}},
        backend_);
    ASSERT_TRUE(opened) << opened.error;
    door_ = *std::move(opened);
  }
  FakeBackend backend_;
  std::unique_ptr<Door> door_;
};

TEST_F(ViewAccessDoor, EveryResponseHasTheHeadersOfSafety) {
  HttpClient client(door_->port(), kLongToken);
  HttpClient stranger(door_->port(), "");
  std::vector<Reached> all{client.get("/"),
                           client.get("/page.css"),
                           client.get("/plan.svg"),
                           client.get("/v1/version"),
                           client.get("/v1/nowhere"),
                           client.get("/v1/plan"),
                           client.post("/v1/plan", "{"),
                           client.send("HEAD", "/"),
                           client.post("/v1/plan", std::string(17'000'000, ' ')),
                           stranger.get("/v1/version")};
  std::vector<int> codes;
  for (const Reached& each : all) {
    codes.push_back(each.code);
    EXPECT_THAT(each.header("Content-Security-Policy"), StartsWith("default-src 'self';"));
    EXPECT_THAT(each.header("Content-Security-Policy"), HasSubstr("frame-ancestors 'none'"));
    EXPECT_EQ(each.header("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(each.header("Referrer-Policy"), "no-referrer");
    EXPECT_EQ(each.header("Cache-Control"), "no-store");
  }
  EXPECT_EQ(codes, std::vector({200, 200, 404, 200, 404, 405, 400, 200, 413, 403}));
}

TEST_F(ViewAccessDoor, TheFirstPageGivesTheCookieAndOthersNeedIt) {
  HttpClient stranger(door_->port(), "");
  EXPECT_EQ(stranger.get("/").code, 403);
  const Reached page = stranger.get(std::string("/?token=") + kLongToken);
  EXPECT_EQ(page.code, 200);
  const std::string cookie = page.header("Set-Cookie");
  EXPECT_THAT(cookie, HasSubstr("SameSite=Strict"));
  EXPECT_THAT(cookie, HasSubstr("HttpOnly"));
  const std::string given = cookie.substr(0, cookie.find(';'));
  EXPECT_EQ(stranger.send("GET", "/v1/version", "", {{"Cookie", given}}).code, 200);
  EXPECT_EQ(stranger.send("GET", "/v1/version", "", {{"Cookie", given + "0"}}).code, 403);
}

TEST_F(ViewAccessDoor, SocketsAreForWhoHasTheTokenToo) {
  const std::string own = "http://127.0.0.1:" + std::to_string(door_->port());
  EXPECT_NO_THROW(SocketClient(door_->port(), kLongToken));
  EXPECT_NO_THROW(SocketClient(door_->port(), kLongToken, own));
  EXPECT_THROW(SocketClient(door_->port(), "x"), beast::system_error);
  EXPECT_THROW(SocketClient(door_->port(), kLongToken, "http://evil.example"), beast::system_error);
}

TEST_F(ViewAccessDoor, ListensOnTheLoopbackAlone) {
  EXPECT_THAT(door_->url(), StartsWith("http://127.0.0.1:"));
  EXPECT_THAT(door_->url(), HasSubstr(kLongToken));
}

}  // namespace
}  // namespace camway::view
