// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/world/random.hpp"

namespace hirosco::simulation {

/// Encoders of a robot's joints that count from where they were switched on, and know their zero from when they have passed a mark that they were told to take it
/// at (docs/adr/0208). Without power they forget it.
/// Realtime: does not allocate once it is made. Thread: one.
class RelativeEncoders {
 public:
  /// rad or m, joint by joint: where each has its mark, and what it tells where it is switched on; none: drawn by the seed each time, from -3 to 3.
  RelativeEncoders(std::vector<double> marks, std::optional<std::vector<double>> begin_at, std::uint64_t seed);

  [[nodiscard]] std::size_t count() const noexcept { return joints_.size(); }
  /// They are switched on anew, where their joints are when they are read next.
  void forget() noexcept;
  /// Whether this one takes its zero at its mark from now on.
  void take_zero(std::size_t joint, bool wanted) noexcept { joints_[joint].takes_zero = wanted; }
  /// Its joint is there: what it tells of that.
  [[nodiscard]] double read(std::size_t joint, double position) noexcept;
  [[nodiscard]] bool knows_zero(std::size_t joint) const noexcept { return joints_[joint].knows_zero; }

 private:
  struct Joint {
    double mark{0};
    double ahead{0};  ///< of what it tells its joint is
    double last{0};
    bool is_on{false};
    bool knows_zero{false};
    bool takes_zero{false};
  };
  std::vector<Joint> joints_;
  std::optional<std::vector<double>> begin_at_;
  Random random_;
};

}  // namespace hirosco::simulation
