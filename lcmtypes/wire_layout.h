// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace camway {
class cancel_t;
class envelope_t;
class error_t;
class map_page_t;
class missing_pages_t;
class occupancy_request_t;
class occupancy_response_t;
class plan_progress_t;
class plan_request_t;
class plan_response_t;
class scene_request_t;
class scene_response_t;
class status_t;
class upload_page_t;
class upload_status_t;
class watch_report_t;
class watch_t;
}  // namespace camway

namespace camway::wire {

/// Nothing of ours that LCM carries is longer, fingerprint included: UDP loses large messages,
/// since one lost datagram loses all of them. So the count of every list is limited as well.
inline constexpr std::size_t kMaxEnvelopeBytes = 60'000;
/// A message, so that it fits an envelope whether it gets one or not.
inline constexpr std::size_t kMaxMessageBytes = 59'900;

/// Limits of strings, in bytes without the final NUL.
inline constexpr std::size_t kMaxSceneNameBytes = 128;
inline constexpr std::size_t kMaxMethodBytes = 64;
inline constexpr std::size_t kMaxObjectNameBytes = 128;
inline constexpr std::size_t kMaxFeatureBytes = 32;
inline constexpr std::size_t kMaxTextBytes = 1024;
inline constexpr std::size_t kMaxDigestBytes = 128;
inline constexpr std::size_t kMaxVersionBytes = 256;
inline constexpr std::size_t kMaxReloadFaultBytes = 1000;

/// Limits of requests about scenes.
inline constexpr std::size_t kMaxPutNameBytes = 64;  ///< of an object that is put into a scene
inline constexpr std::size_t kMaxFileNameBytes = 512;
inline constexpr std::size_t kMaxFormatBytes = 8;
inline constexpr std::size_t kMaxKindBytes = 32;
inline constexpr std::size_t kMaxOperationBytes = 32;
/// Every page of an upload has so many bytes but the last.
inline constexpr std::size_t kUploadPageBytes = 48'000;
inline constexpr std::size_t kMaxMissingPages = 4096;
/// Likewise of an exported map.
inline constexpr std::size_t kMapPageBytes = 48'000;

/// Limits of a body, so that it fits page 0 of a request.
inline constexpr std::size_t kMaxBodyPoints = 512;
inline constexpr std::size_t kMaxBodyTriangles = 1024;

/// Limits of what arrives in pages.
inline constexpr std::int32_t kMaxRequestPages = 128;
inline constexpr std::int32_t kMaxResponsePages = 1024;

/// One thing that stands in a message, in the order of the .lcm file. LCM encodes without padding,
/// big-endian.
struct Field {
  enum class Kind {
    kFixed,   ///< numbers and arrays of constant size: `bytes` in all
    kString,  ///< int32 length with the final NUL, then so many bytes
    kList,    ///< int32 count, then so many elements: of `bytes` each, or as `element` says
  };
  Kind kind;
  std::string_view name;
  std::size_t bytes = 0;             ///< kFixed, kList
  std::size_t max_length = 0;        ///< kString: without the final NUL
  std::span<const Field> element{};  ///< kList of elements that are not all of one size
};

/// How a type is laid out on the wire behind its fingerprint.
struct Layout {
  std::string_view type;
  std::int64_t fingerprint;
  std::span<const Field> fields;
  std::size_t max_bytes = kMaxMessageBytes;
};

/// The layout of a message type; defined for the types that have a channel. Safe from any thread.
template <class Message>
Layout layout_of();
template <>
Layout layout_of<plan_request_t>();
template <>
Layout layout_of<plan_response_t>();
template <>
Layout layout_of<cancel_t>();
template <>
Layout layout_of<plan_progress_t>();
template <>
Layout layout_of<missing_pages_t>();
template <>
Layout layout_of<map_page_t>();
template <>
Layout layout_of<occupancy_request_t>();
template <>
Layout layout_of<occupancy_response_t>();
template <>
Layout layout_of<scene_request_t>();
template <>
Layout layout_of<scene_response_t>();
template <>
Layout layout_of<upload_page_t>();
template <>
Layout layout_of<upload_status_t>();
template <>
Layout layout_of<watch_t>();
template <>
Layout layout_of<watch_report_t>();
template <>
Layout layout_of<status_t>();
template <>
Layout layout_of<error_t>();
template <>
Layout layout_of<envelope_t>();

}  // namespace camway::wire
