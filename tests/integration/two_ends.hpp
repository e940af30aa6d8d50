// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "tests/integration/flight.hpp"

/// A whole spacecraft of two subsystems and the link between them, with authors of the test: supervisor, handshake, cycles, ground.
namespace hirosco::testing {

/// Makes an author of a flight and lets the test look into it.
template <class Author>
std::function<std::unique_ptr<Subsystem>()> making(Author*& made) {
  return [&made] {
    auto author = std::make_unique<Author>();
    made = author.get();
    return author;
  };
}

struct LinkedEnd {
  std::string name;  ///< of the subsystem
  std::string configuration;  ///< that the mission commissions
  std::string set;
  std::string descriptor;  ///< text
  std::function<std::unique_ptr<Subsystem>()> make;
};

/// Mode "operation" commissions both Operational and brings up link 1. `link`: more attributes of it; `permits`: more elements of the mode.
inline Plan two_ends(const LinkedEnd& from, const LinkedEnd& to, const std::string& link = {},
                     const std::string& permits = {}) {
  const auto started = [](const LinkedEnd& end) {
    return "<Subsystem executable=\"end-" + end.name + "\" descriptor=\"end-" + end.name + ".xml\"/>";
  };
  const auto commissioned = [](const LinkedEnd& end) {
    return "<Commission subsystem=\"" + end.name + "\" configuration=\"" + end.configuration +
           "\" state=\"Operational\"/>";
  };
  std::string mission = R"(<Mission name="TWO_ENDS">
  <Supervisor descriptor="../../supervisor/supervisor.xml">
    <Database strategy="sqlite" path="log/two_ends.db"/>
    <Ground subsystem="COMMUNICATION" telemetry="127.0.0.1:10015" telecommand="127.0.0.1:10025"/>
  </Supervisor>
  <Subsystem executable="hirosco-communication" descriptor="../../subsystems/communication/communication.xml"/>
  )" + started(from) + started(to) +
                        "<Links><Link id=\"1\" from=\"" + from.name + "." + from.set + "\" to=\"" + to.name + "." +
                        to.set + "\" " + link + R"(/></Links>
  <Modes initial="commissioning" start="operation">
    <Mode name="commissioning"><Permit subsystem="*" functions="SET_STATE CONFIGURE SET_MODE SHUTDOWN"/></Mode>
    <Mode name="operation">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>)" +
                        commissioned(from) + commissioned(to) + R"(
      <Establish link="1"/>
      <Permit subsystem="SUPERVISOR" functions="SET_MODE SHUTDOWN LINK UNLINK"/>)" +
                        permits + R"(
    </Mode>
  </Modes>
  <Recovery><Plan name="ground-lost"><When event="GROUND_LINK_LOST"/><Do action="log"/></Plan></Recovery>
</Mission>)";
  return {.mission = "hello",
          .subsystems = {{"end-" + from.name, from.make}, {"end-" + to.name, to.make}},
          .files = {{"mission.xml", std::move(mission)},
                    {"end-" + from.name + ".xml", from.descriptor},
                    {"end-" + to.name + ".xml", to.descriptor}}};
}

/// Numbers its cycles, and turns by a milliradian in each.
struct Encoder final : Subsystem {
  Parameter<std::uint64_t> number;
  Parameter<double> angle;

 protected:
  Result<Step> software_init() override {
    publish("NUMBER", number);
    publish("ANGLE", angle);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return turn(); }
  Result<> safe_operational(const Cycle&) noexcept override { return turn(); }
  Result<> operational(const Cycle&) noexcept override { return turn(); }

 private:
  Result<> turn() noexcept {
    const std::uint64_t next = number.load() + 1;
    number.store(next);
    angle.store(0.001 * static_cast<double>(next));
    return ok();
  }
};

}  // namespace hirosco::testing
