// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/record/event_log.h"

namespace camway::tools {

using record::LogEvent;
using record::LogSummary;
using record::read_event_log;

}  // namespace camway::tools
