// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// All points that are no farther than `radius_m` from a line from `from` to `to`.
struct Capsule {
  Vector3 from{Vector3::Zero()};
  Vector3 to{Vector3::Zero()};
  double radius_m{0};
};

/// Between their surfaces; negative: how deep they are in each other, where their lines do not cross.  Realtime: wait-free.
[[nodiscard]] double distance_m(const Capsule& one, const Capsule& other) noexcept;

/// What encloses a link, in its frame.
struct Hull {
  std::string link;
  Capsule capsule;
};

/// What the file has as <collision> of its links, each shape enclosed by a capsule. `unknown`: links with a shape of another file
/// (a mesh), which nothing encloses.  Realtime: allocates.
struct Hulls {
  std::vector<Hull> hulls;
  std::vector<std::string> unknown;
};
[[nodiscard]] Hulls hulls_of(std::string_view urdf);

/// How near an arm comes to itself and to what it is to keep out of. Links that are joined to each other are not looked at, nor pairs whose
/// hulls are nearer than `margin_m` with all joints at 0: those are near by construction.
class Clearance {
 public:
  Clearance(const robotics::Model& model, const Hulls& hulls, double margin_m);

  /// In the axes of the base; those of no radius count for nothing.
  void keep_out(std::span<const Capsule> volumes) noexcept;
  static constexpr std::size_t most_volumes = 4;

  struct Nearest {
    double distance_m{HUGE_VAL};
    const char* names{""};  ///< of the two, as long as this lives
  };
  /// Time grows with the number of pairs.  Realtime: wait-free.
  [[nodiscard]] Nearest nearest(const JointVector& position) noexcept;
  [[nodiscard]] std::size_t pairs() const noexcept { return pairs_.size(); }

 private:
  struct Part {
    robotics::FrameId frame;
    Capsule own;  ///< in its frame
    Capsule now;  ///< in the base's
    bool moves{false};
    std::string volume;  ///< it and any volume that is kept out of
  };
  struct Pair {
    std::size_t one;
    std::size_t other;
    std::string names;
  };
  void place(const JointVector& position) noexcept;

  robotics::Dynamics dynamics_;
  robotics::State state_;
  std::vector<Part> parts_;
  std::vector<Pair> pairs_;
  std::array<Capsule, most_volumes> volumes_{};
};

}  // namespace hirosco::robot_arm
