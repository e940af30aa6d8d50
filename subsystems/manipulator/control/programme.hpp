// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "subsystems/manipulator/control/joints.hpp"

/// Programmes that run on board without a link, as the demonstrator did between two passes over its ground station.
namespace hirosco::manipulator {

/// What an arm makes by itself: legs, each ending at rest, and what its tool does between them.
class Programme {
 public:
  virtual ~Programme() = default;
  /// Moves on and returns the setpoint. Stays at the end of a leg whose tool is due until tool_done().
  virtual Joints advance(double span_s) noexcept = 0;
  /// What the tool is to hold before the programme goes on.
  [[nodiscard]] virtual std::optional<std::uint8_t> tool() const noexcept = 0;
  virtual void tool_done() noexcept = 0;
  [[nodiscard]] virtual bool done() const noexcept = 0;
  /// Legs that are done.
  [[nodiscard]] virtual std::size_t leg() const noexcept = 0;
  /// Where it ends: there the arm is measured.
  [[nodiscard]] virtual Joints goal_rad() const noexcept = 0;
};

/// The legs of a programme in time, wherever they lead.
class Legs {
 public:
  /// How a way is shared out over its time: MinimumJerk from rest to rest, Even at constant speed with a ramp at both ends.
  enum class Pace : std::uint8_t { MinimumJerk, Even };
  struct Leg {
    Pace pace{Pace::MinimumJerk};
    double duration_s{0};
    std::optional<std::uint8_t> tool{};  ///< due at its end
  };
  struct Place {
    std::size_t leg{0};
    double share{0};  ///< of its way
  };
  static constexpr std::size_t most = 8;
  /// To full speed on an even leg, and from it to rest.
  static constexpr double ramp_s = 0.25;

  /// Begins anew, without a leg.
  void clear() noexcept { *this = {}; }
  /// The legs beyond `most` are left out.
  void add(const Leg& leg) noexcept;
  /// Moves on and returns the place; not to be called when it is done.
  Place advance(double span_s) noexcept;
  [[nodiscard]] bool done() const noexcept { return leg_ >= size_; }
  [[nodiscard]] std::size_t leg() const noexcept { return leg_; }  ///< legs that are done
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::optional<std::uint8_t> tool() const noexcept;
  void tool_done() noexcept;

 private:
  std::array<Leg, most> legs_{};
  std::size_t size_{0};
  std::size_t leg_{0};
  double past_s_{0};
};

/// A tool that has been told what to hold: the device does it, or it does not.
class ToolWatch {
 public:
  enum class Verdict : std::uint8_t { Idle, UnderWay, Done, Failed };
  static constexpr int patience_cycles = 40;

  void want(std::uint8_t wanted) noexcept {
    wanted_ = wanted;
    cycles_left_ = patience_cycles;
  }
  void forget() noexcept { cycles_left_ = 0; }
  [[nodiscard]] bool busy() const noexcept { return cycles_left_ > 0; }
  [[nodiscard]] std::uint8_t wanted() const noexcept { return wanted_; }
  /// Once each cycle; Done and Failed are told once.
  [[nodiscard]] Verdict update(std::uint8_t holds) noexcept;

 private:
  std::uint8_t wanted_{0};
  int cycles_left_{0};
};

}  // namespace hirosco::manipulator
