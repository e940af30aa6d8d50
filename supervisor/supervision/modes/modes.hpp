// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/modes/mode_plan.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/succession/journal.hpp"

namespace hirosco::supervisor {

class Commissioning;

/// The mode of the craft (paper 4.3). SET_MODE is a planned change of all of it (docs/adr/0075): refused as a whole with every
/// reason, or carried out in stages of ordinary telecommands; it ends in the new mode, or with whom it moved stopped and the
/// initial mode in force. ENTER_MODE changes what is permitted and moves nobody: what a mode is entered from, needs and excludes holds
/// for it as well (docs/adr/0171). A subsystem that a permit names may ask for both, but for no change that lets anybody move or moves
/// the ground link, and not without a pause (docs/adr/0216). What was permitted in a mode before is void behind it, by its epoch on every member's page.
/// Thread: the supervisor's.
class Modes final : public Undertaking, public Remembered {
 public:
  struct Parts {
    const Means& means;
    OwnSubsystem& own;
    const PowerLedger& power;
    const Commissioning& commissioning;
  };
  /// Behind each change that a subsystem asked for, until any of them may ask for another one: a change voids what was permitted before it,
  /// and one that asked without end would leave the ground no telecommand, nor one to take its permit away.
  static constexpr Duration pause_of_subsystems = std::chrono::seconds{5};

  explicit Modes(const Parts& parts) : parts_{parts}, craft_{parts.means.craft}, runner_{parts.means} {}

  /// SET_MODE and ENTER_MODE.
  void provide();
  /// TC[129,4]: what SET_MODE would do now. Carried out where it is received.
  void preview(const pus::Request& asked, Octets data);

  /// The change ends, and whom it moved and nobody else has stopped is stopped.
  Cancelled cancel(std::string_view why) override;
  /// The change ends.
  void all_stopped(std::string_view why) override;
  [[nodiscard]] bool running() const noexcept { return runner_.running(); }
  /// As of a WayIntoMode.
  [[nodiscard]] Moving moving(std::uint16_t apid) const;
  void stop_now(std::uint16_t apid);
  /// What the change that is under way is to, and whom it moves.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;
  /// It is one of those whom the change moved in the middle of which the supervisor before died.
  [[nodiscard]] bool was_moving(std::uint16_t apid) const noexcept;
  /// That change ends as every one that is cancelled. Does nothing where there was none.
  void end_change(std::string_view why);

 private:
  enum class StatesFollow : std::uint8_t { Here, Elsewhere };
  [[nodiscard]] bool is_of_subsystem(const Call& call) const noexcept;
  [[nodiscard]] std::optional<Outcome> not_now(const Call& call) const;
  Outcome set_mode(std::uint8_t id, const Call& call);
  void object_for_subsystems(ModePlan& plan, const Call& call) const;
  Outcome enter_mode(std::uint8_t id, const Call& call);
  Outcome impossible(const descriptor::Mode& mode, const ModePlan& plan, const Call& call);
  void change(const descriptor::Mode& mode, ModePlan plan, const Call& call);
  void ended(const descriptor::Mode& mode, const std::string& failure);
  void fall_back(std::string_view why, StatesFollow states);
  void enter(const descriptor::Mode& mode);
  void void_permissions();
  /// What this one asked for is done, or has failed.
  void begin_pause(const Call& call);
  void report(std::uint16_t destination, const descriptor::Mode& mode, const ModePlan& plan);

  Parts parts_;
  Craft& craft_;
  ProcedureRunner runner_;
  std::optional<Call> call_;  ///< of the change that is under way
  std::vector<std::uint16_t> moved_;
  std::size_t stage_{0};  ///< of the change that is under way; in the first one all control stops
  TimePoint subsystems_wait_until_{};
};

}  // namespace hirosco::supervisor
