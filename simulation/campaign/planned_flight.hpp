// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "hirosco/descriptor/model/mission.hpp"
#include "simulation/campaign/campaign_log.hpp"
#include "simulation/campaign/plan.hpp"
#include "simulation/campaign/planted_defects.hpp"
#include "simulation/campaign/world_trace.hpp"
#include "simulation/spacecraft/modules.hpp"
#include "simulation/spacecraft/spacecraft.hpp"

namespace hirosco::campaign {

/// One flight of a mission under a plan.
class PlannedFlight {
 public:
  /// `defect`: a defect to be found, else null.
  PlannedFlight(const descriptor::Mission& mission, simulation::Modules modules, FlightPlan plan,
                std::unique_ptr<PlantedDefect> defect);

  /// Flies it all. Packet log and trace are whole afterwards.
  void fly();
  [[nodiscard]] const Disk& disk() const noexcept { return disk_; }
  [[nodiscard]] const WorldTrace& trace() const noexcept { return *trace_; }
  /// What the supervisor told, for people.
  [[nodiscard]] const std::string& story() const noexcept { return observer_.text; }

 private:
  struct Observer final : supervisor::Observer {
    void told(OnboardTime, std::string_view line) override;
    const simulation::Spacecraft* craft{nullptr};
    std::string text;
  };
  struct Verdict {
    bool over{false};
    bool completed{false};
  };

  void run_until(Duration since_start);
  void run_until(const std::function<bool()>& condition, Duration limit);
  void perform(const Action& action);
  [[nodiscard]] bool do_action(const std::vector<std::string>& words);
  [[nodiscard]] bool disk_fault(const std::vector<std::string>& words);
  [[nodiscard]] bool telecommand(const std::vector<std::string>& words);
  [[nodiscard]] bool flood(const std::vector<std::string>& words);
  struct Header {
    std::uint16_t apid{};
    std::uint8_t service{};
    std::uint8_t subtype{};
    std::uint8_t ack{};
  };
  bool send(const std::string& origin, const Header& header, Octets data);
  bool send_packet(const std::string& origin, Octets packet);
  void received_on_ground(Octets packet);

  // The end of each flight: every fault is over, and what can fly has to fly again.
  void finale();
  void end_faults();
  void rest_hands();
  void see_hangs_ended();
  void bring_up();
  [[nodiscard]] bool call(std::string_view subsystem, std::string_view function, std::optional<double> argument);
  [[nodiscard]] std::uint32_t state(std::string_view name) const;

  void look();

  descriptor::Mission mission_;
  FlightPlan plan_;
  std::unique_ptr<PlantedDefect> defect_;
  simulation::Modules modules_;
  Disk disk_;
  std::unique_ptr<supervisor::Database> unused_{database_on(disk_)};
  Observer observer_;
  std::unique_ptr<simulation::Spacecraft> craft_;
  std::unique_ptr<WorldTrace> trace_;
  std::map<std::string, std::uint16_t> counts_;  ///< of the telecommands of each origin
  std::map<std::uint32_t, Verdict> verdicts_;    ///< of the ground's, by request id
  std::uint32_t last_request_{0};
  bool supervisor_stopped_{false};
};

}  // namespace hirosco::campaign
