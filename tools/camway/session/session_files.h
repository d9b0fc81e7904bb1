// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "tools/support/scratch_folder.h"

namespace camway::tools {

/// Returns the sentences in a folder about what was left out when it was packed, whatever their
/// file holds; none if there is no such file.
std::vector<std::string> left_out_in(const std::filesystem::path& folder);

/// The logs of a session that somebody named: a log, a folder of recordings, or a packed session.
class SessionFiles {
 public:
  /// Fails if there are none, with the reason. Unpacks a packed session into a temporary folder,
  /// which goes with the last copy.
  static base::Result<SessionFiles> open(const std::filesystem::path& session);
  /// Opens several sessions as one.
  static base::Result<SessionFiles> open(const std::vector<std::string>& sessions);

  /// The logs in the order in which they were begun.
  [[nodiscard]] const std::vector<std::filesystem::path>& logs() const { return logs_; }
  /// Sentences about what packs of these sessions left out (`kLeftOutName`).
  [[nodiscard]] const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  std::vector<std::filesystem::path> logs_;
  std::vector<std::string> left_out_;
  std::vector<std::shared_ptr<const ScratchFolder>> unpacked_;  ///< temporary folders of `logs_`
};

}  // namespace camway::tools
