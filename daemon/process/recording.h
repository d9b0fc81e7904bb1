// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include <camway/status_t.hpp>

#include "daemon/base/result.h"
#include "daemon/process/settings/daemon_options.h"
#include "daemon/record/recorder.h"
#include "daemon/service/log/log.h"

namespace camway::process {

/// Opens the recorder that the options ask for; null if they ask for none. Fails if its folder
/// cannot be used, with the reason.
base::Result<std::unique_ptr<record::Recorder>> open_recorder(
    const DaemonOptions& options, const std::shared_ptr<service::Log>& log);

/// Writes the members of `status` about the recording.
void add_recording(const DaemonOptions& options, const record::RecordCounts& counts,
                   status_t& status);

/// Returns the numbers of a recorder as metrics, as `metrics_text` does.
std::string record_metrics(const record::RecordCounts& counts);

}  // namespace camway::process
