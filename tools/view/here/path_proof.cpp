// SPDX-License-Identifier: MIT
#include "tools/view/here/path_proof.h"

#include <utility>

#include "daemon/base/deadline.h"
#include "tools/answers/check_input.h"

namespace camway::view {

Answer proof_of(const CheckOrder& order, std::shared_ptr<const scene::Snapshot> snapshot,
                const std::stop_token& by_client, const std::stop_token& by_end) {
  base::Result<tools::CheckInput> input =
      tools::check_input(order.request, order.path, {"request", "path"});
  if (!input) return failure(code::kInvalid, input.error);
  input->snapshot = std::move(snapshot);
  std::stop_source stop;
  const std::stop_callback for_client(by_client, [&] { stop.request_stop(); });
  const std::stop_callback for_end(by_end, [&] { stop.request_stop(); });
  const base::Deadline deadline =
      base::Deadline::after_s(order.request.options.deadline_s)
          .watched(stop.get_token(), std::make_shared<base::Progress>());
  const tools::PathSearch found = tools::search_path(*input, deadline);
  if (stop.stop_requested()) return failure(code::kCancelled, "the check was cancelled");
  nlohmann::ordered_json json = tools::check_json(*input, found);
  json["warnings"] = tools::check_warnings(*input, found);
  return {
      code::kOk, json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace), {}};
}

}  // namespace camway::view
