// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <fstream>

#include "hirosco/pus/housekeeping_decoder.hpp"
#include "hirosco/pus/st08_function.hpp"
#include "tests/ground/station.hpp"

namespace hirosco::testing {

Station::Station(simulation::Flight& flight, const std::string& archive)
    : flight_{flight}, clock_{flight.craft()}, catalogue_{flight.mission()} {
  auto opened = ground::Archive::open(archive);
  if (!opened) throw std::runtime_error{opened.error().text};
  archive_ = std::move(*opened);
  ground::Surroundings outside;
  outside.send = [this](Octets packet) {
    if (linked_) flight_.craft().ground().send(packet);
    return linked_;
  };
  outside.ask_device = [this](const std::string& device, const std::string& line, const auto& done) {
    const auto result = flight_.craft().device(device)->fault(line);
    done(result ? std::string{"ok"} : std::string{result.error().text});
  };
  session_ = std::make_unique<ground::Session>(ground::Session::Parts{
      .catalogue = catalogue_, .archive = *archive_, .clock = clock_, .outside = std::move(outside)});
  ground::Api::Options options;
  options.token = token;
  options.observer_token = "looker";
  options.page = "no/such/folder";
  api_ = std::make_unique<ground::Api>(*session_, options);
  join_link();
}

Station::~Station() { flight_.craft().ground().on_telemetry({}); }

void Station::join_link() {
  linked_ = true;
  session_->link_up();
  flight_.craft().ground().on_telemetry([this](Octets packet) { EXPECT_TRUE(session_->receive(packet)); });
}

void Station::cut_link() {
  linked_ = false;
  flight_.craft().ground().on_telemetry({});
  session_->link_down();
}

void Station::run(Duration span) {
  for (Duration done{0}; done < span; done += 50ms) {
    flight_.craft().run(std::min<Duration>(50ms, span - done));
    session_->tick();
  }
}

bool Station::run_until(const std::function<bool()>& condition, Duration limit) {
  for (Duration done{0}; done < limit && !condition(); done += 50ms) run(50ms);
  return condition();
}

ground::HttpResponse Station::ask(const std::string& method, const std::string& target, const json& body,
                                  std::map<std::string, std::string> headers) {
  headers.try_emplace("host", "127.0.0.1:8080");
  headers.try_emplace("authorization", std::string{"Bearer "} + token);
  std::optional<ground::HttpResponse> answer;
  api_->handle({method, target, headers, body.is_null() ? "" : body.dump()},
               [&](ground::HttpResponse response) { answer = std::move(response); });
  run_until([&] { return answer.has_value(); });
  return answer.value_or(ground::HttpResponse{.status = 0, .type = {}, .body = "{}", .headers = {}});
}

json Station::command(const std::string& subsystem, const std::string& function, const json& arguments) {
  json sent = post("/api/commands", {{"subsystem", subsystem}, {"function", function}, {"arguments", arguments}});
  if (!sent.contains("id")) return sent;
  json command;
  run_until([&] {
    command = get("/api/commands?limit=1")["commands"][0];
    return command["stage"] == "completed" || command["stage"] == "failed";
  });
  return command;
}

namespace {

using simulation::Flight;
using simulation::hand_rests;
using ::testing::HasSubstr;

simulation::Plan rokviss() {
  simulation::Plan plan;
  plan.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/rokviss/mission.xml";
  plan.edit = hand_rests;
  return plan;
}

json subsystem_of(const json& status, const std::string& name) {
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
  Flight flight{rokviss()};
  Station station{flight};
};

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

TEST_F(GroundStation, TellsTheSamplesThatTheConsumerOfALinkHasLostWhileTheLinkIsUp) {
  commission();
  station.run(2s);
  const auto links = station.get("/api/status")["links"];
  EXPECT_EQ(links[0]["lost"], 0);
  EXPECT_EQ(links[1]["lost"], 0);
  EXPECT_TRUE(links[2]["lost"].is_null()) << "not up in this mode";
  EXPECT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "unplug"}})["answer"], "ok");
  station.run(3s);
  EXPECT_TRUE(station.get("/api/status")["links"][0]["lost"].is_null()) << "what is down loses nothing";
}

TEST_F(GroundStation, SaysWhatASubsystemWaitsForAndNothingWhenItIsReady) {
  commission();
  station.command("SUPERVISOR", "SET_MODE", {{"MODE", "commissioning"}});
  for (const char* state : {"SafeOperational", "PostOperational", "PreOperational"})
    EXPECT_EQ(station.command("JOYSTICK", "SET_STATE", {{"STATE", state}})["stage"], "completed");
  EXPECT_EQ(station.command("JOYSTICK", "CONFIGURE", {{"CONFIGURATION", "COUPLED"}})["stage"], "completed");
  station.run(500ms);
  EXPECT_EQ(subsystem_of(station.get("/api/status"), "JOYSTICK")["waits_for"], "link 1 from MANIPULATOR.ROBOT_STATE");
  EXPECT_EQ(station.command("SUPERVISOR", "LINK", {{"LINK", 1}})["stage"], "completed");
  station.run(500ms);
  EXPECT_EQ(subsystem_of(station.get("/api/status"), "JOYSTICK")["waits_for"], "");
}

TEST_F(GroundStation, EveryPageSeesEveryStageOfEverybodysTelecommands) {
  commission();
  Page one, other;
  station.session().opened(one, true);
  station.session().opened(other, true);
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
  station.session().opened(page, true);
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

TEST_F(GroundStation, HistoryIsWhatTheLiveViewShowedAndLongOnesKeepTheirExtremes) {
  commission();
  Page page;
  station.session().opened(page, true);
  const double from = station.get("/api/status")["t"].get<double>();
  station.run(2s);
  const std::string name = "MANIPULATOR.CUR_VALUES.TORQUE[1]";
  std::map<double, double> live;
  for (const json& message : page.of_type("values"))
    if (message["set"].contains(name))
      live[message["set"][name][1].get<double>()] = message["set"][name][0].get<double>();
  const json history = station.get("/api/history?parameter=" + name + "&from=" + std::to_string(from));
  std::map<double, double> past;
  for (std::size_t i = 0; i < history["t"].size(); ++i)
    past[history["t"][i].get<double>()] = history["v"][i].get<double>();
  EXPECT_GE(live.size(), 35U);  // 20 a second, in batches of the same rate
  for (const auto& [t, value] : live)
    if (t >= from) {
      EXPECT_EQ(past.at(t), value);
    }
  EXPECT_EQ(history["unit"], "N m");

  const json few = station.get("/api/history?parameter=" + name + "&points=10&from=" + std::to_string(from));
  EXPECT_LE(few["t"].size(), 10U);
  const auto all = history["v"].get<std::vector<double>>();
  EXPECT_EQ(few["min"].size(), few["max"].size());
  EXPECT_EQ(std::ranges::min(few["min"].get<std::vector<double>>()), std::ranges::min(all));
  EXPECT_EQ(std::ranges::max(few["max"].get<std::vector<double>>()), std::ranges::max(all));
}

TEST_F(GroundStation, PlacesOfNumbersAgreeWithTheDecoderOfHousekeepingInAllReports) {
  std::size_t compared = 0;
  flight.story().on_telemetry = [&](const pus::TelemetryView& packet) {
    if (packet.service() != 3 || packet.subtype() != 25) return;
    const auto* subsystem = station.catalogue().find(packet.apid());
    const auto decoded = pus::HousekeepingDecoder{*subsystem}.decode(packet.source_data());
    const auto* report = station.catalogue().report_of(packet.apid(), packet.source_data());
    ASSERT_TRUE(decoded && report != nullptr);
    std::map<std::string, double> expected;
    for (const auto& value : *decoded)
      for (std::size_t i = 0; i < value.values.size(); ++i)
        expected[subsystem->name + "." + value.name + (value.values.size() == 1 ? "" : "[" + std::to_string(i) + "]")] =
            value.values[i];
    EXPECT_EQ(report->places.size(), expected.size());
    for (const auto& place : report->places) {
      const auto& column = station.catalogue().columns()[place.column];
      EXPECT_EQ(station.catalogue().read(place, packet.source_data()), expected.at(column.name)) << column.name;
      ++compared;
    }
  };
  commission();
  station.run(1s);
  EXPECT_GT(compared, 2000U);
}

TEST_F(GroundStation, ReplayTellsTheSameStoryAndLocksCommanding) {
  commission();
  const double from = station.get("/api/status")["t"].get<double>();
  Page live;
  station.session().opened(live, true);
  station.run(50ms);
  station.command("JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.05}});
  EXPECT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "unplug"}})["answer"], "ok");
  station.run(2s);
  const double to = station.get("/api/status")["t"].get<double>();

  Page page;
  const std::string client = station.session().opened(page, true);
  page.messages.clear();
  station.session().received(page, json{{"type", "replay"}, {"at", from}, {"speed", 10}}.dump());
  EXPECT_EQ(page.messages.front()["type"], "replay");
  const json first = page.last("status");
  EXPECT_EQ(subsystem_of(first, "JOYSTICK")["state"], "Operational");
  EXPECT_EQ(first["replay"], true);
  const auto refused =
      station.ask("POST", "/api/commands", {{"subsystem", "JOYSTICK"}, {"function", "CENTRE"}}, {{"x-client", client}});
  EXPECT_EQ(refused.status, 409U);
  ASSERT_TRUE(station.run_until([&] { return page.last("replay")["state"] == "ended"; }));
  const auto texts = [&](const Page& who) {
    std::vector<std::string> list;
    for (const json& message : who.messages) {
      if (message.contains("t") && message["t"].is_number() && message["t"].get<double>() > to) continue;
      if (message["type"] == "event")
        list.push_back(message["subsystem"].get<std::string>() + message["text"].get<std::string>());
    }
    return list;
  };
  EXPECT_EQ(texts(page), texts(live));
  EXPECT_GT(texts(page).size(), 5U);
  EXPECT_EQ(page.of_type("command").size(), live.of_type("command").size());
  EXPECT_EQ(page.of_type("fault").size(), 1U);
  EXPECT_EQ(subsystem_of(page.last("status"), "JOYSTICK")["state"], "Offline");

  station.session().received(page, R"({"type":"live"})");
  EXPECT_EQ(page.last("replay")["state"], "live");
  EXPECT_FALSE(page.last("status").contains("replay"));
  EXPECT_EQ(station
                .ask("POST", "/api/commands/preview", {{"subsystem", "JOYSTICK"}, {"function", "PING"}},
                     {{"x-client", client}})
                .status,
            200U);
}

TEST_F(GroundStation, ALinkThatWasAwayIsAGapAndValuesGrowOldMeanwhile) {
  commission();
  Page page;
  station.session().opened(page, true);
  station.cut_link();
  station.run(3s);
  const json away = station.get("/api/status");
  EXPECT_EQ(away["link"]["connected"], false);
  EXPECT_NEAR(away["link"]["age_s"].get<double>(), 3.0, 0.1);
  EXPECT_NEAR(away["values"]["MANIPULATOR.TIP_FORCE[0]"]["age_s"].get<double>(), 3.0, 0.2);
  EXPECT_EQ(station.ask("POST", "/api/commands", {{"subsystem", "JOYSTICK"}, {"function", "PING"}}).status, 503U);
  station.join_link();
  station.run(500ms);
  ASSERT_EQ(page.of_type("gap").size(), 1U);
  const json gap = page.last("gap");
  EXPECT_NEAR(gap["to"].get<double>() - gap["from"].get<double>(), 3.0, 0.2);
  const json history = station.get("/api/history?parameter=MANIPULATOR.TIP_FORCE[0]&last=10");
  ASSERT_EQ(history["gaps"].size(), 1U);
  EXPECT_EQ(history["gaps"][0]["from"], gap["from"]);
}

TEST_F(GroundStation, WhyTellsTheChainFromTheFaultToTheStop) {
  commission();
  EXPECT_EQ(station.get("/api/why")["causes"].size(), 0U);
  EXPECT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "unplug"}})["answer"], "ok");
  station.run(2s);
  std::string story;
  const json why = station.get("/api/why");
  for (const json& cause : why["causes"]) story += cause["text"].get<std::string>() + "\n";
  std::size_t at = 0;
  for (const char* part :
       {"injected: joystick unplug", "JOYSTICK reports high: JOYSTICK_LOST",
        "MANIPULATOR: STATE_CHANGED STATE=ErrorOperational", "MANIPULATOR: STATE_CHANGED STATE=Offline"}) {
    at = story.find(part, at);
    ASSERT_NE(at, std::string::npos) << part << " in\n" << story;
  }
}

TEST_F(GroundStation, AStalledPageLosesHousekeepingNotEventsAndTheOthersNothing) {
  commission();
  Page good, stalled;
  station.session().opened(good, true);
  station.session().opened(stalled, true);
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

/// A packet of the spacecraft as its link would bring it, at a time and with data of our choice.
[[nodiscard]] std::vector<std::byte> telemetry(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype,
                                               OnboardTime t, Octets data) {
  std::array<std::byte, pus::max_telemetry_octets> buffer;
  const auto written =
      pus::write_telemetry(buffer, {.apid = apid, .service = service, .subtype = subtype, .time = t}, data);
  EXPECT_TRUE(written);
  return {written->begin(), written->end()};
}
[[nodiscard]] std::vector<std::byte> joints(OnboardTime t, double first) {
  std::array<std::byte, 256> buffer;
  OctetWriter writer{buffer};
  writer.put(std::uint16_t{4713});
  for (int i = 0; i < 8; ++i) writer.put(i == 0 ? first : 0.0);
  return telemetry(10, 3, 25, t, Octets{buffer}.first(writer.size()));
}
constexpr OnboardTime noon{std::chrono::seconds{2'145'916'900}};
constexpr const char* first_joint = "MANIPULATOR.CUR_VALUES.POSITION[0]";

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

TEST_F(GroundStation, AReplayBeginsWithTheNewestValuesHoweverOldThoseOfOthersAre) {
  const ground::Report& other = station.catalogue().reports().back();
  ASSERT_NE(other.apid, 10);
  std::vector<std::byte> data(other.octets);
  OctetWriter{data}.put(other.sid);
  ASSERT_TRUE(station.session().receive(telemetry(other.apid, 3, 25, noon - 1h, data)));
  ASSERT_TRUE(station.session().receive(joints(noon, 1.0)));
  Page page;
  station.session().opened(page, true);
  station.session().received(page, json{{"type", "replay"}, {"at", 2'145'916'900.0}, {"speed", 0}}.dump());
  EXPECT_EQ(page.last("values")["replay"], true);
  EXPECT_EQ(page.last("values")["set"][first_joint][1], 2'145'916'900.0);
}

TEST_F(GroundStation, AReplayLeavesOutNoEventOfABurst) {
  const std::vector<std::byte> event(2);
  constexpr std::size_t burst = 3500;
  for (std::size_t i = 0; i < burst; ++i)
    ASSERT_TRUE(station.session().receive(telemetry(11, 5, 1, noon + 1s + i * 10us, event)));
  ASSERT_TRUE(station.session().receive(joints(noon + 3s, 1.0)));
  ASSERT_TRUE(station.session().receive(joints(noon, 1.0)));
  Page page;
  station.session().opened(page, true);
  page.messages.clear();
  station.session().received(page, json{{"type", "replay"}, {"at", 2'145'916'900.0}, {"speed", 100}}.dump());
  ASSERT_TRUE(station.run_until([&] { return page.last("replay")["state"] == "ended"; }));
  EXPECT_EQ(page.of_type("event").size(), burst);
}

TEST_F(GroundStation, ATimelineWithTooManyEventsHasTheNewest) {
  const std::vector<std::byte> event(2);
  for (int i = 0; i < 10'500; ++i) ASSERT_TRUE(station.session().receive(telemetry(11, 5, 1, noon + i * 1ms, event)));
  const json events = station.get("/api/timeline?from=2145916800&to=2145917000")["events"];
  ASSERT_EQ(events.size(), 10'000U);
  EXPECT_NEAR(events.front()["t"].get<double>(), 2'145'916'900.5, 0.001);
  EXPECT_NEAR(events.back()["t"].get<double>(), 2'145'916'910.499, 0.001);
}

TEST_F(GroundStation, ARequestThatNestsDeeperThanAnyIsRefused) {
  const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  ground::Api api{station.session(), {.token = "t", .observer_token = {}, .page = {}, .transitions = {}}};
  ground::HttpResponse answer;
  const std::string body = R"({"subsystem":"JOYSTICK","function":"PING","arguments":)" + nested(32'000) + "}";
  api.handle({"POST", "/api/commands", {{"host", "127.0.0.1:8080"}, {"authorization", "Bearer t"}}, body},
             [&](ground::HttpResponse response) { answer = std::move(response); });
  EXPECT_EQ(answer.status, 400U);
  EXPECT_THAT(answer.body, HasSubstr("a JSON object is wanted"));
}

TEST_F(GroundStation, WhatIsNoNumberOrSeverityIsNamedInsteadOfIgnored) {
  const auto error = [&](const char* target) {
    const auto answer = station.ask("GET", target);
    EXPECT_EQ(answer.status, 400U) << target;
    return json::parse(answer.body)["error"].get<std::string>();
  };
  EXPECT_EQ(error("/api/history?parameter=MANIPULATOR.TIP_FORCE[0]&points=many"), "points: a number is wanted");
  EXPECT_EQ(error("/api/timeline?from=nan"), "from: a number is wanted");
  EXPECT_EQ(error("/api/events?severity=urgent"), "severity: info, low, medium or high is wanted");
  EXPECT_EQ(station.ask("GET", "/api/events?from=&to=&severity=").status, 200U);
}

TEST_F(GroundStation, AnExportThatWouldHoldUpTheLiveViewIsRefused) {
  // As many columns as a request may have: each of them is a reading of the whole span.
  for (int i = 0; i < 20'000; ++i) ASSERT_TRUE(station.session().receive(joints(noon + i * 10ms, 1.0)));
  std::string target = "/api/export.csv?from=2145916800&to=2145917200";
  for (int i = 0; i < 64; ++i) target += "&parameter=" + std::string{first_joint};
  EXPECT_EQ(station.ask("GET", target).status, 413U);
  const auto one =
      station.ask("GET", "/api/export.csv?from=2145916800&to=2145917200&parameter=" + std::string{first_joint});
  EXPECT_EQ(one.status, 200U);
  EXPECT_EQ(std::ranges::count(one.body, '\n'), 20'001);
}

class GroundArchive : public ::testing::Test {
 protected:
  GroundArchive() { std::remove(file.c_str()); }
  ~GroundArchive() override { std::remove(file.c_str()); }
  const std::string file = ::testing::TempDir() + "ground-archive.db";
};

TEST_F(GroundArchive, AFloodOfEventsDoesNotGrowItBeyondItsLimit) {
  constexpr std::int64_t limit = 1 << 20;
  auto archive = ground::Archive::open(file, limit);
  ASSERT_TRUE(archive);
  const std::string text(200, 'x');
  const std::vector<std::byte> octets(100);
  for (int second = 0; second < 200; ++second) {
    for (int i = 0; i < 100; ++i) {
      const OnboardTime t = noon + second * 1s + i * 1ms;
      (*archive)->add(ground::StoredPacket{.t = t, .apid = 11, .service = 5, .subtype = 1, .octets = {}}, octets);
      (*archive)->add(ground::StoredEvent{.t = t, .subsystem = "A", .name = "B", .text = text, .values = "{}"});
    }
    (*archive)->keep_within_limit();
  }
  EXPECT_LT(std::filesystem::file_size(file), 2 * limit);
  const auto newest = (*archive)->events({.span = {}, .text = {}, .limit = 1});
  ASSERT_EQ(newest.size(), 1U);
  EXPECT_EQ(newest[0].t, noon + 199s + 99ms);
  const auto extent = (*archive)->extent();
  ASSERT_TRUE(extent);
  EXPECT_GT(extent->from, noon + 1s);
  EXPECT_EQ(extent->to, noon + 199s + 99ms);
  EXPECT_EQ((*archive)->failures(), 0U);
}

TEST_F(GroundArchive, ThatIsDamagedSaysSoAndAnswersWithWhatItHas) {
  const std::vector<std::byte> octets(500);
  {
    auto archive = ground::Archive::open(file);
    ASSERT_TRUE(archive);
    for (int i = 0; i < 1000; ++i)
      (*archive)->add(ground::StoredPacket{.t = noon + i * 1s, .apid = 10, .sid = 1, .octets = {}}, octets);
  }
  std::fstream disk{file, std::ios::in | std::ios::out | std::ios::binary};
  const std::string junk(300'000, '\xA5');
  disk.seekp(100'000);
  disk << junk;
  disk.close();
  auto archive = ground::Archive::open(file);
  ASSERT_TRUE(archive);
  std::size_t read = 0;
  (*archive)->packets({}, [&](const ground::StoredPacket&) { return ++read > 0; });
  EXPECT_LT(read, 1000U);
  EXPECT_GT((*archive)->failures(), 0U);
}

/// Files grow no further than this while it lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t octets) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit full{octets, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST_F(GroundArchive, CountsWhatAFullDiskRefusesAndGoesOnWhenThereIsRoomAgain) {
  auto archive = ground::Archive::open(file);
  ASSERT_TRUE(archive);
  const auto tell = [&](OnboardTime t) {
    (*archive)->add(ground::StoredEvent{.t = t, .subsystem = "A", .name = "B", .text = "C", .values = "{}"});
    (*archive)->commit();
  };
  {
    const FullDisk full{200'000};
    for (int i = 0; i < 1000; ++i) tell(noon + i * 1s);
    EXPECT_GT((*archive)->failures(), 0U);
  }
  tell(noon + 1h);
  archive->reset();
  archive = ground::Archive::open(file);
  ASSERT_TRUE(archive);
  const auto kept = (*archive)->events({.span = {}, .text = {}});
  ASSERT_FALSE(kept.empty());
  EXPECT_EQ(kept.front().t, noon + 1h);
  EXPECT_EQ((*archive)->failures(), 0U);
}

[[nodiscard]] json resolved(const json& document, const json& part) {
  return part.contains("$ref") ? document.at(json::json_pointer{part["$ref"].get<std::string>().substr(1)}) : part;
}

/// Whatever is answered stands in the document, to the last field.
void expect_described(const json& document, const json& part, const json& answer, const std::string& where) {
  const json schema = resolved(document, part);
  if (answer.is_array() && schema.contains("items"))
    for (const json& one : answer) expect_described(document, schema["items"], one, where + "[]");
  if (!answer.is_object() || schema.value("additionalProperties", json{}) == json(true)) return;
  for (const auto& [name, value] : answer.items()) {
    const json known = schema.value("properties", json::object());
    const bool described = known.contains(name) || schema.contains("additionalProperties");
    EXPECT_TRUE(described) << where << "." << name;
    if (described)
      expect_described(document, known.contains(name) ? known[name] : schema["additionalProperties"], value,
                       where + "." + name);
  }
}

/// Every operation of openapi.json is asked: it is there, wants the token, and answers as the document says.
TEST_F(GroundStation, AnswersAsItsOpenApiDocumentSays) {
  commission();
  std::ifstream file{std::filesystem::path{HIROSCO_SOURCE_DIR} / "ground/api/openapi.json"};
  const json document = json::parse(file);
  const std::string span = "?parameter=" + std::string{first_joint};
  const json command{{"subsystem", "JOYSTICK"}, {"function", "PING"}, {"device", "robot"}, {"line", "heal"}};
  for (const auto& [path, methods] : document["paths"].items())
    for (const auto& [method, operation] : methods.items()) {
      SCOPED_TRACE(method + " " + path);
      const bool posts = method == "post";
      const json& responses = operation["responses"];
      const auto ask = [&](std::map<std::string, std::string> headers, const json& body) {
        const auto answer = station.ask(posts ? "POST" : "GET", path + span, body, std::move(headers));
        EXPECT_TRUE(responses.contains(std::to_string(answer.status))) << answer.status << answer.body.substr(0, 100);
        return answer;
      };
      EXPECT_EQ(ask({{"authorization", ""}}, {}).status, 401U);
      EXPECT_EQ(ask({{"host", "evil.example"}}, {}).status, 403U);
      if (posts) {
        EXPECT_EQ(ask({}, json::array()).status, 400U);
      }
      const auto answer = ask({}, posts ? command : json{});
      EXPECT_EQ(answer.status / 100, 2U) << answer.body;
      const json content = resolved(document, responses[std::to_string(answer.status)])["content"];
      ASSERT_TRUE(content.contains(answer.type.substr(0, answer.type.find(';')))) << answer.type;
      if (answer.type != "application/json") continue;
      expect_described(document, content["application/json"]["schema"], json::parse(answer.body), path);
    }
}

TEST_F(GroundArchive, ThatSomebodyLocksKeepsNoPageFromHearingOfATelecommand) {
  Flight flight{rokviss()};
  Station station{flight, file};
  ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
  Page page;
  station.session().opened(page, true);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  station.post("/api/commands", {{"subsystem", "JOYSTICK"}, {"function", "PING"}});
  station.run(1s);
  std::string stages;
  for (const json& message : page.of_type("command")) stages += message["stage"].get<std::string>() + " ";
  EXPECT_EQ(stages, "sent accepted started completed ");
  EXPECT_GT(station.get("/api/status")["link"]["archive_failures"], 0);
  sqlite3_close(other);
  EXPECT_EQ(station.command("JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.05}})["stage"], "completed");
}

TEST_F(GroundArchive, ARestartedGatewayStillKnowsAndShowsItsAbsenceAsAGap) {
  Flight flight{rokviss()};
  std::size_t events = 0;
  {
    Station station{flight, file};
    ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
    events = station.get("/api/events?limit=1000")["events"].size();
    EXPECT_EQ(station.command("JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.05}})["stage"], "completed");
  }
  flight.craft().run(2s);
  Station station{flight, file};
  station.run(500ms);
  EXPECT_GE(station.get("/api/events?limit=1000")["events"].size(), events);
  EXPECT_EQ(station.get("/api/commands")["commands"][0]["stage"], "completed");
  const json history = station.get("/api/history?parameter=MANIPULATOR.TIP_FORCE[0]&last=60");
  ASSERT_EQ(history["gaps"].size(), 1U);
  EXPECT_GE(history["t"].size(), 10U);
}

TEST_F(GroundStation, OnlyWhoKnowsTheTokenFromThisComputerMayAskAndObserversMayNotCommand) {
  const auto status = [&](const std::string& method, const std::string& target,
                          std::map<std::string, std::string> headers, const json& body = {}) {
    return station.ask(method, target, body, std::move(headers)).status;
  };
  EXPECT_EQ(status("GET", "/api/status", {}), 200U);
  EXPECT_EQ(status("GET", "/api/status?token=right", {{"authorization", ""}}), 200U);
  EXPECT_EQ(status("GET", "/api/status", {{"authorization", "Bearer wrong"}}), 401U);
  EXPECT_EQ(status("GET", "/api/status", {{"authorization", ""}}), 401U);
  EXPECT_EQ(status("GET", "/api/status?token=", {{"authorization", ""}}), 401U);
  EXPECT_EQ(status("GET", "/api/status", {{"host", "evil.example:8080"}}), 403U);
  EXPECT_EQ(status("GET", "/", {{"host", "evil.example:8080"}}), 403U);
  EXPECT_EQ(status("GET", "/api/status", {{"origin", "http://evil.example"}}), 403U);
  EXPECT_EQ(status("GET", "/api/status", {{"origin", "http://127.0.0.1:8080"}}), 200U);
  EXPECT_EQ(status("GET", "/api/status", {{"authorization", "Bearer looker"}}), 200U);
  const json ping{{"subsystem", "JOYSTICK"}, {"function", "PING"}};
  EXPECT_EQ(status("POST", "/api/commands", {{"authorization", "Bearer looker"}}, ping), 403U);
  EXPECT_EQ(status("POST", "/api/commands", {{"authorization", ""}}, ping), 401U);
  EXPECT_EQ(status("DELETE", "/api/status", {}), 405U);
  EXPECT_EQ(status("GET", "/api/nothing", {}), 404U);
  for (const char* path : {"/../main.cpp", "/%2e%2e/main.cpp", "/.git/config", "//etc/passwd", "/a\\b", "/%00", "/%zz"})
    EXPECT_GE(status("GET", path, {}), 400U) << path;
  const auto page = station.ask("GET", "/", {}, {{"authorization", ""}});
  EXPECT_EQ(page.status, 200U);
  EXPECT_THAT(page.body, HasSubstr("hirosco_ground_page"));
  bool strict = false;
  for (const auto& [name, value] : page.headers)
    strict = strict || (name == "Content-Security-Policy" && value.find("script-src 'self';") != std::string::npos);
  EXPECT_TRUE(strict);
}

TEST_F(GroundStation, HostileInputIsTextOrRefused) {
  commission();
  const std::string evil = "<script>alert(1)</script>'; DROP TABLE events;--%s%n";
  const std::string sender = evil + std::string(70'000, 'x');
  const json sent =
      station.post("/api/commands", {{"subsystem", "JOYSTICK"}, {"function", "PING"}, {"sender", sender}});
  EXPECT_TRUE(sent.contains("id"));
  EXPECT_EQ(station.get("/api/commands")["commands"][0]["sender"], sender.substr(0, 32));
  EXPECT_EQ(station.get("/api/events?text=%25%27%3B--")["events"].size(), 0U);
  EXPECT_GT(station.get("/api/events?limit=1e300&from=-1e300&to=1e300")["events"].size(), 0U);
  EXPECT_EQ(station.get("/api/events?limit=-5")["events"].size(), 0U);
  EXPECT_EQ(station.ask("GET", "/api/history?parameter=" + std::string(60'000, 'A')).status, 404U);
  for (const char* body : {"", "[]", "{", "null", "\"\xff\xfe\"", "{\"subsystem\":7}"}) {
    ground::HttpResponse answer;
    ground::Api api{station.session(), {.token = "t", .observer_token = {}, .page = {}, .transitions = {}}};
    api.handle({"POST", "/api/commands", {{"host", "127.0.0.1:8080"}, {"authorization", "Bearer t"}}, body},
               [&](ground::HttpResponse response) { answer = std::move(response); });
    EXPECT_EQ(answer.status, 400U) << body;
  }
  Page page;
  station.session().opened(page, true);
  for (const char* text : {"", "{", "[1]", "7", R"({"type":"replay","at":"x"})", R"({"type":{}})", "\xff"})
    station.session().received(page, text);
  EXPECT_EQ(page.of_type("error").size(), 7U);
  const auto answer = station.ask("POST", "/api/faults", {{"device", "../../etc"}, {"line", "x"}});
  EXPECT_EQ(answer.status, 404U);
  EXPECT_EQ(station.ask("POST", "/api/faults", {{"device", "robot"}, {"line", "a\nb"}}).status, 400U);
  // Whatever is no telemetry ends the connection; the session goes on.
  const std::vector<std::byte> garbage(100, std::byte{0xFF});
  EXPECT_FALSE(station.session().receive(garbage));
  station.session().link_up();
  station.run(200ms);
  EXPECT_EQ(station.get("/api/status")["mode"], "telepresence");
}

TEST_F(GroundStation, NumbersThatJsonDoesNotHaveAreTextsThatJavaScriptUnderstands) {
  std::array<std::byte, 256> buffer;
  OctetWriter writer{buffer};
  writer.put(std::uint16_t{4713});
  for (int i = 0; i < 8; ++i)
    writer.put(i == 0   ? std::numeric_limits<double>::quiet_NaN()
               : i == 1 ? std::numeric_limits<double>::infinity()
               : i == 2 ? -std::numeric_limits<double>::infinity()
                        : 0.0);
  std::array<std::byte, 512> packet;
  const auto written = pus::write_telemetry(
      packet, {.apid = 10, .service = 3, .subtype = 25, .time = OnboardTime{std::chrono::seconds{2'145'916'900}}},
      Octets{buffer}.first(writer.size()));
  ASSERT_TRUE(written && station.session().receive(*written));
  const json values = station.get("/api/status")["values"];
  EXPECT_EQ(values["MANIPULATOR.CUR_VALUES.POSITION[0]"]["v"], "NaN");
  EXPECT_EQ(values["MANIPULATOR.CUR_VALUES.POSITION[1]"]["v"], "Infinity");
  EXPECT_EQ(values["MANIPULATOR.CUR_VALUES.TORQUE[0]"]["v"], "-Infinity");
}

TEST_F(GroundStation, TheMissionIsWholeForAPageThatKnowsNothing) {
  const json mission = station.get("/api/mission");
  EXPECT_EQ(mission["name"], "ROKVISS");
  EXPECT_EQ(mission["subsystems"][0]["name"], "SUPERVISOR");
  for (const json& subsystem : mission["subsystems"]) {
    EXPECT_EQ(subsystem["states"].size(), 10U);
    for (const json& report : subsystem["housekeeping"]) EXPECT_GT(report["period_s"].get<double>(), 0.0);
  }
  const json commanding = mission["subsystems"][0]["functions"];
  const auto set_mode = std::ranges::find_if(commanding, [](const json& f) { return f["name"] == "SET_MODE"; });
  ASSERT_NE(set_mode, commanding.end());
  EXPECT_EQ((*set_mode)["arguments"][0]["enumeration"].size(), mission["modes"].size());
}

}  // namespace
}  // namespace hirosco::testing
