// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/rokviss/scenarios/beside.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hirosco::simulation {

Curve independently(const independent::Conditions& conditions, const Shown& shown, double start_s) {
  Curve curve{.name = "independent loop", .stroke = Stroke::Dotted};
  for (const independent::Sample& sample : independent::fly(conditions))
    if (sample.time_s >= start_s) curve.add(sample.time_s - start_s, shown(sample));
  return curve;
}

double largest_distance(const Curve& flown, const Curve& other) {
  double largest = 0;
  for (std::size_t i = 0; i < flown.x.size(); ++i) {
    const auto after = std::ranges::lower_bound(other.x, flown.x[i]);
    if (after == other.x.end() || (after == other.x.begin() && *after != flown.x[i])) continue;
    const auto at = static_cast<std::size_t>(after - other.x.begin());
    double value = other.y[at];
    if (at > 0) {
      const double share = (flown.x[i] - other.x[at - 1]) / (other.x[at] - other.x[at - 1]);
      value = other.y[at - 1] + share * (other.y[at] - other.y[at - 1]);
    }
    largest = std::max(largest, std::abs(flown.y[i] - value));
  }
  return largest;
}

double draw_beside(Plot& plot, std::size_t flown, Curve other, const std::string& unit) {
  const double distance = largest_distance(plot.curves.at(flown), other);
  plot.caption += fmt::format(" The {} is {:.2g} {} away at most.", other.name, distance, unit);
  plot.curves.push_back(std::move(other));
  return distance;
}

}  // namespace hirosco::simulation
