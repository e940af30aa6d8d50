// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// Plots for people who print them: curves with axes, units and a legend, as SVG text without scripts or outside fonts.
namespace hirosco::simulation {

enum class Stroke : std::uint8_t { Solid, Dashed, Dotted };

struct Curve {
  std::string name;
  std::vector<double> x{};
  std::vector<double> y{};
  Stroke stroke{Stroke::Solid};

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

/// A line across the plot at one value of y (a limit) or of x (a moment).
struct Mark {
  std::string name;
  double at{0};
  bool vertical{false};
};

struct Plot {
  std::string name;  ///< of the file, without ending
  std::string title;
  std::string x_label;  ///< with the unit
  std::string y_label;
  std::string caption{};  ///< one or two sentences: what to see
  std::vector<Curve> curves{};
  std::vector<Mark> marks{};
  bool bars{false};  ///< a histogram of one curve: x is the power of two that a bin ends at; logarithmic y
};

/// The plot as a whole SVG document. Curves with more points than can be seen are drawn by the smallest and the largest
/// value of each column, so that no peak is lost. Values that are no numbers leave a gap.
[[nodiscard]] std::string svg_of(const Plot& plot);

}  // namespace hirosco::simulation
