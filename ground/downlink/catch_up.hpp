// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "ground/archive/archive.hpp"
#include "ground/model/model.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::ground {

/// Fetches what the station missed from the log on board (docs/adr/0140): what was said before there was a link, while there was none, and
/// what was lost on the way. It comes behind all that is said now, and never into the live view. No I/O but the archive's. Thread: one.
class CatchUp {
 public:
  struct Parts {
    const Catalogue& catalogue;
    Archive& archive;
    const Clock& clock;
    std::uint16_t source{};  ///< of the station's questions
    /// TC[129,11]: its request id; empty: it certainly does not leave.
    std::function<std::optional<std::uint32_t>(const pus::st129::Retrieve&)> ask;
    /// What a packet said that was missed and is in the archive now.
    std::function<void(const Heard&, OnboardTime)> heard;
    /// From here to there nothing is missing any more, as far as there was a flight.
    std::function<void(OnboardTime from, OnboardTime to)> filled;
  };
  /// Of a longer span housekeeping comes of its end only; events and verdicts come of all of it.
  static constexpr Duration whole_span = std::chrono::minutes{10};
  /// Nothing was heard for so long: the supervisor was replaced, or nobody knows the question there.
  static constexpr Duration patience = std::chrono::seconds{10};
  static constexpr int most_tries = 3;
  static constexpr std::size_t most_spans = 16;

  explicit CatchUp(Parts parts) : parts_{std::move(parts)} {}

  /// What stands before what is missing: a packet that was heard, or nothing, as the flight began.
  enum class After { APacket, TheBegin };
  void missing(OnboardTime from, OnboardTime to, After after = After::APacket);
  void link_up();
  void link_down();
  /// True: it was about what was missed, and is nobody else's.
  bool hear(const pus::TelemetryView& packet);
  /// Call several times a second.
  void tick();

 private:
  struct Wanted {
    OnboardTime from{}, to{};
    bool housekeeping{true};
    int tries{0};
    bool closes_gap{true};  ///< it is all that is missing there
    After after{After::APacket};
  };
  void add(const Wanted& wanted);
  void take(Octets octets);
  void finish(const pus::st129::RetrievalEnd& end);
  [[nodiscard]] bool is_known(const pus::TelemetryView& packet, Octets octets) const;

  Parts parts_;
  std::deque<Wanted> wanted_;  ///< the first is being fetched where `past_` is there
  std::optional<Model> past_;
  std::optional<OnboardTime> first_;  ///< packet that came, known or not
  std::uint32_t request_{0};  ///< id of what is being fetched
  TimePoint heard_at_{};
  bool connected_{false};
};

}  // namespace hirosco::ground
