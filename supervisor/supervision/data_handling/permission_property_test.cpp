// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// Who may ask the supervisor, and HAND, for what (docs/adr/0216): every sender, every row that a mode can have of a kind, every state, every
/// function of the supervisor's own descriptor, every service and subtype, in a change of mode and out of one. What is to come out is said
/// here a second time, by the words of the record, and nothing of the code is asked for it.
namespace hirosco::supervisor {
namespace {

using descriptor::State;
using descriptor::Thing;
using testing::arm;
using testing::camera;
using testing::hand;

constexpr std::uint16_t heard_structure = 4701, other_structure = 4702, harmless_event = 103, safety_event = 101;
const std::set<std::string> essential_of_supervisor{"SAFE_ALL", "SET_DATABASE", "SHUTDOWN"};

/// Something that may be asked, with what the oracle goes by.
struct Question {
  std::string name;  ///< of the function; of others what it is
  std::uint16_t to{supervisor_apid};
  std::uint8_t service{8};
  std::uint8_t subtype{1};
  std::vector<std::byte> packet;
  bool declared_by_camera{false};
};

struct Asking {
  std::string who;
  Origin origin;
};

std::vector<std::byte> list_of(std::uint16_t id, bool with_interval) {
  std::vector<std::byte> data(with_interval ? 7 : 3);
  OctetWriter{data}.put(std::uint8_t{1}).put(id);
  return data;
}

/// Each function of the supervisor and one that it has not; of its services each subtype, and the lists that CAMERA declares.
std::vector<Question> all_questions(const descriptor::Mission& mission) {
  std::vector<Question> all;
  const auto add = [&](std::string name, std::uint16_t to, std::uint8_t service, std::uint8_t subtype, Octets data,
                       bool declared) {
    all.push_back({std::move(name), to, service, subtype, testing::telecommand(to, service, subtype, data), declared});
  };
  const auto call = [&](const std::string& name, std::uint16_t to, int argument, bool declared) {
    add(name, to, 8, 1, testing::call_data(name, argument), declared);
  };
  for (const auto& function : mission.supervisor.functions) call(function.name, supervisor_apid, 1, true);
  for (int state = 0; state < 10; ++state) call("SET_STATE", supervisor_apid, state, true);
  call("CONFIGURE", supervisor_apid, 1, true);
  call("NOBODYS", supervisor_apid, -1, false);
  for (const char* name : {"MOVE_TO", "BRAKE"}) call(name, hand, -1, std::string_view{name} == "MOVE_TO");
  for (const std::uint8_t subtype : std::array<std::uint8_t, 4>{5, 6, 27, 31}) {
    add("heard", supervisor_apid, 3, subtype, list_of(heard_structure, subtype == 31), true);
    add("other", supervisor_apid, 3, subtype, list_of(other_structure, subtype == 31), false);
  }
  for (const std::uint8_t subtype : std::array<std::uint8_t, 2>{5, 6}) {
    add("harmless", supervisor_apid, 5, subtype, list_of(harmless_event, false), true);
    add("safety", supervisor_apid, 5, subtype, list_of(safety_event, false), true);
  }
  std::vector<std::byte> id(5);
  OctetWriter{id}.put(std::uint8_t{1}).put(ParameterId{supervisor_apid, Type::Uint8, 0}.wire());
  add("MODE", supervisor_apid, 20, 1, id, true);
  using What = pus::st129::Subscribed::What;
  for (const std::uint8_t subtype : std::array<std::uint8_t, 2>{8, 9}) {
    add("hear", supervisor_apid, 129, subtype,
        pus::st129::write_subscribed({supervisor_apid, What::Structure, heard_structure}), false);
    add("hear other", supervisor_apid, 129, subtype,
        pus::st129::write_subscribed({supervisor_apid, What::Structure, other_structure}), false);
    add("hear other", supervisor_apid, 129, subtype,
        pus::st129::write_subscribed({hand, What::Structure, heard_structure}), false);
  }
  // Whatever else has a number, without data: nobody declares it.
  for (const int service : {1, 3, 5, 8, 17, 20, 128, 129, 130, 200, 255})
    for (int subtype = 0; subtype < 256; subtype += subtype < 34 || (subtype >= 126 && subtype < 132) ? 1 : 23)
      if (service != 8 || subtype != 1)
        add("bare", supervisor_apid, static_cast<std::uint8_t>(service), static_cast<std::uint8_t>(subtype), {}, false);
  return all;
}

/// Rows of each kind: for whom, of whom, and what they open.
std::vector<descriptor::Permit> all_rows() {
  std::vector<descriptor::Permit> opening(7);
  opening[0].functions = {"*"};
  opening[1].functions = {"SET_MODE"};
  opening[2].functions = {"ENTER_MODE", "SHUTDOWN", "MOVE_TO", "SET_STATE"};
  opening[3].services = {3, 5, 17, 20};
  opening[4].services = {8};
  opening[5].parameters = {"*"};
  opening[6].functions = {"*"};
  opening[6].services = {3, 5, 17, 20, 128, 129, 130, 200};
  std::vector<descriptor::Permit> rows;
  const std::vector<std::vector<std::string>> froms{{}, {"ground"}, {"CAMERA"}, {"HAND"}, {"ground", "CAMERA", "ARM"}};
  for (const auto& from : froms)
    for (const char* whom : {"*", "SUPERVISOR", "HAND", "ARM"})
      for (descriptor::Permit row : opening) {
        row.subsystem = whom;
        row.from = from;
        rows.push_back(row);
      }
  return rows;
}

// --- the oracle ----------------------------------------------------------------------------------------------------------

struct AskedInMode {
  const Question& question;
  const std::string& who;
  const std::vector<descriptor::Permit>& rows;
  State state;
  bool changing;
};

bool has(const auto& list, const auto& word) { return std::find(list.begin(), list.end(), word) != list.end(); }

/// One row, which does it all alone.
bool is_opened(const AskedInMode& asked) {
  const bool to_supervisor = asked.question.to == supervisor_apid, by_ground = asked.who == "ground";
  const std::string whom = to_supervisor ? "SUPERVISOR" : "HAND";
  return std::ranges::any_of(asked.rows, [&](const descriptor::Permit& row) {
    if (row.subsystem != "*" && row.subsystem != whom) return false;
    if (row.from.empty() ? to_supervisor && !by_ground : !has(row.from, asked.who)) return false;
    if (has(row.services, asked.question.service)) return true;
    return asked.question.service == 8 && (has(row.functions, "*") || has(row.functions, asked.question.name));
  });
}

/// Of a function that goes by mode and state.
bool may_run(const AskedInMode& asked) {
  const bool there = asked.state == State::Operational ||
                     (asked.question.to == supervisor_apid && asked.state == State::SafeOperational);
  return there && !asked.changing && is_opened(asked);
}

bool subsystem_may(const AskedInMode& asked) {
  const Question& question = asked.question;
  const bool to_supervisor = question.to == supervisor_apid;
  if (to_supervisor && question.name == "SAFE_ALL") return true;
  if (question.name == "hear") return asked.who == "ARM";
  const bool declared = (asked.who == "CAMERA" && question.declared_by_camera) ||
                        (asked.who == "HAND" && to_supervisor && question.name == "SET_MODE");
  if (!declared) return false;
  if (question.service == 8 && to_supervisor && question.name != "SET_MODE" && question.name != "ENTER_MODE")
    return false;
  if (question.name == "safety" && question.subtype == 6) return false;
  return question.service == 8 ? may_run(asked) : is_opened(asked);
}

/// Empty: not asked here. What every subsystem has is said of the ground by permission_test.cpp.
std::optional<bool> ground_may(const AskedInMode& asked) {
  const Question& question = asked.question;
  if (question.name == "bare") return std::nullopt;
  if (question.name.starts_with("hear ") || question.name == "hear") return false;
  if (question.name == "safety" && question.subtype == 6) return false;
  if (question.service != 8) return is_opened(asked);
  if (question.to == hand) return question.name == "BRAKE" || may_run(asked);
  if (question.name == "SET_STATE" || question.name == "CONFIGURE") return false;
  // Whether it has such a function it says itself.
  return essential_of_supervisor.contains(question.name) || question.name == "NOBODYS" || may_run(asked);
}

// --- all of them -----------------------------------------------------------------------------------------------------------

struct PermissionProperty : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  LinkGraph links{mission};
  std::vector<Question> questions;
  std::vector<Asking> senders{{"ground", Origin::ground()},
                              {"ARM", Origin::subsystem(arm)},
                              {"HAND", Origin::subsystem(hand)},
                              {"CAMERA", Origin::subsystem(camera)}};
  std::size_t permitted{0}, of_subsystems{0}, wrong{0};
  std::string first_wrong;

  void SetUp() override {
    const auto own =
        descriptor::read_subsystem(HIROSCO_SOURCE_DIR "/supervisor/supervisor.xml", descriptor::file_system());
    ASSERT_TRUE(own.value);
    mission.supervisor = *own.value;
    // CAMERA's descriptor declares all that there is, as the reader would not let it.
    descriptor::Commands of_hand{.subsystem = "HAND", .functions = {"MOVE_TO"}, .at = {}, .apid = hand};
    descriptor::Commands all{.subsystem = "SUPERVISOR", .functions = {}, .at = {}, .apid = supervisor_apid};
    for (const auto& function : mission.supervisor.functions) all.functions.push_back(function.name);
    all.functions.insert(all.functions.end(), {"SET_STATE", "CONFIGURE"});
    using enum Thing::Kind;
    all.things = {{Housekeeping, "4701", heard_structure, {}},
                  {Event, "LOG_STORE", harmless_event, {}},
                  {Event, "PROCESS_DIED", safety_event, {}},
                  {Read, "MODE", ParameterId{supervisor_apid, Type::Uint8, 0}.wire(), {}}};
    mission.subsystems[2].subsystem.commands = {of_hand, all};
    mission.subsystems[1].subsystem.commands = {
        {.subsystem = "SUPERVISOR", .functions = {"SET_MODE"}, .at = {}, .apid = supervisor_apid}};
    mission.subsystems[0].subsystem.subscribes = {{.subsystem = "SUPERVISOR",
                                                   .things = {{Housekeeping, "4701", heard_structure, {}}},
                                                   .at = {},
                                                   .apid = supervisor_apid}};
    // The other mode, which is not in force, permits everything to everybody.
    mission.modes[1].permits = {{.subsystem = "*",
                                 .functions = {"*"},
                                 .services = {3, 5, 8, 17, 20, 129},
                                 .parameters = {"*"},
                                 .at = {},
                                 .from = {"ground", "ARM", "HAND", "CAMERA"}}};
    questions = all_questions(mission);
  }
  void look(const Question& question, const Asking& sender, State state, bool changing) {
    const AskedInMode asked{question, sender.who, mission.modes[0].permits, state, changing};
    const bool by_ground = sender.origin.is_ground();
    const auto expected = by_ground ? ground_may(asked) : std::optional{subsystem_may(asked)};
    if (!expected) return;
    Situation situation{.mission = mission, .mode = mission.modes[0], .links = links, .state = state};
    situation.changing = changing;
    const auto decision = decide(pus::TelecommandView::parse(question.packet).value(), sender.origin, situation);
    permitted += decision ? 1 : 0;
    of_subsystems += decision && !by_ground ? 1 : 0;
    // Of a subsystem nothing goes past what waits but a stop, and what is heard; nothing of it lets anybody go, or starts anybody.
    const bool urgent = question.name == "SAFE_ALL" || question.name == "hear";
    const bool sound = !decision || by_ground ||
                       (decision->essential == urgent && !decision->releases_stop && !decision->starts &&
                        decision->stops_the_craft == (question.name == "SAFE_ALL"));
    if (decision.has_value() == *expected && sound) return;
    if (wrong++ > 0) return;
    const auto& row = mission.modes[0].permits.front();
    first_wrong = sender.who + " asks " + std::to_string(question.to) + " for " + question.name + " TC[" +
                  std::to_string(question.service) + "," + std::to_string(question.subtype) + "] in state " +
                  std::to_string(static_cast<int>(state)) + (changing ? " in a change" : "") + ", row of " +
                  row.subsystem + " from " + ::testing::PrintToString(row.from) + " functions " +
                  ::testing::PrintToString(row.functions) + " services " + ::testing::PrintToString(row.services) +
                  ": " + (decision ? "permitted" : "refused");
  }
};

TEST_F(PermissionProperty, WithEachRowInEachStateThatIsPermittedWhichTheRecordPermitsAndNothingElse) {
  for (const auto& row : all_rows()) {
    mission.modes[0].permits = {row};
    for (const auto& question : questions)
      for (const auto& sender : senders) {
        // What nobody declares and nobody opens is refused in one state as in another.
        const bool everywhere = question.name != "bare";
        for (int state = everywhere ? 0 : 5; state < (everywhere ? 10 : 6); ++state)
          for (const bool changing : {false, true}) look(question, sender, static_cast<State>(state), changing);
      }
  }
  EXPECT_EQ(wrong, 0U) << first_wrong;
  EXPECT_GT(of_subsystems, 0U);
  EXPECT_GT(permitted, of_subsystems);
}

TEST_F(PermissionProperty, TwoRowsOpenWhatOneOfThemOpensAndNothingTogether) {
  const auto rows = all_rows();
  std::erase_if(questions, [](const Question& each) { return each.name == "bare"; });
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (std::size_t b = a % 5; b < rows.size(); b += 5) {
      mission.modes[0].permits = {rows[a], rows[b]};
      for (const auto& question : questions)
        for (const auto& sender : senders) look(question, sender, State::Operational, false);
    }
  EXPECT_EQ(wrong, 0U) << first_wrong;
  EXPECT_GT(of_subsystems, 0U);
}

TEST_F(PermissionProperty, AModeWithoutRowsPermitsASubsystemAStopAndWhatItHears) {
  mission.modes[0].permits.clear();
  std::set<std::string> names;
  for (const auto& question : questions)
    for (const auto& sender : senders)
      for (int state = 0; state < 10; ++state) {
        if (sender.origin.is_ground()) continue;
        const Situation situation{
            .mission = mission, .mode = mission.modes[0], .links = links, .state = static_cast<State>(state)};
        if (decide(pus::TelecommandView::parse(question.packet).value(), sender.origin, situation))
          names.insert(sender.who + " " + question.name);
      }
  EXPECT_EQ(names, (std::set<std::string>{"ARM SAFE_ALL", "HAND SAFE_ALL", "CAMERA SAFE_ALL", "ARM hear"}));
}

}  // namespace
}  // namespace hirosco::supervisor
