// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

/// The figures of a measurement and how they are compared.
namespace hirosco::bench {

struct Figures {
  double p50{};
  double p99{};
  double p99_9{};
  double max{};
};

/// Figures of samples in any order, in the samples' unit times `scale`.
inline Figures figures_of(std::vector<std::int64_t>& samples, double scale) {
  if (samples.empty()) return {};
  std::ranges::sort(samples);
  const auto at = [&](double share) {
    const auto index = static_cast<std::size_t>(share * static_cast<double>(samples.size() - 1));
    return static_cast<double>(samples[index]) * scale;
  };
  return {at(0.50), at(0.99), at(0.999), at(1.0)};
}

inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// One contestant over all repeats.
struct Series {
  const char* name;
  std::vector<Figures> repeats;

  [[nodiscard]] double middle(double Figures::* figure) const {
    std::vector<double> values;
    for (const Figures& repeat : repeats) values.push_back(repeat.*figure);
    return median(values);
  }
  /// Median over the repeats of the ratio inside one repeat, which a busy machine disturbs least.
  [[nodiscard]] double ratio_to(const Series& other, double Figures::* figure) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(repeats.size(), other.repeats.size()); ++i)
      if (other.repeats[i].*figure > 0) ratios.push_back(repeats[i].*figure / (other.repeats[i].*figure));
    return median(ratios);
  }
  void print(const char* unit) const {
    std::printf("%-28s p50 %9.2f  p99 %9.2f  p99.9 %9.2f  max %10.2f %s\n", name, middle(&Figures::p50),
                middle(&Figures::p99), middle(&Figures::p99_9), middle(&Figures::max), unit);
  }
  void print_ratio(const Series& other) const {
    std::printf("%-14s / %-11s  p50 %9.2f  p99 %9.2f  p99.9 %9.2f  max %10.2f\n", name, other.name,
                ratio_to(other, &Figures::p50), ratio_to(other, &Figures::p99), ratio_to(other, &Figures::p99_9),
                ratio_to(other, &Figures::max));
  }
};

}  // namespace hirosco::bench
