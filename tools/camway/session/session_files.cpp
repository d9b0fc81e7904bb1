// SPDX-License-Identifier: MIT
#include "tools/camway/session/session_files.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "daemon/record/log_files.h"
#include "lcmtypes/wire/channels.h"
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

std::vector<std::string> left_out_in(const fs::path& folder) {
  /// Longest text to show; what is behind it stays in the file.
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  std::ifstream stream(folder / kLeftOutName, std::ios::binary);
  std::string text(kMostBytes, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  std::vector<std::string> sentences;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) sentences.push_back(wire::printable(line));
  }
  return sentences;
}

base::Result<SessionFiles> SessionFiles::open(const fs::path& session) {
  SessionFiles files;
  std::error_code error;
  fs::path folder = session;
  if (looks_like_pack(session)) {
    base::Result<ScratchFolder> unpacked = ScratchFolder::make("session");
    if (!unpacked) return base::Failure{std::move(unpacked.error)};
    folder = unpacked->path() / "session";
    if (std::string fault = unpack(session, folder); !fault.empty()) {
      return base::Failure{std::move(fault)};
    }
    files.unpacked_.push_back(std::make_shared<const ScratchFolder>(*std::move(unpacked)));
  } else if (!fs::is_directory(session, error)) {
    // The reader of logs reports the fault of a file.
    files.logs_.push_back(session);
    files.left_out_ = left_out_in(session.parent_path());
    return files;
  }
  files.logs_ = logs_in(folder);
  files.left_out_ = left_out_in(folder);
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
    all.left_out_.insert(all.left_out_.end(), files->left_out_.begin(), files->left_out_.end());
    all.unpacked_.insert(all.unpacked_.end(), files->unpacked_.begin(), files->unpacked_.end());
  }
  return all;
}

}  // namespace camway::tools
