// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/in_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/descriptor/testing.hpp"

/// What of a descriptor may change while its subsystem flies.
namespace hirosco::descriptor {
namespace {

using testing::changed;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string flown_text = R"(<Subsystem name="PAN" id="9">
  <Description>it turns</Description>
  <Parameters>
    <ParamRef name="GAIN" id="1" type="DOUBLE" init="3" minimum="0" maximum="10" writable="PreOperational"/>
    <ParamRef name="TITLE" id="1" type="TEXT" octets="8" init="old"/>
    <ParamRef name="LIMIT" id="2" type="DOUBLE" init="1" minimum="0" maximum="2" protection="yes"/>
    <ParamRef name="STAYS" id="3" type="DOUBLE" minimum="0" maximum="7" persistent="yes" writable="PreOperational"/>
    <StructRef name="SEEN" id="1" type="STRUCT"><ParamRef name="ANGLE" id="9" type="FLOAT" minimum="-1" maximum="1"/></StructRef>
  </Parameters>
  <Enumeration name="SIDES"><Text value="0">left</Text><Text value="1">right</Text></Enumeration>
  <Resources memory_kB="100000"/>
  <EventService><Event name="BUMP" id="7" severity="low"><Argument name="WHERE" type="DOUBLE"/></Event></EventService>
  <FunctionService>
    <Function name="TURN" states="Operational"><Argument name="TO" type="DOUBLE" minimum="-1" maximum="1" default="0"/></Function>
    <Function name="RAISE_LIMIT" states="Operational"><Argument name="TO" of="LIMIT"/></Function>
  </FunctionService>
  <CustomService name="GAZE" type="200">
    <Request name="LOOK" subtype="1" states="Operational"><Argument name="AT" type="UINT8" minimum="0" maximum="4"/></Request>
    <Report name="SAW" subtype="2"><Field name="WHAT" type="UINT8" enumeration="SIDES"/></Report>
  </CustomService>
  <Device name="MOTOR" actuator="yes">
    <Input><Field name="ANGLE" type="DOUBLE"/></Input>
    <Output><Field name="TORQUE" type="DOUBLE" safe="0" minimum="-5" maximum="5"/></Output>
    <Enable transfer="udp" address="127.0.0.1:4001"/>
  </Device>
  <Device name="LAMP"><Output><Field name="LIT" type="UINT8" minimum="0" maximum="1"/></Output></Device>
  <Configuration name="FAST" id="1" priority="50" sampling_us="1000" power_W="5">
    <HKService id="11" interval="10"><SampledOnce><ParamRef name="GAIN"/></SampledOnce></HKService>
    <RealTimeLinkService>
      <Provides name="OUT"><ParamRef name="GAIN"/></Provides>
      <Requires name="IN" age="3"><Field name="X" type="DOUBLE"/></Requires>
    </RealTimeLinkService>
    <Device name="MOTOR" silence="3" watchdog_ms="10"><Endnode transfer="udp" address="127.0.0.1:4000"/></Device>
    <Device name="LAMP" silence="3"><Setting name="colour" value="red"/><Endnode transfer="shared_memory" address="lamp"/></Device>
    <Set parameter="GAIN" value="4"/>
  </Configuration>
</Subsystem>)";

[[nodiscard]] SubsystemDescriptor read(const std::string& text) {
  auto reading = testing::read_text(text);
  EXPECT_TRUE(reading.value) << testing::rendered(reading.problems, testing::text_source(text));
  return reading.value.value_or(SubsystemDescriptor{});
}

struct Edit {
  const char* from;
  const char* to;
  const char* told{""};  ///< of the obstacle
};

[[nodiscard]] std::string all(const std::vector<Obstacle>& found) {
  std::string text;
  for (const Obstacle& each : found) text += each.what + "\n";
  return text;
}

TEST(InFlight, NothingStandsAgainstTheSameText) {
  EXPECT_THAT(obstacles(read(flown_text), read(flown_text)), IsEmpty());
  EXPECT_THAT(obstacles_in_force(read(flown_text), read(flown_text), 1), IsEmpty());
}

TEST(InFlight, WhatIsNotBuiltInMayChange) {
  for (const Edit& edit : std::initializer_list<Edit>{
           {"it turns", "it turns about"},
           {R"(init="3" minimum="0" maximum="10" w)", R"(init="3" minimum="1" maximum="20" w)"},
           {R"(init="3")", R"(init="5")"},
           {R"(init="old")", R"(init="new")"},
           {R"(maximum="10" writable="PreOperational")", R"(maximum="10" writable="PreOperational SafeOperational")"},
           {R"(minimum="-1" maximum="1"/></StructRef>)", R"(minimum="-2" maximum="1"/></StructRef>)"},
           {R"(minimum="-1" maximum="1" default="0")", R"(minimum="-2" maximum="2" default="1")"},
           {R"(type="UINT8" minimum="0" maximum="4")", R"(type="UINT8" minimum="0" maximum="5")"},
           {R"(<HKService id="11" interval="10">)", R"(<HKService id="11" interval="20" enabled="no">)"},
           {R"(<HKService id="11" interval="10"><SampledOnce><ParamRef name="GAIN"/></SampledOnce></HKService>)",
            R"(<HKService id="12" interval="10"><SampledOnce><ParamRef name="SEEN"/></SampledOnce></HKService>)"},
           {R"(127.0.0.1:4000)", R"(127.0.0.1:4002)"},
           {R"(address="lamp")", R"(address="lamp-2")"},
           {R"(<Device name="LAMP" silence="3">)", R"(<Device name="LAMP" silence="9" every="2">)"},
           {R"(value="red")", R"(value="blue")"},
           {R"("UINT8" minimum="0" maximum="1")", R"("UINT8" minimum="1" maximum="2")"},
           {R"(power_W="5")", R"(power_W="6" overruns="9")"},
           {R"(age="3")", R"(age="5")"},
           {"<EventService>", R"(<Failure code="0x8001" name="BENT"/><EventService>)"},
           {R"(<Set parameter="GAIN" value="4"/>)", R"(<Set parameter="GAIN" value="6"/>)"}})
    EXPECT_EQ(all(obstacles(read(flown_text), read(changed(edit.from, edit.to, flown_text)))), "") << edit.from;
}

TEST(InFlight, WhatMemoryThreadsLinksAndGuardWereMadeByIsRefusedByName) {
  for (const Edit& edit : std::initializer_list<Edit>{
           {R"(name="PAN" id="9")", R"(name="PEN" id="9")", "its name or id"},
           {R"(name="GAIN" id="1" type="DOUBLE")", R"(name="GAIN" id="1" type="FLOAT")", "parameter GAIN: its type"},
           {R"(name="GAIN" id="1" type="DOUBLE")", R"(name="GAIN" id="4" type="DOUBLE")", "parameter GAIN: its id"},
           {R"(name="GAIN" id="1" type="DOUBLE")", R"(name="GAIN" id="1" type="DOUBLE" unit="V")",
            "parameter GAIN: its unit"},
           {R"(octets="8")", R"(octets="9")", "parameter TITLE: how many there are"},
           {R"(init="1" minimum="0" maximum="2" protection)", R"(init="1" minimum="0" maximum="3" protection)",
            "parameter LIMIT: range or initial value of a protection"},
           {R"(init="1" minimum="0" maximum="2" protection)", R"(init="2" minimum="0" maximum="2" protection)",
            "parameter LIMIT: range or initial value of a protection"},
           {R"(persistent="yes" )", "", "parameter STAYS: whether it outlives the flight"},
           {R"(name="ANGLE" id="9" type="FLOAT")", R"(name="ANGLE" id="8" type="FLOAT")",
            "parameter SEEN.ANGLE: its id"},
           {R"(<ParamRef name="ANGLE" id="9")",
            R"(<ParamRef name="MORE" id="7" type="FLOAT"/><ParamRef name="ANGLE" id="9")",
            "parameter SEEN: member MORE is new"},
           {R"(<ParamRef name="TITLE")", R"(<ParamRef name="FRESH" id="8" type="DOUBLE"/><ParamRef name="TITLE")",
            "parameter FRESH is new"},
           {R"(<ParamRef name="TITLE" id="1" type="TEXT" octets="8" init="old"/>)", "", "parameter TITLE is gone"},
           {">right<", ">other<", "enumeration SIDES: its values and their names"},
           {R"(memory_kB="100000")", R"(memory_kB="90000")", "its resources"},
           {R"(memory_kB="100000")", R"(memory_kB="100000" waiting_events="500")", "its resources"},
           {R"(memory_kB="100000")", R"(memory_kB="100000" cycle_events_kB="64")", "its resources"},
           {R"(memory_kB="100000")", R"(memory_kB="100000" channel_kB="64")", "its resources"},
           {R"(name="BUMP" id="7" severity="low")", R"(name="BUMP" id="7" severity="high")",
            "event BUMP: what follows it"},
           {R"(name="BUMP" id="7")", R"(name="BUMP" id="8")", "event BUMP: its id"},
           {R"(<Argument name="WHERE" type="DOUBLE"/>)", "", "event BUMP: field WHERE is gone"},
           {R"(<Function name="TURN" states="Operational">)", R"(<Function name="TURN" states="SafeOperational">)",
            "function TURN: when it is permitted"},
           {R"(name="TO" type="DOUBLE")", R"(name="TO" type="FLOAT")", "function TURN: argument TO: its type"},
           {R"(maximum="1" default="0")", R"(maximum="1")", "function TURN: argument TO: whether it may be left out"},
           {R"(name="GAZE" type="200")", R"(name="GAZE" type="201")", "service GAZE: its type"},
           {R"(name="LOOK" subtype="1")", R"(name="LOOK" subtype="3")", "service GAZE: request LOOK: its type"},
           {R"(name="SAW" subtype="2")", R"(name="SAW" subtype="4")", "service GAZE: report SAW: its subtype"},
           {R"(minimum="-5" maximum="5")", R"(minimum="-5" maximum="50")",
            "device MOTOR: what an actuator may be told"},
           {R"(safe="0" minimum="-5")", R"(safe="1" minimum="-5")", "device MOTOR: what an actuator may be told"},
           {"127.0.0.1:4001", "127.0.0.1:4009", "device MOTOR: its second inhibit"},
           {R"(name="LIT" type="UINT8")", R"(name="LIT" type="UINT16")", "device LAMP: field LIT: its type"},
           {R"(watchdog_ms="10")", R"(watchdog_ms="20")", "device MOTOR: the watchdog of an actuator"},
           {R"(<Setting name="colour")", R"(<Setting name="shade")", "device LAMP: which settings it has"},
           {R"(sampling_us="1000")", R"(sampling_us="2000")", "configuration FAST: priority, sampling time or budget"},
           {R"(<SampledOnce><ParamRef name="GAIN"/>)", R"(<SampledOnce><ParamRef name="SEEN"/>)",
            "housekeeping 11: what it reports"},
           {R"(<Provides name="OUT"><ParamRef name="GAIN"/>)", R"(<Provides name="OUT"><ParamRef name="SEEN"/>)",
            "provided set OUT: field GAIN is gone"},
           {R"(<Field name="X" type="DOUBLE"/></Requires>)", R"(<Field name="Y" type="DOUBLE"/></Requires>)",
            "required set IN: field X is gone"},
           {R"(<Field name="X" type="DOUBLE"/></Requires>)", R"(<Field name="X" type="FLOAT"/></Requires>)",
            "required set IN: field X: its type or length"},
           {R"(<Requires name="IN" age="3">)", R"(<Requires name="IN" age="3" missing="hold">)",
            "required set IN: what is without it"},
           {R"(<Function name="TURN" states="Operational">)",
            R"(<Function name="TURN" states="Operational" sets="GAIN">)", "function TURN: which parameters it sets"},
           {R"(<Request name="LOOK" subtype="1" states="Operational">)",
            R"(<Request name="LOOK" subtype="1" states="Operational" sets="SEEN">)",
            "service GAZE: request LOOK: which parameters it sets"},
           {R"(name="FAST" id="1")", R"(name="FAST" id="2")", "configuration FAST: its id"}}) {
    const SubsystemDescriptor fresh = read(changed(edit.from, edit.to, flown_text));
    EXPECT_THAT(all(obstacles(read(flown_text), fresh)), HasSubstr(edit.told)) << edit.from;
  }
}

/// Each is behind what was there, but for events, functions and fields of links, whose order nobody goes by.
const std::initializer_list<Edit> additions = {
    {"</StructRef>", R"(</StructRef><ParamRef name="FRESH" id="8" type="DOUBLE" init="7" minimum="0" maximum="9"/>)",
     "parameter FRESH is new"},
    {"<EventService>", R"(<EventService><Event name="CRACK" id="6" severity="high"/>)", "event CRACK is new"},
    {R"(<Function name="RAISE_LIMIT")", R"(<Function name="SPIN" states="Operational"/><Function name="RAISE_LIMIT")",
     "function SPIN is new"},
    {R"(<Enumeration name="SIDES">)",
     R"(<Enumeration name="ENDS"><Text value="0">top</Text></Enumeration><ParamRef name="END" id="7" type="UINT8" enumeration="ENDS"/><Enumeration name="SIDES">)",
     "enumeration ENDS is new\nparameter END is new"},
    {R"(<Provides name="OUT"><ParamRef name="GAIN"/>)",
     R"(<Provides name="OUT"><ParamRef name="GAIN"/><ParamRef name="SEEN.ANGLE"/>)",
     "configuration FAST: provided set OUT: field SEEN.ANGLE is new"},
    {R"(<Field name="X" type="DOUBLE"/></Requires>)",
     R"(<Field name="Y" type="UINT8" count="3"/><Field name="X" type="DOUBLE"/></Requires>)",
     "configuration FAST: required set IN: field Y is new"}};

TEST(InFlight, WhatIsAddedNeedsAProgramThatHasIt) {
  for (const Edit& edit : additions) {
    const SubsystemDescriptor fresh = read(changed(edit.from, edit.to, flown_text));
    const auto found = obstacles(read(flown_text), fresh);
    EXPECT_EQ(all(found), std::string{edit.told} + "\n");
    for (const Obstacle& each : found) {
      EXPECT_TRUE(each.addition) << each.what;
      EXPECT_THAT(each.why, HasSubstr("REPLACE"));
    }
    EXPECT_EQ(all(obstacles(read(flown_text), fresh, TakenBy::AnotherProcess)), "");
  }
}

TEST(InFlight, NobodyIsSentToAnotherProcessForWhatThatMayNotHaveEither) {
  const auto fresh =
      read(changed(R"(<Function name="RAISE_LIMIT")",
                   R"(<Function name="SPIN" essential="yes"/><Function name="RAISE_LIMIT")", flown_text));
  EXPECT_THAT(all(obstacles(read(flown_text), fresh)), HasSubstr("function SPIN is new and essential: that"));
}

TEST(InFlight, WhatIsNoPureAdditionIsRefusedForAnotherProcess) {
  for (
      const Edit& edit : std::initializer_list<Edit>{
          {R"(<ParamRef name="TITLE")", R"(<ParamRef name="FRESH" id="8" type="DOUBLE"/><ParamRef name="TITLE")",
           "parameter FRESH is new and stands before others"},
          {"</StructRef>",
           R"(</StructRef><ParamRef name="FRESH" id="8" type="DOUBLE" minimum="0" maximum="7" persistent="yes" writable="PreOperational"/>)",
           "parameter FRESH is new and is to outlive the flight"},
          {R"(<ParamRef name="ANGLE" id="9")",
           R"(<ParamRef name="MORE" id="7" type="FLOAT"/><ParamRef name="ANGLE" id="9")",
           "parameter SEEN: member MORE is new"},
          {R"(<Function name="RAISE_LIMIT")",
           R"(<Function name="SPIN" states="Operational" essential="yes"/><Function name="RAISE_LIMIT")",
           "function SPIN is new and essential"},
          {"<EventService>", R"(<EventService><Event name="HANG" id="6" severity="low"/>)", "event HANG is new: that"},
          {R"(<ParamRef name="TITLE" id="1" type="TEXT" octets="8" init="old"/>)", "", "parameter TITLE is gone"},
          {R"(name="GAIN" id="1" type="DOUBLE")", R"(name="GAIN" id="4" type="DOUBLE")", "parameter GAIN: its id"},
          {R"(name="BUMP" id="7")", R"(name="BUMP" id="8")", "event BUMP: its id"},
          {R"(<Argument name="WHERE" type="DOUBLE"/>)", R"(<Argument name="WHERE" type="FLOAT"/>)",
           "event BUMP: field WHERE: its type"},
          {R"(<Request name="LOOK")", R"(<Request name="BLINK" subtype="5" states="Operational"/><Request name="LOOK")",
           "service GAZE: request BLINK is new"},
          {R"(<SampledOnce><ParamRef name="GAIN"/>)", R"(<SampledOnce><ParamRef name="SEEN"/>)",
           "housekeeping 11: what it reports"},
          {R"(<Field name="X" type="DOUBLE"/></Requires>)", R"(<Field name="X" type="DOUBLE" count="2"/></Requires>)",
           "required set IN: field X: its type or length"},
          {R"(<Field name="X" type="DOUBLE"/></Requires>)", R"(<Field name="Y" type="DOUBLE"/></Requires>)",
           "required set IN: field X is gone"},
          {R"(<Provides name="OUT"><ParamRef name="GAIN"/>)", R"(<Provides name="OUT"><ParamRef name="SEEN"/>)",
           "provided set OUT: field GAIN is gone"},
          {R"(<Provides name="OUT">)",
           R"(<Provides name="MORE"><ParamRef name="SEEN"/></Provides><Provides name="OUT">)",
           "provided set MORE is new"},
          {R"(memory_kB="100000")", R"(memory_kB="90000")", "its resources"},
          {R"(sampling_us="1000")", R"(sampling_us="2000")", "configuration FAST: priority, sampling time or budget"}})
    EXPECT_THAT(
        all(obstacles(read(flown_text), read(changed(edit.from, edit.to, flown_text)), TakenBy::AnotherProcess)),
        HasSubstr(edit.told))
        << edit.from;
}

/// A structure's only parameter, by the place that it refers to.
[[nodiscard]] std::string only_value_of(const SubsystemDescriptor& subsystem, std::uint16_t id) {
  for (const HousekeepingStructure& each : subsystem.configurations.front().housekeeping)
    if (each.id == id) return subsystem.parameters.at(each.sampled_once.front().parameter).field.name;
  return "none";
}

/// Of its provided set by the places that it refers to, and of its required one.
[[nodiscard]] std::string fields_of_links(const SubsystemDescriptor& subsystem) {
  const Configuration& one = subsystem.configurations.front();
  std::string text;
  for (const ParameterRef& each : one.provides.front().parameters) {
    const Parameter& parameter = subsystem.parameters.at(each.parameter);
    text += (text.empty() ? "" : " ") + parameter.field.name;
    if (each.member) text += "." + parameter.members.at(*each.member).field.name;
  }
  text += ",";
  for (const Field& each : one.requires_.front().fields) text += " " + each.name;
  return text;
}

TEST(InFlight, AFieldOfALinkIsAddedAloneToo) {
  const std::string text =
      changed(R"(<Provides name="OUT"><ParamRef name="GAIN"/>)",
              R"(<Provides name="OUT"><ParamRef name="GAIN"/><ParamRef name="STAYS"/>)", flown_text);
  SubsystemDescriptor flown = read(flown_text);
  ASSERT_EQ(all(obstacles(flown, read(text), TakenBy::AnotherProcess)), "");
  take_over(flown, read(text));
  EXPECT_EQ(fields_of_links(flown), "GAIN STAYS, X");
  take_over(flown, read(flown_text));
  EXPECT_EQ(fields_of_links(flown), "GAIN, X");
}

// A lent sample lies in the memory of producer and consumers as one object.
TEST(InFlight, WhatIsLentStaysWhoeverIsToFlyByIt) {
  const std::string lent =
      changed(R"(<Provides name="OUT"><ParamRef name="GAIN"/></Provides>)",
              R"(<Provides name="OUT" kind="loaned"><Field name="A" type="UINT32"/></Provides>)", flown_text);
  const std::string more = changed(R"(<Field name="A" type="UINT32"/>)",
                                   R"(<Field name="A" type="UINT32"/><Field name="B" type="UINT32"/>)", lent);
  for (const TakenBy by : {TakenBy::SameProcess, TakenBy::AnotherProcess}) {
    const auto found = obstacles(read(lent), read(more), by);
    ASSERT_EQ(all(found), "configuration FAST: provided set OUT: field B is new\n");
    EXPECT_FALSE(found.front().addition);
    EXPECT_THAT(found.front().why, HasSubstr("lent"));
  }
}

// The parameters of the framework stand behind those of the author: what is added moves them.
TEST(InFlight, WhatIsAddedIsTakenAndTakenBackWithAllThatRefersToIt) {
  const std::string structure = R"(<HKService id="11" interval="10">)";
  const std::string text = changed(
      structure,
      R"(<HKService id="12" interval="10"><SampledOnce><ParamRef name="CYCLE_STATS"/></SampledOnce></HKService>)" +
          structure,
      flown_text);
  std::string more = changed(
      structure,
      R"(<HKService id="13" interval="10"><SampledOnce><ParamRef name="FRESH"/></SampledOnce></HKService>)" + structure,
      text);
  for (const Edit& edit : additions) more = changed(edit.from, edit.to, more);
  more = changed("<EventService>", R"(<Failure code="0x8001" name="BENT"/><EventService>)", more);
  SubsystemDescriptor flown = read(text);
  ASSERT_EQ(all(obstacles(flown, read(more), TakenBy::AnotherProcess)), "");

  take_over(flown, read(more));
  EXPECT_EQ(all(obstacles(flown, read(more))), "");
  EXPECT_EQ(*flown.text, more);
  EXPECT_EQ(flown.find_parameter("FRESH")->init, std::vector<Value>{Number{7.0}});
  EXPECT_NE(flown.find_function("SPIN"), nullptr);
  EXPECT_EQ(flown.find_event("CRACK")->severity, Severity::High);
  EXPECT_EQ(flown.failures.size(), 1U);
  EXPECT_EQ(fields_of_links(flown), "GAIN SEEN.ANGLE, Y X");
  EXPECT_EQ(only_value_of(flown, 13), "FRESH");
  EXPECT_EQ(only_value_of(flown, 12), "CYCLE_STATS");

  take_over(flown, read(text));
  EXPECT_EQ(all(obstacles(flown, read(text))), "");
  EXPECT_EQ(*flown.text, text);
  EXPECT_TRUE(flown.failures.empty());
  EXPECT_EQ(flown.find_parameter("FRESH"), nullptr);
  EXPECT_EQ(flown.find_function("SPIN"), nullptr);
  EXPECT_EQ(fields_of_links(flown), "GAIN, X");
  EXPECT_EQ(only_value_of(flown, 13), "none");
  EXPECT_EQ(only_value_of(flown, 12), "CYCLE_STATS");
}

TEST(InFlight, AnObstacleSaysWhereItStands) {
  const auto marked = testing::marked(changed(R"(<Function name="TURN" states="Operational">)",
                                              R"(@<Function name="TURN" states="SafeOperational">)", flown_text));
  const auto found = obstacles(read(flown_text), read(marked.text));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().at, marked.at);
}

TEST(InFlight, HowALoopOfServicesGoesInAConfigurationStays) {
  const std::string lamp = R"(<Device name="LAMP"><Output>)", set = R"(<Set parameter="GAIN" value="4"/>)";
  const auto with = [&](const std::string& pace) {
    return read(
        changed(set, set + pace,
                changed(lamp, R"(<ServiceLoop name="L" period_us="1000"/><Service name="ST03" loop="L"/>)" + lamp,
                        flown_text)));
  };
  const SubsystemDescriptor flown = with(R"(<ServiceLoop name="L" period_us="2000"/>)");
  EXPECT_EQ(all(obstacles(flown, with(R"(<ServiceLoop name="L" period_us="2000"/>)"))), "");
  for (const char* other :
       {"", R"(<ServiceLoop name="L" period_us="3000"/>)", R"(<ServiceLoop name="L" period_us="2000" priority="1"/>)"})
    EXPECT_EQ(all(obstacles(flown, with(other))), "configuration FAST: how its loops of services go\n") << other;
}

TEST(InFlight, WhatTheConfigurationInForceWasMadeOfWaits) {
  for (const Edit& edit : std::initializer_list<Edit>{
           {R"(<HKService id="11" interval="10">)", R"(<HKService id="11" interval="20">)", "its housekeeping"},
           {"127.0.0.1:4000", "127.0.0.1:4002", "device MOTOR: its endnodes"},
           {R"(value="red")", R"(value="blue")", "device LAMP: its endnodes, limits or settings"},
           {R"("UINT8" minimum="0" maximum="1")", R"("UINT8" minimum="0" maximum="2")",
            "device LAMP: what it may be told"},
           {R"(age="3")", R"(age="5")", "required set IN: its age"},
           {R"(power_W="5")", R"(power_W="6")", "its limits or power"}}) {
    const SubsystemDescriptor fresh = read(changed(edit.from, edit.to, flown_text));
    EXPECT_THAT(all(obstacles_in_force(read(flown_text), fresh, 1)), HasSubstr(edit.told)) << edit.from;
    EXPECT_THAT(obstacles_in_force(read(flown_text), fresh, 7), IsEmpty()) << "of another one nobody asks";
  }
  const SubsystemDescriptor ranged = read(changed(R"(maximum="10")", R"(maximum="9")", flown_text));
  EXPECT_THAT(obstacles_in_force(read(flown_text), ranged, 1), IsEmpty());
}

TEST(InFlight, WhoReferredToAPartRefersToItStill) {
  SubsystemDescriptor flown = read(flown_text);
  const Parameter* const gain = flown.find_parameter("GAIN");
  const Function* const turn = flown.find_function("TURN");
  const Configuration* const fast = flown.find_configuration("FAST");
  std::string text =
      changed(R"(init="3" minimum="0" maximum="10")", R"(init="5" minimum="1" maximum="20")", flown_text);
  text = changed(R"(minimum="-1" maximum="1" default="0")", R"(minimum="-2" maximum="2" default="1")", text);
  text = changed(R"(address="lamp")", R"(address="lamp-2")", text);
  text = changed(
      R"(<HKService id="11")",
      R"(<HKService id="12" interval="5"><SampledOnce><ParamRef name="SEEN"/></SampledOnce></HKService><HKService id="11")",
      text);
  take_over(flown, read(text));
  EXPECT_EQ(flown.find_parameter("GAIN"), gain);
  EXPECT_EQ(gain->field.maximum, Number{20.0});
  EXPECT_EQ(gain->init, std::vector<Value>{Number{5.0}});
  EXPECT_EQ(turn->arguments.front().field.maximum, Number{2.0});
  EXPECT_EQ(fast->devices[1].endnode.address, "lamp-2");
  EXPECT_EQ(fast->housekeeping.size(), 2U);
  EXPECT_EQ(*flown.text, text);
}

/// A cycle may be reading it: where nothing of its configuration differs, nothing of that is written.
TEST(InFlight, WhatIsTheSameIsNotTouched) {
  SubsystemDescriptor flown = read(flown_text);
  const Configuration& fast = flown.configurations.front();
  const auto places = [&] {
    return std::vector<const void*>{flown.devices[0].output[0].safe.data(), fast.devices[1].settings.data(),
                                    fast.devices[1].endnode.address.data(), fast.housekeeping.data()};
  };
  const auto before = places();
  take_over(flown, read(changed(R"(maximum="10")", R"(maximum="9")", flown_text)));
  EXPECT_EQ(flown.find_parameter("GAIN")->field.maximum, Number{9.0});
  EXPECT_EQ(places(), before);
}

// What take_over() leaves out would be accepted and have no effect.
TEST(InFlight, WhatWasTakenIsAllThatWasDifferent) {
  SubsystemDescriptor flown = read(flown_text);
  std::string text =
      changed(R"(<Device name="LAMP" silence="3">)", R"(<Device name="LAMP" silence="9" every="2">)", flown_text);
  text = changed(R"(power_W="5")", R"(power_W="6" overruns="9")", text);
  text = changed(R"(age="3")", R"(age="5")", text);
  text = changed(R"("UINT8" minimum="0" maximum="1")", R"("UINT8" minimum="1" maximum="2")", text);
  text = changed(R"(value="red")", R"(value="blue")", text);
  text = changed(R"(interval="10")", R"(interval="20")", text);
  const SubsystemDescriptor fresh = read(text);
  EXPECT_THAT(obstacles_in_force(flown, fresh, 1), ::testing::SizeIs(5));
  take_over(flown, read(text));
  EXPECT_EQ(all(obstacles_in_force(flown, fresh, 1)), "");
}

/// The mission of the test data with another text of one of its files, all others as they were.
struct Evolution : ::testing::Test {
  const Mission flown = read_mission(testing::data / "mission.xml", file_system()).value.value();
  [[nodiscard]] Reading<Mission> with(const std::string& from, const std::string& to) const {
    const SubsystemDescriptor& subsystem = flown.find_subsystem("FLYWHEEL")->subsystem;
    return read_again(flown, subsystem.file, changed(from, to, *subsystem.text), file_system());
  }
};

TEST_F(Evolution, WhatIsAddedAsksNothingOfOthers) {
  for (const auto& [from, to] : std::initializer_list<std::pair<const char*, const char*>>{
           {R"(<ParamRef name="ENABLE" id)",
            R"(<ParamRef name="MORE" id="9" type="DOUBLE"/><ParamRef name="ENABLE" id)"},
           {"<FunctionService>", R"(<FunctionService><Function name="MORE"/>)"},
           {R"(<ParamRef name="ENABLE"/></Provides>)",
            R"(<ParamRef name="ENABLE"/><ParamRef name="LINK_STATS.LOST"/></Provides>)"}}) {
    const auto reading = with(from, to);
    ASSERT_TRUE(reading.value) << testing::rendered(reading.problems, file_system());
    EXPECT_EQ(all(obstacles(flown.find_subsystem("CORONAGRAPH")->subsystem,
                            reading.value->find_subsystem("CORONAGRAPH")->subsystem)),
              "");
  }
}

TEST_F(Evolution, WhatIsGoneIsRefusedWithItsUsersNamed) {
  const auto reading = with(R"(name="SET_FORCE_SCALE")", R"(name="SET_SCALE")");
  EXPECT_FALSE(reading.value);
  ASSERT_FALSE(reading.problems.empty());
  EXPECT_THAT(reading.problems.front().file.string(), ::testing::EndsWith("mission.xml"));
  EXPECT_GT(reading.problems.front().at.line, 1);
  EXPECT_THAT(reading.problems.front().message, HasSubstr("SET_FORCE_SCALE"));
}

}  // namespace
}  // namespace hirosco::descriptor
