// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/api/api.hpp"
#include "ground/api/session.hpp"
#include "ground/archive/archive.hpp"
#include "ground/model/catalogue.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

/// The ground station beside the whole spacecraft on virtual time: everything but the sockets.
namespace hirosco::testing {

using nlohmann::json;

/// A page that keeps what it was told. `takes` false: its network has stopped.
class Page final : public ground::Peer {
 public:
  void send(std::string text) override {
    octets += text.size();
    if (!takes) pending += text.size();
    messages.push_back(json::parse(text));
  }
  [[nodiscard]] std::size_t pending_octets() const override { return pending; }
  void close(std::uint16_t code, const std::string&) override { closed_with = code; }

  [[nodiscard]] std::vector<json> of_type(const std::string& type) const {
    std::vector<json> found;
    for (const json& message : messages)
      if (message["type"] == type) found.push_back(message);
    return found;
  }
  [[nodiscard]] json last(const std::string& type) const {
    const auto found = of_type(type);
    return found.empty() ? json{} : found.back();
  }

  std::vector<json> messages;
  std::size_t octets{0};
  std::size_t pending{0};
  bool takes{true};
  int closed_with{0};
};

class Station {
 public:
  static constexpr const char* token = "right";

  explicit Station(simulation::Flight& flight, const std::string& archive = ":memory:");
  ~Station();

  /// Lets the spacecraft fly while the station listens, with a batch every 50 ms.
  void run(Duration span);
  bool run_until(const std::function<bool()>& condition, Duration limit = 10s);
  void cut_link();
  void join_link();
  /// Into a simulated device, past the station, which is told of it as by the file that each device writes.
  Result<> inject(const std::string& device, const std::string& line);
  /// The answer to a request as `who`; runs until it has come.
  ground::HttpResponse ask(const std::string& method, const std::string& target, const json& body = {},
                           std::map<std::string, std::string> headers = {});
  json get(const std::string& target) { return json::parse(ask("GET", target).body); }
  json post(const std::string& target, const json& body) { return json::parse(ask("POST", target, body).body); }
  /// Sends a telecommand and waits for its last report; the command as the archive has it.
  json command(const std::string& subsystem, const std::string& function, const json& arguments = json::object());

  [[nodiscard]] ground::Session& session() noexcept { return *session_; }
  [[nodiscard]] const ground::Catalogue& catalogue() const noexcept { return catalogue_; }

 private:
  class CraftClock final : public Clock {
   public:
    explicit CraftClock(simulation::Spacecraft& craft) : craft_{craft} {}

   private:
    [[nodiscard]] TimePoint do_now() const noexcept override { return craft_.now(); }
    [[nodiscard]] OnboardTime do_onboard() const noexcept override {
      return OnboardTime{std::chrono::seconds{2'145'916'837}} + craft_.now().time_since_epoch();
    }
    simulation::Spacecraft& craft_;
  };

  simulation::Flight& flight_;
  CraftClock clock_;
  ground::Catalogue catalogue_;
  std::unique_ptr<ground::Archive> archive_;
  std::unique_ptr<ground::Session> session_;
  std::unique_ptr<ground::Api> api_;
  std::vector<ground::StoredFault> injected_;  ///< that the station has not been told of yet
  bool linked_{false};
};

[[nodiscard]] inline simulation::Plan rokviss(const char* start_mode = "telepresence") {
  simulation::Plan plan;
  plan.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/rokviss/mission.xml";
  plan.edit = [start_mode](auto& mission) {
    simulation::hand_rests(mission);
    mission.start_mode = start_mode;
  };
  return plan;
}

[[nodiscard]] inline json subsystem_of(const json& status, const std::string& name) {
  for (const json& one : status["subsystems"])
    if (one["name"] == name) return one;
  return {};
}

class GroundStation : public ::testing::Test {
 protected:
  void commission() {
    ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
    station.run(1s);
  }
  simulation::Flight flight{rokviss()};
  Station station{flight};
};

/// A packet of the spacecraft as its link would bring it, at a time and with data of our choice.
[[nodiscard]] inline std::vector<std::byte> telemetry(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype,
                                                      OnboardTime t, Octets data) {
  std::array<std::byte, pus::max_telemetry_octets> buffer;
  const auto written =
      pus::write_telemetry(buffer, {.apid = apid, .service = service, .subtype = subtype, .time = t}, data);
  EXPECT_TRUE(written);
  return {written->begin(), written->end()};
}
[[nodiscard]] inline std::vector<std::byte> joints(OnboardTime t, double first) {
  std::array<std::byte, 256> buffer;
  OctetWriter writer{buffer};
  writer.put(std::uint16_t{4713});
  for (int i = 0; i < 8; ++i) writer.put(i == 0 ? first : 0.0);
  return telemetry(10, 3, 25, t, Octets{buffer}.first(writer.size()));
}
inline constexpr OnboardTime noon{std::chrono::seconds{2'145'916'900}};
inline constexpr const char* first_joint = "MANIPULATOR.CUR_VALUES.POSITION[0]";

}  // namespace hirosco::testing
