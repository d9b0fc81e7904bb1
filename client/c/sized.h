// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "client/c/refusal.h"

/// Structs that may get members at their end. A program may be older than the library, and its
/// structs shorter; or newer, and its structs longer.
namespace camway::c {

/// Size of a struct in ABI 1.0; never changes. No program has a shorter one.
template <class T>
inline constexpr std::size_t kFirstSize = 0;
template <>
inline constexpr std::size_t kFirstSize<camway_client_options> = 72;
template <>
inline constexpr std::size_t kFirstSize<camway_daemon_status> = 104;
template <>
inline constexpr std::size_t kFirstSize<camway_body> = 112;
template <>
inline constexpr std::size_t kFirstSize<camway_plan_request> = 304;
template <>
inline constexpr std::size_t kFirstSize<camway_answer_summary> = 88;
template <>
inline constexpr std::size_t kFirstSize<camway_plan_handlers> = 32;
template <>
inline constexpr std::size_t kFirstSize<camway_progress> = 40;
template <>
inline constexpr std::size_t kFirstSize<camway_scene_info> = 96;
template <>
inline constexpr std::size_t kFirstSize<camway_object_info> = 144;
template <>
inline constexpr std::size_t kFirstSize<camway_mesh_file> = 56;
template <>
inline constexpr std::size_t kFirstSize<camway_watch_event> = 56;
template <>
inline constexpr std::size_t kFirstSize<camway_path_measures> = 88;
template <>
inline constexpr std::size_t kFirstSize<camway_scene_revision> = 56;
template <>
inline constexpr std::size_t kFirstSize<camway_scan_map> = 56;
template <>
inline constexpr std::size_t kFirstSize<camway_infeasibility> = 112;
template <>
inline constexpr std::size_t kFirstSize<camway_plan_timing> = 48;

template <class T>
void require_size(std::size_t size) {
  static_assert(kFirstSize<T> >= sizeof(std::uint32_t) && kFirstSize<T> <= sizeof(T));
  static_assert(std::is_trivially_copyable_v<T> && offsetof(T, struct_size) == 0);
  if (size >= kFirstSize<T> && size <= UINT32_MAX) return;
  throw Refusal{CAMWAY_BAD_ARGUMENT, "struct_size: is " + std::to_string(size) + ", and not " +
                                         std::to_string(sizeof(T)) +
                                         "; initialise the struct by its _init function"};
}

/// Writes `value` into a struct of `size` bytes of the caller, as far as that goes, and zeros
/// behind it. `struct_size` tells how many bytes were set.
template <class T>
void write_sized(T value, T* target, std::size_t size) {
  require(target, "the struct");
  require_size<T>(size);
  const std::size_t known = std::min(size, sizeof(T));
  value.struct_size = static_cast<std::uint32_t>(known);
  std::memset(target, 0, size);
  std::memcpy(target, &value, known);
}

/// Initialises a struct of `size` bytes of the caller: members that this library does not know are
/// 0, which stands for their default.
template <class T>
void init_sized(const T& defaults, T* target, std::size_t size) {
  write_sized(defaults, target, size);
  target->struct_size = static_cast<std::uint32_t>(size);
}

/// Returns the struct of a caller. Members that it does not have are as in `defaults`. Throws if it
/// has members that this library does not know, and sets them.
template <class T>
T read_sized(const T* given, const T& defaults, const char* name) {
  require(given, name);
  const std::size_t size = given->struct_size;
  require_size<T>(size);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(given);
  for (std::size_t i = sizeof(T); i < size; ++i) {
    if (bytes[i] == 0) continue;
    throw Refusal{CAMWAY_BAD_ARGUMENT, std::string(name) +
                                           ": sets a member that this library does not know; it is "
                                           "older than the headers"};
  }
  T value = defaults;
  std::memcpy(&value, given, std::min(size, sizeof(T)));
  return value;
}

}  // namespace camway::c
