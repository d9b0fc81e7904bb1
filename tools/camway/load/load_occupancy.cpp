// SPDX-License-Identifier: MIT
#include "tools/camway/load/load_occupancy.h"

#include <camway/client.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <random>
#include <thread>

#include "tools/camway/occupancy/occupancy_queries.h"

namespace camway::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kKinds = 6;
/// Number of different batches: so many that no processor cache holds all the data that they use.
constexpr std::uint64_t kBatches = 8;

/// Makes queries in the box, with lengths up to a fifth of its size.
class RandomBatches {
 public:
  RandomBatches(const geometry::Box& bounds_W, std::uint64_t seed)
      : bounds_W_(bounds_W), length_m_(0.2 * bounds_W.sizes().maxCoeff()), random_(seed) {}

  OccupancyBatch batch(const std::string& scene, std::size_t queries) {
    OccupancyBatch batch;
    batch.scene = scene;
    for (std::size_t i = 0; i < queries; ++i) {
      const auto at = point();
      const auto other = beside(at);
      switch (i % kKinds) {
        case 0:
          batch.points_m.push_back(at);
          break;
        case 1:
          batch.boxes.push_back(box(at, other));
          break;
        case 2:
          batch.spheres.push_back({at, 0.1 * share() * length_m_});
          break;
        case 3:
          batch.rays.push_back(
              {at, {other[0] - at[0], other[1] - at[1], other[2] - at[2]}, length_m_});
          break;
        case 4:
          batch.distances.push_back({at, length_m_});
          break;
        default:
          batch.sphere_paths.push_back({at, other, 0.02 * share() * length_m_});
      }
    }
    return batch;
  }

 private:
  double share() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  std::array<double, 3> point() {
    std::array<double, 3> at{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      at[k] = bounds_W_.min()[axis] + share() * bounds_W_.sizes()[axis];
    }
    return at;
  }

  std::array<double, 3> beside(std::array<double, 3> at) {
    for (double& coordinate : at) coordinate += (2.0 * share() - 1.0) * length_m_;
    return at;
  }

  static OccupancyBox box(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    OccupancyBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.min_m[k] = std::min(a[k], a[k] + 0.1 * (b[k] - a[k]));
      box.max_m[k] = std::max(a[k], a[k] + 0.1 * (b[k] - a[k]));
    }
    return box;
  }

  geometry::Box bounds_W_;
  double length_m_;
  std::mt19937_64 random_;
};

bool same(const OccupancyAnswer& a, const OccupancyAnswer& b) {
  return a.points_occupied == b.points_occupied && a.boxes_occupied == b.boxes_occupied &&
         a.spheres_occupied == b.spheres_occupied && a.rays_hit_m == b.rays_hit_m &&
         a.distances_m == b.distances_m && a.sphere_paths_hit_m == b.sphere_paths_hit_m;
}

/// A batch and the answer of the local map.
struct Asked {
  OccupancyBatch batch;
  OccupancyAnswer expected;
};

void ask(Client& client, const std::vector<Asked>& batches, std::size_t first,
         Clock::time_point until, OccupancyLoad& load) {
  for (std::size_t turn = first; Clock::now() < until; ++turn) {
    const Asked& asked = batches[turn % batches.size()];
    const Clock::time_point begun = Clock::now();
    const OccupancyAnswer answer = client.occupancy(asked.batch);
    const std::chrono::duration<float, std::milli> taken = Clock::now() - begun;
    ++load.batches;
    if (!answer.ok()) {
      ++load.lost;
      if (load.error.empty()) load.error = answer.error;
    } else if (!same(answer, asked.expected)) {
      ++load.wrong;
    } else {
      load.queries +=
          static_cast<std::int64_t>(answer.points_occupied.size() + answer.boxes_occupied.size() +
                                    answer.spheres_occupied.size() + answer.rays_hit_m.size() +
                                    answer.distances_m.size() + answer.sphere_paths_hit_m.size());
      load.latency_ms.push_back(taken.count());
    }
  }
}

void add(const OccupancyLoad& part, OccupancyLoad& sum) {
  sum.batches += part.batches;
  sum.queries += part.queries;
  sum.wrong += part.wrong;
  sum.lost += part.lost;
  sum.latency_ms.insert(sum.latency_ms.end(), part.latency_ms.begin(), part.latency_ms.end());
  if (sum.error.empty()) sum.error = part.error;
}

}  // namespace

OccupancyLoad run_occupancy_load(const scene::SceneMirror& map, const geometry::Box& bounds_W,
                                 const LoadScene& scene, std::size_t queries,
                                 const LoadOptions& options) {
  OccupancyLoad load;
  std::vector<Asked> batches;
  for (std::uint64_t seed = 1; seed <= kBatches; ++seed) {
    OccupancyBatch batch = RandomBatches(bounds_W, seed).batch(scene.name, queries);
    OccupancyAnswer expected = answer_offline(map, batch);
    batches.push_back({std::move(batch), std::move(expected)});
  }
  const base::Result<Clients> made = make_clients(options);
  if (!made) {
    load.error = made.error;
    return load;
  }
  const Clients& clients = *made;
  if (LoadFault fault = fault_of_daemon(*clients.front(), scene); fault.status != Status::kOk) {
    load.error = std::move(fault.error);
    load.status = fault.status;
    return load;
  }
  std::vector<OccupancyLoad> parts(clients.size());
  const Clock::time_point start = Clock::now();
  const Clock::time_point until = start + std::chrono::duration_cast<Clock::duration>(
                                              std::chrono::duration<double>(options.seconds));
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < clients.size(); ++i) {
      threads.emplace_back([&, i] { ask(*clients[i], batches, i, until, parts[i]); });
    }
  }
  load.elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
  for (const OccupancyLoad& part : parts) add(part, load);
  return load;
}

}  // namespace camway::tools
