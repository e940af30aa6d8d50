// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/shapes/collision.hpp"

namespace hirosco::robotics {

/// All points that are no farther than `radius_m` from a line from `from` to `to`.
struct Capsule {
  Vector3 from{Vector3::Zero()};
  Vector3 to{Vector3::Zero()};
  double radius_m{0};
};

/// How near an arm comes to itself and to what it is to keep out of. Links that are joined to each other are not looked at. Two others have an own
/// limit where they are built near each other: a third of how far apart they are with the joints between them at 0, where these may be there, and what somebody else moves (swept.hpp) as it
/// stands, or as far apart as they ever come. Where that is less than a millimetre they pass through each other.
class Clearance {
 public:
  /// `tip`: of who may carry() something.  Realtime: allocates; some hundred postures are looked at.
  Clearance(const Model& model, std::span<const LinkHull> hulls, std::optional<FrameId> tip = std::nullopt);

  /// How near any two may come.  Realtime: wait-free.
  void set_limit(double limit_m) noexcept;

  /// In the axes of the base; those of no radius count for nothing.
  void keep_out(std::span<const Capsule> volumes) noexcept;
  static constexpr std::size_t most_volumes = 4;

  /// What the tip carries and no file knows: a capsule from the tip's origin, where its rear cap ends, to a radius beyond `to`, in its frame; at that origin: nothing. A part of
  /// the tip's body, as near to others as that origin is built, less what reaches behind it of who is rounder than long, and not looked at against what else is carried.  Realtime: wait-free.
  enum class Carried : std::uint8_t { Tool, Payload };
  void carry(Carried which, const Vector3& to, double radius_m) noexcept;
  static constexpr std::size_t most_carried = 2;

  struct Nearest {
    double distance_m{HUGE_VAL};
    const char* names{""};  ///< of the two, as long as this lives
  };
  /// Of those that are not built nearer than the limit. Time grows with the number of pairs.  Realtime: wait-free.
  [[nodiscard]] Nearest nearest(const JointVector& position) noexcept;
  /// As far as a search for a distance is exact: who does not move is no nearer.
  static constexpr double same_m = 3e-7;
  /// The nearest two at `then` among those that are nearer there than they may be, and by more than `by_m`, half of their own limit at most, nearer than at `now`: who
  /// is too near may go away, and keeps nobody else from being seen. None: infinitely far.  Realtime: wait-free.
  [[nodiscard]] Nearest nearer(const JointVector& now, const JointVector& then, double by_m = same_m) noexcept;

  /// The nearest two among those that are nearer there than they may be, wherever they come from. None: infinitely far.  Realtime: wait-free.
  [[nodiscard]] Nearest too_near(const JointVector& position) noexcept;
  /// Whether no two are.  Realtime: wait-free.
  [[nodiscard]] bool keeps_limits(const JointVector& position) noexcept {
    return too_near(position).distance_m == HUGE_VAL;
  }

  /// Two links, and how near each other they are built.
  struct Pair {
    std::string names;
    double built_m{HUGE_VAL};
    double limit_m{0};  ///< 0: they pass through each other
  };
  /// Of links.
  [[nodiscard]] std::size_t pairs() const noexcept { return link_pairs_; }
  [[nodiscard]] const Pair& pair(std::size_t i) const noexcept { return pairs_[i].named; }
  /// Of every one of these pairs.  Realtime: wait-free.
  void distances(const JointVector& position, std::span<double> of_pairs) noexcept;

 private:
  struct Solid {
    RoundedHull hull;
    Ball ball;  ///< in the link's frame
    Vector3 centre{Vector3::Zero()};  ///< of the ball, in the base's
  };
  /// A link, what the tip carries, or a volume, which stands.
  struct Body {
    FrameId frame;
    std::size_t body{0};
    std::vector<Solid> solids;
    Ball ball;
    Vector3 centre{Vector3::Zero()};
    Pose pose;
  };
  struct LookedAt {
    Pair named;
    std::size_t one{0};
    std::size_t other{0};
    std::vector<Vector3> axes;  ///< of each two solids, from the last search
    double then_m{0};
  };
  void add_links(const Model& model, std::span<const LinkHull> hulls);
  void add_carried(const Model& model);
  void add_pair(std::size_t one, std::size_t other, std::string names);
  void limit_pairs() noexcept;
  [[nodiscard]] bool counts(std::size_t body) const noexcept;
  [[nodiscard]] double behind_m(std::size_t body) const noexcept;
  void learn_construction(const Model& model, std::span<const LinkHull> hulls);
  void built_distances(const Model& model, std::span<const LinkHull> hulls, std::span<double> of_pairs);
  void place(const JointVector& position) noexcept;
  [[nodiscard]] double apart_m(LookedAt& pair, double enough_m) noexcept;

  Dynamics dynamics_;
  State state_;
  std::vector<Body> bodies_;  ///< links, then what is carried, then volumes
  std::vector<LookedAt> pairs_;  ///< of links, then of links and what is carried, then of both and volumes
  std::optional<FrameId> tip_;
  std::size_t links_{0};
  std::size_t moved_{0};  ///< links, and what is carried
  std::size_t link_pairs_{0};
  std::size_t moved_pairs_{0};  ///< without volumes
  double limit_m_{0};
  std::size_t nearest_{0};  ///< of the last search: the next begins there
};

}  // namespace hirosco::robotics
