// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mesh_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>

namespace hirosco::simulation {
namespace {

void add_cuboid(const Corner& low, const Corner& high, std::vector<Facet>& facets) {
  const auto corner = [&](unsigned which) {
    return Corner{(which & 1U) != 0 ? high[0] : low[0], (which & 2U) != 0 ? high[1] : low[1],
                  (which & 4U) != 0 ? high[2] : low[2]};
  };
  for (const auto& [a, b, c] : {std::array{0U, 2U, 1U},
                                {1U, 2U, 3U},
                                {4U, 5U, 6U},
                                {5U, 7U, 6U},
                                {0U, 1U, 4U},
                                {1U, 5U, 4U},
                                {2U, 6U, 3U},
                                {3U, 6U, 7U},
                                {0U, 4U, 2U},
                                {2U, 4U, 6U},
                                {1U, 3U, 5U},
                                {3U, 7U, 5U}})
    facets.push_back({corner(a), corner(b), corner(c)});
}
[[nodiscard]] std::vector<Facet> cuboid(const Corner& low, const Corner& high) {
  std::vector<Facet> facets;
  add_cuboid(low, high, facets);
  return facets;
}
/// Of which nobody knows whether it is full: a facet is missing.
[[nodiscard]] std::vector<Facet> open_cuboid(const Corner& low, const Corner& high) {
  auto facets = cuboid(low, high);
  facets.pop_back();
  return facets;
}
/// Closed to the last bit, as no corner is reckoned twice.
[[nodiscard]] std::vector<Facet> ellipsoid(int parts, const Corner& half_m) {
  std::vector<Corner> corners{{half_m[0], 0, 0}};
  for (int i = 1; i < parts; ++i)
    for (int j = 0; j < parts; ++j) {
      const double turn = 2 * std::numbers::pi * j / parts, up = std::numbers::pi * i / parts;
      corners.push_back({half_m[0] * std::cos(up), half_m[1] * std::sin(up) * std::cos(turn),
                         half_m[2] * std::sin(up) * std::sin(turn)});
    }
  corners.push_back({-half_m[0], 0, 0});
  const auto at = [&](int i, int j) {
    if (i == 0) return corners.front();
    return i == parts ? corners.back() : corners[static_cast<std::size_t>(1 + (i - 1) * parts + j % parts)];
  };
  std::vector<Facet> facets;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts; ++j) {
      if (i + 1 < parts) facets.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (i > 0) facets.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return facets;
}
[[nodiscard]] std::pair<double, double> from_to(const MeshPiece& piece, std::size_t axis) {
  const auto [low, high] = std::ranges::minmax(piece, {}, [&](const Corner& corner) { return corner[axis]; });
  return {low[axis], high[axis]};
}

TEST(MeshPieces, OfALongBoxAreItsEighthsAndHaveEightCornersEach) {
  auto pieces = pieces_of(open_cuboid({-0.8, 0, 0}, {0.8, 0.1, 0.1}));
  ASSERT_EQ(pieces.size(), 8U);
  std::ranges::sort(pieces);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double from_m = -0.8 + 0.2 * static_cast<double>(i);
    EXPECT_EQ(pieces[i].size(), 8U);
    EXPECT_NEAR(from_to(pieces[i], 0).first, from_m, 1e-12);
    EXPECT_NEAR(from_to(pieces[i], 0).second, from_m + 0.2, 1e-12);
    for (const std::size_t axis : {1U, 2U}) EXPECT_EQ(from_to(pieces[i], axis), (std::pair{0.0, 0.1}));
  }
}

TEST(MeshPieces, OfWhatIsClosedAndConvexAreOneWhicheverSideIsOutside) {
  auto box = cuboid({-0.8, 0, 0}, {0.8, 0.1, 0.1});
  for (const char* side : {"outside", "inside"}) {
    const auto pieces = pieces_of(box);
    ASSERT_EQ(pieces.size(), 1U) << side;
    EXPECT_EQ(pieces.front().size(), 8U) << side;
    for (Facet& facet : box) std::swap(facet[1], facet[2]);
  }
  add_cuboid({1, 0, 0}, {1.2, 0.1, 0.1}, box);
  EXPECT_EQ(pieces_of(box).size(), most_pieces) << "two boxes are not convex";
}

/// Of a thousand corners those of the pieces count.
TEST(MeshPieces, OfALongRoundLinkThatIsOneAreNotThinnerThanItIs) {
  const Corner half_m{0.5, 0.05, 0.05};
  for (const int parts : {20, 40}) {
    const auto link = ellipsoid(parts, half_m);
    const auto pieces = pieces_of(link);
    ASSERT_EQ(pieces.size(), 1U) << parts;
    EXPECT_LE(pieces.front().size(), most_convex_corners);
    for (const Facet& facet : link) {
      // In lengths of its three axes it is a ball, and so is a direction.
      const auto reaches = [&](const Corner& corner) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) sum += corner[k] / half_m[k] * facet[0][k] / half_m[k];
        return sum;
      };
      EXPECT_GE(std::ranges::max(pieces.front() | std::views::transform(reaches)), 0.95) << parts;
      EXPECT_LE(std::ranges::max(pieces.front() | std::views::transform(reaches)), 1 + 1e-12) << parts;
    }
  }
}

/// A hull would fill them: both sides of each wall are within a millimetre of it.
TEST(MeshPieces, OfThinWallsAndOfSheetsWithTwoSidesAreNotOne) {
  constexpr double side_m = 0.2, wall_m = 0.0005;
  std::vector<Facet> plates = cuboid({0, 0, 0}, {wall_m, side_m, side_m});
  add_cuboid({side_m - wall_m, 0, 0}, {side_m, side_m, side_m}, plates);
  EXPECT_EQ(pieces_of(plates).size(), most_pieces) << "two plates";
  std::vector<Facet> cup = plates;
  add_cuboid({0, 0, 0}, {side_m, wall_m, side_m}, cup);
  add_cuboid({0, side_m - wall_m, 0}, {side_m, side_m, side_m}, cup);
  add_cuboid({0, 0, 0}, {side_m, side_m, wall_m}, cup);
  EXPECT_EQ(pieces_of(cup).size(), most_pieces) << "a cup";
  auto box = cuboid({0, 0, 0}, {side_m, side_m, side_m});
  box.resize(10);
  for (std::size_t i = 0; i < 10; ++i) box.push_back({box[i][0], box[i][2], box[i][1]});
  EXPECT_EQ(pieces_of(box).size(), most_pieces) << "an open box, drawn from both sides";
}

TEST(MeshPieces, LeaveWhatIsHollowFree) {
  auto trough = cuboid({-0.2, -0.2, 0}, {0.2, 0.2, 0.05});
  add_cuboid({-0.2, -0.2, 0}, {-0.15, 0.2, 0.4}, trough);
  add_cuboid({0.15, -0.2, 0}, {0.2, 0.2, 0.4}, trough);
  for (const MeshPiece& piece : pieces_of(trough)) {
    const auto [left_m, right_m] = from_to(piece, 0);
    if (left_m <= 0.1 && right_m >= -0.1 && from_to(piece, 2).first < 0.2)
      EXPECT_LE(from_to(piece, 2).second, 0.2) << "the middle of the upper half is free";
    else EXPECT_TRUE(right_m <= -0.1 || left_m >= 0.1);
  }
}

TEST(MeshPieces, AreNotMadeOfWhatIsSmall) {
  EXPECT_EQ(pieces_of(open_cuboid({0, 0, 0}, {0.039, 0.03, 0.02})).size(), 1U);
  EXPECT_EQ(pieces_of(open_cuboid({0, 0, 0}, {0.041, 0.03, 0.02})).size(), 2U);
  EXPECT_TRUE(pieces_of({}).empty());
}

/// All of it, twice: triangles of no area, and one point alone.
TEST(MeshPieces, OfWhatHasNoExtentAreOne) {
  const Corner point{1, 2, 3};
  const auto pieces = pieces_of({{point, point, point}, {point, point, point}});
  EXPECT_EQ(pieces, (std::vector<MeshPiece>{{point}}));
}

/// Each of which a cut makes three of.
TEST(MeshPieces, AreFewerWhereCutsWouldMakeTooManyFacets) {
  const Facet across{Corner{0, 0, 0}, {1, 0.1, 0}, {1, 0, 0.1}};
  EXPECT_EQ(pieces_of(std::vector<Facet>(1000, across)).size(), most_pieces);
  EXPECT_EQ(pieces_of(std::vector<Facet>(most_cut_facets / 3 + 1, across)).size(), 2U);
}

TEST(MeshPieces, AreBoundedAndHardlySmallerThanWhatIsRound) {
  constexpr int parts = 60;
  const auto on_ball = [](int i, int j) {
    const double turn = 2 * std::numbers::pi * j / parts, up = std::numbers::pi * i / parts;
    return Corner{std::sin(up) * std::cos(turn), std::sin(up) * std::sin(turn), std::cos(up)};
  };
  std::vector<Facet> ball;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts; ++j) {
      ball.push_back({on_ball(i, j), on_ball(i + 1, j), on_ball(i + 1, j + 1)});
      ball.push_back({on_ball(i, j), on_ball(i + 1, j + 1), on_ball(i, j + 1)});
    }
  ball.pop_back();  // a hole: as a whole it would be one piece
  const auto pieces = pieces_of(ball);
  EXPECT_EQ(pieces.size(), most_pieces);
  for (const MeshPiece& piece : pieces) EXPECT_LE(piece.size(), most_piece_corners);
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; j < parts; ++j) {
      const Corner direction = on_ball(i, j);
      double farthest_m = 0;
      for (const MeshPiece& piece : pieces)
        for (const Corner& corner : piece)
          farthest_m =
              std::max(farthest_m, corner[0] * direction[0] + corner[1] * direction[1] + corner[2] * direction[2]);
      // No direction is more than 17.6 deg beside one in which the farthest point is taken, and that one is a corner of this ball beside it.
      EXPECT_GE(farthest_m, 0.95) << i << " " << j;
      EXPECT_LE(farthest_m, 1 + 1e-12);
    }
}

}  // namespace
}  // namespace hirosco::simulation
