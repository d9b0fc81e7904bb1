// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "tools/camway/replay/session.h"

namespace camway::tools {

/// Returns a table (RFC 4180) with a line for each request of a session, in the order in which they
/// came: times, scene, status, and the answer's facts on path, proof and effort. Numbers have
/// their unit in the name of the column. Columns of a request without an answer are empty.
std::string session_csv(const Session& session);

/// Returns a summary for people: the span of the log, requests by status, client and scene, and
/// the events that could not be read.
std::string session_summary(const Session& session);

}  // namespace camway::tools
