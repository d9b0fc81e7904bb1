// SPDX-License-Identifier: MIT
#include "tools/camway/replay/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace camway::tools {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kBeginUtime = 1'700'000'000'000'000;  // 2023-11-14T22:13:20Z

TEST(LogTime, IsSecondsOrATimeOfTheClock) {
  EXPECT_EQ(log_time_of("12.5")->value_s, 12.5);
  EXPECT_FALSE(log_time_of("12.5")->is_of_the_clock);
  EXPECT_EQ(log_time_of("2023-11-14T22:13:20Z")->value_s, 1.7e9);
  EXPECT_EQ(log_time_of("2023-11-14T22:13:20.25Z")->value_s, 1.7e9 + 0.25);
  EXPECT_TRUE(log_time_of("2023-11-14T22:13:20Z")->is_of_the_clock);
  for (const char* wrong : {"", "x", "nan", "inf", "1 ", "2023-11-14T22:13:20", "2023-11-14",
                            "2023-11-14T22:13:20.xZ", "2023-11-14T22:13:20 1Z"}) {
    EXPECT_FALSE(log_time_of(wrong)) << wrong;
  }
}

TEST(IdRanges, AreNumbersAndRanges) {
  EXPECT_THAT(*id_ranges_of("3,7..9,-5..-2"),
              ElementsAre(IdRange(3, 3), IdRange(7, 9), IdRange(-5, -2)));
  for (const char* wrong :
       {"", ",", "3,", "a", "9..7", "1..", "..1", "1...2", "99999999999999999999"}) {
    EXPECT_FALSE(id_ranges_of(wrong)) << wrong;
  }
}

/// Five requests, a second apart, of two clients, in two scenes; the last one has no answer.
Session five_requests() {
  Session session;
  session.begin_utime = kBeginUtime;
  for (int i = 0; i < 5; ++i) {
    RecordedRequest& request = session.requests.emplace_back();
    request.ids = {i % 2 == 0 ? "even" : "odd", i, 0};
    request.scene = i < 3 ? "office" : "maze";
    request.received_s = i;
    if (i < 4) request.answer.emplace().status = i == 1 ? "partial" : "ok";
  }
  return session;
}

std::vector<std::int64_t> selected(const Selection& selection) {
  Session session = five_requests();
  EXPECT_EQ(select(selection, session) + session.requests.size(), 5U);
  std::vector<std::int64_t> ids;
  for (const RecordedRequest& request : session.requests) ids.push_back(request.ids.request_id);
  return ids;
}

TEST(Selection, WantsWhatAllItsMembersWant) {
  EXPECT_THAT(selected({}), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_TRUE(Selection{}.is_all());
  EXPECT_THAT(selected({.clients = {"odd"}}), ElementsAre(1, 3));
  EXPECT_THAT(selected({.ids = {{1, 2}, {4, 4}}}), ElementsAre(1, 2, 4));
  EXPECT_THAT(selected({.statuses = {"partial", "none"}}), ElementsAre(1, 4));
  EXPECT_THAT(selected({.scenes = {"maze"}}), ElementsAre(3, 4));
  EXPECT_THAT(selected({.from = log_time_of("1"), .to = log_time_of("3")}), ElementsAre(1, 2, 3));
  EXPECT_THAT(selected({.from = log_time_of("2023-11-14T22:13:22Z")}), ElementsAre(2, 3, 4));
  EXPECT_THAT(selected({.clients = {"even"}, .scenes = {"maze"}}), ElementsAre(4));
  EXPECT_THAT(selected({.clients = {"nobody"}}), ElementsAre());
}

TEST(Selection, IsWrittenAsTheWordsThatSelectTheSame) {
  EXPECT_THAT(words_of({}, kBeginUtime), ElementsAre());
  const Selection whole{.from = log_time_of("-1.5"),
                        .to = log_time_of("2023-11-14T22:13:20.25Z"),
                        .clients = {"even", "odd"},
                        .ids = {{3, 3}, {-5, -2}},
                        .statuses = {"ok", "none"},
                        .scenes = {"maze"}};
  EXPECT_THAT(words_of(whole, kBeginUtime),
              ElementsAre("--from=-1.5", "--to=0.25", "--id=3..3,-5..-2", "--client=even,odd",
                          "--status=ok,none", "--scene-name=maze"));
  // A time of the clock that no short number is reads back as the same time.
  const Selection clock{.from = log_time_of("2023-11-14T22:13:21.123456Z")};
  const std::string word = words_of(clock, kBeginUtime).at(0).substr(std::string("--from=").size());
  EXPECT_EQ(log_time_of(word)->value_s, clock.from->value_s - 1.7e9);
  EXPECT_EQ(id_ranges_of("3..3,-5..-2"), whole.ids);
}

TEST(Selection, KnowsTheStatusesOfAnswers) {
  const std::vector<std::string> words = status_words();
  for (const char* word : {"none", "ok", "infeasible", "overloaded", "cancelled", "old_scene"}) {
    EXPECT_THAT(words, ::testing::Contains(word));
  }
  EXPECT_THAT(words, ::testing::Not(::testing::Contains("unknown status")));
}

}  // namespace
}  // namespace camway::tools
