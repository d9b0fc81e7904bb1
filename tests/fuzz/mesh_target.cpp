// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "daemon/scene/import/surfaces/bezier_patches.h"
#include "daemon/scene/import/unigrafix/unigrafix_reader.h"
#include "tests/fuzz/exercise_mesh.h"
#include "tests/fuzz/targets.h"

namespace camway::testing {
namespace {

/// The first byte selects the format of the others.
constexpr std::array<std::string_view, 4> kMeshExtensions = {".obj", ".off", ".ply", ".stl"};

bool exercise_mesh_file(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return false;
  return exercise_mesh(kMeshExtensions[bytes[0] % kMeshExtensions.size()],
                       as_text(bytes.subspan(1)));
}

std::vector<FuzzBytes> mesh_seeds() {
  std::vector<FuzzBytes> all;
  for (const auto& files : {sound_mesh_files(), malformed_mesh_files()}) {
    for (const MeshFile& file : files) {
      const auto kind = std::ranges::find(kMeshExtensions, file.extension);
      FuzzBytes bytes{static_cast<std::uint8_t>(kind - kMeshExtensions.begin())};
      bytes.insert(bytes.end(), file.bytes.begin(), file.bytes.end());
      all.push_back(std::move(bytes));
    }
  }
  return all;
}

/// What a file may include, whatever name it gives.
constexpr std::string_view kIncluded = "def chip; v a 0 0 0; v b 1 0 0; v c 0 1 0; f (a b c); end;";
/// Vertices and faces of all instances, few so that arrays in arrays end soon.
constexpr std::uint64_t kMostOfInstances = 10'000;

bool exercise_unigrafix(std::span<const std::uint8_t> bytes) {
  namespace unigrafix = scene::unigrafix;
  const auto read = unigrafix::read_unigrafix(
      as_text(bytes),
      [](const std::string&, const std::string& name) -> base::Result<unigrafix::IncludedFile> {
        return unigrafix::IncludedFile{name, std::string(kIncluded)};
      },
      kMostOfInstances);
  promise(static_cast<bool>(read) == read.error.empty(), "a record or a reason");
  if (!read) return false;
  promise(read->header.absolute_rounding >= 0.0, "the rounding is a bound");
  std::uint64_t triangles = 0;
  for (const auto& object : read->objects) triangles += object.triangles;
  promise(triangles == read->triangles.size(), "objects cover all triangles");
  return true;
}

bool exercise_bezier(std::span<const std::uint8_t> bytes) {
  // A patch may be made as fine as its numbers ask for; a mutant must not take a second.
  constexpr std::uint64_t kMostTriangles = 20'000;
  const auto read = scene::surfaces::read_bezier_patches(as_text(bytes), kMostTriangles);
  promise(static_cast<bool>(read) == read.error.empty(), "a record or a reason");
  if (!read) return false;
  promise(read->header.surface_error >= 0.0, "the error is a bound");
  promise(read->triangles.size() <= kMostTriangles, "no more triangles than are allowed");
  return true;
}

std::vector<FuzzBytes> bezier_seeds() {
  std::string points = "\n16\n";
  std::string knob = "1";
  std::string patch = "1";
  for (int i = 0; i < 16; ++i) {
    points +=
        std::to_string(i % 4) + "," + std::to_string(i / 4) + ",0." + std::to_string(i) + "\n";
    if (i > 0) patch += "," + std::to_string(i + 1);
    if (i > 0) knob += i < 4 ? ",1" : " " + std::to_string(i + 1);
  }
  return {fuzz_bytes("1\n" + patch + points),
          fuzz_bytes("2\n" + patch + "\n" + knob + points),
          fuzz_bytes("1\n" + patch + "\n16\n0,0,nan\n"),
          fuzz_bytes("99999999999\n"),
          {}};
}

std::vector<FuzzBytes> unigrafix_seeds() {
  const std::string square = "v a 0 0 0;v b 9 0 0;v c 9 9 0;v d 0 9 0;";
  return {
      fuzz_bytes(square + "f x (a b c d) red;c red 1 2 3;c_rgb s 1 2 3;w(a b c);l 1;cam -og;"),
      fuzz_bytes(square + "v e 1 1 0;v f 2 1 0;v g 2 2 0;v h 5 5 0;v i 6 5 0;v j 6 6 0;"
                          "f (a b c d)(e f g)(h i j);"),
      fuzz_bytes("def d;" + square +
                 "f(a b c);def e;v a 1 1 1;f(a a a);end;i(e -tx 2);end;"
                 "a x(d -rx 30 -sv 1 2 3 4)7 -rv 0 1 0 5 -mz;i(d red);"),
      fuzz_bytes("include chip.ug; i (chip -M3 1 2 3 4 5 6 7 8 9);{ {} }( x ( y ) )\n# 3 \"a\"\n"
                 "i (chip -M4 1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1 -ta 1 2 3 -mv 1 0 0);"),
      fuzz_bytes("def d;v a 0 0 0;f(a a a);end;def e;a(d)999;end;a(e)999 -tx 1;"),
      fuzz_bytes("execute sh;"),
      fuzz_bytes("{"),
      {}};
}

}  // namespace

constinit const FuzzTarget kUnigrafixTarget{"unigrafix", exercise_unigrafix, unigrafix_seeds,
                                            40'000};
constinit const FuzzTarget kBezierTarget{"bezier", exercise_bezier, bezier_seeds, 2'000};
constinit const FuzzTarget kMeshTarget{"mesh", exercise_mesh_file, mesh_seeds, 40'000};

}  // namespace camway::testing
