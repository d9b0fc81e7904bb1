// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/camway/replay/session.h"

namespace camway::tools {

/// A time of a log: seconds after its first event, or a time of the clock.
struct LogTime {
  double value_s = 0.0;          ///< after the first event, or after 1970
  bool is_of_the_clock = false;  ///< whether it is a time of the clock
};

/// Reads "12.5" or "2026-11-27T08:30:00.250Z"; nothing for another text.
std::optional<LogTime> log_time_of(const std::string& text);

/// First and last id of a range.
using IdRange = std::pair<std::int64_t, std::int64_t>;

/// Reads "3,7..9"; nothing for another text.
std::optional<std::vector<IdRange>> id_ranges_of(const std::string& text);

/// The requests of a session that are wanted: those that all members that are set accept.
struct Selection {
  std::optional<LogTime> from = {}, to = {};  ///< both ends included
  std::vector<std::string> clients = {};      ///< empty: all
  std::vector<IdRange> ids = {};              ///< empty: all
  std::vector<std::string> statuses = {};  ///< recorded statuses, "none" for no answer; empty: all
  std::vector<std::string> scenes = {};    ///< names of scenes; empty: all

  [[nodiscard]] bool is_all() const;
  [[nodiscard]] bool wants(const RecordedRequest& request, std::int64_t begin_utime) const;
};

/// Returns the words of a command line that select the same from the same session, "--id=3,7..9",
/// which began at `begin_utime` (`Session`).
std::vector<std::string> words_of(const Selection& selection, std::int64_t begin_utime);

/// Whether `from` is after `to`, so that no request of a session with this beginning is wanted.
bool is_backwards(const Selection& selection, std::int64_t begin_utime);

/// The words that `Selection::statuses` may have.
std::vector<std::string> status_words();

/// Removes the requests that are not wanted. Returns their number.
std::size_t select(const Selection& selection, Session& session);

}  // namespace camway::tools
