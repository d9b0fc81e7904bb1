// SPDX-License-Identifier: MIT
#include "daemon/scene/log/removal_requests.h"

#include <algorithm>

namespace camway::scene {

std::string with_removal(std::string_view text, std::string_view request) {
  std::vector<std::string> requests = removals_in(text);
  if (!request.empty() && request.find('\n') == std::string_view::npos)
    requests.emplace_back(request);
  const std::size_t surplus = requests.size() - std::min(requests.size(), kRememberedRemovals);
  std::string next;
  for (std::size_t i = surplus; i < requests.size(); ++i) next += requests[i] + '\n';
  return next;
}

std::vector<std::string> removals_in(std::string_view text) {
  std::vector<std::string> requests;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (!line.empty()) requests.emplace_back(line);
  }
  return requests;
}

}  // namespace camway::scene
