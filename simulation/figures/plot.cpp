// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/figures/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "hirosco/xml/escaped.hpp"

namespace hirosco::simulation {
namespace {

constexpr double width = 820, height = 400;
constexpr double left = 78, right = 18, top = 62, bottom = 52;
constexpr double inner_width = width - left - right;
constexpr double inner_height = height - top - bottom;
// Apart for eyes that see fewer colours, and in grey.
constexpr std::array<std::string_view, 6> colours{"#0b4f9e", "#d1600a", "#1a7f4e", "#8a2f8f", "#5a5a5a", "#b8860b"};

struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};
  void take(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Round steps, at most about `wanted` of them.
double step_of(const Range& range, double wanted) {
  const double raw = (range.high - range.low) / wanted;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power) return factor * power;
  return 10 * power;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_{plot} {
    for (const Curve& curve : plot.curves) {
      for (const double value : curve.x) x_.take(value);
      for (const double value : curve.y) y_.take(value);
    }
    for (const Mark& mark : plot.marks) (mark.vertical ? x_ : y_).take(mark.at);
    if (plot.bars) y_.low = 0;
    for (Range* range : {&x_, &y_})
      if (!(range->low <= range->high)) *range = {0, 1};
    if (plot.bars) {
      const double half = plot.curves[0].x.size() > 1 ? (plot.curves[0].x[1] - plot.curves[0].x[0]) / 2 : 0.5;
      x_ = {x_.low - half, x_.high + half};
      y_ = {0, std::ceil(std::log10(std::max(y_.high, 1.0)) + 0.05)};
    } else {
      const double margin = y_.high > y_.low ? 0.05 * (y_.high - y_.low) : std::max(0.05 * std::abs(y_.high), 1e-9);
      y_ = {y_.low - margin, y_.high + margin};
    }
    if (!(x_.high > x_.low)) x_.high = x_.low + 1;
    // A curve from the first sample on begins at zero for the eye.
    if (x_.low > 0 && x_.low < 0.01 * x_.high) x_.low = 0;
  }

  std::string draw() {
    text_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
        "role=\"img\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\">\n<title>{2}</title>\n"
        "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>\n",
        width, height, xml::escaped(plot_.title));
    label(left, 22, "start", plot_.title, "font-weight=\"bold\" font-size=\"15\"");
    grid();
    if (plot_.bars) bars();
    else
      for (std::size_t i = 0; i < plot_.curves.size(); ++i) curve(plot_.curves[i], colours[i % colours.size()]);
    marks();
    frame();
    if (!plot_.bars) legend();
    return text_ + "</svg>\n";
  }

 private:
  [[nodiscard]] double px(double x) const { return left + inner_width * (x - x_.low) / (x_.high - x_.low); }
  [[nodiscard]] double py(double y) const { return top + inner_height * (y_.high - y) / (y_.high - y_.low); }

  void label(double x, double y, std::string_view anchor, std::string_view words, std::string_view more = "") {
    text_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"#1c1c1c\" {}>{}</text>\n", x, y,
                         anchor, more, xml::escaped(words));
  }
  void line(double x1, double y1, double x2, double y2, std::string_view style) {
    text_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2, style);
  }

  void grid() {
    constexpr std::string_view thin = "stroke=\"#dcdcdc\" stroke-width=\"1\"";
    const double x_step = plot_.bars ? 1 : step_of(x_, 9), y_step = plot_.bars ? 1 : step_of(y_, 6);
    for (double n = std::ceil(x_.low / x_step); n * x_step <= x_.high * (1 + 1e-12) + 1e-12; ++n) {
      line(px(n * x_step), top, px(n * x_step), top + inner_height, thin);
      const double value = plot_.bars ? std::exp2(n) : n * x_step + 0.0;
      label(px(n * x_step), top + inner_height + 18, "middle", fmt::format("{:.6g}", value));
    }
    for (double n = std::ceil(y_.low / y_step); n * y_step <= y_.high; ++n) {
      line(left, py(n * y_step), left + inner_width, py(n * y_step), thin);
      const double value = plot_.bars ? std::pow(10, n) : n * y_step + 0.0;
      label(left - 8, py(n * y_step) + 4, "end", fmt::format("{:.6g}", value));
    }
  }

  void frame() {
    text_ +=
        fmt::format("<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"none\" stroke=\"#1c1c1c\"/>\n",
                    left, top, inner_width, inner_height);
    label(left + inner_width / 2, height - 12, "middle", plot_.x_label);
    label(0, 0, "middle", plot_.y_label,
          fmt::format("transform=\"translate(18 {:g}) rotate(-90)\"", top + inner_height / 2));
  }

  static std::string_view dashes(Stroke stroke) {
    switch (stroke) {
      case Stroke::Dashed: return "stroke-dasharray=\"7 4\"";
      case Stroke::Dotted: return "stroke-dasharray=\"2 3\"";
      case Stroke::Solid: break;
    }
    return "";
  }

  /// One column of the picture takes two points of a curve that has more.
  void curve(const Curve& curve, std::string_view colour) {
    constexpr auto columns = static_cast<std::size_t>(inner_width);
    const std::size_t bunch = std::max<std::size_t>(1, curve.x.size() / columns);
    std::string points;
    bool pen_down = false;
    const auto point = [&](std::size_t i) {
      if (!std::isfinite(curve.y[i])) {
        pen_down = false;
        return;
      }
      points += fmt::format("{}{:.1f} {:.1f}", pen_down ? " L" : " M", px(curve.x[i]), py(curve.y[i]));
      pen_down = true;
    };
    for (std::size_t first = 0; first < curve.x.size(); first += bunch) {
      const std::size_t end = std::min(first + bunch, curve.x.size());
      std::size_t smallest = first, largest = first;
      for (std::size_t i = first; i < end; ++i) {
        if (curve.y[i] < curve.y[smallest]) smallest = i;
        if (curve.y[i] > curve.y[largest]) largest = i;
      }
      point(std::min(smallest, largest));
      if (smallest != largest) point(std::max(smallest, largest));
    }
    text_ +=
        fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" stroke-linejoin=\"round\" {}/>\n",
                    points, colour, dashes(curve.stroke));
  }

  void bars() {
    const Curve& bars = plot_.curves.front();
    const double wide = inner_width / static_cast<double>(bars.x.size());
    for (std::size_t i = 0; i < bars.x.size(); ++i) {
      if (!(bars.y[i] > 0)) continue;
      // One sample alone has a height, too: a bar begins at a half.
      const double up = py(std::max(std::log10(bars.y[i]), 0.08));
      text_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                           px(bars.x[i]) - 0.42 * wide, up, 0.84 * wide, top + inner_height - up, colours[0]);
    }
  }

  void marks() {
    for (const Mark& mark : plot_.marks) {
      constexpr std::string_view style = "stroke=\"#a11212\" stroke-width=\"1.2\" stroke-dasharray=\"5 4\"";
      constexpr std::string_view words =
          "font-size=\"12\" style=\"fill:#a11212\" stroke=\"#ffffff\" stroke-width=\"4\" paint-order=\"stroke\"";
      if (mark.vertical) {
        const bool at_right = px(mark.at) > left + 0.75 * inner_width;
        line(px(mark.at), top, px(mark.at), top + inner_height, style);
        label(px(mark.at) + (at_right ? -5 : 5), top + 16, at_right ? "end" : "start", mark.name, words);
      } else {
        line(left, py(mark.at), left + inner_width, py(mark.at), style);
        label(left + inner_width - 6, py(mark.at) - 4, "end", mark.name, words);
      }
    }
  }

  void legend() {
    double x = left;
    constexpr double y = 44, sample = 26, gap = 22, letter = 7.1;
    for (std::size_t i = 0; i < plot_.curves.size(); ++i) {
      const Curve& curve = plot_.curves[i];
      line(x, y - 4, x + sample, y - 4,
           fmt::format("stroke=\"{}\" stroke-width=\"2.4\" {}", colours[i % colours.size()], dashes(curve.stroke)));
      label(x + sample + 6, y, "start", curve.name);
      x += sample + 6 + gap + letter * static_cast<double>(curve.name.size());
    }
  }

  const Plot& plot_;
  Range x_, y_;
  std::string text_;
};

}  // namespace

std::string svg_of(const Plot& plot) { return plot.curves.empty() ? std::string{} : Drawing{plot}.draw(); }

}  // namespace hirosco::simulation
