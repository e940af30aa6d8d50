// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "ground/archive/records.hpp"
#include "ground/model/answered.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::ground {

/// Who commands: one seat at a time. A seat is a page, or a script that gives itself one; it is no secret, and keeps people from
/// acting at once by mistake, not by intent: all of them hold the operator's token. Nobody asks it of what is essential.
/// Thread: one.
class Authority {
 public:
  static constexpr Duration idle_limit = 15min;  ///< without a telecommand
  static constexpr Duration absence_limit = 30s;  ///< without a page of the seat, and without a telecommand
  static constexpr Duration answer_limit = 30s;  ///< to who asks for it
  static constexpr std::size_t longest_seat = 64;
  static constexpr std::size_t longest_name = 32;

  struct Seat {
    std::string id;  ///< "" = who has none
    std::string name;  ///< in words, for others
  };
  struct Now {
    TimePoint ground;
    OnboardTime onboard;
  };
  /// `did` hears of each change, to keep it and to tell everybody.
  explicit Authority(std::function<void(const StoredMark&)> did) : did_{std::move(did)} {}

  /// Whether this seat may command now; who may begins to command where nobody does. A refusal says who commands (409).
  [[nodiscard]] Answered<void> may_command(const Seat& seat, const Now& now);
  /// From nobody, at once; from another one, when that one hands it over or has not answered in `answer_limit`.
  [[nodiscard]] Answered<void> take(const Seat& seat, const Now& now);
  /// The one who commands goes on, whoever asks.
  [[nodiscard]] Answered<void> keep(const Seat& seat, const Now& now);
  /// To who asks for it, or to nobody.
  [[nodiscard]] Answered<void> hand_over(const Seat& seat, const Now& now);
  /// The seats that have a page open.
  void see(std::set<std::string> present, const Now& now);

  /// {holder: {seat, name, since} or null, asking: {seat, name, answer_s} or null}
  [[nodiscard]] nlohmann::json json(TimePoint now) const;

 private:
  struct Holder {
    Seat seat;
    OnboardTime since{};
    TimePoint acted{};
    TimePoint seen{};
  };
  struct Asking {
    Seat seat;
    TimePoint since{};
  };
  void give(const Seat& seat, std::string_view action, const Now& now);
  void did(std::string_view action, const Seat& who, const std::string& note, const Now& now);
  [[nodiscard]] Answered<void> expect_holder(const Seat& seat) const;

  std::function<void(const StoredMark&)> did_;
  std::optional<Holder> holder_;
  std::optional<Asking> asking_;
};

}  // namespace hirosco::ground
