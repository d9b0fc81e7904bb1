// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/log/scene_log.h"

namespace camway::record {

/// A log that holds the contents of objects only: the changes of scenes are among the messages of a
/// recording. Whoever derives from it may write.
class BlobLog : public scene::SceneLog {
 public:
  scene::AppendResult put_blob(const scene::BlobId&, const scene::Blob&) override {
    return unwritable();
  }
  scene::AppendResult append(std::string_view, const scene::LogEntry&) override {
    return unwritable();
  }
  scene::AppendResult remove(std::string_view, std::uint64_t, std::string_view) override {
    return unwritable();
  }
  scene::AppendResult summarize(std::string_view, std::uint64_t, const scene::Bytes&,
                                const std::vector<scene::BlobId>&) final {
    return {};
  }
  std::uint64_t highest_removed() final { return 0; }
  std::vector<std::string> removals() final { return {}; }
  base::Result<std::vector<scene::LoggedScene>> scenes() final {
    return std::vector<scene::LoggedScene>();
  }
  std::string note(std::string_view) final { return {}; }
  scene::AppendResult set_note(std::string_view, std::string_view) final { return unwritable(); }
  base::Result<std::map<std::string, std::string>> notes(std::string_view) final {
    return std::map<std::string, std::string>();
  }
  scene::AppendResult drop_unused_blobs() final { return {}; }

 private:
  static scene::AppendResult unwritable() {
    return {scene::AppendFault::kBroken, "this log is for reading"};
  }
};

}  // namespace camway::record
