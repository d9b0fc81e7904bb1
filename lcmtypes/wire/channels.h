// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// What sender and receiver of the wire types share beside the types themselves.
namespace camway::wire {

/// LCM_MAX_CHANNEL_NAME_LENGTH: a longer name cannot be published on.
inline constexpr std::size_t kMaxChannelLength = 63;
/// Longest client id. With the longest prefix and the longest channel name between them,
/// `<prefix>_OCCUPANCY_RESPONSE_<client_id>`, this just fits `kMaxChannelLength`.
inline constexpr std::size_t kMaxClientIdLength = 32;
inline constexpr std::size_t kMaxPrefixLength = 11;
static_assert(kMaxPrefixLength + std::string_view("_OCCUPANCY_RESPONSE_").size() +
                  kMaxClientIdLength ==
              kMaxChannelLength);

/// Whether `text` is of [A-Za-z0-9_-]{1,max_length}. None of these characters means anything in the
/// regular expressions that LCM takes for channel names.
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

/// `text` of a peer without control characters, which could forge lines of a log or change what a
/// terminal shows.
inline std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return text;
}

/// Names of all channels. Preconditions: `is_prefix(prefix)`, `is_client_id(client_id)`.
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
