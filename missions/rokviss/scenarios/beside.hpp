// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "missions/rokviss/independent/coupled_loop.hpp"
#include "simulation/figures/plot.hpp"

/// What the independent loop (missions/rokviss/independent) makes of the same run, drawn beside what the craft did.
namespace hirosco::simulation {

using Shown = std::function<double(const independent::Sample&)>;

/// One value of each sample of a flight of the independent loop; time counts from `start_s` of it.
[[nodiscard]] Curve independently(const independent::Conditions& conditions, const Shown& shown, double start_s = 0);

/// Largest distance in y of `other` from `flown`, at the places of `flown` that lie within both.
[[nodiscard]] double largest_distance(const Curve& flown, const Curve& other);

/// Adds `other` as a dotted curve and says in the caption how far it is from the curve number `flown`, in `unit`.
/// \return that distance
double draw_beside(Plot& plot, std::size_t flown, Curve other, const std::string& unit);

}  // namespace hirosco::simulation
