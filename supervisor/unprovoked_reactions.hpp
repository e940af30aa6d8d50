// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervisor.hpp"

namespace hirosco::supervisor {

/// A reaction of high severity, and the event that it answers.
struct ToldReaction {
  TimePoint at{};
  std::string subsystem;
  std::string event;  ///< PROCESS_DIED and HANG where its process is told to have died or to hang
};
/// What somebody injected into a simulated device of the mission.
struct DeviceInjection {
  TimePoint at{};
  std::string device;  ///< as the mission names the simulated one
  std::string line;
};
/// Those that nothing of `injections`, oldest first, had caused. Cause of a reaction is what was injected up to UnprovokedReactions::limit
/// before it, but of a death not what makes well again (`heal`, `plug`); and of the loss of a device besides what is still in force there,
/// however long ago it was injected (`unplug` until `plug`, `silent` and `delay` until `heal`, `stall` and `freeze` for their time).
[[nodiscard]] std::vector<ToldReaction> unprovoked(std::vector<ToldReaction> reactions,
                                                   const std::vector<DeviceInjection>& injections,
                                                   const descriptor::Mission& mission);

/// Hears what is told and routed, keeps the moments of reactions of high severity before which no telecommand had come from
/// ground for some time, and passes everything on. What was injected into simulated devices is asked for by the shell. All of it is of the
/// flight, whichever of its supervisors heard it.
/// Thread: the supervisor's.
class UnprovokedReactions final : public Observer {
 public:
  /// A reaction this long after somebody's deed may be its effect.
  static constexpr Duration limit{std::chrono::seconds{2}};
  UnprovokedReactions(const Clock& clock, Observer& next) : clock_{clock}, next_{next} {}

  [[nodiscard]] const std::vector<ToldReaction>& uncommanded() const noexcept { return uncommanded_; }

  void told(OnboardTime when, std::string_view line) override {
    hear(line);
    next_.told(when, line);
  }
  void routed(const pus::TelemetryView& packet) override {
    next_.routed(packet);
    if (packet.service() != pus::st129::service_type || packet.subtype() != pus::st129::telecommand_copy) return;
    const auto telecommand = pus::TelecommandView::parse(packet.source_data());
    constexpr std::uint8_t ping = 17;  // causes nothing
    if (telecommand && telecommand->service() != ping) commanded_ = clock_.now();
  }
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  static constexpr std::size_t most_kept = 100;

  void hear(std::string_view line) {
    constexpr std::string_view high = " high ";
    constexpr std::string_view stop_asked = "stop by signal or local socket";
    constexpr std::string_view because = " because of ";
    if (line.starts_with(stop_asked)) commanded_ = clock_.now();
    if (!line.starts_with("plan ")) {
      const auto place = line.find(' ');
      const auto behind = place != std::string_view::npos ? line.substr(place) : std::string_view{};
      // "SUBSYSTEM died: ...": that is told before its event is.
      if (behind.starts_with(" died: ")) newest_ = {{}, std::string{line.substr(0, place)}, "PROCESS_DIED"};
      if (behind.starts_with(" hangs: ")) newest_ = {{}, std::string{line.substr(0, place)}, "HANG"};
      // "SUBSYSTEM high EVENT ...": what its reaction will name.
      if (!behind.starts_with(high)) return;
      const auto name = behind.substr(high.size());
      newest_ = {{}, std::string{line.substr(0, place)}, std::string{name.substr(0, name.find(' '))}};
      if (high_.size() < most_kept) high_.emplace(newest_.event);
      return;
    }
    const auto reason = line.find(because);
    const bool network = line.find(": network {") != std::string_view::npos;
    const bool of_high =
        reason != std::string_view::npos && high_.contains(std::string{line.substr(reason + because.size())});
    if ((!network && !of_high) || uncommanded_.size() >= most_kept) return;
    const TimePoint now = clock_.now();
    if (commanded_ == TimePoint{} || now - commanded_ > limit)
      uncommanded_.push_back({now, newest_.subsystem, newest_.event});
  }

  const Clock& clock_;
  Observer& next_;
  TimePoint commanded_{};
  std::set<std::string> high_;
  ToldReaction newest_;  ///< what a reaction that is told next answers
  std::vector<ToldReaction> uncommanded_;
};

}  // namespace hirosco::supervisor
