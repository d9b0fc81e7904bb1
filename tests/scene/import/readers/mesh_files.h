// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

/// Meshes written by hand in every way that a format allows, with a fixed seed, for tests and as
/// what the fuzzer starts from.
namespace camway::scene::testing {

using Random = std::mt19937_64;
inline constexpr std::uint64_t kMeshSeed = 20061127;

struct TriangleSoup {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Which numbers coordinates are, so that a file can hold them to the bit.
enum class Numbers { kDoubles, kFloats, kSmallIntegers };

/// An integer of [0, below).
std::uint64_t below(Random& random, std::uint64_t below);

/// Coordinates of every magnitude, far from the origin and close together, zeros of either sign.
TriangleSoup random_soup(Random& random, Numbers numbers);

/// The text that reads back as the same double.
std::string decimal(double value);

enum class PlyEncoding { kText, kLittleEndian, kBigEndian };

std::string write_obj(const TriangleSoup& soup, Random& random);
std::string write_off(const TriangleSoup& soup, Random& random);
/// Coordinates are written in the narrowest type that holds `numbers`, or a wider one.
std::string write_ply(const TriangleSoup& soup, Numbers numbers, PlyEncoding encoding,
                      Random& random);
std::string write_text_stl(const TriangleSoup& soup, Random& random);
/// Coordinates are rounded to floats.
std::string write_binary_stl(const TriangleSoup& soup);

}  // namespace camway::scene::testing
