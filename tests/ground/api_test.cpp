// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "ground/api/routes.hpp"
#include "tests/ground/station.hpp"

/// The API as such: its document, who may ask, and input that means ill.
namespace hirosco::testing {
namespace {

using ::testing::HasSubstr;

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

/// The answer to a POST of octets that json::dump() would not write.
struct Posts : GroundStation {
  ground::HttpResponse post(const std::string& body) {
    ground::HttpResponse answer;
    api.handle({"POST", "/api/commands/preview", {{"host", "127.0.0.1:8080"}, {"authorization", "Bearer t"}}, body},
               [&](ground::HttpResponse response) { answer = std::move(response); });
    return answer;
  }
  ground::HttpResponse value(const std::string& text) {
    return post(R"({"subsystem":"JOYSTICK","function":"SET_FORCE_SCALE","arguments":{"SCALE":)" + text + "}}");
  }
  ground::Api api{station.session(), {.token = "t", .observer_token = {}, .page = {}, .transitions = {}}};
};

TEST_F(Posts, AKeyThatStandsTwiceIsRefusedBecauseTwoReadersCouldMeanTwoThings) {
  for (const char* body :
       {R"({"subsystem":"SUPERVISOR","function":"PING","function":"SAFE_ALL"})",
        R"({"subsystem":"JOYSTICK","subsystem":"SUPERVISOR","function":"PING"})",
        R"({"subsystem":"JOYSTICK","function":"SET_FORCE_SCALE","arguments":{"SCALE":0.01,"SCALE":0.1}})",
        R"({"subsystem":"JOYSTICK","function":"PING","arguments":{},"arguments":{}})"}) {
    const auto answer = post(body);
    EXPECT_EQ(answer.status, 400U) << body;
    EXPECT_THAT(answer.body, HasSubstr("each key once"));
  }
  const auto fine = R"({"function":"PING","subsystem":"JOYSTICK","arguments":{},"more":[{"a":1},{"a":1}]})";
  EXPECT_NE(post(fine).status, 400U) << "the same key in two objects is none twice";
}

TEST_F(Posts, ANumberIsANumber) {
  for (const char* text : {"true", "false", "\"0.05\"", "[0.05, 0.05]", "{\"v\": 0.05}", "1e400", "0x1", "NaN", "null",
                           "18446744073709551615", "9007199254740993", "-9007199254740993"})
    EXPECT_EQ(value(text).status, 400U) << text;
}

TEST_F(GroundStation, WrongTokensAreAnsweredLaterAndLaterAndRightOnesAtOnce) {
  ground::Api api{station.session(), {.token = "t", .observer_token = {}, .page = {}, .transitions = {}}};
  std::vector<unsigned> answers;
  const auto ask = [&](const char* token) {
    api.handle(
        {"GET", "/api/status", {{"host", "127.0.0.1:8080"}, {"authorization", std::string{"Bearer "} + token}}, ""},
        [&](const ground::HttpResponse& response) { answers.push_back(response.status); });
  };
  const auto pass = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) api.tick();
  };
  for (int i = 0; i < 8; ++i) ask("wrong");
  EXPECT_EQ(answers, std::vector<unsigned>(5, 401U)) << "somebody may mistype";
  pass(19);
  EXPECT_EQ(answers.size(), 5U);
  ask("t");
  EXPECT_EQ(answers.back(), 200U) << "who has the right one does not wait for who has not";
  pass(1);
  EXPECT_EQ(answers.size(), 7U);
  pass(40);
  EXPECT_EQ(answers.size(), 9U) << "one each second, however many ask";
  for (int i = 0; i < 200; ++i) ask("wrong");
  EXPECT_EQ(std::ranges::count(answers, 429U), 200 - 16) << "what waits has an end";
  pass(20 * 90);
  answers.clear();
  ask("wrong");
  EXPECT_EQ(answers.size(), 1U) << "a minute of calm is forgiveness";
}

TEST_F(GroundStation, AParameterOfAnAddressThatStandsTwiceIsRefused) {
  EXPECT_EQ(station.ask("GET", "/api/events?to=1&to=2").status, 400U);
  EXPECT_EQ(station.ask("GET", "/api/export.csv?parameter=MANIPULATOR.TIP_FORCE[0]&parameter=MANIPULATOR.TIP_FORCE[1]")
                .status,
            200U);
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

[[nodiscard]] json resolved(const json& document, const json& part) {
  return part.contains("$ref") ? document.at(json::json_pointer{part["$ref"].get<std::string>().substr(1)}) : part;
}

[[nodiscard]] bool is_of(const json& schema, const json& value) {
  const std::string type = schema.value("type", "");
  const bool listed = !schema.contains("enum") || std::ranges::find(schema["enum"], value) != schema["enum"].end();
  return listed &&
         (type.empty() || (type == "string" && value.is_string()) || (type == "integer" && value.is_number_integer()) ||
          (type == "number" && value.is_number()) || (type == "boolean" && value.is_boolean()) ||
          (type == "array" && value.is_array()) || (type == "object" && value.is_object()));
}

/// What is answered is as the document says: of its types, whole, and nothing that does not stand there.
void expect_described(const json& document, const json& part, const json& answer, const std::string& where) {
  const json schema = resolved(document, part);
  if (schema.empty() || (answer.is_null() && schema.value("nullable", false))) return;
  const bool fits = schema.contains("oneOf")
                        ? std::ranges::any_of(schema["oneOf"], [&](const json& one) { return is_of(one, answer); })
                        : is_of(schema, answer);
  EXPECT_TRUE(fits) << where << ": " << answer.dump().substr(0, 100);
  if (answer.is_array())
    for (const json& one : answer) expect_described(document, schema["items"], one, where + "[]");
  if (!answer.is_object()) return;
  for (const json& name : schema.value("required", json::array()))
    EXPECT_TRUE(answer.contains(name.get<std::string>())) << where << " lacks " << name;
  const json known = schema.value("properties", json::object());
  for (const auto& [name, value] : answer.items()) {
    const bool named = known.contains(name);
    EXPECT_TRUE(named || schema.contains("additionalProperties")) << where << "." << name;
    if (named || schema.contains("additionalProperties"))
      expect_described(document, named ? known[name] : schema["additionalProperties"], value, where + "." + name);
  }
}

/// The address of an operation with its required parameters, or with all, each with a value of its kind.
[[nodiscard]] std::string address_of(const std::string& path, const json& operation, bool all) {
  std::string address = path;
  for (const json& parameter : operation["parameters"]) {
    if (parameter["in"] != "query" || (!all && parameter["required"] != true)) continue;
    const json& schema = parameter["schema"];
    const std::string type = schema["type"];
    const std::string value = parameter["name"] == "parameter" ? first_joint
                              : schema.contains("enum")        ? schema["enum"][0].get<std::string>()
                              : type == "string"               ? "a"
                                                               : "10";
    address += (address == path ? "?" : "&") + parameter["name"].get<std::string>() + "=" + value;
  }
  return address;
}

/// Every operation of the station's own document is asked: it is there, wants the token, and answers as the document says.
TEST_F(GroundStation, AnswersAsItsOpenApiDocumentSays) {
  commission();
  const json document = station.get("/api/openapi.json");
  // Something to be acknowledged.
  ASSERT_EQ(station.post("/api/faults", {{"device", "joystick"}, {"line", "unplug"}})["answer"], "ok");
  ASSERT_TRUE(station.run_until([&] { return !station.get("/api/alarms")["alarms"].empty(); }));
  const json alarm = station.get("/api/alarms")["alarms"][0];
  const json usual{
      {"subsystem", "JOYSTICK"}, {"function", "PING"}, {"device", "robot"}, {"line", "heal"}, {"mode", "telepresence"}};
  /// What each path is sent that wants more than that.
  const std::map<std::string, json> bodies{
      {"/api/alarms", {{"subsystem", alarm["subsystem"]}, {"event", alarm["name"]}, {"action", "acknowledge"}}},
      {"/api/authority", {{"action", "take"}, {"seat", "a"}}},
      {"/api/flights", {{"flight", 1}, {"name", "a name"}}},
      {"/api/stacks", {{"name", "home"}, {"text", "hirosco tc MANIPULATOR HOLD"}}}};
  std::size_t asked = 0;
  for (const auto& [path, methods] : document["paths"].items())
    for (const auto& [method, operation] : methods.items()) {
      SCOPED_TRACE(method + " " + path);
      ++asked;
      const bool posts = method == "post";
      const json& command = bodies.contains(path) ? bodies.at(path) : usual;
      const json& responses = operation["responses"];
      const auto ask = [&](std::map<std::string, std::string> headers, const json& body, bool all = false) {
        const auto answer =
            station.ask(posts ? "POST" : "GET", address_of(path, operation, all), body, std::move(headers));
        EXPECT_TRUE(responses.contains(std::to_string(answer.status))) << answer.status << answer.body.substr(0, 100);
        return answer;
      };
      EXPECT_EQ(ask({{"authorization", ""}}, {}).status, 401U);
      EXPECT_EQ(ask({{"host", "evil.example"}}, {}).status, 403U);
      if (posts) {
        EXPECT_EQ(ask({}, json::array()).status, 400U);
      }
      for (const bool all : {false, true}) {
        const auto answer = ask({}, posts ? command : json{}, all);
        EXPECT_EQ(answer.status / 100, 2U) << answer.body;
        const json content = resolved(document, responses[std::to_string(answer.status)])["content"];
        ASSERT_TRUE(content.contains(answer.type.substr(0, answer.type.find(';')))) << answer.type;
        if (answer.type != "application/json") continue;
        expect_described(document, content["application/json"]["schema"], json::parse(answer.body), path);
      }
    }
  EXPECT_EQ(asked, ground::routes().size());
}

/// Sends as a page of somebody would.
struct TwoPeople : GroundStation {
  unsigned send(const std::string& seat, const std::string& subsystem, const std::string& function,
                json arguments = json::object()) {
    const auto answer = station.ask("POST", "/api/commands",
                                    {{"subsystem", subsystem},
                                     {"function", function},
                                     {"arguments", std::move(arguments)},
                                     {"seat", seat},
                                     {"sender", seat}});
    told = json::parse(answer.body).value("error", "");
    return answer.status;
  }
  json authority(const std::string& seat, const std::string& action) {
    return station.post("/api/authority", {{"seat", seat}, {"sender", seat}, {"action", action}});
  }
  std::string told;
};

TEST_F(TwoPeople, OneCommandsAndTheOtherIsRefusedByTheStationUntilItIsHandedOver) {
  commission();
  Page page;
  static_cast<void>(station.session().pages().opened(page, true, "ben"));
  EXPECT_EQ(send("anna", "JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.01}}), 202U);
  EXPECT_EQ(send("ben", "JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.02}}), 409U);
  EXPECT_EQ(told, "anna commands: ask for the command, or wait until it is handed over");
  EXPECT_EQ(page.last("authority")["holder"]["name"], "anna") << "every page is told";
  EXPECT_EQ(authority("ben", "take")["asking"]["name"], "ben");
  EXPECT_EQ(authority("anna", "hand_over")["holder"]["name"], "ben");
  EXPECT_EQ(send("anna", "JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.01}}), 409U);
  EXPECT_EQ(send("ben", "JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.02}}), 202U);
  std::vector<std::string> log;
  const json marks = station.get("/api/marks")["marks"];
  for (const json& mark : marks)
    if (mark["kind"] == "authority")
      log.push_back(mark["who"].get<std::string>() + " " + mark["action"].get<std::string>());
  EXPECT_EQ(log, (std::vector<std::string>{"ben was handed", "ben asked", "anna took"}));
  station.session().pages().closed(page);
  station.run(40s);
  EXPECT_TRUE(station.get("/api/authority")["holder"].is_null()) << "nobody is there any more";
}

TEST_F(TwoPeople, EachPageIsToldWhoElseLooksByNameAndKindAndWhetherAtThePast) {
  commission();
  Page anna, ben, guest;
  static_cast<void>(station.session().pages().opened(anna, true, "seat-anna"));
  static_cast<void>(station.session().pages().opened(ben, true, "seat-ben"));
  static_cast<void>(station.session().pages().opened(guest, false, "seat-guest"));
  station.session().pages().received(anna, R"({"type":"name","name":"anna"})");
  station.session().pages().received(ben,
                                     R"({"type":"name","name":"ben, who has a name of more than thirty-two octets"})");
  station.run(200ms);
  const json told = anna.last("present");
  EXPECT_EQ(told["operators"], 2);
  EXPECT_EQ(told["observers"], 1);
  ASSERT_EQ(told["pages"].size(), 3U);
  EXPECT_EQ(told["pages"][0]["name"], "anna");
  EXPECT_EQ(told["pages"][0]["seat"], "seat-anna");
  EXPECT_EQ(told["pages"][1]["name"], "ben, who has a name of more than");
  EXPECT_EQ(told["pages"][2]["name"], "");
  EXPECT_EQ(told["pages"][2]["seat"], "") << "an observer cannot hold what it cannot take";
  EXPECT_EQ(told["pages"][2]["operator"], false);
  EXPECT_EQ(guest.last("present"), told) << "observers are told, too";
  station.session().pages().received(ben, R"({"type":"replay","at":0,"speed":0})");
  station.run(200ms);
  EXPECT_EQ(anna.last("present")["pages"][1]["replay"], true);
  station.session().pages().closed(ben);
  station.run(200ms);
  EXPECT_EQ(anna.last("present")["pages"].size(), 2U);
  EXPECT_EQ(station.get("/api/present")["operators"], 1);
  std::vector<Page> crowd(40);
  for (Page& page : crowd) static_cast<void>(station.session().pages().opened(page, false));
  EXPECT_EQ(station.get("/api/present")["pages"].size(), 32U);
  EXPECT_EQ(station.get("/api/present")["observers"], 41) << "counted are all";
  for (Page& page : crowd) station.session().pages().closed(page);
}

TEST_F(TwoPeople, ANoteOfAFlightIsToldToEveryPageAndStaysWithTheFlight) {
  commission();
  Page page;
  static_cast<void>(station.session().pages().opened(page, false));
  const json note{{"flight", 1}, {"note", "the wall <i>gave way</i>"}, {"sender", "anna"}};
  EXPECT_EQ(station.post("/api/flights", note)["notes"].size(), 1U);
  EXPECT_EQ(page.last("notes")["notes"][0]["text"], "the wall <i>gave way</i>") << "as it was written: pages show text";
  EXPECT_EQ(station.get("/api/flights")["flights"][0]["notes"][0]["who"], "anna");
  EXPECT_EQ(station.ask("POST", "/api/flights", {{"flight", 9}, {"note", "x"}}).status, 404U);
  EXPECT_EQ(station.ask("POST", "/api/flights", {{"flight", 1}, {"note", 5}}).status, 400U);
  EXPECT_EQ(station.get("/api/marks")["marks"][0]["action"], "noted");
}

/// Of every function of every subsystem, so of those of a new one, too.
TEST_F(TwoPeople, WhatIsEssentialIsRefusedToNobodyAndNeedsNoConfirmation) {
  commission();
  ASSERT_EQ(authority("anna", "take")["holder"]["name"], "anna");
  int essential = 0, others = 0;
  const json mission = station.get("/api/mission");
  for (const json& subsystem : mission["subsystems"])
    for (const json& function : subsystem["functions"]) {
      if (!function["arguments"].empty() || function["name"] == "SHUTDOWN") continue;
      const unsigned status = send("ben", subsystem["name"], function["name"]);
      const bool is_essential = function["essential"];
      EXPECT_EQ(status, is_essential ? 202U : 409U) << subsystem["name"] << function["name"];
      (is_essential ? essential : others) += 1;
    }
  EXPECT_GT(essential, 3);
  EXPECT_GT(others, 3);
  EXPECT_EQ(send("ben", "SUPERVISOR", "SHUTDOWN"), 202U) << "marked for people, and towards safety all the same";
}

TEST_F(TwoPeople, WhatTheDescriptorMarksIsSentOnlyWhenItIsConfirmed) {
  commission();
  json body{{"subsystem", "SUPERVISOR"}, {"function", "TAKE_BACK"}, {"arguments", {{"APID", 10}}}, {"seat", "anna"}};
  for (const json& no : {json(nullptr), json(false), json("true"), json(1)}) {
    body["confirmed"] = no;
    const auto answer = station.ask("POST", "/api/commands", body);
    EXPECT_EQ(answer.status, 409U);
    EXPECT_THAT(answer.body, HasSubstr("to be confirmed"));
  }
  body["confirmed"] = true;
  EXPECT_EQ(station.ask("POST", "/api/commands", body).status, 202U);
}

TEST_F(TwoPeople, AlarmsAreAcknowledgedForEverybodyAndKeptByTheStation) {
  commission();
  Page page;
  static_cast<void>(station.session().pages().opened(page, true, "ben"));
  station.post("/api/faults", {{"device", "joystick"}, {"line", "unplug"}});
  ASSERT_TRUE(station.run_until([&] { return !page.of_type("alarm").empty(); }));
  const json alarm = page.last("alarm");
  EXPECT_EQ(alarm["calls"], true);
  const json done = station.post("/api/alarms", {{"subsystem", alarm["subsystem"]},
                                                 {"event", alarm["name"]},
                                                 {"action", "acknowledge"},
                                                 {"sender", "anna"},
                                                 {"note", "was me"}});
  const auto acknowledged =
      std::ranges::find_if(done["alarms"], [&](const json& one) { return one["name"] == alarm["name"]; });
  ASSERT_NE(acknowledged, done["alarms"].end());
  EXPECT_EQ((*acknowledged)["acknowledged"]["who"], "anna");
  EXPECT_EQ(page.last("alarm")["acknowledged"]["note"], "was me");
  station.run(1s);
  station.post("/api/alarms", {{"subsystem", "*"}, {"action", "acknowledge"}, {"sender", "ben"}});
  for (const json& one : page.last("alarms")["alarms"]) EXPECT_EQ(one["calls"], false);
  EXPECT_EQ(station.get("/api/alarms")["seen_until"], page.last("alarms")["seen_until"]);
  EXPECT_EQ(
      station.ask("POST", "/api/alarms", {{"action", "acknowledge"}}, {{"authorization", "Bearer looker"}}).status,
      403U);
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
  station.session().pages().opened(page, true);
  for (const char* text : {"", "{", "[1]", "7", R"({"type":"replay","at":"x"})", R"({"type":{}})", "\xff"})
    station.session().pages().received(page, text);
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
