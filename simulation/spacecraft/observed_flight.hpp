// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "simulation/spacecraft/modules.hpp"
#include "simulation/spacecraft/spacecraft.hpp"

/// A whole spacecraft on virtual time with everything that scenarios and tests want to see of it.
namespace hirosco::simulation {

/// What the supervisor told, in order.
class Story final : public supervisor::Observer {
 public:
  struct Line {
    OnboardTime when{};
    std::string text;
  };
  void told(OnboardTime when, std::string_view line) override;
  void routed(const pus::TelemetryView& packet) override;

  [[nodiscard]] const std::vector<Line>& lines() const noexcept { return lines_; }
  /// The first line that contains `part`, from index `from` on.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view part, std::size_t from = 0) const;
  [[nodiscard]] bool has(std::string_view part) const { return find(part).has_value(); }
  [[nodiscard]] std::size_t count(std::string_view part) const;
  /// Empty when lines with these parts stand there in this order, else the first part that is missing.
  [[nodiscard]] std::string missing_in_order(const std::vector<std::string>& parts) const;
  [[nodiscard]] std::string text() const;
  /// Called for every telemetry packet that is routed.
  std::function<void(const pus::TelemetryView&)> on_telemetry;
  /// Called for every line, for what must be timed to the cycle.
  std::function<void(std::string_view)> on_line;

 private:
  std::vector<Line> lines_;
};

struct Plan {
  std::filesystem::path mission{};  ///< the mission file
  std::function<void(descriptor::Mission&)> edit{};
  SubsystemCatalogue subsystems{};  ///< in place of modules, or besides them
  DeviceCatalogue devices{};
  /// Texts that stand in for files, by file name.
  std::map<std::string, std::string> files{};
  std::uint64_t seed{1};
  /// What stands between the supervisor and a member's channel; empty: nothing.
  std::function<std::unique_ptr<Channel>(std::string_view member, std::unique_ptr<Channel>)> wrap_channel{};
  /// Of persistent parameters, from flight to flight; null: of this one alone.
  supervisor::ValueStore* values{nullptr};
  /// Another supervisor goes on so long after one that dies; empty: its death ends the flight.
  std::optional<Duration> revives_after{};
  std::size_t journal_octets{std::size_t{256} << 10};  ///< in which the one that died has noted what it knew, twice
  /// In place of a log that stores at once: Flight::records() knows nothing of it then.
  std::function<std::unique_ptr<supervisor::PacketLog>(const Clock&)> make_log{};
};

/// Edit of a mission with a simulated hand: it rests until the test moves it.
void hand_rests(descriptor::Mission& mission);

class Flight {
 public:
  /// Throws std::runtime_error with what is wrong with the mission file or with a module: nothing could fly.
  explicit Flight(Plan plan);

  [[nodiscard]] Spacecraft& craft() noexcept { return *craft_; }
  [[nodiscard]] Story& story() noexcept { return story_; }
  /// From now on this text stands in for the file of this name.
  void write(const std::string& file_name, std::string text) { files_[file_name] = std::move(text); }
  [[nodiscard]] const descriptor::Mission& mission() const noexcept { return *mission_; }
  [[nodiscard]] std::vector<supervisor::LogRecord> records();
  /// Runs until the start mode is commissioned; false when it never is.
  [[nodiscard]] bool commission();
  /// As the vital page says; Offline when the process is gone.
  [[nodiscard]] State state(std::string_view subsystem);
  [[nodiscard]] std::uint32_t inhibited(std::string_view subsystem);
  [[nodiscard]] bool run_until_state(std::string_view subsystem, State state, Duration limit);
  [[nodiscard]] std::uint64_t cycles(std::string_view subsystem);
  template <class Device>
  [[nodiscard]] Device& device(std::string_view name) {
    return dynamic_cast<Device&>(*craft_->device(name));
  }
  CommandOutcome set_state(std::string_view subsystem, State state);
  CommandOutcome configure(std::string_view subsystem, std::string_view configuration);
  /// The whole craft into this mode.
  CommandOutcome set_mode(std::string_view mode);
  /// What it permits, and nobody moves.
  CommandOutcome enter_mode(std::string_view mode);
  /// Sends octets as they are and returns the first report of service 1 on them that is a failure or a completion.
  struct Verdict {
    std::uint8_t subtype{0};
    std::uint16_t code{0};
    std::uint16_t apid{0};  ///< who reported
  };
  Verdict send(Octets packet);

 private:
  std::map<std::string, std::string> files_;
  std::optional<descriptor::Mission> mission_;
  supervisor::MemoryDatabase log_;
  Story story_;
  Modules modules_;
  std::unique_ptr<Spacecraft> craft_;
};

}  // namespace hirosco::simulation
