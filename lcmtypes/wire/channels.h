// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Rules of the wire that sender and receiver share beside the message types.
namespace camway::wire {

/// Longest channel name that LCM can publish on: its LCM_MAX_CHANNEL_NAME_LENGTH.
inline constexpr std::size_t kMaxChannelLength = 63;
/// Longest client id. `<prefix>_OCCUPANCY_RESPONSE_<client_id>`, the longest channel name, then has
/// exactly `kMaxChannelLength` characters if the prefix has `kMaxPrefixLength`.
inline constexpr std::size_t kMaxClientIdLength = 32;
inline constexpr std::size_t kMaxPrefixLength = 11;
static_assert(kMaxPrefixLength + std::string_view("_OCCUPANCY_RESPONSE_").size() +
                  kMaxClientIdLength ==
              kMaxChannelLength);

/// Returns whether `text` matches [A-Za-z0-9_-]{1,max_length}. None of these characters is special
/// in the regular expressions that LCM takes as channel names.
constexpr bool is_plain_name(std::string_view text, std::size_t max_length) {
  if (text.empty() || text.size() > max_length) return false;
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool digit = c >= '0' && c <= '9';
    if (!letter && !digit && c != '_' && c != '-') return false;
  }
  return true;
}

constexpr bool is_client_id(std::string_view text) {
  return is_plain_name(text, kMaxClientIdLength);
}
constexpr bool is_prefix(std::string_view text) { return is_plain_name(text, kMaxPrefixLength); }

/// Returns `text` with each control character replaced by `?`. Control characters of a peer could
/// forge lines of a log or change a terminal's state.
inline std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return text;
}

/// The names of all channels. Requires `is_prefix(prefix)` and `is_client_id(client_id)`.
struct Channels {
  std::string prefix = "CAMWAY";

  [[nodiscard]] std::string plan_request() const { return prefix + "_PLAN_REQUEST"; }
  [[nodiscard]] std::string plan_response(std::string_view client_id) const {
    return (prefix + "_PLAN_RESPONSE_").append(client_id);
  }
  [[nodiscard]] std::string plan_offer(std::string_view client_id) const {
    return (prefix + "_PLAN_OFFER_").append(client_id);
  }
  [[nodiscard]] std::string plan_progress(std::string_view client_id) const {
    return (prefix + "_PLAN_PROGRESS_").append(client_id);
  }
  [[nodiscard]] std::string cancel() const { return prefix + "_CANCEL"; }
  [[nodiscard]] std::string cancel_occupancy() const { return prefix + "_CANCEL_OCCUPANCY"; }
  [[nodiscard]] std::string cancel_scene() const { return prefix + "_CANCEL_SCENE"; }
  [[nodiscard]] std::string missing_pages() const { return prefix + "_MISSING_PAGES"; }
  [[nodiscard]] std::string missing_pages(std::string_view client_id) const {
    return (prefix + "_MISSING_PAGES_").append(client_id);
  }
  [[nodiscard]] std::string occupancy_request() const { return prefix + "_OCCUPANCY_REQUEST"; }
  [[nodiscard]] std::string occupancy_response(std::string_view client_id) const {
    return (prefix + "_OCCUPANCY_RESPONSE_").append(client_id);
  }
  [[nodiscard]] std::string scene_request() const { return prefix + "_SCENE_REQUEST"; }
  [[nodiscard]] std::string scene_response(std::string_view client_id) const {
    return (prefix + "_SCENE_RESPONSE_").append(client_id);
  }
  [[nodiscard]] std::string upload() const { return prefix + "_UPLOAD"; }
  [[nodiscard]] std::string upload_status(std::string_view client_id) const {
    return (prefix + "_UPLOAD_STATUS_").append(client_id);
  }
  [[nodiscard]] std::string watch() const { return prefix + "_WATCH"; }
  [[nodiscard]] std::string watch_report(std::string_view client_id) const {
    return (prefix + "_WATCH_REPORT_").append(client_id);
  }
  [[nodiscard]] std::string missing_map_pages() const { return prefix + "_MISSING_MAP_PAGES"; }
  [[nodiscard]] std::string map_page(std::string_view client_id) const {
    return (prefix + "_MAP_PAGE_").append(client_id);
  }
  [[nodiscard]] std::string claim() const { return prefix + "_CLAIM"; }
  [[nodiscard]] std::string status() const { return prefix + "_STATUS"; }
  [[nodiscard]] std::string error() const { return prefix + "_ERROR"; }
};

}  // namespace camway::wire
