// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// SAFE_ALL, however it was asked for: the guard stops everything, the states follow, and what became of it is told by who
/// was to stop. What was said before it, read or not, lets nobody move (`Guard::newest_stop()`).
/// It holds until a SET_STATE(Operational) that was permitted after it leaves (`Telecommands::send()`, `Guard::release()`).
/// Thread: the supervisor's; the stop itself is the guard's.
class SafeAll final : public Remembered, public Hearer {
 public:
  /// Of one subsystem that wait for the outcome, as of all that it asks for. What goes beyond is carried out all the same; it is kept for nobody,
  /// for one that says it without end would fill what is noted for the next supervisor.
  static constexpr std::size_t most_waiting = 16;

  /// Ends that have not left; beyond these the oldest is told by this supervisor alone.
  static constexpr std::size_t most_told = 256;
  /// Who did not stop, by name: as many as a report of it has room for.
  static constexpr std::size_t most_named = pus::FailureNotice::max_data_octets / sizeof(std::uint16_t);

  SafeAll(Craft& craft, OwnSubsystem& own, CommandDesk& desk, std::vector<Undertaking*> under_way)
      : craft_{craft}, own_{own}, desk_{desk}, under_way_{std::move(under_way)} {}

  void provide();
  /// SAFE_ALL, carried out where it is received.
  void carry_out(const pus::Request& request);
  /// A signal or the local socket asked for a stop, at some time before.
  void asked();
  /// The guard stopped everybody, as nobody had heard of the supervisor for so long.
  void stood_still();
  /// Everything was stopped already: nothing starts it again, and the states follow.
  void after_stop(std::string_view why);
  /// One was under way when the supervisor before died, or was asked for when there was none.
  void again();
  /// Somebody asked for one by signal or local socket, and no supervisor has noted that.
  void asked_meanwhile();
  /// The ends of those that the supervisor before had ended: it may have told them, and may not (docs/adr/0243).
  void tell_again();
  /// Whether there is a ground link to tell by. What was said without one is told again, with its mark, once there is.
  void ground_hears(bool now);
  /// Its own word on the end of a stop is on its way to ground.
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  /// What was heard so far has left for the ground.
  void delivered() noexcept {
    if (!ground_hears_) return;
    std::erase_if(told_, [](const End& end) { return end.heard; });
  }
  [[nodiscard]] bool under_way() const noexcept { return !pending_.empty() || !before_.empty(); }
  /// Who waits for the end of a stop, and whose end has perhaps not left.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;
  /// Tells what became of the stops that are under way.
  void follow();

 private:
  struct Pending {
    std::uint64_t stop{0};
    std::optional<pus::Request> request;  ///< empty: asked for by signal or local socket
  };
  /// Of a request; who had not stopped, if any.
  struct End {
    pus::Request request;
    std::vector<std::uint16_t> moving;
    bool heard{false};  ///< it was told
  };
  [[nodiscard]] bool has_room_for(const pus::Request& request) const;
  /// Into the story. \return who had not stopped.
  std::vector<std::uint16_t> tell_outcome(const std::vector<StopAnswer>& answers);
  void tell(const End& end);
  void tell_before();
  void keep_bounded();
  /// Whoever is Operational, or enters it after all on the word of before, however slow its cycle: until it is let go, and once.
  void states_follow();

  Craft& craft_;
  OwnSubsystem& own_;
  CommandDesk& desk_;
  std::vector<Undertaking*> under_way_;
  std::vector<Pending> pending_;
  std::vector<std::optional<pus::Request>> before_;  ///< of stops that the supervisor before had begun
  std::vector<End> told_;  ///< and not known to have left
  std::vector<End> told_before_;  ///< by the supervisor before, perhaps, or where nobody could hear it
  bool ground_hears_{true};
  std::vector<std::uint16_t> follow_;  ///< whose states have not followed the newest stop
};

}  // namespace hirosco::supervisor
