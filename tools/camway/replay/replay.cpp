// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>

#include "daemon/base/named_enum.h"
#include "daemon/cli_support/flag_checks.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/replay/replay_flags.h"
#include "tools/camway/replay/selection_flags.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

/// Sends the wanted requests to a daemon.
ExitCode publish_wanted(const ReplayFlags& flags,
                        const std::shared_ptr<const wire::MessageKeys>& keys) {
  PublishOptions options = flags.publishing;
  if (!flags.selection.is_all()) {
    const std::optional<OpenedSession> opened = open_session(flags.log, flags, keys.get());
    if (!opened) return ExitCode::kInvalidInput;
    options.wanted.emplace();
    for (const RecordedRequest& request : opened->session.requests) {
      options.wanted->emplace(request.ids.client_id, request.ids.request_id);
    }
  }
  return publish_log(flags.log, options, keys);
}

ExitCode run_replay(const ReplayFlags& flags) {
  if (!wire::is_prefix(flags.publishing.prefix)) {
    return invalid_replay("--prefix " + flags.publishing.prefix +
                          ": must be 1 to 11 letters, digits, '-' or '_'");
  }
  const bool compares_logs = !flags.baseline.empty();
  if (flags.log.empty() && !compares_logs) return invalid_replay("LOG is required");
  if (!flags.log.empty() && compares_logs) {
    return invalid_replay(flags.log + ": --baseline and --against name the logs");
  }
  const bool has_scenes = !flags.sources.scenes.empty() || !flags.sources.roots.empty();
  if (compares_logs && has_scenes && flags.reports.html.empty()) {
    return invalid_replay(
        "--scene and --root: with --baseline nothing is planned; only pictures of --html use them");
  }
  wire::MessageKeys::ReadResult read;
  if (!flags.key_file.empty()) read = wire::MessageKeys::from_file(flags.key_file);
  if (!read.error.empty()) return invalid_replay("--key-file " + read.error);
  if (flags.publish) return publish_wanted(flags, read.keys);
  if (compares_logs) return compare_logs(flags, read.keys.get());
  if (!flags.baseline_build.empty()) return compare_builds(flags, read.keys.get());
  return flags.step ? replay_by_steps(flags, read.keys.get())
                    : replay_offline(flags, read.keys.get());
}

void add_threshold_flags(CLI::App& command, ReplayFlags& flags) {
  Thresholds& thresholds = flags.run.thresholds;
  CLI::Option* const tolerance =
      command
          .add_option("--tolerance-m", thresholds.tolerance_m,
                      "Count paths that stay this many metres from each other as the same; 0: only "
                      "the same bits")
          ->check(cli_support::at_least_0())
          ->capture_default_str();
  const auto set_shift = [&thresholds](double shift_deg) {
    thresholds.tolerance_shift_rad = radians(shift_deg);
  };
  command
      .add_option_function<double>("--tolerance-shift-deg", set_shift,
                                   "With --tolerance-m: only if their pictures shift by no more "
                                   "than this many degrees, too")
      ->check(cli_support::at_least_0())
      ->needs(tolerance);
  command
      .add_option("--most-clearance-loss-m", thresholds.clearance_loss_m,
                  "A proved clearance smaller by more than this is a regression")
      ->check(cli_support::at_least_0());
  const auto at_least_1 =
      cli_support::number_in({"1 or more", [](double value) { return value >= 1.0; }});
  command
      .add_option("--longer-than", thresholds.longer,
                  "A path longer than this multiple of the earlier one is a regression")
      ->check(at_least_1);
  command
      .add_option("--slower-than", thresholds.slower,
                  "Planning that takes longer than this multiple of the earlier time, and 20 ms, "
                  "is a regression; times of a busy machine say little")
      ->check(at_least_1);
}

void add_failing_flag(CLI::App& command, Failing& failing) {
  const auto set = [&failing](const std::vector<std::string>& words) {
    failing.clear();
    for (const std::string& word : words) {
      if (const auto verdict = base::value_of<Verdict>(word)) failing.push_back(*verdict);
    }
  };
  std::vector<std::string> words{"nothing"};
  for (const std::string_view name : names_of(Verdict{})) words.emplace_back(name);
  command
      .add_option_function<std::vector<std::string>>(
          "--fail-on", set,
          "Verdicts for which the command ends with 3 [worse,different,regressed]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("VERDICTS")
      ->check(cli_support::one_of(words));
}

void add_report_flags(CLI::App& command, ReplayFlags& flags) {
  command.add_option("--json", flags.reports.json, "Write the comparison as JSON")
      ->type_name("FILE");
  CLI::Option* const html =
      command
          .add_option("--html", flags.reports.html,
                      "Write the comparison as a page that is one file: table, plots, requests in "
                      "3D, floor plans")
          ->type_name("FILE");
  PageOptions& page = flags.reports.page;
  cli_support::add_choice(
      command, "--views", page.reviewed, base::named_values<Reviewed>(),
      "With --html: requests to show in 3D with both paths: none, differing, or all [differing]")
      ->needs(html);
  command
      .add_option("--pictures", page.pictures,
                  "With --html: largest number of requests that differ to draw as floor plans")
      ->check(cli_support::whole_number(0, 1000))
      ->needs(html)
      ->capture_default_str();
  command
      .add_option_function<std::size_t>(
          "--most-mb", [&page](std::size_t megabytes) { page.most_bytes = megabytes * kMegabyte; },
          "With --html: megabytes of that page, beyond which further requests are not shown in 3D, "
          "and then not drawn [16]")
      ->check(cli_support::whole_number(1, 1000))
      ->needs(html);
  command
      .add_flag("--no-timing", flags.no_timing,
                "Leave times out of reports and responses, so that two runs compare byte by byte")
      ->excludes(command.get_option("--slower-than"));
}

void add_offline_flags(CLI::App& command, ReplayFlags& flags) {
  add_scene_source_flags(command, flags.sources);
  command
      .add_option(
          "--threads", flags.run.threads,
          "Number of requests that are planned at the same time; the output does not depend on it")
      ->check(cli_support::whole_number(1, 256))
      ->capture_default_str();
  command
      .add_option("--least-deadline-s", flags.run.least_deadline_s,
                  "Lengthen shorter deadlines to this, so that a slow machine gives the same "
                  "answers")
      ->check(cli_support::at_least_0());
  command
      .add_option("--responses", flags.responses_dir,
                  "Write the response to each request into this folder")
      ->type_name("DIR");
}

/// The other ways to use a log, of which one call takes one.
void add_mode_flags(CLI::App& command, ReplayFlags& flags) {
  CLI::Option* const against =
      command.add_option("--against", flags.against, "With --baseline: log with the later answers")
          ->type_name("LOG");
  CLI::Option* const baseline =
      command
          .add_option("--baseline", flags.baseline,
                      "Compare the answers of this log with those of another, without planning")
          ->type_name("LOG")
          ->needs(against);
  against->needs(baseline);
  // Nothing is planned.
  for (const char* planning : {"--threads", "--least-deadline-s", "--responses"}) {
    baseline->excludes(command.get_option(planning));
  }
  CLI::Option* const build =
      command
          .add_option("--baseline-build", flags.baseline_build,
                      "Compare with the answers of this other camway instead of the recorded ones")
          ->type_name("CAMWAY")
          ->excludes(baseline);
  command
      .add_flag("--step", flags.step,
                "Show one request after the other, and ask after each; needs a terminal")
      ->excludes(baseline)
      ->excludes(build);
}

void add_publish_flags(CLI::App& command, ReplayFlags& flags) {
  CLI::Option* publish = command.add_flag(
      "--publish", flags.publish,
      "Send the recorded requests and changes of scenes to a running daemon instead of planning "
      "them here");
  // The options of planning here and of its reports.
  for (const char* other :
       {"--baseline", "--baseline-build", "--step", "--scene", "--root", "--threads",
        "--least-deadline-s", "--responses", "--tolerance-m", "--most-clearance-loss-m",
        "--longer-than", "--slower-than", "--fail-on", "--json", "--html", "--no-timing"}) {
    publish->excludes(command.get_option(other));
  }
  CLI::Option* const speed =
      command
          .add_option("--speed", flags.publishing.speed,
                      "With --publish: multiple of the recorded speed; 0: as fast as possible")
          ->check(cli_support::at_least_0())
          ->needs(publish)
          ->capture_default_str();
  command
      .add_flag("--lockstep", flags.publishing.lockstep,
                "With --publish: send each message when the request before is answered")
      ->needs(publish)
      ->excludes(speed);
  command
      .add_option("--times", flags.publishing.times,
                  "With --publish: send all this often, each time with new ids, so that the daemon "
                  "plans again")
      ->check(cli_support::whole_number(1, 1'000'000))
      ->needs(publish)
      ->capture_default_str();
  command
      .add_option("--wait-s", flags.publishing.wait_s,
                  "With --publish: seconds to wait for answers after the last message, and after "
                  "each change of a scene; with --lockstep after each request")
      ->check(cli_support::between(0.0, 1e6))
      ->needs(publish)
      ->capture_default_str();
  command
      .add_option("--url", flags.publishing.url, "With --publish: LCM network [LCM_DEFAULT_URL]")
      ->needs(publish);
}

}  // namespace

void add_replay_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<ReplayFlags>();
  CLI::App* command = app.add_subcommand(
      "replay", "Plan the requests of a recorded session again and compare with the answers");
  command->add_option("LOG", flags->log,
                      "Log of lcm-logger, folder of a daemon's recordings, or packed session");
  command->add_option("--prefix", flags->publishing.prefix, "Prefix of the daemon's channels")
      ->capture_default_str();
  command
      ->add_option("--key-file", flags->key_file,
                   "Use only messages that were signed with a key of this file; with --publish, "
                   "sign them anew")
      ->type_name("FILE");
  add_offline_flags(*command, *flags);
  add_selection_flags(*command, flags->selection);
  add_threshold_flags(*command, *flags);
  add_failing_flag(*command, flags->failing);
  add_report_flags(*command, *flags);
  add_mode_flags(*command, *flags);
  add_publish_flags(*command, *flags);
  command->footer(
      exit_code_help("an answer has a verdict of --fail-on (with --publish: a request was not "
                     "answered, or a change not made)") +
      " With --publish also 4: no daemon was heard."
      "\nA damaged log is replayed up to the damage and ends with 2, unless an answer has a "
      "verdict "
      "of --fail-on."
      "\nExample: camway replay session.lcmlog --scene office=scenes/office.obj --threads 4");
  command->callback([flags, &exit_code] { exit_code = run_replay(*flags); });
}

}  // namespace camway::tools
