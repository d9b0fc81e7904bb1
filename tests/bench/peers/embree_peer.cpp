// SPDX-License-Identifier: MIT
#include "tests/bench/peers/embree_peer.h"

#include <embree3/rtcore.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace camway::bench {

/// Bytes that the library has allocated.
struct EmbreeMemory {
  std::atomic<long> now = 0;
  std::atomic<long> peak = 0;
};

namespace {

// Four edges, two diagonals.
constexpr std::array<std::array<std::size_t, 2>, 6> kRays{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}}};

bool count_memory(void* context, ssize_t bytes, bool /*post*/) {
  EmbreeMemory& memory = *static_cast<EmbreeMemory*>(context);
  const long now = memory.now += bytes;
  long peak = memory.peak;
  while (now > peak && !memory.peak.compare_exchange_weak(peak, now)) {
  }
  return true;
}

void fail(void* /*context*/, RTCError code, const char* message) {
  std::fprintf(stderr, "bench: Embree error %d: %s\n", static_cast<int>(code), message);
  std::exit(1);
}

template <class Value>
Value* buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  return static_cast<Value*>(
      rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(Value), count));
}

}  // namespace

struct EmbreePeer::State {
  EmbreeMemory memory;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  motion::Corners corners_C;
};

EmbreePeer::EmbreePeer(const scene::Mesh& mesh, unsigned threads)
    : state_(std::make_unique<State>()) {
  const std::string config = threads == 0 ? "" : "threads=" + std::to_string(threads);
  state_->device = rtcNewDevice(config.c_str());
  rtcSetDeviceErrorFunction(state_->device, fail, nullptr);
  rtcSetDeviceMemoryMonitorFunction(state_->device, count_memory, &state_->memory);
  state_->scene = rtcNewScene(state_->device);
  rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  float* vertices =
      buffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices.size());
  for (const geometry::Vec3& vertex : mesh.vertices) {
    for (Eigen::Index k = 0; k < 3; ++k) *vertices++ = static_cast<float>(vertex[k]);
  }
  unsigned* indices =
      buffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) *indices++ = index;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(state_->scene, geometry);
  rtcReleaseGeometry(geometry);
}

EmbreePeer::~EmbreePeer() {
  rtcReleaseScene(state_->scene);
  rtcReleaseDevice(state_->device);
}

void EmbreePeer::build() { rtcCommitScene(state_->scene); }

std::size_t EmbreePeer::memory_bytes() const {
  return static_cast<std::size_t>(state_->memory.now.load());
}

std::size_t EmbreePeer::peak_memory_bytes() const {
  return static_cast<std::size_t>(state_->memory.peak.load());
}

void EmbreePeer::set_camera(const motion::Camera& camera) {
  state_->corners_C = motion::near_corners_C(camera);
}

bool EmbreePeer::collides_by_rays(const motion::Pose& pose) const {
  const motion::Corners corners = motion::corners_W(state_->corners_C, pose);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (const auto& [from, to] : kRays) {
    const Eigen::Vector3f origin = corners[from].cast<float>();
    const Eigen::Vector3f along = (corners[to] - corners[from]).cast<float>();
    RTCRay ray{};
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = along.x();
    ray.dir_y = along.y();
    ray.dir_z = along.z();
    ray.tfar = 1.0F;
    ray.mask = ~0U;
    rtcOccluded1(state_->scene, &context, &ray);
    if (ray.tfar < 0.0F) return true;
  }
  return false;
}

bool EmbreePeer::collides_by_packet(const motion::Pose& pose) const {
  const motion::Corners corners = motion::corners_W(state_->corners_C, pose);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  alignas(32) std::array<int, 8> valid{};
  alignas(32) RTCRay8 rays{};
  for (std::size_t i = 0; i < kRays.size(); ++i) {
    const Eigen::Vector3f origin = corners[kRays[i][0]].cast<float>();
    const Eigen::Vector3f along = (corners[kRays[i][1]] - corners[kRays[i][0]]).cast<float>();
    valid[i] = -1;
    rays.org_x[i] = origin.x();
    rays.org_y[i] = origin.y();
    rays.org_z[i] = origin.z();
    rays.dir_x[i] = along.x();
    rays.dir_y[i] = along.y();
    rays.dir_z[i] = along.z();
    rays.tfar[i] = 1.0F;
    rays.mask[i] = ~0U;
  }
  rtcOccluded8(valid.data(), state_->scene, &context, &rays);
  for (std::size_t i = 0; i < kRays.size(); ++i) {
    if (rays.tfar[i] < 0.0F) return true;
  }
  return false;
}

}  // namespace camway::bench
