// SPDX-License-Identifier: MIT
#include "daemon/process/settings/daemon_options.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace camway::process {

std::string url_of_environment() {
  const char* const url = std::getenv("LCM_DEFAULT_URL");
  return url == nullptr ? "" : url;
}

std::string DaemonOptions::where(std::string_view key) const {
  const auto said = set_at.find(key);
  return said == set_at.end() ? std::string(key) : said->second;
}

std::vector<std::string> servers_of(std::string_view list) {
  std::vector<std::string> servers;
  while (!list.empty()) {
    std::string_view one = list.substr(0, list.find(','));
    list.remove_prefix(std::min(list.size(), one.size() + 1));
    while (one.starts_with(' ')) one.remove_prefix(1);
    while (one.ends_with(' ')) one.remove_suffix(1);
    if (!one.empty()) servers.emplace_back(one);
  }
  return servers;
}

std::optional<scene::SceneCache> scene_cache(const DaemonOptions& options) {
  std::filesystem::path folder = options.cache_folder;
  if (folder.empty()) folder = scene::cache_folder_of_environment();
  if (folder.empty() || options.cache_bytes == 0) return std::nullopt;
  return scene::SceneCache(std::move(folder), {.bytes = options.cache_bytes});
}

DaemonOptions default_options() {
  DaemonOptions options;
  options.lcm_url = url_of_environment();
  if (options.lcm_url.empty()) {
    options.lcm_url = kDefaultLcmUrl;
  } else {
    options.set_at["lcm.url"] = "LCM_DEFAULT_URL";
  }
  options.service.workers = 0;
  return options;
}

}  // namespace camway::process
