// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/bezier_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/mesh_collector.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/import/surfaces/nurbs_surface.h"

namespace camway::scene::surfaces {
namespace {

using import_record::Record;
using mesh_readers::MeshCollector;

constexpr std::size_t kSide = 4;  ///< control points along an edge
constexpr std::size_t kPatchPoints = kSide * kSide;

/// The least bytes that a line of `numbers` numbers takes: a digit and what follows it.
constexpr std::size_t least_bytes(std::size_t numbers) { return 2 * numbers; }

/// A point on a grid is a convex combination by two rounds of de Casteljau's algorithm, each of
/// three steps of three operations: 18 roundoffs, and the division by the weight 1 has none.
constexpr double kGridRoundoffs = 18.0;

/// The lines of a text that are not empty, as numbers between commas and blanks.
class NumberLines {
 public:
  explicit NumberLines(std::string_view text) : rest_(text), size_(text.size()) {}

  /// Takes the next line that is not empty. Returns false at the end of the text.
  bool next() {
    while (!rest_.empty()) {
      line_ = std::string(mesh_readers::take_line(rest_));
      ++number_;
      std::ranges::replace(line_, ',', ' ');
      words_.clear();
      std::string_view left = line_;
      for (std::string_view word = mesh_readers::take_token(left); !word.empty();
           word = mesh_readers::take_token(left)) {
        words_.push_back(word);
      }
      if (!words_.empty()) return true;
    }
    ++number_;
    words_.clear();
    return false;
  }
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size() + 1; }
  [[nodiscard]] base::Failure fault(const std::string& what) const {
    return {"line " + std::to_string(number_) + ": " + what};
  }
  [[nodiscard]] std::string size_text() const { return std::to_string(size_) + " bytes"; }

 private:
  std::string_view rest_;
  std::size_t size_;
  std::size_t number_ = 0;
  std::string line_;
  std::vector<std::string_view> words_;
};

struct PatchFile {
  std::vector<std::array<std::size_t, kPatchPoints>> patches;  ///< indices from 0
  std::vector<Point> points;
};

/// Fails with the line.
class PatchParser {
 public:
  explicit PatchParser(std::string_view text) : lines_(text) {}

  base::Result<PatchFile> parse() {
    base::Result<std::size_t> patches = read_count("patches", kPatchPoints);
    if (!patches) return base::Failure{std::move(patches.error)};
    for (std::size_t i = 0; i < *patches; ++i) {
      if (std::string fault = read_patch(i); !fault.empty()) return base::Failure{fault};
    }
    base::Result<std::size_t> points = read_count("points", 3);
    if (!points) return base::Failure{std::move(points.error)};
    for (std::size_t i = 0; i < *points; ++i) {
      if (std::string fault = read_point(i); !fault.empty()) return base::Failure{fault};
    }
    if (lines_.next()) {
      return lines_.fault("the file goes on after the " + std::to_string(*points) +
                          " points that it says it has");
    }
    if (std::string fault = check_indices(); !fault.empty()) return base::Failure{fault};
    return std::move(file_);
  }

 private:
  base::Result<std::size_t> read_count(const std::string& of, std::size_t numbers) {
    if (!lines_.next()) return lines_.fault("the file ends before its number of " + of);
    const std::optional<std::int64_t> count = mesh_readers::parse_integer(lines_.words()[0]);
    if (lines_.words().size() != 1 || !count || *count < 1) {
      return lines_.fault("the number of " + of + " was expected");
    }
    if (static_cast<std::uint64_t>(*count) > lines_.bytes_left() / least_bytes(numbers)) {
      return lines_.fault("says it has " + std::to_string(*count) + " " + of + ", in " +
                          lines_.size_text());
    }
    return static_cast<std::size_t>(*count);
  }

  /// Takes a line of `numbers` numbers. Returns the fault, or nothing.
  std::string take(std::size_t i, const std::string& of, std::size_t numbers) {
    if (!lines_.next()) return lines_.fault("the file ends after " + std::to_string(i) + of).error;
    if (lines_.words().size() == numbers) return {};
    return lines_
        .fault("has " + std::to_string(lines_.words().size()) + " numbers, not " +
               std::to_string(numbers))
        .error;
  }

  std::string read_patch(std::size_t i) {
    if (std::string fault = take(i, " patches", kPatchPoints); !fault.empty()) return fault;
    std::array<std::size_t, kPatchPoints>& patch = file_.patches.emplace_back();
    for (std::size_t k = 0; k < kPatchPoints; ++k) {
      const std::string_view word = lines_.words()[k];
      const std::optional<std::int64_t> index = mesh_readers::parse_integer(word);
      if (!index || *index < 1) {
        return lines_.fault("'" + std::string(word) + "' is no index of a point: these begin at 1")
            .error;
      }
      const auto number = static_cast<std::size_t>(*index);
      if (number > largest_) {
        largest_ = number;
        fault_of_largest_ = lines_.fault("there is no point " + std::to_string(number)).error;
      }
      patch[k] = number - 1;
    }
    return {};
  }

  std::string read_point(std::size_t i) {
    if (std::string fault = take(i, " points", 3); !fault.empty()) return fault;
    Point& point = file_.points.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string_view word = lines_.words()[k];
      point[k] = mesh_readers::parse_decimal(word);
      if (!(std::abs(point[k]) < geometry::kLargestCoordinate_m)) {
        return lines_.fault("'" + std::string(word) + "' is no usable coordinate").error;
      }
    }
    return {};
  }

  /// Points follow the patches, so how many there are is known last.
  [[nodiscard]] std::string check_indices() const {
    return largest_ > file_.points.size() ? fault_of_largest_ : "";
  }

  NumberLines lines_;
  PatchFile file_;
  std::size_t largest_ = 0;  ///< index from 1
  std::string fault_of_largest_;
};

using Edge = std::array<Point, kSide>;

bool is_one_point(const Edge& edge) { return std::ranges::count(edge, edge[0]) == kSide; }

/// Control points of the edges: where v is 0 and 1, then where u is 0 and 1.
std::array<Edge, 4> edges_of(const NurbsSurface& patch) {
  std::array<Edge, 4> edges;
  const auto at = [&](std::size_t u, std::size_t v) {
    const WeightedPoint& point = patch.points[v * kSide + u];
    return Point{point[0], point[1], point[2]};
  };
  for (std::size_t k = 0; k < kSide; ++k) {
    edges[0][k] = at(k, 0);
    edges[1][k] = at(k, kSide - 1);
    edges[2][k] = at(0, k);
    edges[3][k] = at(kSide - 1, k);
  }
  return edges;
}

/// Chooses the grids of all patches so that edges in common are divided alike: the directions of
/// patches are joined in sets (a patch's u is 2 i, its v 2 i + 1), and each set takes its finest
/// division.
class CommonGrids {
 public:
  explicit CommonGrids(const std::vector<NurbsSurface>& patches) : parent_(2 * patches.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    std::map<Edge, std::size_t> owner;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const std::array<Edge, 4> edges = edges_of(patches[i]);
      for (std::size_t k = 0; k < edges.size(); ++k) {
        if (is_one_point(edges[k])) continue;
        const std::size_t slot = 2 * i + (k < 2 ? 0 : 1);
        Edge reversed = edges[k];
        std::ranges::reverse(reversed);
        const auto found = owner.try_emplace(std::min(edges[k], reversed), slot).first;
        parent_[root(slot)] = root(found->second);
      }
    }
    divisions_.assign(parent_.size(), 1);
  }

  void raise(std::size_t patch, const GridSize& size) {
    for (const auto& [slot, count] : {std::pair(2 * patch, size.u), {2 * patch + 1, size.v}}) {
      std::size_t& divisions = divisions_[root(slot)];
      divisions = std::max(divisions, count);
    }
  }
  [[nodiscard]] GridSize of(std::size_t patch) {
    return {divisions_[root(2 * patch)], divisions_[root(2 * patch + 1)]};
  }

 private:
  std::size_t root(std::size_t slot) {
    while (parent_[slot] != slot) slot = parent_[slot] = parent_[parent_[slot]];
    return slot;
  }

  std::vector<std::size_t> parent_;
  std::vector<std::size_t> divisions_;
};

NurbsSurface surface_of(const std::array<std::size_t, kPatchPoints>& indices,
                        const std::vector<Point>& points) {
  NurbsSurface surface{kSide, kSide, {0, 0, 0, 0, 1, 1, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}, {}};
  for (const std::size_t index : indices) {
    const Point& p = points[index];
    surface.points.push_back({p[0], p[1], p[2], 1.0});
  }
  return surface;
}

/// Half the diagonal of the control points that patches use, which is what the radius is for a
/// sphere, and their largest coordinate.
struct Extent {
  double size = 0.0;
  double largest = 0.0;
};

Extent extent_of(const std::vector<NurbsSurface>& patches) {
  Point low;
  Point high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  Extent extent;
  for (const NurbsSurface& patch : patches) {
    for (const WeightedPoint& point : patch.points) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], point[k]);
        high[k] = std::max(high[k], point[k]);
        extent.largest = std::max(extent.largest, std::abs(point[k]));
      }
    }
  }
  extent.size = 0.5 * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  return extent;
}

/// Sets the points of edges that are one point to it: rounding takes them apart.
void close_edges(const NurbsSurface& patch, FacetedGrid& grid) {
  const std::size_t columns = grid.size.u + 1;
  const std::size_t rows = grid.size.v + 1;
  const std::array<Edge, 4> edges = edges_of(patch);
  const auto set = [&](const Edge& edge, std::size_t first, std::size_t step, std::size_t count) {
    if (!is_one_point(edge)) return;
    for (std::size_t i = 0; i < count; ++i) grid.facets.points[first + i * step] = edge[0];
  };
  set(edges[0], 0, 1, columns);
  set(edges[1], (rows - 1) * columns, 1, columns);
  set(edges[2], 0, columns, rows);
  set(edges[3], columns - 1, columns, rows);
}

/// Adds patches to a mesh, in which equal points are one vertex.
class PatchMesh {
 public:
  void add(const FacetedSurface& facets, const std::string& name) {
    mesh_.begin_object(name);
    numbers_.clear();
    for (const Point& point : facets.points) numbers_.push_back(vertex(point));
    for (const auto& facet : facets.triangles) {
      std::array<std::uint32_t, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = numbers_[facet[k]];
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) {
        mesh_.add_polygon(corners);
      }
    }
  }
  MeshCollector& mesh() { return mesh_; }

 private:
  std::uint32_t vertex(Point point) {
    for (double& x : point) x += 0.0;  // -0 becomes 0
    const auto [found, is_new] = vertices_.try_emplace(point, 0);
    if (is_new) found->second = mesh_.add_vertex(point);
    return found->second;
  }

  MeshCollector mesh_;
  std::map<Point, std::uint32_t> vertices_;
  std::vector<std::uint32_t> numbers_;
};

base::Failure too_many(std::uint64_t most) {
  return {"its patches come to more than " + std::to_string(most) + " triangles"};
}

/// Chooses grids whose facets are within `tolerance`. Fails if they have too many triangles.
base::Result<std::vector<GridSize>> grids_of(const std::vector<NurbsSurface>& patches,
                                             double tolerance, std::uint64_t most) {
  CommonGrids grids(patches);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const base::Result<FacetedGrid> grid = grid_of(patches[i], tolerance);
    if (!grid) return base::Failure{"patch " + std::to_string(i + 1) + " " + grid.error};
    grids.raise(i, grid->size);
  }
  std::vector<GridSize> sizes;
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    sizes.push_back(grids.of(i));
    triangles += 2 * static_cast<std::uint64_t>(sizes[i].u) * sizes[i].v;
    if (triangles > most) return too_many(most);
  }
  return sizes;
}

}  // namespace

bool is_bezier_extension(std::string_view extension) {
  return mesh_readers::equals_ignoring_case(extension, ".bpt");
}

base::Result<Record> read_bezier_patches(std::string_view text, std::uint64_t most) {
  const base::Result<PatchFile> file = PatchParser(text).parse();
  if (!file) return base::Failure{file.error};
  std::vector<NurbsSurface> patches;
  for (const auto& indices : file->patches) patches.push_back(surface_of(indices, file->points));
  const Extent extent = extent_of(patches);
  const double tolerance = kRelativeTolerance * extent.size;
  const base::Result<std::vector<GridSize>> sizes = grids_of(patches, tolerance, most);
  if (!sizes) return base::Failure{sizes.error};
  PatchMesh mesh;
  double error = 0.0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    base::Result<FacetedGrid> grid =
        grid_of(patches[i], std::numeric_limits<double>::infinity(), (*sizes)[i]);
    if (!grid) return base::Failure{grid.error};
    close_edges(patches[i], *grid);
    mesh.add(grid->facets, "patch_" + std::to_string(i + 1));
    error = std::max(error, grid->facets.error);
  }
  if (mesh.mesh().triangle_count() == 0) return base::Failure{"its patches have no area"};
  Record record = mesh.mesh().finish("Bezier patches", geometry::kUnitRoundoff);
  record.header.absolute_rounding = kGridRoundoffs * geometry::kUnitRoundoff * extent.largest;
  record.header.surface_error = error;
  record.notes = "Bezier patches state no unit and no axes: see --scale and --up\n" +
                 std::to_string(patches.size()) + " smooth patches were made flat\n";
  return record;
}

}  // namespace camway::scene::surfaces
