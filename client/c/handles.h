// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/client.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>
#include <utility>

#include "client/c/refusal.h"

namespace camway::c {

class EventQueue;
class PendingCall;

/// The object that a handle of the C interface stands for.
template <class Handle>
struct ObjectOf;
template <>
struct ObjectOf<camway_client> {
  using Type = Client;
};
template <>
struct ObjectOf<camway_answer> {
  using Type = const PlanResponse;
};
template <>
struct ObjectOf<camway_pending> {
  using Type = PendingCall;
};
template <>
struct ObjectOf<camway_event_queue> {
  using Type = EventQueue;
};
template <>
struct ObjectOf<camway_scene_answer> {
  using Type = const SceneAnswer;
};

/// The live handles of this process. A handle is a number that is never given twice, in the form of
/// a pointer, so one that was freed is recognised, and so is one of another kind. A call holds the
/// object that it found, so freeing its handle meanwhile is harmless.
///
/// Thread-safe.
class Handles {
 public:
  /// The table is never destroyed: at the end of a process threads of clients may still use it.
  static Handles& all();

  template <class Handle>
  Handle* add(std::shared_ptr<typename ObjectOf<Handle>::Type> object) {
    // Multiples of the largest alignment, as languages expect of addresses.
    const std::uintptr_t number = 16 * next_.fetch_add(1);
    const std::unique_lock lock(mutex_);
    live_.emplace(number, Entry{kind_of<Handle>(), erased(std::move(object))});
    return reinterpret_cast<Handle*>(number);
  }

  /// Returns the object of a handle. Throws `Refusal` if the handle is not live.
  template <class Handle>
  std::shared_ptr<typename ObjectOf<Handle>::Type> find(const Handle* handle) const {
    const std::shared_lock lock(mutex_);
    const auto position = live_.find(reinterpret_cast<std::uintptr_t>(handle));
    if (position == live_.end() || position->second.kind != kind_of<Handle>()) refuse(handle);
    return std::static_pointer_cast<typename ObjectOf<Handle>::Type>(position->second.object);
  }

  /// Frees a handle and returns its object, nothing for NULL. Throws `Refusal` if it is not live.
  template <class Handle>
  std::shared_ptr<typename ObjectOf<Handle>::Type> take(const Handle* handle) {
    if (handle == nullptr) return nullptr;
    const std::unique_lock lock(mutex_);
    const auto position = live_.find(reinterpret_cast<std::uintptr_t>(handle));
    if (position == live_.end() || position->second.kind != kind_of<Handle>()) refuse(handle);
    auto object =
        std::static_pointer_cast<typename ObjectOf<Handle>::Type>(position->second.object);
    live_.erase(position);
    return object;
  }

  std::int64_t count() const;

 private:
  struct Entry {
    const void* kind;
    std::shared_ptr<void> object;
  };

  template <class Handle>
  static const void* kind_of() {
    static const char kind = 0;
    return &kind;
  }
  static std::shared_ptr<void> erased(std::shared_ptr<const void> object) {
    return std::const_pointer_cast<void>(object);
  }
  [[noreturn]] static void refuse(const void* handle);

  std::atomic<std::uintptr_t> next_ = 1;
  mutable std::shared_mutex mutex_;
  std::unordered_map<std::uintptr_t, Entry> live_;
};

/// A handle for the time of a handler's run.
template <class Handle>
class ScopedHandle {
 public:
  explicit ScopedHandle(std::shared_ptr<typename ObjectOf<Handle>::Type> object)
      : handle_(Handles::all().add<Handle>(std::move(object))) {}
  ~ScopedHandle() {
    try {
      Handles::all().take(handle_);
    } catch (const Refusal&) {
      // The handler freed it.
    }
  }
  ScopedHandle(const ScopedHandle&) = delete;
  ScopedHandle& operator=(const ScopedHandle&) = delete;

  Handle* get() const { return handle_; }

 private:
  Handle* handle_;
};

}  // namespace camway::c
