// SPDX-License-Identifier: MIT
#include "daemon/scene/log/nats/scene_chain.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/random.h"

namespace camway::scene {
namespace {

using Kind = LogMessage::Kind;
using Repair = ChainRepair::Kind;

/// Makes messages that follow each other, with rising sequences.
class ChainMaker {
 public:
  LogMessage entry(std::uint64_t revision) { return next(Kind::kEntry, revision); }
  [[nodiscard]] bool has_scene() const { return revision_ > 0; }
  LogMessage summary() { return next(Kind::kSummary, revision_); }
  LogMessage removal() { return next(Kind::kRemoval, revision_); }
  /// An entry that follows the same message as the next one.
  LogMessage rival(std::uint64_t revision) const {
    ChainMaker copy = *this;
    return copy.entry(revision);
  }

 private:
  LogMessage next(Kind kind, std::uint64_t revision) {
    LogMessage message;
    message.kind = kind;
    message.id = new_message_id();
    message.after = all_.empty() ? MessageId{} : all_.back();
    message.before = kind == Kind::kEntry ? revision_ : 0;
    message.revision = revision;
    if (kind != Kind::kEntry) message.replaces = all_;
    all_.push_back(message.id);
    revision_ = kind == Kind::kRemoval ? 0 : revision;
    return message;
  }

  std::vector<MessageId> all_;
  std::uint64_t revision_ = 0;
};

SceneChain chain_of(const std::vector<LogMessage>& messages, std::uint64_t first = 1) {
  SceneChain chain;
  for (const LogMessage& message : messages) chain.take(message, first++);
  return chain;
}

std::string revisions_of(const SceneChain& chain) {
  std::string text;
  for (const ChainLink& link : chain.links()) {
    text += std::string(1, "esr"[static_cast<int>(link.message.kind)]) +
            std::to_string(link.message.revision) + " ";
  }
  return text + (chain.is_whole() ? "" : chain.fault());
}

std::vector<LogMessage> part(const std::vector<LogMessage>& all, std::size_t begin,
                             std::size_t end) {
  return {all.begin() + static_cast<std::ptrdiff_t>(begin),
          all.begin() + static_cast<std::ptrdiff_t>(end)};
}

TEST(SceneChain, BeginsAtTheLastSummaryOrRemoval) {
  ChainMaker maker;
  SceneChain chain = chain_of({maker.entry(2), maker.entry(5)});
  EXPECT_EQ(revisions_of(chain), "e2 e5 ");
  EXPECT_EQ(chain.newest_revision(), 5U);
  chain.take(maker.summary(), 3);
  chain.take(maker.entry(6), 4);
  EXPECT_EQ(revisions_of(chain), "s5 e6 ");
  chain.take(maker.removal(), 5);
  EXPECT_EQ(chain.newest_revision(), 0U);
  EXPECT_EQ(chain.removed(), 6U);
  chain.take(maker.entry(8), 6);
  EXPECT_EQ(revisions_of(chain), "r6 e8 ");
  EXPECT_EQ(chain.newest_revision(), 8U);
  EXPECT_EQ(chain.last_sequence(), 6U);
}

TEST(SceneChain, NoticesAChangeThatIsMissing) {
  ChainMaker maker;
  std::vector<LogMessage> all{maker.entry(1), maker.entry(2), maker.entry(3), maker.summary(),
                              maker.entry(4)};
  EXPECT_EQ(revisions_of(chain_of({all[0], all[2]})),
            "e1 e3 lost its changes after revision 1 until revision 2, before message 2");
  EXPECT_EQ(revisions_of(chain_of({all[1]})),
            "e2 lost its changes after revision 0 until revision 1, before message 1");
  // A purge that was undone in part.
  EXPECT_EQ(revisions_of(chain_of({all[1], all[3], all[4]})), "s3 e4 ");
  EXPECT_EQ(revisions_of(chain_of({all[3], all[4]})), "s3 e4 ");
}

TEST(SceneChain, TheFirstOfTwoThatFollowTheSameCounts) {
  ChainMaker maker;
  const LogMessage first = maker.entry(1);
  const LogMessage rival = maker.rival(2);
  const LogMessage rival_summary = [&] {
    ChainMaker copy = maker;
    return copy.summary();
  }();
  const LogMessage second = maker.entry(2);
  const LogMessage third = maker.entry(3);
  EXPECT_EQ(revisions_of(chain_of({first, second, rival, rival_summary, third})), "e1 e2 e3 ");
  const SceneChain other = chain_of({first, rival, second, third});
  EXPECT_FALSE(other.is_whole());
  EXPECT_EQ(other.links()[1].message.id, rival.id);
  const SceneChain with_rival = chain_of({first, second, rival});
  EXPECT_FALSE(with_rival.contains(rival.id));
  EXPECT_EQ(with_rival.last_sequence(), 3U) << "the next append expects it";
}

TEST(SceneChain, TheSameMessageTwiceIsThereOnce) {
  ChainMaker maker;
  const LogMessage first = maker.entry(1);
  const LogMessage second = maker.entry(2);
  const SceneChain chain = chain_of({first, second, first, second});
  EXPECT_EQ(revisions_of(chain), "e1 e2 ");
  EXPECT_EQ(chain.last_sequence(), 4U);
}

TEST(SceneChain, PassesOnInOrder) {
  ChainMaker maker;
  SceneChain chain = chain_of({maker.entry(1), maker.entry(2), maker.entry(3)});
  EXPECT_TRUE(chain.is_next(chain.links()[0]));
  EXPECT_FALSE(chain.is_next(chain.links()[1]));
  chain.links()[0].is_taken = true;
  EXPECT_TRUE(chain.is_next(chain.links()[1]));
  EXPECT_FALSE(chain.is_next(chain.links()[2]));
  chain.take(maker.summary(), 4);
  EXPECT_TRUE(chain.is_next(chain.links()[0]));
}

TEST(ChainRepair, AppendsWhatIsMissing) {
  testing::Random random(77);
  for (int i = 0; i < 300; ++i) {
    ChainMaker maker;
    std::vector<LogMessage> all;
    for (std::uint64_t revision = 1; revision < 30; ++revision) {
      const double kind = maker.has_scene() ? random.uniform(0, 1) : 1;
      all.push_back(kind < 0.1    ? maker.summary()
                    : kind < 0.15 ? maker.removal()
                                  : maker.entry(revision));
    }
    const std::size_t size = all.size();
    const SceneChain known = chain_of(all);
    const auto kept = static_cast<std::size_t>(random.integer(0, static_cast<int>(size)));
    SceneChain found = chain_of(part(all, 0, kept));
    const ChainRepair repair = repair_of(known, found);
    ASSERT_EQ(repair.kind, kept == size ? Repair::kNone : Repair::kAppend) << i << " " << kept;
    if (repair.kind == Repair::kNone) continue;
    for (std::size_t k = repair.first; k < known.links().size(); ++k) {
      const LogMessage& message = known.links()[k].message;
      ASSERT_NE(found.fit_of(message), ChainFit::kVoid);
      found.take(message, found.last_sequence() + 1);
    }
    EXPECT_EQ(revisions_of(found), revisions_of(known));
    EXPECT_EQ(repair_of(known, found).kind, Repair::kNone);
  }
}

TEST(ChainRepair, LeavesWhatIsNewer) {
  ChainMaker maker;
  const std::vector<LogMessage> all{maker.entry(1), maker.entry(2), maker.summary(),
                                    maker.entry(3)};
  EXPECT_EQ(repair_of(chain_of(part(all, 0, 2)), chain_of(all)).kind, Repair::kNone);
  EXPECT_EQ(repair_of({}, chain_of(all)).kind, Repair::kNone);
  EXPECT_EQ(repair_of(chain_of(all), chain_of(all)).kind, Repair::kNone);
}

TEST(ChainRepair, GivesUpWhereAnotherChangeWasMade) {
  ChainMaker maker;
  const LogMessage first = maker.entry(1);
  const LogMessage rival = maker.rival(2);
  const LogMessage second = maker.entry(2);
  EXPECT_EQ(repair_of(chain_of({first, second}), chain_of({first, rival})).kind, Repair::kDiverged);
  EXPECT_EQ(repair_of(chain_of({first, second}), chain_of({rival})).kind, Repair::kRewrite);
}

TEST(ChainRepair, WritesAgainWhatIsDamaged) {
  ChainMaker maker;
  const std::vector<LogMessage> all{maker.entry(1), maker.entry(2), maker.entry(3)};
  EXPECT_EQ(repair_of(chain_of(all), chain_of({all[0], all[2]})).kind, Repair::kRewrite);
  EXPECT_EQ(repair_of(chain_of(all), {}).kind, Repair::kAppend);
}

}  // namespace
}  // namespace camway::scene
