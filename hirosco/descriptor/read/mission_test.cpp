// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "hirosco/descriptor/read/detail/mission_link_reader.hpp"
#include "hirosco/descriptor/testing.hpp"
#include "hirosco/utilities/testing/slice.hpp"

namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::good_mission;
using testing::marked;
using testing::overlay;
using testing::rendered;

TEST(MissionDescriptor, NamesWhatComesWithHiroscoWhereverThatIs) {
  const std::string shipped = "@hirosco/supervisor/supervisor.xml";
  const auto source =
      overlay({{"mission.xml", changed(R"(descriptor="supervisor.xml")", "descriptor=\"" + shipped + "\"")}});
  const auto reading = read_mission(data / "mission.xml", source);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
  // As it was written: each program looks for it by itself.
  EXPECT_EQ(reading.value->supervisor.file, shipped);
}

TEST(MissionDescriptor, FillsTheWholeModel) {
  const auto reading = read_mission(data / "mission.xml", file_system());
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const Mission& mission = *reading.value;
  EXPECT_EQ(mission.name, "ORBITER");
  EXPECT_EQ(mission.file, data / "mission.xml");
  EXPECT_EQ(mission.supervisor.name, "SUPERVISOR");
  EXPECT_EQ(mission.database.path, "log/orbiter.db");
  EXPECT_EQ(mission.ground.subsystem, "GROUNDSTATION");
  ASSERT_EQ(mission.subsystems.size(), 3U);
  EXPECT_EQ(mission.find_subsystem("FLYWHEEL")->subsystem.id, 11);
  EXPECT_EQ(mission.find_subsystem(std::uint16_t{10})->executable, "hirosco-coronagraph");
  EXPECT_EQ(mission.find_subsystem("SUPERVISOR"), nullptr);
  EXPECT_EQ(mission.devices.at(0).seed, 7U);
  EXPECT_EQ(mission.devices.at(0).settings.at(0).name, "NOISE");
  EXPECT_EQ(mission.find_link(2)->requires_, "FLYWHEEL_STATE");
  EXPECT_EQ(mission.initial_mode, "commissioning");
  EXPECT_EQ(mission.start_mode, "telepresence");
  EXPECT_EQ(mission.power_budget_w, 150);
  EXPECT_EQ(mission.find_subsystem("CORONAGRAPH")->subsystem.find_parameter("DES_POSITION")->init,
            (std::vector<Value>{-0.7, 1.5}));
  EXPECT_EQ(mission.find_subsystem("CORONAGRAPH")->subsystem.find_configuration("COUPLED")->power_w, 60.5);
}

TEST(MissionDescriptor, FillsModesAndPlans) {
  const Mission mission = read_mission(data / "mission.xml", file_system()).value.value();
  EXPECT_EQ(mission.find_mode("commissioning")->id, 1) << "counted from 1 in file order";
  const Mode& mode = *mission.find_mode("telepresence");
  EXPECT_EQ(mode.id, 7);
  EXPECT_EQ(mode.commission.at(0).state, State::SafeOperational);
  EXPECT_EQ(mode.commission.at(1).state, State::Operational);
  EXPECT_EQ(mode.establish, (std::vector<std::uint8_t>{1, 2}));
  EXPECT_EQ(mode.permits.at(1).functions.at(0), "*");
  EXPECT_EQ(mode.permits.at(1).parameters, std::vector<std::string>{"DES_POSITION"});
  EXPECT_EQ(mission.find_mode("commissioning")->permits.at(2).services, (std::vector<std::uint8_t>{3, 17, 20}));
  EXPECT_EQ(mission.plans.at(0).steps.at(0).kind, "shut_down_network");
  EXPECT_EQ(mission.plans.at(1).steps.at(0).values, std::vector{static_cast<std::int64_t>(State::SafeOperational)});
  EXPECT_EQ(mission.plans.at(1).event, "TORQUE_LIMIT_EXCEEDED");
  EXPECT_EQ(mission.plans.at(2).severities, (std::vector{Severity::Low, Severity::Info}));
}

TEST(MissionDescriptor, SaysWhatATerminalShows) {
  const auto read = read_mission(data / "mission.xml", file_system());
  ASSERT_TRUE(read.value);
  ASSERT_EQ(read.value->console.size(), 2U);
  const ShownValue& felt = read.value->console[0];
  EXPECT_EQ(felt.parameter, "CORONAGRAPH.CUR_VALUES.TORQUE");
  EXPECT_EQ(felt.label, "felt");
  EXPECT_EQ(felt.unit, "N m");
  EXPECT_EQ(felt.decimals, 2);
  EXPECT_EQ(read.value->console[1].unit, "");
  EXPECT_EQ(read.value->console[1].decimals, 3);
}

TEST(MissionDescriptor, APlanForWhatIsToldOfASubsystemNamesThatOneOrTheSupervisorOrNeither) {
  for (const char* when : {R"(subsystem="FLYWHEEL" event="HANG")", R"(subsystem="SUPERVISOR" event="HANG")",
                           R"(event="HANG")", R"(subsystem="FLYWHEEL" event="PROCESS_DIED" severity="high")"}) {
    const auto reading = read_mission(
        data / "mission.xml",
        overlay({{"mission.xml", changed(R"(<When severity="low info"/>)", "<When " + std::string{when} + "/>")}}));
    EXPECT_TRUE(reading.value) << when << '\n' << rendered(reading.problems, file_system());
  }
}

TEST(MissionDescriptor, APlanHasItsStepsInTheirOrderAndTheValuesThatAreNotGiven) {
  const auto reading = read_mission(
      data / "mission.xml",
      overlay({{"mission.xml", changed(R"(<When severity="low info"/><Do action="log"/>)",
                                       R"(<When event="PROCESS_DIED"/><Do action="restart" limit="5" pause_ms="20"/>)"
                                       R"(<Do action="set_state" state="Offline"/>)")}}));
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const auto& steps = reading.value->plans.at(2).steps;
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].kind, "restart");
  EXPECT_EQ(steps[0].values, (std::vector<std::int64_t>{5, 60, 20, 0}));
  EXPECT_EQ(steps[1].kind, "set_state");
  EXPECT_EQ(steps[1].values, (std::vector<std::int64_t>{0}));
}

struct Mistake {
  const char* code;
  const char* from;
  const char* to;  ///< '@' marks the line and column that must be named
  const char* hint = "";
};

// clang-format off
constexpr Mistake mistakes[] = {
    {"E0102", "<Links>", "@<Link/><Links>", "'Links'"},
    {"E0103", R"(seed="7")", R"(@sed="7")", "'seed'"},
    {"E0105", R"(<Establish link="1"/>)", "@<Establish/>"},
    {"E0106", R"(<Plan name="note"><When severity="low info"/>)", R"(@<Plan name="note">)"},
    {"E0107", R"(<When severity="low info"/>)", R"(<When severity="low info"/>@<When severity="low info"/>)"},
    {"E0110", R"(executable="hirosco-flywheel")", R"(executable="@../../bin/sh")"},
    {"E0110", R"(from="CORONAGRAPH.PLATE_STATE")", R"(from="@PLATE_STATE")"},
    {"E0111", R"(services="3 17 20")", R"(services="@3 ping")"},
    {"E0112", R"(services="3 17 20")", R"(services="@3 256")"},
    {"E0103", R"(<Mission name="ORBITER">)", R"(<Mission name="ORBITER" @id="1">)", "leave it out"},
    {"E0113", R"(action="shut_down_network")", R"(action="@shut_down_net")"},
    {"E0113", R"(strategy="sqlite")", R"(strategy="@sqlit")", "'sqlite'"},
    {"E0113", R"(severity="low info")", R"(severity="@low inof")", "'info'"},
    {"E0113", R"(state="SafeOperational"/>
    </Plan>)", R"(state="@SafeOperationl"/>
    </Plan>)", "'SafeOperational'"},
    {"E0201", R"(<Plan name="note">)", R"(@<Plan name="to-safe">)"},
    {"E0201", R"(subsystem="FLYWHEEL" configuration="COUPLED")", R"(subsystem="@CORONAGRAPH" configuration="COUPLED")"},
    {"E0202", R"(<Establish link="2"/>)", R"(<Establish link="@1"/>)"},
    {"E0202", R"(id="7">)", R"(id="1">)"},
    {"E0217", R"(telemetry="127.0.0.1:10015")", R"(telemetry="@127.0.0.1")"},
    {"E0304", R"(<Permit subsystem="FLYWHEEL")", R"(<Permit subsystem="@FLYWHEL")", "'FLYWHEEL'"},
    {"E0304", R"(<Ground subsystem="GROUNDSTATION")", R"(<Ground subsystem="@COMM")"},
    {"E0304", R"(from="FLYWHEEL.FLYWHEEL_STATE")", R"(from="@FLYWHEELS.FLYWHEEL_STATE")"},
    {"E0305", R"(start="telepresence")", R"(start="@telepresense")", "'telepresence'"},
    {"E0305", R"(mode="telepresence")", R"(mode="@none")"},
    {"E0306", R"(state="SafeOperational"/>
    </Plan>)", R"(state="@HardwareInit"/>
    </Plan>)"},
    {"E0306", R"(configuration="COUPLED" state="SafeOperational")", R"(configuration="COUPLED" state="@PostOperational")"},
    {"E0307", R"(to="FLYWHEEL.PLATE_STATE")", R"(to="@FLYWHEEL.PLATE_STATES")", "'PLATE_STATE'"},
    {"E0307", R"(from="CORONAGRAPH.PLATE_STATE")", R"(from="@CORONAGRAPH.PLATE")"},
    {"E0308", R"(<Link id="2" from="FLYWHEEL.FLYWHEEL_STATE" to="CORONAGRAPH.FLYWHEEL_STATE"/>)",
              R"(@<Link id="2" from="FLYWHEEL.FLYWHEEL_STATE" to="FLYWHEEL.PLATE_STATE"/>)"},
    {"E0309", R"(<Establish link="2"/>)", R"(<Establish link="@3"/>)"},
    {"E0310", R"(functions="SET_FORCE_SCALE")", R"(functions="@SET_FORCE_SCALES")", "'SET_FORCE_SCALE'"},
    {"E0310", R"(functions="SET_STATE CONFIGURE")", R"(functions="@SET_STATE NONE")"},
    {"E0310", R"(<Permit subsystem="FLYWHEEL" functions="SET_FORCE_SCALE")", R"(<Permit subsystem="FLYWHEEL" functions="@SET_MODE")"},
    {"E0311", R"(event="TORQUE_LIMIT_EXCEEDED")", R"(event="@TORQUE_LIMIT_EXCEDED")", "'TORQUE_LIMIT_EXCEEDED'"},
    {"E0312", R"(device="PLATE")", R"(device="@PLATES")", "'PLATE'"},
    {"E0313", R"(telemetry="127.0.0.1:10015")", R"(telemetry="@0.0.0.0:10015")", "loopback"},
    {"E0313", R"(telecommand="127.0.0.1:10025")", R"(telecommand="@127.0.0.1.example.org:10025")"},
    {"E0314", R"(path="log/orbiter.db")", R"(path="@/tmp/orbiter.db")"},
    {"E0314", R"(path="log/orbiter.db")", R"(path="@log/../../orbiter.db")"},
    {"E0112", R"(path="log/orbiter.db")", R"(path="log/orbiter.db" rotate_MB="@0")"},
    {"E0111", R"(path="log/orbiter.db")", R"(path="log/orbiter.db" rotate_h="@day")"},
    {"E0342", R"(path="log/orbiter.db")", R"(path="log/orbiter.db" keep_MB="@100")", "rotate_MB"},
    {"E0342", R"(path="log/orbiter.db")", R"(path="log/orbiter.db" rotate_MB="51" keep_MB="@100")", "at most half"},
    {"E0346", R"(path="log/orbiter.db")", R"(server="@host=db.example.org password=x" path="log/orbiter.db")", "passfile"},
    {"E0346", R"(path="log/orbiter.db")", R"(server="@postgresql://me:secret@db.example.org/log" path="log/orbiter.db")"},
    {"E0314", R"(descriptor="flywheel.xml")", R"(descriptor="@/etc/passwd")"},
    {"E0314", R"(descriptor="flywheel.xml")", R"(descriptor="@../../../../flywheel.xml")"},
    {"E0314", R"(descriptor="flywheel.xml")", R"(descriptor="@@hirosco/../flywheel.xml")"},
    {"E0315", R"(descriptor="flywheel.xml")", R"(descriptor="@../flywheel.xml.none")"},
    {"E0315", R"(descriptor="flywheel.xml")", R"(descriptor="@@hirosco/subsystems/none.xml")"},
    {"E0105", R"(<Power budget_W="150"/>)", R"(@<Power/>)"},
    {"E0107", R"(<Power budget_W="150"/>)", R"(<Power budget_W="150"/>@<Power budget_W="150"/>)"},
    {"E0111", R"(budget_W="150")", R"(budget_W="@much")"},
    {"E0112", R"(budget_W="150")", R"(budget_W="@-5")", "0.001 to 1000000 W"},
    {"E0105", R"(<Set parameter="DES_POSITION" value="-0.7 1.5"/>)", R"(@<Set parameter="DES_POSITION"/>)"},
    {"E0111", R"(value="-0.7 1.5")", R"(value="@here there")"},
    {"E0201", R"(<Set )", R"(<Set parameter="DES_POSITION" value="0 0"/><Set )"},
    {"E0204", R"("DES_POSITION" value)", R"("@DES_POSITIONS" value)", "'DES_POSITION'"},
    {"E0204", R"("DES_POSITION" value)", R"("@CYCLE_STATS" value)"},
    {"E0207", R"(value="-0.7 1.5")", R"(value="@-0.7 2.7")", "-2 to 2.6"},
    {"E0209", R"(value="-0.7 1.5")", R"(value="@-0.7")"},
    {"E0319", R"("DES_POSITION" value="-0.7 1.5")", R"("@TORQUE_LIMIT" value="9")", "change it in the descriptor"},
    {"E0351", R"(<Setting name="STIFFNESS" value)", R"(<Setting name="@STIFNESS" value)", "'STIFFNESS'"},
    {"E0312", R"(<Device name="PLATE"><Set)", R"(<Device name="@PLATES"><Set)", "'PLATE'"},
    {"E0105", R"(<Device name="PLATE"><Setting name="STIFFNESS" value="4500"/></Device>)", R"(@<Device name="PLATE"/>)"},
    {"E0201", R"(<Setting name="STIFFNESS" value="4500"/>)", R"(<Setting name="STIFFNESS" value="1"/>@<Setting name="STIFFNESS" value="2"/>)"},
    {"E0316", R"(configuration="COUPLED" state)", R"(configuration="@COUPLE" state)", "'COUPLED'"},
    {"E0320", R"(parameters="DES_POSITION")", R"(parameters="@DES_POSITIONS")", "'DES_POSITION'"},
    {"E0320", R"(parameters="DES_POSITION")", R"(parameters="@TORQUE_LIMIT")", "writable"},
    {"E0109", R"(parameters="DES_POSITION")", R"(parameters="@ ")"},
    {"E0105", R"( functions="*" services="3 20" parameters="DES_POSITION")", ""},
    {"E0325", R"(severity="medium" subsystem)", R"(severity="@high low" subsystem)", "leave severity out"},
    {"E0325", R"(<Plan name="note"><When severity="low info"/>)", R"(<Plan name="note"><When event="@RECOVERY_STEP"/>)", "the other plan"},
    {"E0326", R"(<Plan name="note"><When severity="low info"/><Do action="log"/>)", R"(@<Plan name="note"><When severity="low info"/><Do action="restart"/>)", "PROCESS_DIED"},
    {"E0326", R"(<Plan name="note"><When severity="low info"/><Do action="log"/>)", R"(@<Plan name="note"><When event="HANG"/><Do action="restart"/>)", "PROCESS_DIED"},
    {"E0311", R"(<Plan name="note"><When severity="low info"/>)", R"(<Plan name="note"><When subsystem="FLYWHEEL" event="@LOG_STORE"/>)"},
    {"E0311", R"(<Plan name="note"><When severity="low info"/>)", R"(<Plan name="note"><When subsystem="FLYWHEEL" event="@GROUND_LINK_LOST"/>)"},
    {"E0317", R"(<Do action="log"/>)", R"(<Do action="log" state="@Operational"/>)"},
    {"E0317", R"(<Do action="log"/>)", R"(<Do action="log" limit="@3"/>)"},
    {"E0317", R"(<Do action="log"/>)", R"(<Do action="log" subsystem="@FLYWHEEL"/>)", "whose event"},
    {"E0304", R"(<Do action="shut_down_network"/>)", R"(<Do action="shut_down_network" subsystem="@FLYWHEELS"/>)", "'FLYWHEEL'"},
    {"E0304", R"(<Do action="shut_down_network"/>)", R"(<Do action="shut_down_network" subsystem="@SUPERVISOR"/>)"},
    {"E0370", R"(<Do action="log"/>)", R"(<Do action="set_state" state="@Operational"/>)", "the ground"},
    {"E0371", R"(<Plan name="note">)", R"(<Plan name="@default">)", "another name"},
    {"E0112", R"(<Plan name="note">)", R"(<Plan name="note" priority="@0">)"},
    {"E0112", R"(<Plan name="note">)", R"(<Plan name="note" priority="@256">)"},
    {"E0317", R"(<Do action="log"/>)", R"(<Do action="log" to="@commanded"/>)"},
    {"E0113", R"(<When severity="low info"/><Do action="log"/>)", R"(<When event="PROCESS_DIED"/><Do action="restart" to="@Operational"/>)", "PreOperational"},
    {"E0103", R"(<Do action="log"/>)", R"(<Do action="log" @lmit="3"/>)"},
    {"E0103", R"(<Plan name="note">)", R"(<Plan name="note" @safety="yes">)"},
    {"E0105", R"(<Do action="log"/>)", R"(@<Do action="set_state"/>)"},
    {"E0112", R"(<When severity="low info"/><Do action="log"/>)", R"(<When event="PROCESS_DIED"/><Do action="restart" limit="@0"/>)"},
    {"E0327", R"(parameter="ACTIVE" label)", R"(parameter="@CUR_VALUES.TORQ" label)", "CUR_VALUES.TORQUE"},
    {"E0327", R"(parameter="ACTIVE" label)", R"(parameter="@CUR_VALUES" label)"},
    {"E0304", R"(<Show subsystem="CORONAGRAPH" parameter="ACTIVE")", R"(<Show subsystem="@NOBODY" parameter="ACTIVE")"},
    {"E0105", R"( label="active")", ""},
    {"E0340", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE" on_loss="@hold"/>)"},
    {"E0340", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE" hold_ms="@50"/>)"},
    {"E0340", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE" fallback="@COUPLED"/>)"},
    {"E0340", R"(<Link id="2" from="FLYWHEEL.FLYWHEEL_STATE" to="CORONAGRAPH.FLYWHEEL_STATE"/>)", R"(<Link id="2" from="FLYWHEEL.FLYWHEEL_STATE" to="CORONAGRAPH.FLYWHEEL_STATE" on_loss="@ignore"/>)", "leave on_loss out"},
    {"E0341", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE" on_loss="@ignore"/>)", "missing="},
    {"E0316", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE" on_loss="fallback" fallback="@COUPELD"/>)", "COUPLED"},
    {"E0340", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE" on_loss="fallback" fallback="@COUPLED"/>)", "without it"},
    {"E0113", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE" on_loss="@perhaps"/>)"},
    {"E0112", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE" on_loss="hold" hold_ms="@0"/>)"},
    {"E0329", R"(<Ground subsystem="GROUNDSTATION")", R"(<Ground subsystem="@CORONAGRAPH")", "another subsystem"},
};
// clang-format on

TEST(MissionErrors, AreReportedWhereTheyStand) {
  for (const Mistake& bad : mistakes) {
    const auto expected = marked(changed(bad.from, bad.to));
    const bool anywhere = std::string_view{bad.to}.find('@') == std::string_view::npos;
    const auto source = overlay({{"mission.xml", expected.text}});
    const auto reading = read_mission(data / "mission.xml", source);
    const std::string found = rendered(reading.problems, source);
    EXPECT_FALSE(reading.value) << bad.to;
    ASSERT_FALSE(reading.problems.empty()) << bad.to;
    const bool there = std::ranges::any_of(reading.problems, [&](const Diagnostic& problem) {
      return problem.code == bad.code && problem.hint.find(bad.hint) != std::string::npos &&
             (anywhere || (problem.at.line == expected.at.line && problem.at.column == expected.at.column));
    });
    EXPECT_TRUE(there) << bad.code << " expected at " << expected.at.line << ":" << expected.at.column << " for "
                       << bad.to << "\nfound:\n"
                       << found;
    EXPECT_LE(reading.problems.size(), 2U) << "follow-up problems:\n" << found;
  }
}

TEST(MissionErrors, ProblemsOfASubsystemCarryItsOwnFile) {
  const std::string flywheel = file_system()(data / "flywheel.xml").value();
  const auto reading = read_mission(data / "mission.xml",
                                    overlay({{"flywheel.xml", changed("type=\"UINT8\"", "type=\"UNIT8\"", flywheel)}}));
  ASSERT_EQ(reading.problems.size(), 1U) << rendered(reading.problems, file_system());
  EXPECT_EQ(reading.problems[0].file, data / "flywheel.xml");
  EXPECT_EQ(reading.problems[0].code, "E0104");
}

TEST(MissionErrors, FieldsOfALinkMustMatch) {
  const std::string flywheel = file_system()(data / "flywheel.xml").value();
  const auto with = [&](const std::string& from, const std::string& to) {
    const auto reading = read_mission(data / "mission.xml", overlay({{"flywheel.xml", changed(from, to, flywheel)}}));
    EXPECT_EQ(reading.problems.size(), 1U) << rendered(reading.problems, file_system());
    return reading.problems.empty() ? std::string{} : reading.problems[0].message;
  };
  const std::string torque = "name=\"TORQUE\" type=\"DOUBLE\" count=\"2\" unit=\"N m\"";
  EXPECT_EQ(with(torque, "name=\"TORQUE\" type=\"FLOAT\" count=\"2\" unit=\"N m\""),
            "link 1 does not fit: field 'TORQUE': DOUBLE[2] N m against FLOAT[2] N m");
  EXPECT_EQ(with(torque, "name=\"TORQUE\" type=\"DOUBLE\" count=\"2\" unit=\"mN m\""),
            "link 1 does not fit: field 'TORQUE': DOUBLE[2] N m against DOUBLE[2] mN m");
  EXPECT_EQ(with(torque, "name=\"FORCE\" type=\"DOUBLE\""),
            "link 1 does not fit: field 'FORCE' is not in the provided set");
  EXPECT_EQ(with("from=\"CORONAGRAPH\"", "from=\"OTHER\""),
            "link 1 does not fit: 'PLATE_STATE' is required from 'OTHER'");
  EXPECT_EQ(with("from=\"CORONAGRAPH\"", "byte_order=\"big\""), "link 1 does not fit: no common byte order");
}

TEST(MissionErrors, WhatAModeCommissionsMustFitThePowerBudget) {
  const std::string flywheel =
      changed(R"(<Configuration name="COUPLED")", R"(<Configuration power_W="25" name="COUPLED")",
              file_system()(data / "flywheel.xml").value());
  const auto with = [&](const std::string& budget, const std::string& state) {
    const std::string text = changed(R"(budget_W="150")", budget, good_mission());
    const std::string robot = R"(configuration="COUPLED" state=")";
    return read_mission(data / "mission.xml",
                        overlay({{"mission.xml", changed(robot + "SafeOperational", robot + state, text)},
                                 {"flywheel.xml", flywheel}}));
  };
  EXPECT_TRUE(with(R"(budget_W="85.5")", "SafeOperational").value);
  EXPECT_TRUE(with(R"(budget_W="85")", "PreOperational").value);
  const auto reading = with(R"(budget_W="85")", "SafeOperational");
  ASSERT_EQ(reading.problems.size(), 1U) << rendered(reading.problems, file_system());
  EXPECT_EQ(reading.problems[0].code, "E0318");
  EXPECT_EQ(reading.problems[0].message, "mode 'telepresence' commissions 85.5 W, the budget is 85 W");
  EXPECT_EQ(reading.problems[0].at.column, 5);
}

/// The good mission with changes to any of its files; each names the file and what is replaced.
struct Change {
  const char* file;
  std::string from, to;
};
Reading<Mission> read_changed(const std::vector<Change>& changes) {
  std::map<std::string, std::string> files;
  for (const Change& change : changes) {
    auto& text = files.try_emplace(change.file, file_system()(data / change.file).value()).first->second;
    text = changed(change.from, change.to, text);
  }
  return read_mission(data / "mission.xml", overlay(files));
}

void expect_one(const Reading<Mission>& reading, std::string_view code, std::string_view message) {
  ASSERT_EQ(reading.problems.size(), 1U) << message << rendered(reading.problems, file_system());
  EXPECT_EQ(reading.problems[0].code, code);
  EXPECT_EQ(reading.problems[0].message, message);
  EXPECT_FALSE(reading.problems[0].hint.empty());
  EXPECT_GT(reading.problems[0].at.line, 1);
}

TEST(MissionErrors, AModeBringsUpALinkIntoEachSetThatItRequires) {
  const Change without{"mission.xml", "<Establish link=\"1\"/>", ""};
  const std::string_view missing =
      "mode 'telepresence' brings up no link into 'FLYWHEEL.PLATE_STATE', which configuration 'COUPLED' requires";
  expect_one(read_changed({without}), "E0321", missing);
  EXPECT_EQ(read_changed({without}).problems.at(0).hint, "add <Establish link=\"1\"/>");
  const Change none{"mission.xml", R"(<Link id="1" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)", ""};
  expect_one(read_changed({without, none}), "E0321", missing);
  const Change optional{"flywheel.xml", "<Requires name=\"PLATE_STATE\"",
                        "<Requires name=\"PLATE_STATE\" required=\"no\""};
  EXPECT_TRUE(read_changed({without, optional}).value);
  const Change resting{"mission.xml", R"(<Commission subsystem="FLYWHEEL" configuration="COUPLED"/>)",
                       R"(<Commission subsystem="FLYWHEEL" configuration="COUPLED" state="PreOperational"/>)"};
  EXPECT_TRUE(read_changed({without, resting}).value) << "Pre-Operational waits for no link";
}

TEST(MissionErrors, ALinkComesUpBetweenSetsThatItsModeCommissions) {
  expect_one(read_changed({{"mission.xml", R"(subsystem="CORONAGRAPH" configuration="COUPLED")",
                            R"(subsystem="CORONAGRAPH" configuration="STANDALONE")"},
                           {"mission.xml", "<Establish link=\"2\"/>", ""}}),
             "E0322",
             "link 1 cannot come up: configuration 'STANDALONE' of 'CORONAGRAPH' does not provide 'PLATE_STATE'");
  expect_one(read_changed({{"mission.xml", R"(<Commission subsystem="FLYWHEEL" configuration="COUPLED"/>)", ""},
                           {"mission.xml", "<Establish link=\"1\"/>", ""}}),
             "E0322", "link 2 cannot come up: the mode does not commission 'FLYWHEEL'");
}

TEST(MissionErrors, ASetIsFilledByOneLink) {
  expect_one(
      read_changed({{"mission.xml", "<Links>",
                     R"(<Links><Link id="3" from="CORONAGRAPH.PLATE_STATE" to="FLYWHEEL.PLATE_STATE"/>)"},
                    {"mission.xml", "<Establish link=\"2\"/>", R"(<Establish link="2"/><Establish link="3"/>)"}}),
      "E0323", "links 1 and 3 both fill 'FLYWHEEL.PLATE_STATE'");
}

TEST(MissionErrors, TheCyclesOfAModeFitOneProcessor) {
  const auto with = [](const char* robot, const char* flywheel) {
    return read_changed({{"coronagraph.xml", R"(<Configuration name="COUPLED")",
                          std::string{R"(<Configuration name="COUPLED" budget_us=")"} + robot + "\""},
                         {"flywheel.xml", R"(<Configuration name="COUPLED")",
                          std::string{R"(<Configuration name="COUPLED" budget_us=")"} + flywheel + "\""}});
  };
  const auto good = with("300", "200");
  ASSERT_TRUE(good.value) << rendered(good.problems, file_system());
  EXPECT_DOUBLE_EQ(cycle_share(*good.value, *good.value->find_mode("telepresence")), 1);
  EXPECT_DOUBLE_EQ(cycle_share(*good.value), 1);
  EXPECT_DOUBLE_EQ(cycle_share(*good.value, *good.value->find_mode("commissioning")), 0);
  expect_one(with("300", "205"), "E0324", "the cycles of mode 'telepresence' take 101 % of a processor");
}

TEST(MissionErrors, EveryCycleOfAModeEndsBeforeItIsDueAgain) {
  const auto with = [](const char* robot, const char* flywheel) {
    return read_changed({{"coronagraph.xml", R"(name="COUPLED" id="2" priority="80" sampling_us="500")",
                          std::string{R"(name="COUPLED" id="2" )"} + robot},
                         {"flywheel.xml", R"(name="COUPLED" id="2" priority="80" sampling_us="500")",
                          std::string{R"(name="COUPLED" id="2" )"} + flywheel}});
  };
  // Sixty per cent of a processor, but the slow one goes first and takes longer than the quick one may wait.
  expect_one(
      with(R"(priority="81" sampling_us="2000" budget_us="800")", R"(priority="80" sampling_us="500" budget_us="100")"),
      "E0331", "in mode 'telepresence' a cycle of FLYWHEEL 'COUPLED' may not end within its 500 us");
  EXPECT_TRUE(
      with(R"(priority="80" sampling_us="2000" budget_us="800")", R"(priority="81" sampling_us="500" budget_us="100")")
          .value);
}

TEST(MissionWarnings, NameActuatorsWithoutASecondInhibitAndKeepTheMission) {
  const auto codes = [](const Reading<Mission>& reading) {
    std::string all;
    for (const Diagnostic& warning : reading.warnings) all += warning.code + " ";
    return all;
  };
  EXPECT_EQ(codes(read_changed({})), "");
  const auto reading =
      read_changed({{"coronagraph.xml", R"(<Enable transfer="shared_memory" address="orbiter-robot-enable"/>)", ""}});
  EXPECT_TRUE(reading.value);
  ASSERT_EQ(codes(reading), "E0403 ");
  EXPECT_EQ(reading.warnings[0].grade, Grade::Warning);
  EXPECT_EQ(reading.warnings[0].file, data / "coronagraph.xml");
  EXPECT_EQ(reading.warnings[0].message, "actuator 'PLATE' has no second inhibit");
}

TEST(MissionErrors, NamesAndIdsOfSubsystemsAreUnique) {
  const std::string flywheel = file_system()(data / "flywheel.xml").value();
  const auto code = [&](const std::string& from, const std::string& to) {
    const auto reading = read_mission(data / "mission.xml", overlay({{"flywheel.xml", changed(from, to, flywheel)}}));
    EXPECT_FALSE(reading.problems.empty());
    return reading.problems.empty() ? std::string{} : reading.problems[0].code;
  };
  EXPECT_EQ(code("id=\"11\"", "id=\"10\""), "E0302");
  EXPECT_EQ(code("id=\"11\"", "id=\"1\""), "E0332") << "who has its id is judged as the supervisor";
  const auto numbered =
      read_changed({{"mission.xml", R"(descriptor="flywheel.xml")", R"(descriptor="flywheel.xml" id="1")"}});
  ASSERT_FALSE(numbered.problems.empty());
  EXPECT_EQ(numbered.problems[0].code, "E0303");
  EXPECT_EQ(code("name=\"FLYWHEEL\"", "name=\"CORONAGRAPH\""), "E0301");
  const std::string supervisor = file_system()(data / "supervisor.xml").value();
  const auto reading =
      read_mission(data / "mission.xml", overlay({{"supervisor.xml", changed("id=\"1\"", "id=\"3\"", supervisor)}}));
  ASSERT_FALSE(reading.problems.empty());
  EXPECT_EQ(reading.problems[0].code, "E0303");
}

TEST(MissionErrors, EndnodesStayOnThisComputer) {
  const std::string robot = file_system()(data / "coronagraph.xml").value();
  const auto reading = read_mission(data / "mission.xml",
                                    overlay({{"coronagraph.xml", changed("127.0.0.1:5001", "192.0.2.1:5001", robot)}}));
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "E0313");
  EXPECT_EQ(reading.problems[0].file, data / "coronagraph.xml");
}

TEST(MissionErrors, AnAddressBelongsToOneSubsystem) {
  const std::string flywheel = file_system()(data / "flywheel.xml").value();
  for (const char* robots : {"orbiter-robot", "orbiter-robot-enable"}) {
    const auto reading =
        read_mission(data / "mission.xml", overlay({{"flywheel.xml", changed("orbiter-stick", robots, flywheel)}}));
    ASSERT_EQ(reading.problems.size(), 1U) << robots;
    EXPECT_EQ(reading.problems[0].code, "E0313");
    EXPECT_EQ(reading.problems[0].message, "'" + std::string{robots} + "' is a device's of 'CORONAGRAPH'");
  }
}

TEST(MissionErrors, ALentSetHasTheSameFieldsInTheSameOrderAtBothEnds) {
  constexpr std::string_view a = R"(<Field name="A" type="UINT8" count="70000" unit="m"/>)",
                             b = R"(<Field name="B" type="UINT64"/>)",
                             wide = R"(<Field name="A" type="UINT16" count="70000" unit="m"/>)";
  const auto why = [&](std::string_view provided, std::string_view required, std::string_view kind = "loaned") {
    std::string text =
        R"(<Subsystem name="S" id="10"><Configuration name="C" id="1" sampling_us="100"><RealTimeLinkService>)";
    text.append(R"(<Provides name="P" kind="loaned">)").append(provided).append("</Provides>");
    text.append(R"(<Requires name="R" kind=")").append(kind).append("\">").append(required).append("</Requires>");
    const auto reading = testing::read_text(text + "</RealTimeLinkService></Configuration></Subsystem>");
    if (!reading.value) return rendered(reading.problems, file_system());
    const Configuration& configuration = reading.value->configurations.front();
    return detail::mismatch({*reading.value, configuration, configuration.provides.front(), *reading.value,
                             configuration, configuration.requires_.front()},
                            std::nullopt);
  };
  const std::string both = std::string{a} + std::string{b}, reverse = std::string{b} + std::string{a};
  EXPECT_EQ(why(both, both), "");
  EXPECT_EQ(why(both, reverse), "a lent set has the same fields in the same order at both ends");
  EXPECT_EQ(why(both, a), "a lent set has the same fields in the same order at both ends");
  EXPECT_EQ(why(a, both), "field 'B' is not in the provided set");
  EXPECT_EQ(why(wide, a), "field 'A': UINT16[70000] m against UINT8[70000] m");
  EXPECT_EQ(why(both, b, "latest"), "no common kind");
}

TEST(MissionErrors, AQueueOfAllThatIsProvidedFitsItsMemory) {
  const auto why = [](std::string_view depth) {
    std::string text = R"(<Subsystem name="S" id="10"><Parameters><ParamRef name="A" id="1" type="DOUBLE" count="4096"/>
      <ParamRef name="B" id="2" type="DOUBLE" count="4096"/></Parameters>
      <Configuration name="C" id="1" sampling_us="100"><RealTimeLinkService>
      <Provides name="P" kind="latest queued"><ParamRef name="A"/><ParamRef name="B"/></Provides>
      <Requires name="R" kind="queued" depth=")";
    text.append(depth).append(R"("><Field name="A" type="DOUBLE" count="4096"/></Requires>)");
    const auto reading = testing::read_text(text + "</RealTimeLinkService></Configuration></Subsystem>");
    if (!reading.value) return rendered(reading.problems, file_system());
    const Configuration& configuration = reading.value->configurations.front();
    return detail::mismatch({*reading.value, configuration, configuration.provides.front(), *reading.value,
                             configuration, configuration.requires_.front()},
                            std::nullopt);
  };
  EXPECT_EQ(why("1024"), "");
  EXPECT_EQ(why("1025"), "1025 samples of 65536 octets are more than 67108864");
}

TEST(MissionErrors, EveryTruncationIsRefused) {
  std::string text = good_mission();
  while (text.ends_with('\n')) text.pop_back();
  for (std::size_t octets = 0; octets < text.size(); octets += hirosco::testing::one_in(std::size_t{7}))
    EXPECT_FALSE(read_mission(data / "mission.xml", overlay({{"mission.xml", text.substr(0, octets)}})).value)
        << octets;
}

}  // namespace
}  // namespace hirosco::descriptor
