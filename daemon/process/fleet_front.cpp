// SPDX-License-Identifier: MIT
#include "daemon/process/fleet_front.h"

#include <cstdint>
#include <string>
#include <utility>

#include "daemon/version/build_info.h"

namespace camway::process {

std::unique_ptr<FleetFront> FleetFront::open_or_log(const DaemonOptions& options,
                                                    FleetMember& member,
                                                    const scene::SceneStore& scenes,
                                                    service::PlanAnswerer& here,
                                                    const std::shared_ptr<service::Log>& log) {
  std::unique_ptr<FleetFront> front(new FleetFront(member, options.service.workers));
  fleet::FrontOptions front_options;
  front_options.fleet = options.fleet.name;
  front_options.front_id = member.id();
  front_options.workers_here = options.service.workers;
  front_options.deadline = options.service.deadline;
  const scene::SharedLog& shared_log = member.shared_log();
  auto opened = fleet::RemoteAnswerer::open(
      {member.connection(), front->board_, scenes, here}, front_options,
      [&shared_log](const std::string& scene) {
        return static_cast<std::int64_t>(shared_log.position_of(scene));
      },
      log);
  if (!opened) {
    log->error("planners cannot be asked", {{"reason", opened.error}});
    return nullptr;
  }
  front->answerer_ = *std::move(opened);
  // In the place of what the member logs: a front knows its planners, too.
  member.connection().on_change([answerer = std::weak_ptr(front->answerer_)](bool is_connected) {
    if (const auto alive = answerer.lock()) alive->connection_changed(is_connected);
  });
  return front;
}

FleetFront::FleetFront(FleetMember& member, int workers)
    : member_(member), workers_(workers), board_(service::version_text()) {}

bool FleetFront::claim_id_or_log(const DaemonOptions& options, service::Log& log) {
  if (answerer_->claim_id()) return true;
  log.error("another front of the fleet has this id",
            {{"setting", options.where("fleet.id")},
             {"id", member_.id()},
             {"hint", "give each front an id of its own (fleet.id)"}});
  return false;
}

void FleetFront::feed(service::Service& service) {
  board_.on_change(
      [this, &service](int capacity) { service.allow(capacity > 0 ? capacity : workers_); });
}

void FleetFront::add_to(status_t& status) const {
  const scene::SharedLog& shared_log = member_.shared_log();
  answerer_->add_to(status, static_cast<std::int64_t>(shared_log.followed()),
                    shared_log.is_in_touch());
}

}  // namespace camway::process
