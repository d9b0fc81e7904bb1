// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>

#include "daemon/scene/import/readers/mesh_reader.h"
#include "tests/scene/import/readers/mesh_files.h"
#include "tests/support/random.h"

namespace camway::scene::testing {
namespace {

constexpr int kTrials = 300;

std::array<std::uint64_t, 3> bits_of(const std::array<double, 3>& v) {
  return {std::bit_cast<std::uint64_t>(v[0]), std::bit_cast<std::uint64_t>(v[1]),
          std::bit_cast<std::uint64_t>(v[2])};
}

/// Expects every triangle, in order, with the same bits in every coordinate.
void expect_same(const TriangleSoup& soup, std::string_view extension, const std::string& file) {
  const auto read = mesh_readers::read_mesh(extension, file);
  ASSERT_EQ(read.error, "") << file;
  ASSERT_EQ(read->triangles.size(), soup.triangles.size()) << file;
  EXPECT_EQ(read->header.dropped_points_and_lines, 0U);
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = read->triangles[i][k];
      ASSERT_LT(corner, read->vertices.size());
      ASSERT_EQ(bits_of(read->vertices[corner]), bits_of(soup.vertices[soup.triangles[i][k]]))
          << "triangle " << i << " of\n"
          << file;
    }
  }
}

template <class Write>
void expect_all_same(Numbers numbers, std::string_view extension, Write write) {
  Random random(kMeshSeed);
  for (int trial = 0; trial < kTrials; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    const TriangleSoup soup = random_soup(random, numbers);
    expect_same(soup, extension, write(soup, random));
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(RoundTrip, Obj) { expect_all_same(Numbers::kDoubles, ".obj", write_obj); }
TEST(RoundTrip, Off) { expect_all_same(Numbers::kDoubles, ".OFF", write_off); }
TEST(RoundTrip, TextStl) { expect_all_same(Numbers::kDoubles, ".stl", write_text_stl); }
TEST(RoundTrip, BinaryStl) {
  expect_all_same(Numbers::kFloats, ".Stl",
                  [](const TriangleSoup& soup, Random&) { return write_binary_stl(soup); });
}

TEST(RoundTrip, PlyOfEveryEncodingAndType) {
  for (const PlyEncoding encoding :
       {PlyEncoding::kText, PlyEncoding::kLittleEndian, PlyEncoding::kBigEndian}) {
    for (const Numbers numbers : {Numbers::kDoubles, Numbers::kFloats, Numbers::kSmallIntegers}) {
      expect_all_same(numbers, ".ply", [=](const TriangleSoup& soup, Random& random) {
        return write_ply(soup, numbers, encoding, random);
      });
      if (HasFatalFailure()) return;
    }
  }
}

TEST(RoundTrip, SaysWhatItRounds) {
  Random random(kMeshSeed);
  const TriangleSoup soup = random_soup(random, Numbers::kFloats);
  const auto rounding = [](std::string_view extension, const std::string& file) {
    return mesh_readers::read_mesh(extension, file)->header.relative_rounding;
  };
  EXPECT_EQ(rounding(".stl", write_binary_stl(soup)), 0.0);
  EXPECT_EQ(rounding(".ply", write_ply(soup, Numbers::kFloats, PlyEncoding::kBigEndian, random)),
            0.0);
  EXPECT_EQ(rounding(".ply", write_ply(soup, Numbers::kFloats, PlyEncoding::kText, random)),
            0x1p-53);
  EXPECT_EQ(rounding(".obj", "v 1 2 3\nv 0.1 0 0\nv 0 1 0\nf 1 2 3\n"), 0x1p-53);
  // 1/3 of 0.1: number, weight and quotient round.
  EXPECT_EQ(rounding(".obj", "v 1 2 3\nv 0.1 0 0 3\nv 0 1 0\nf 1 2 3\n"), 0x1p-51);
}

}  // namespace
}  // namespace camway::scene::testing
