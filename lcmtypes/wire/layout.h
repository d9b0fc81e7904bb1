// SPDX-License-Identifier: MIT
#pragma once

#include <camway/max_bytes.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace camway {
class cancel_t;
class claim_t;
class envelope_t;
class error_t;
class fleet_answer_t;
class fleet_job_t;
class map_page_t;
class missing_pages_t;
class occupancy_request_t;
class occupancy_response_t;
class plan_progress_t;
class plan_request_t;
class plan_response_t;
class planner_status_t;
class scene_request_t;
class scene_response_t;
class status_t;
class upload_page_t;
class upload_status_t;
class watch_report_t;
class watch_t;
}  // namespace camway

namespace camway::wire {

/// Largest size that Camway sends over LCM, fingerprint included. Larger messages get lost more
/// often over UDP, because one lost datagram loses the whole message. The size also limits the
/// count of every list.
inline constexpr std::size_t kMaxEnvelopeBytes = 60'000;
/// Largest size of a message without an envelope. Every message fits an envelope, signed or not.
inline constexpr std::size_t kMaxMessageBytes = 59'900;

/// Largest size of a message between a front and its planners, which travels over NATS.
inline constexpr std::size_t kMaxFleetBytes = std::size_t{512} << 10;
/// Largest number of parts of a job, or of its answer.
inline constexpr std::int32_t kMaxFleetParts = 65'536;

/// Limits of strings from the .lcm files, in bytes without the final NUL.
inline constexpr std::size_t kMaxSceneNameBytes = max_bytes::plan_request_scene;
inline constexpr std::size_t kMaxMethodBytes = max_bytes::plan_request_method;
inline constexpr std::size_t kMaxObjectNameBytes = max_bytes::scene_object_name;
inline constexpr std::size_t kMaxFeatureBytes = max_bytes::collision_interval_witness_feature;
inline constexpr std::size_t kMaxTextBytes = max_bytes::plan_response_message;
inline constexpr std::size_t kMaxDigestBytes = max_bytes::plan_response_scene_digest;
inline constexpr std::size_t kMaxVersionBytes = max_bytes::status_version;
inline constexpr std::size_t kMaxReloadFaultBytes = max_bytes::status_failed_reload;
inline constexpr std::size_t kMaxRecordingFolderBytes = max_bytes::status_recording_folder;
inline constexpr std::size_t kMaxRecordingTroubleBytes = max_bytes::status_recording_trouble;
inline constexpr std::size_t kMaxHostBytes = max_bytes::claim_host;
static_assert(max_bytes::planner_status_host == kMaxHostBytes &&
              max_bytes::planner_status_version == kMaxVersionBytes);
inline constexpr std::size_t kMaxFileNameBytes = max_bytes::scene_request_file;
inline constexpr std::size_t kMaxFormatBytes = max_bytes::scene_request_upload_format;
inline constexpr std::size_t kMaxKindBytes = max_bytes::scene_object_kind;
inline constexpr std::size_t kMaxOperationBytes = max_bytes::scene_change_operation;

inline constexpr std::size_t kMaxPutNameBytes = 64;  ///< name of an object that is put into a scene
/// Size of every page of an upload except the last.
inline constexpr std::size_t kUploadPageBytes = 48'000;
/// Largest number of missing pages that an `upload_status_t` lists.
inline constexpr std::size_t kMaxMissingPages = 4096;
/// Size of every page of an exported map except the last.
inline constexpr std::size_t kMapPageBytes = 48'000;

/// Limits of a body: points of all convex pieces, vertices and triangles of a mesh.
inline constexpr std::size_t kMaxBodyPoints = 512;
inline constexpr std::size_t kMaxBodyVertices = 100'000;
inline constexpr std::size_t kMaxBodyTriangles = 100'000;

/// Largest numbers of pages of a request and of an answer.
inline constexpr std::int32_t kMaxRequestPages = 256;
inline constexpr std::int32_t kMaxResponsePages = 1024;

/// A field of a message, in the order of the .lcm file. LCM encodes big-endian without padding.
struct Field {
  enum class Kind {
    kFixed,   ///< numbers and arrays of constant size, `bytes` together
    kString,  ///< an int32 length, final NUL included, then that many bytes
    kList,    ///< an int32 count, then that many elements, of `bytes` each or laid out as `element`
  };
  Kind kind;
  std::string_view name;
  std::size_t bytes = 0;             ///< kFixed: total size; kList: size of an element
  std::size_t max_length = 0;        ///< kString: largest length without the final NUL
  std::span<const Field> element{};  ///< kList: fields of an element whose size is not constant
};

/// The layout of a message type on the wire, after the fingerprint.
struct Layout {
  std::string_view type;
  std::int64_t fingerprint;
  std::span<const Field> fields;
  std::size_t max_bytes = kMaxMessageBytes;
};

/// Returns the layout of a message type. Defined for the types that have a channel or a subject, in
/// a source that `generate_layout.py` writes from the .lcm files. Thread-safe.
template <class Message>
Layout layout_of();
template <>
Layout layout_of<plan_request_t>();
template <>
Layout layout_of<plan_response_t>();
template <>
Layout layout_of<cancel_t>();
template <>
Layout layout_of<claim_t>();
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
template <>
Layout layout_of<fleet_job_t>();
template <>
Layout layout_of<fleet_answer_t>();
template <>
Layout layout_of<planner_status_t>();

}  // namespace camway::wire
