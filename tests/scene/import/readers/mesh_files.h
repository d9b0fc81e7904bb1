// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/random.h"

/// Mesh files in every encoding that a format allows, made from a fixed seed, for tests and as the
/// corpus of the fuzzer.
namespace camway::scene::testing {

using camway::testing::Random;

inline constexpr std::uint64_t kMeshSeed = 20061127;

struct TriangleSoup {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The type of the coordinates, which a file can hold without rounding.
enum class Numbers { kDoubles, kFloats, kSmallIntegers };

/// Returns an integer in [0, below).
std::uint64_t below(Random& random, std::uint64_t below);

/// Returns triangles with coordinates of every magnitude, far from the origin, close together, and
/// with zeros of either sign.
TriangleSoup random_soup(Random& random, Numbers numbers);

/// Returns a text that reads back as the same double.
std::string decimal(double value);

enum class PlyEncoding { kText, kLittleEndian, kBigEndian };

std::string write_obj(const TriangleSoup& soup, Random& random);
std::string write_off(const TriangleSoup& soup, Random& random);
/// Returns a PLY file whose coordinates have the narrowest type that holds `numbers`, or a wider
/// one.
std::string write_ply(const TriangleSoup& soup, Numbers numbers, PlyEncoding encoding,
                      Random& random);
std::string write_text_stl(const TriangleSoup& soup, Random& random);
/// Returns a binary STL file, whose coordinates are rounded to floats.
std::string write_binary_stl(const TriangleSoup& soup);

}  // namespace camway::scene::testing
