// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

/// A mesh as several convex pieces, by which links touch each other: MuJoCo's one hull of an elbow or a wrist fills what the next link but one moves in
/// (docs/adr/0218). No MuJoCo here, and no code of the arm's: model and world share nothing but the file.
namespace hirosco::simulation {

using Corner = std::array<double, 3>;
/// A triangle of a surface.
using Facet = std::array<Corner, 3>;
/// Points whose hull is meant.
using MeshPiece = std::vector<Corner>;

inline constexpr std::size_t most_pieces = 8;
/// A closed surface of which nothing lies this far in front of one of its facets is convex.
inline constexpr double convex_within_m = 1e-3;
/// Nothing is cut into parts shorter than this, m.
inline constexpr double shortest_piece_m = 0.02;
/// As many are held at most where a cut begins, three times that behind it, beside the surface: 290 MB. A mesh of 4 MiB that is one has a tenth.
inline constexpr std::size_t most_cut_facets = 1'000'000;
/// Of one piece: as many as there are directions in which the farthest point is taken.
inline constexpr std::size_t most_piece_corners = 98;
/// Of one that is closed and convex: all of its own, or those of the pieces that it would be.
inline constexpr std::size_t most_convex_corners = most_pieces * most_piece_corners;

/// The surface, cut in the middle again and again where it is longest along x, y or z, unless it is closed, convex and full: what has walls thinner than
/// convex_within_m is cut, as before all that is open. Empty: it has no facet. A piece's hull has those of its points
/// that are farthest out: of a ball they are at most 5 % of the radius too small, of what has edges nearly nothing. Each cut makes at most three facets of one: with
/// more than most_cut_facets nothing is cut any more, and pieces are fewer and larger.  Realtime: allocates.
[[nodiscard]] std::vector<MeshPiece> pieces_of(std::vector<Facet> surface);

}  // namespace hirosco::simulation
