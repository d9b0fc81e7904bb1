// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"
#include "tests/support/nats_server.h"

namespace camway::integration {

/// Tests with fleets of real processes.
class FleetTest : public IntegrationTest {
 protected:
  void TearDown() override;

  /// Starts the front with the office. `prefix`: other than that of a front before.
  void start_front(const std::string& prefix = "CAMWAY", const std::vector<std::string>& more = {});
  /// Starts a planner with one worker, by a command that replaces itself by it (`exec`), if any.
  Process& start_planner(const std::string& id, const std::string& server,
                         const std::vector<std::string>& wrapper = {});
  Process& start_planner(const std::string& id) { return start_planner(id, servers_); }
  void start_planners(int number);
  Process& planner(const std::string& id) { return *planners_.at(id); }
  Process& front(const std::string& prefix = "CAMWAY") { return *fronts_.at(prefix); }

  /// Waits until the front hears so many planners which have read all of the log.
  void await_planners(std::size_t number, const std::string& prefix = "CAMWAY");
  static ClientOptions of_prefix(const std::string& prefix);

  testing::NatsServer server_;
  std::string servers_ = server_.url();  ///< of the front and of planners
  std::string settings_;                 ///< more lines of `[fleet]` for all that are started

 private:
  std::map<std::string, std::unique_ptr<Process>> fronts_;
  std::map<std::string, std::unique_ptr<Process>> planners_;
  int started_ = 0;
};

/// Requests on the office that are free, corrected, and impossible.
inline const std::vector<std::string> kOfficeRequests = {
    "office-free-door", "office-graze-column", "office-graze-lamp", "office-wall-corridor",
    "office-impossible-safe"};

/// What an answer says, without times: equal for equal answers, bit for bit.
std::string bits_of(const PlanResponse& answer);

}  // namespace camway::integration
