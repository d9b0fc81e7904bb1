// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daemon/scene/log/scene_log.h"
#include "tests/scene/log/log_samples.h"
#include "tests/scene/log/memory_log.h"
#include "tests/support/random.h"

namespace camway::scene {

/// Makes the same random changes to a log and to its model.
class LogComparison {
 public:
  struct Options {
    std::uint64_t seed = 0;
    /// Opens the log anew, after the one before was closed.
    std::function<std::unique_ptr<SceneLog>()> open;
    /// The log summarises the newest revision only.
    bool summarises_newest_only = false;
  };

  explicit LogComparison(Options options) : options_(std::move(options)), random_(options_.seed) {
    for (int i = 0; i < 12; ++i) {
      std::vector<BlobId> needs;
      if (i > 2) needs.push_back(blobs_[static_cast<std::size_t>(random_.integer(0, i - 1))].id);
      // Some are larger than a page.
      blobs_.emplace_back(std::to_string(i) + std::string(i % 3 == 0 ? 9000 : 10, 'b'), needs);
    }
    reopen();
  }

  void reopen() {
    log_.reset();
    log_ = options_.open();
    ASSERT_NE(log_, nullptr);
  }

  void step() {
    const std::string scene(1, static_cast<char>('a' + random_.integer(0, 2)));
    const std::string text(static_cast<std::size_t>(random_.log_uniform(1, 6000)), 't');
    const int kind = random_.integer(0, 99);
    if (kind < 55) {
      const std::uint64_t before = revision_of(scene);
      const LogEntry entry = sample_entry(
          before, before + static_cast<std::uint64_t>(random_.integer(1, 3)), text, some_blobs());
      same([&](SceneLog& log) { return log.append(scene, entry).fault; });
    } else if (kind < 65) {
      const std::uint64_t revision =
          options_.summarises_newest_only ? model_.head(scene) : revision_of(scene);
      const auto needs = some_blobs();
      same([&](SceneLog& log) {
        return log.summarize(scene, revision, log_bytes(text), needs).fault;
      });
    } else if (kind < 68) {
      const std::uint64_t revision = revision_of(scene);
      same([&](SceneLog& log) { return log.remove(scene, revision).fault; });
    } else if (kind < 85) {
      const SampleBlob& sample = any_blob();
      same([&](SceneLog& log) { return log.put_blob(sample.id, sample.blob).fault; });
    } else if (kind < 90) {
      same([&](SceneLog& log) { return log.set_note(scene, text).fault; });
    } else if (kind < 95) {
      same([&](SceneLog& log) { return log.drop_unused_blobs().fault; });
    } else {
      reopen();
    }
  }

  void compare() {
    const auto scenes = log_->scenes();
    ASSERT_TRUE(scenes) << scenes.error;
    ASSERT_EQ(text_of_scenes(*scenes), text_of_scenes(*model_.scenes()));
    for (const SampleBlob& sample : blobs_) {
      const auto bytes = log_->blob(sample.id);
      ASSERT_EQ(bool(bytes), model_.has_blob(sample.id)) << bytes.error;
      ASSERT_EQ(log_->has_blob(sample.id), model_.has_blob(sample.id));
      ASSERT_TRUE(!bytes || *bytes == sample.blob.bytes);
    }
    for (const char* const key : {"a", "b", "c"}) ASSERT_EQ(log_->note(key), model_.note(key));
    ASSERT_EQ(log_->highest_removed(), model_.highest_removed());
  }

 private:
  template <typename Change>
  void same(const Change& change) {
    ASSERT_EQ(change(*log_), change(model_));
  }
  /// Returns the newest revision, or now and then a wrong one.
  std::uint64_t revision_of(const std::string& scene) {
    const std::uint64_t head = model_.head(scene);
    return random_.chance(0.1)
               ? head + 1 -
                     static_cast<std::uint64_t>(random_.integer(0, 1)) * 2 * (head > 0 ? 1 : 0)
               : head;
  }
  const SampleBlob& any_blob() { return blobs_[static_cast<std::size_t>(random_.integer(0, 11))]; }
  std::vector<BlobId> some_blobs() {
    std::vector<BlobId> ids;
    while (random_.chance(0.3)) {
      const BlobId& id = any_blob().id;
      // Most are there, so that most changes succeed.
      if (model_.has_blob(id) || random_.chance(0.1)) ids.push_back(id);
    }
    return ids;
  }

  Options options_;
  testing::Random random_;
  std::vector<SampleBlob> blobs_;
  std::unique_ptr<SceneLog> log_;
  testing::MemoryLog model_;
};

}  // namespace camway::scene
