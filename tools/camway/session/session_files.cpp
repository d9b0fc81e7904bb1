// SPDX-License-Identifier: MIT
#include "tools/camway/session/session_files.h"

#include <stdlib.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "daemon/record/log_files.h"
#include "tools/camway/session/session_pack.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> logs_in(const fs::path& folder) {
  std::vector<fs::path> logs;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == record::kLogEnding && entry.is_regular_file(error)) {
      logs.push_back(entry.path());
    }
  }
  std::ranges::sort(logs);
  return logs;
}

}  // namespace

/// A temporary folder with an unpacked session, removed at the end.
class SessionFiles::Unpacked {
 public:
  /// Returns an error, empty on success.
  std::string unpack_from(const fs::path& pack) {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "camway-session-XXXXXX").string();
    if (error || mkdtemp(name.data()) == nullptr) return name + ": cannot be made";
    folder_ = name;
    return unpack(pack, sessions());
  }
  Unpacked() = default;
  ~Unpacked() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  [[nodiscard]] fs::path sessions() const { return folder_ / "session"; }

 private:
  fs::path folder_;
};

base::Result<SessionFiles> SessionFiles::open(const fs::path& session) {
  SessionFiles files;
  std::error_code error;
  fs::path folder = session;
  if (looks_like_pack(session)) {
    const auto unpacked = std::make_shared<Unpacked>();
    if (std::string fault = unpacked->unpack_from(session); !fault.empty()) {
      return base::Failure{std::move(fault)};
    }
    folder = unpacked->sessions();
    files.unpacked_.push_back(unpacked);
  } else if (!fs::is_directory(session, error)) {
    // The reader of logs says what is wrong with a file.
    files.logs_.push_back(session);
    return files;
  }
  files.logs_ = logs_in(folder);
  if (files.logs_.empty()) {
    return base::Failure{session.string() + ": holds no file *" + record::kLogEnding};
  }
  return files;
}

base::Result<SessionFiles> SessionFiles::open(const std::vector<std::string>& sessions) {
  SessionFiles all;
  for (const std::string& session : sessions) {
    base::Result<SessionFiles> files = open(fs::path(session));
    if (!files) return files;
    all.logs_.insert(all.logs_.end(), files->logs_.begin(), files->logs_.end());
    all.unpacked_.insert(all.unpacked_.end(), files->unpacked_.begin(), files->unpacked_.end());
  }
  return all;
}

}  // namespace camway::tools
