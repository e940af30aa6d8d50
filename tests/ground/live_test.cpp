// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "tests/ground/station.hpp"

/// What pages are told of a flying spacecraft, and what becomes of their telecommands and of those of others.
namespace hirosco::testing {
namespace {

using simulation::Flight;

TEST_F(GroundStation, ShowsModeStatesLinksAndValuesOfACommissionedSpacecraft) {
  commission();
  const json status = station.get("/api/status");
  EXPECT_EQ(status["mode"], "telepresence");
  EXPECT_EQ(subsystem_of(status, "MANIPULATOR")["state"], "Operational");
  EXPECT_EQ(subsystem_of(status, "MANIPULATOR")["configuration"], "COUPLED");
  EXPECT_GT(subsystem_of(status, "MANIPULATOR")["cycles"].get<int>(), 1000);
  EXPECT_EQ(status["links"][0]["up"], true);
  EXPECT_NEAR(status["links"][0]["rate_hz"].get<double>(), 2000.0, 1.0);
  EXPECT_LE(status["links"][0]["age_cycles"].get<double>(), 3.0);
  EXPECT_LE(status["link"]["age_s"].get<double>(), 0.1);
  const json position = status["values"]["MANIPULATOR.CUR_VALUES.POSITION[0]"];
  const auto truth = flight.state("MANIPULATOR");
  EXPECT_EQ(truth, State::Operational);
  EXPECT_NEAR(position["v"].get<double>(), -0.8, 0.05);
  EXPECT_LE(position["age_s"].get<double>(), 0.15);
}

TEST_F(GroundStation, TellsLossAndLatencyOfEachLinkThatIsUp) {
  commission();
  station.run(2s);
  const auto links = station.get("/api/status")["links"];
  EXPECT_EQ(links[0]["lost"], 0);
  EXPECT_EQ(links[1]["lost"], 0);
  // Both cycle at the same instants: who comes first waits a period for what the other writes then.
  EXPECT_EQ(links[0]["latency_mean_ns"].get<double>() + links[1]["latency_mean_ns"].get<double>(), 500'000);
  EXPECT_EQ(links[0]["latency_max_ns"], links[0]["latency_mean_ns"]);
  EXPECT_EQ(links[0]["jitter_ns"], 0) << "all samples take the same time here";
  EXPECT_EQ(links[0]["age_at_use_us"].get<double>() * 1e3, links[0]["latency_mean_ns"].get<double>());
  for (std::size_t i = 0; i < 2; ++i) {
    const auto histogram = links[i]["latencies"];
    EXPECT_EQ(histogram["period_ns"], 500'000);
    const auto counts = histogram["counts"].get<std::vector<std::uint32_t>>();
    ASSERT_EQ(counts.size(), 9U);
    // In the simulation a sample takes nothing or exactly one period, which is still within it.
    const std::size_t bin = links[i]["latency_mean_ns"] == 0 ? 0 : 6;
    EXPECT_GT(counts[bin], 2000U);
    EXPECT_EQ(std::reduce(counts.begin(), counts.end()), counts[bin]);
    EXPECT_LE(counts[bin], links[i]["samples"].get<std::uint32_t>());
  }
  EXPECT_TRUE(links[2]["latencies"].is_null());
  EXPECT_TRUE(links[2]["lost"].is_null()) << "not up in this mode";
  EXPECT_TRUE(links[2]["latency_mean_ns"].is_null());
  EXPECT_TRUE(links[2]["jitter_ns"].is_null());
  EXPECT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "unplug"}})["answer"], "ok");
  station.run(3s);
  EXPECT_TRUE(station.get("/api/status")["links"][0]["lost"].is_null()) << "what is down loses nothing";
}

TEST(GroundStationOfALinkOverGround, TellsApartTheLinksIntoOneConsumer) {
  Flight flight{rokviss("remote")};
  Station station{flight};
  ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
  station.run(2s);
  const auto links = station.get("/api/status")["links"];
  // COMMUNICATION and the joystick cycle at 500 Hz, the robot at 2 kHz: three of four of its sets come and go in between.
  EXPECT_EQ(links[2]["lost"], 0);
  EXPECT_NEAR(links[4]["lost"].get<double>() / links[4]["samples"].get<double>(), 0.75, 0.01);
  EXPECT_LE(links[2]["latency_max_ns"], 2'000'000);
  EXPECT_LE(links[4]["latency_max_ns"], 500'000);
  EXPECT_EQ(links[3]["lost"], 0);
  EXPECT_EQ(links[5]["lost"], 0);
}

/// `hello` with twenty of its subsystem, of whom the first and the last are used.
[[nodiscard]] simulation::Plan crowd() {
  simulation::Plan plan;
  plan.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/hello/mission.xml";
  std::string mission = descriptor::file_system()(plan.mission).value();
  const auto replace = [&mission](const std::string& from, const std::string& to) {
    const std::size_t at = mission.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    mission.replace(at, from.size(), to);
  };
  const std::string one = R"(<Subsystem executable="hirosco-hello" descriptor="../../subsystems/hello/hello.xml")";
  std::string many;
  for (int i = 1; i <= 20; ++i)
    many += one + " name=\"HELLO_" + std::to_string(i) + "\" id=\"" + std::to_string(100 + i) + "\"/>";
  replace(one + "/>", many);
  const std::string step = R"(configuration="STAND_ALONE" state="Operational"/>)";
  replace(R"(<Commission subsystem="HELLO" )" + step,
          R"(<Commission subsystem="HELLO_1" )" + step + R"(<Commission subsystem="HELLO_20" )" + step);
  replace(R"(<Permit subsystem="HELLO" )", R"(<Permit subsystem="HELLO_20" )");
  plan.files["mission.xml"] = mission;
  return plan;
}

TEST(GroundStationOfACrowd, ShowsEachOfMoreThanSixteenSubsystems) {
  simulation::Flight flight{crowd()};
  Station station{flight};
  ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
  station.run(1s);
  const json status = station.get("/api/status");
  ASSERT_EQ(status["subsystems"].size(), 22U);  // with the supervisor and the ground link
  for (const json& one : status["subsystems"]) {
    const std::string name = one["name"];
    const bool used = name == "SUPERVISOR" || name == "COMMUNICATION" || name == "HELLO_1" || name == "HELLO_20";
    EXPECT_EQ(one["state"], used ? "Operational" : "Offline") << name;
    EXPECT_TRUE(one["age_s"].is_number()) << name;
    EXPECT_EQ(one["cycles"].get<int>() > 0, used) << name;
  }
}

TEST_F(GroundStation, SaysWhatASubsystemWaitsForAndNothingWhenItIsReady) {
  commission();
  station.command("SUPERVISOR", "SET_MODE", {{"MODE", "commissioning"}});
  for (const char* state : {"SafeOperational", "PostOperational", "PreOperational"})
    EXPECT_EQ(station.command("JOYSTICK", "SET_STATE", {{"STATE", state}})["stage"], "completed");
  EXPECT_EQ(station.command("JOYSTICK", "CONFIGURE", {{"CONFIGURATION", "COUPLED"}})["stage"], "completed");
  station.run(500ms);
  // A link whose end has another configuration is negotiated anew by itself (adr 0094).
  EXPECT_EQ(subsystem_of(station.get("/api/status"), "JOYSTICK")["waits_for"], "");
  EXPECT_EQ(station.command("SUPERVISOR", "UNLINK", {{"LINK", 1}})["stage"], "completed");
  station.run(500ms);
  EXPECT_EQ(subsystem_of(station.get("/api/status"), "JOYSTICK")["waits_for"], "link 1 from MANIPULATOR.ROBOT_STATE");
  EXPECT_EQ(station.command("SUPERVISOR", "LINK", {{"LINK", 1}})["stage"], "completed");
  station.run(500ms);
  EXPECT_EQ(subsystem_of(station.get("/api/status"), "JOYSTICK")["waits_for"], "");
}

TEST_F(GroundStation, EveryPageSeesEveryStageOfEverybodysTelecommands) {
  commission();
  Page one, other;
  station.session().pages().opened(one, true);
  station.session().pages().opened(other, true);
  const json sent = station.post("/api/commands", {{"subsystem", "JOYSTICK"},
                                                   {"function", "SET_FORCE_SCALE"},
                                                   {"arguments", {{"SCALE", 0.05}}},
                                                   {"sender", "anna"}});
  station.run(1s);
  for (const Page* page : {&one, &other}) {
    std::string stages;
    for (const json& message : page->of_type("command")) {
      EXPECT_EQ(message["id"], sent["id"]);
      EXPECT_EQ(message["sender"], "anna");
      stages += message["stage"].get<std::string>() + " ";
    }
    EXPECT_EQ(stages, "sent accepted started completed ");
  }
}

TEST(GroundStationOfAnAuthorsRefusal, CallsItByItsNameInTheDescriptorEverywhere) {
  Flight flight{rokviss("standalone")};
  Station station{flight};
  ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
  station.run(1s);
  Page page;
  station.session().pages().opened(page, true);
  const json refused = station.command("MANIPULATOR", "MOVE_TO", {{"Q1", 1.0}, {"Q2", 2.6}, {"DURATION", 0.2}});
  EXPECT_EQ(refused["stage"], "failed");
  EXPECT_EQ(refused["code"], 0x8002);
  EXPECT_EQ(refused["reason"], "TOO_FAST");
  EXPECT_EQ(refused["reports"].back()["reason"], "TOO_FAST");
  EXPECT_EQ(page.last("command")["reason"], "TOO_FAST");
}

/// What `send` makes of a telecommand of another ground in the history; the newest command.
class AnotherGround : public GroundStation {
 protected:
  json send(std::uint16_t apid, std::uint8_t service, std::uint16_t source, Octets data) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = apid,
                                                .sequence_count = count++,
                                                .ack = pus::ack_all,
                                                .service = service,
                                                .subtype = 1,
                                                .source = source},
                                               data);
    EXPECT_TRUE(packet);
    flight.craft().ground().send(*packet);
    station.run(300ms);
    return station.get("/api/commands?limit=1")["commands"][0];
  }
  json call(const char* subsystem, const char* function, std::vector<double> values, std::uint16_t source) {
    const auto& descriptor = *station.catalogue().find(std::string_view{subsystem});
    const auto functions = station.catalogue().functions_of(descriptor);
    const auto found = std::ranges::find(functions, function, &descriptor::Function::name);
    const auto data = pus::encode_call(*found, std::span<const double>{values});
    EXPECT_TRUE(data);
    return send(descriptor.id, 8, source, *data);
  }
  std::uint16_t count{7};
};

TEST_F(AnotherGround, ShowsItsTelecommandsWithFunctionArgumentsSenderAndWhatBecameOfThem) {
  commission();
  Page page;
  station.session().pages().opened(page, true);
  const json scaled = call("JOYSTICK", "SET_FORCE_SCALE", {0.05}, 0x4001);
  EXPECT_EQ(scaled["function"], "SET_FORCE_SCALE");
  EXPECT_EQ(scaled["arguments"], (json{{"SCALE", 0.05}}));
  EXPECT_EQ(scaled["sender"], "hirosco tc (16385)");
  EXPECT_EQ(scaled["subsystem"], "JOYSTICK");
  EXPECT_EQ(scaled["stage"], "completed");
  std::string stages;
  for (const json& message : page.of_type("command")) {
    EXPECT_EQ(message["function"], "SET_FORCE_SCALE");
    stages += message["stage"].get<std::string>() + " ";
  }
  EXPECT_EQ(stages, "sent accepted started completed ");
  const json ping = send(11, 17, 777, {});
  EXPECT_EQ(ping["function"], "PING");
  EXPECT_EQ(ping["sender"], "another ground (777)");
  const json state = call("MANIPULATOR", "SET_STATE", {4}, 0x8001);
  EXPECT_EQ(state["arguments"], (json{{"STATE", "SafeOperational"}}));
  EXPECT_EQ(state["sender"], "a Python client (32769)");
  EXPECT_EQ(state["stage"], "completed");
}

TEST_F(AnotherGround, ShowsWhatWasRefusedAndWhatCannotBeRead) {
  commission();
  const json refused = call("MANIPULATOR", "MOVE_TO", {-0.8, 1.6, 2.0}, 0x2001);
  EXPECT_EQ(refused["function"], "MOVE_TO");
  EXPECT_EQ(refused["arguments"], (json{{"Q1", -0.8}, {"Q2", 1.6}, {"DURATION", 2}}));
  EXPECT_EQ(refused["sender"], "another ground station (8193)");
  EXPECT_EQ(refused["stage"], "failed");
  EXPECT_EQ(refused["code"], static_cast<int>(pus::FailureCode::WrongMode));
  const std::vector<std::byte> markup(40, std::byte{'<'});
  const json garbled = send(10, 8, 777, markup);
  EXPECT_EQ(garbled["function"], std::string(16, '<'));
  EXPECT_EQ(garbled["arguments"], json::object());
  EXPECT_EQ(send(10, 20, 777, markup)["function"], "TC[20,1]");
  EXPECT_EQ(send(10, 8, 777, {})["function"], "?");
  const std::vector<std::byte> longest(pus::max_telecommand_octets - pus::telecommand_overhead_octets, std::byte{'A'});
  EXPECT_EQ(send(10, 8, 777, longest)["function"], "?");
}

TEST_F(AnotherGround, ItsQuestionsToTheSupervisorAreNoTelecommands) {
  commission();
  std::array<std::byte, 64> buffer;
  const auto asked = pus::write_telecommand(
      buffer, {.apid = 11, .sequence_count = 7, .ack = pus::ack_all, .service = 17, .subtype = 1, .source = 777}, {});
  ASSERT_TRUE(asked);
  std::array<std::byte, 128> question;
  const auto packet = pus::write_telecommand(
      question, {.apid = 1, .sequence_count = 8, .ack = 0, .service = 129, .subtype = 1, .source = 777}, *asked);
  ASSERT_TRUE(packet);
  flight.craft().ground().send(*packet);
  station.run(300ms);
  EXPECT_EQ(station.get("/api/commands")["commands"].size(), 0U);
}

/// Asking before and sending must agree, for whatever function in whatever situation.
TEST_F(GroundStation, TheSupervisorSaysBeforeSendingWhatItSaysOnSending) {
  commission();
  struct Case {
    const char* subsystem;
    const char* function;
    json arguments;
  };
  const std::vector<Case> cases{{"MANIPULATOR", "MOVE_TO", {{"Q1", -1}, {"Q2", 1.5}, {"DURATION", 1}}},
                                {"MANIPULATOR", "SET_GAINS", {{"KP", 300}, {"KD", 24}}},
                                {"MANIPULATOR", "SET_TORQUE_LIMIT", {{"LIMIT", 12}}},
                                {"MANIPULATOR", "PING", json::object()},
                                {"JOYSTICK", "CENTRE", json::object()},
                                {"JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.05}}},
                                {"COMMUNICATION", "PING", json::object()},
                                {"SUPERVISOR", "LINK", {{"LINK", 1}}},
                                {"SUPERVISOR", "SET_DATABASE", {{"STRATEGY", "sqlite"}}}};
  int refused = 0, permitted = 0;
  for (const char* mode : {"telepresence", "commissioning", "standalone", "safe"}) {
    station.command("SUPERVISOR", "SET_MODE", {{"MODE", mode}});
    station.run(300ms);
    for (const auto& [subsystem, function, arguments] : cases) {
      SCOPED_TRACE(std::string{mode} + " " + subsystem + " " + function);
      const json body{{"subsystem", subsystem}, {"function", function}, {"arguments", arguments}};
      const json asked = station.post("/api/commands/preview", body);
      const json done = station.command(subsystem, function, arguments);
      ASSERT_TRUE(asked["permitted"].is_boolean()) << asked.dump();
      const json first = done["reports"][0];
      EXPECT_EQ(asked["permitted"].get<bool>(), first["stage"] == "accepted") << done.dump();
      if (!asked["permitted"].get<bool>()) {
        EXPECT_EQ(asked["code"], first["code"]);
      }
      asked["permitted"].get<bool>() ? ++permitted : ++refused;
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(permitted, 8);
}

TEST_F(GroundStation, WhatAModeWouldTakeIsTheSupervisorsOwnAnswer) {
  commission();
  const json asked = station.post("/api/modes/preview", {{"mode", "standalone"}});
  EXPECT_EQ(asked["mode"], "standalone");
  EXPECT_EQ(asked["against"], json::array());
  ASSERT_FALSE(asked["steps"].empty());
  EXPECT_EQ(asked["steps"][0]["stage"], 1);
  std::set<std::string> moved;
  for (const json& step : asked["steps"]) moved.insert(step["subsystem"].get<std::string>());
  EXPECT_TRUE(moved.contains("MANIPULATOR"));
  EXPECT_EQ(station.ask("POST", "/api/modes/preview", {{"mode", "nowhere"}}).status, 400U);
  station.cut_link();
  EXPECT_EQ(station.ask("POST", "/api/modes/preview", {{"mode", "standalone"}}).status, 503U);
}

TEST_F(GroundStation, AnArgumentThatDoesNotFitIsNamedAndNothingIsSent) {
  commission();
  const auto error = [&](const json& arguments, const char* function = "MOVE_TO") {
    const auto answer = station.ask("POST", "/api/commands",
                                    {{"subsystem", "MANIPULATOR"}, {"function", function}, {"arguments", arguments}});
    EXPECT_EQ(answer.status, 400U);
    return json::parse(answer.body)["error"].get<std::string>();
  };
  const json good{{"Q1", 0}, {"Q2", 1}, {"DURATION", 2}};
  const auto with = [&](const char* name, json value) {
    json arguments = good;
    arguments[name] = std::move(value);
    return arguments;
  };
  EXPECT_EQ(error(with("Q1", 1.01)), "Q1: 1.01 is above its maximum 1 rad");
  EXPECT_EQ(error(with("Q1", -2.01)), "Q1: -2.01 is below its minimum -2 rad");
  EXPECT_EQ(error(with("Q2", "NaN")), "Q2: neither a number nor a name that it knows");
  EXPECT_EQ(error(with("Q2", json::array({1, 2}))), "Q2: 1 values are wanted");
  EXPECT_EQ(error(with("Q3", 1)), "MOVE_TO has no argument 'Q3'");
  EXPECT_EQ(error({{"Q1", 0}}), "Q2: a value is wanted");
  EXPECT_EQ(error(json::array()), "arguments: an object {name: value} is wanted");
  EXPECT_EQ(error({{"STATE", "Asleep"}}, "SET_STATE"), "STATE: neither a number nor a name that it knows");
  EXPECT_EQ(error({}, "DANCE"), "MANIPULATOR has no function 'DANCE'");
  EXPECT_EQ(station.get("/api/commands")["commands"].size(), 0U);
}

TEST_F(GroundStation, AStalledPageLosesHousekeepingNotEventsAndTheOthersNothing) {
  commission();
  Page good, stalled;
  station.session().pages().opened(good, true);
  station.session().pages().opened(stalled, true);
  stalled.takes = false;
  station.run(1s);
  stalled.pending = std::size_t{1} << 20;
  const std::size_t before = stalled.of_type("values").size();
  const std::size_t good_before = good.of_type("values").size();
  EXPECT_EQ(station.post("/api/faults", {{"device", "robot"}, {"line", "temperature 1 60"}})["answer"], "ok");
  station.run(1s);
  EXPECT_EQ(stalled.of_type("values").size(), before);
  EXPECT_GE(good.of_type("event").size(), 1U);
  EXPECT_EQ(stalled.of_type("event").size(), good.of_type("event").size());
  EXPECT_GE(good.of_type("values").size() - good_before, 19U);
  // What piled up goes on when its network does: the newest values at once.
  stalled.takes = true;
  stalled.pending = 0;
  station.run(50ms);
  EXPECT_EQ(stalled.of_type("values").size(), before + 1);

  stalled.pending = std::size_t{5} << 20;
  station.post("/api/faults", {{"device", "robot"}, {"line", "temperature 1 40"}});
  EXPECT_EQ(stalled.closed_with, 1013);
  EXPECT_EQ(good.closed_with, 0);
}

TEST_F(GroundStation, ASpacecraftThatBeginsAgainWithAnEarlierClockIsShownAndWhatItHasNotToldAgainIsOld) {
  ASSERT_TRUE(station.session().receive(joints(noon, 1.0)));
  const std::vector<std::byte> event(2);
  ASSERT_TRUE(station.session().receive(telemetry(11, 5, 1, noon - 1h, event)));
  json status = station.get("/api/status");
  EXPECT_NEAR(status["t"].get<double>(), 2'145'916'900.0 - 3600.0, 1.0);
  EXPECT_EQ(status["values"][first_joint]["v"], 1);
  EXPECT_GT(status["values"][first_joint]["age_s"].get<double>(), 1e6);
  ASSERT_TRUE(station.session().receive(joints(noon - 1h, 2.0)));
  status = station.get("/api/status");
  EXPECT_EQ(status["values"][first_joint]["v"], 2);
  EXPECT_NEAR(status["values"][first_joint]["age_s"].get<double>(), 0.0, 1.0);
}

TEST_F(GroundStation, PacketsThatOvertookEachOtherLeaveTheNewestValue) {
  ASSERT_TRUE(station.session().receive(joints(noon, 1.0)));
  ASSERT_TRUE(station.session().receive(joints(noon - 100ms, 2.0)));
  EXPECT_EQ(station.get("/api/status")["values"][first_joint]["v"], 1);
}

}  // namespace
}  // namespace hirosco::testing
