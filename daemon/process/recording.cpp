// SPDX-License-Identifier: MIT
#include "daemon/process/recording.h"

#include <fmt/format.h>

#include <string_view>

#include "daemon/process/scene_origins.h"
#include "daemon/process/settings/daemon_settings.h"
#include "daemon/process/status_text.h"
#include "daemon/version/build_info.h"
#include "lcmtypes/wire/layout.h"

namespace camway::process {
namespace {

record::RecordFacts facts_of(const DaemonOptions& options) {
  record::RecordFacts facts;
  facts.version = service::version_text();
  for (const SettingChange& change : changes_between(default_options(), options)) {
    facts.settings.emplace(change.key, change.after);
  }
  for (const SceneArgument& scene : options.scenes) {
    facts.settings.emplace("scene." + scene.name, SceneOrigins::arguments_of(scene));
  }
  return facts;
}

std::string metric(std::string_view name, std::string_view type, std::string_view help,
                   std::uint64_t value) {
  return fmt::format("# HELP camway_{0} {1}\n# TYPE camway_{0} {2}\ncamway_{0} {3}\n", name, help,
                     type, value);
}

}  // namespace

base::Result<std::unique_ptr<record::Recorder>> open_recorder(
    const DaemonOptions& options, const std::shared_ptr<service::Log>& log) {
  if (options.record.folder.empty()) return std::unique_ptr<record::Recorder>();
  record::RecordOptions record;
  record.folder = options.record.folder;
  record.prefix = options.service.prefix;
  record.limits = options.record.limits;
  return record::Recorder::open(record, facts_of(options), log);
}

void add_recording(const DaemonOptions& options, const record::RecordCounts& counts,
                   status_t& status) {
  status.recording_folder = beginning_of(options.record.folder, wire::kMaxRecordingFolderBytes);
  status.recorded_bytes = static_cast<std::int64_t>(counts.bytes);
  status.not_recorded = static_cast<std::int64_t>(counts.dropped);
  status.recording_trouble = beginning_of(counts.trouble, wire::kMaxRecordingTroubleBytes);
}

std::string record_metrics(const record::RecordCounts& counts) {
  return metric("recorded_total", "counter", "Messages and changes of scenes that were recorded.",
                counts.recorded) +
         metric("recorded_bytes_total", "counter", "Bytes that were recorded.", counts.bytes) +
         metric("not_recorded_total", "counter",
                "Messages and changes of scenes that were left out of the recording.",
                counts.dropped) +
         metric("recording_failing", "gauge",
                "1 if the recording has left out messages or changes within the last half minute.",
                counts.trouble.empty() ? 0 : 1);
}

}  // namespace camway::process
