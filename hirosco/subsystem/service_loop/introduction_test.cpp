// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// Mistakes of an author: told in Software-Init, in words, all at once.
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;
using ::testing::StartsWith;

std::string explanation_of(Subsystem& author, const std::string& text = probe_descriptor) {
  Rig rig{author, text};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::Offline);
  return rig.explanations.empty() ? "" : rig.explanations.front();
}

TEST(AuthorsMistakes, ASoftwareInitThatNeverEndsIsTold) {
  struct Endless : Probe {
    Result<Step> software_init() override { return again; }
  } endless;
  Rig rig{endless, probe_descriptor};
  const auto request = rig.set_state(State::PreOperational);
  rig.service();
  rig.advance(10s + 1ms);
  rig.settle();
  EXPECT_THAT(rig.outcome(request), StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(rig.explanations, ElementsAre("PROBE: SoftwareInit failed: time limit"));
}

TEST(AuthorsMistakes, PublishingAnUndeclaredParameterFailsSoftwareInit) {
  struct Wrong : Probe {
    Result<Step> software_init() override {
      publish("MISSPELT", kp);
      return done;
    }
  } wrong;
  EXPECT_EQ(explanation_of(wrong),
            "PROBE: SoftwareInit failed: MISSPELT: the descriptor declares no parameter of this name");
}

TEST(AuthorsMistakes, AParameterOfAnotherLayoutFailsSoftwareInit) {
  struct Wrong : Probe {
    Parameter<float> narrow;
    Result<Step> software_init() override {
      publish("KP", narrow);
      return done;
    }
  } wrong;
  EXPECT_EQ(explanation_of(wrong),
            "PROBE: SoftwareInit failed: KP: the C++ type is float, the descriptor declares DOUBLE");
}

TEST(AuthorsMistakes, AParameterThatIsDeclaredButNotPublishedIsNamed) {
  struct Wrong : Probe {
    Result<Step> software_init() override {
      publish("KP", kp);
      return done;
    }
  } wrong;
  EXPECT_EQ(explanation_of(wrong),
            "PROBE: SoftwareInit failed: parameters declared but not published: CUR_VALUES, DES_POSITION, KD, SEEN");
}

TEST(AuthorsMistakes, AHandlerWithAnotherNumberOfArgumentsIsNamed) {
  struct Wrong : Probe {
    Result<Step> software_init() override {
      static_cast<void>(Probe::software_init());
      on_function("SET_GOAL", [](double, double) -> Result<> { return ok(); });
      return done;
    }
  } wrong;
  EXPECT_EQ(explanation_of(wrong),
            "PROBE: SoftwareInit failed: on_function SET_GOAL: the handler takes 2 (double, double), the descriptor "
            "declares 1 "
            "(DOUBLE)");
}

std::string configuration_mistake(Subsystem& author, std::uint8_t id) {
  Rig rig{author, probe_descriptor};
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(rig.configure_now(id), StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::PreOperational);
  return rig.explanations.empty() ? "" : rig.explanations.front();
}

constexpr const char* set_descriptor = R"(<Subsystem name="S" id="10">
  <Device name="MOTOR"><Input><Field name="Q" type="DOUBLE"/></Input><Output><Field name="Q" type="DOUBLE"/></Output></Device>
  <Configuration name="SOFT" id="1" sampling_us="1000">
    <Device name="MOTOR">
      <Setting name="STIFFNESS" value="4000"/>
      <Setting name="STIFNESS" value="4000"/>
      <Endnode transfer="shared_memory" address="motor"/>
    </Device>
  </Configuration>
  <Configuration name="HARD" id="2" sampling_us="1000">
    <Device name="MOTOR"><Setting name="DAMPING" value="2"/><Endnode transfer="shared_memory" address="motor"/></Device>
  </Configuration>
</Subsystem>)";

struct Motor final : Subsystem {
  struct Sensed {
    double q;
  };
  DevicePort<Sensed, Sensed> motor;
  std::function<void(Motor&)> names;
  Result<Step> software_init() override {
    names(*this);
    return done;
  }
  using Subsystem::use_device;
};

TEST(AuthorsMistakes, SettingsThatNobodyReadsAreToldWithTheirPlacesBeforeAnyHardwareIsAsked) {
  Motor motor;
  motor.names = [](Motor& own) { own.use_device("MOTOR", own.motor, {"STIFFNESS", "INERTIA"}); };
  Rig rig{motor, set_descriptor};
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(rig.explanations,
              ElementsAre(::testing::HasSubstr(":6:39: error: E0405: nobody reads setting 'STIFNESS' of 'MOTOR'"),
                          ::testing::HasSubstr(":11:57: error: E0405: nobody reads setting 'DAMPING' of 'MOTOR'")));
}

TEST(AuthorsMistakes, SettingsThatAreNamedAreNone) {
  Motor motor;
  motor.names = [](Motor& own) { own.use_device("MOTOR", own.motor, {"STIFFNESS", "STIFNESS", "DAMPING"}); };
  Rig rig{motor, set_descriptor};
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(rig.explanations, IsEmpty());
  EXPECT_EQ(rig.state(), State::PreOperational);
}

struct Mute final : FrameProtocol {
  std::size_t say(const DeviceCommand&, MutableOctets) noexcept override { return 0; }
  Heard hear(Octets) noexcept override { return {}; }
  void restart() noexcept override {}
};

TEST(AuthorsMistakes, ADeviceOfItsOwnProtocolNeedsAPortThatSpeaksIt) {
  const std::string raw = R"(<Subsystem name="S" id="10">
    <Device name="MOTOR"><Input><Field name="Q" type="DOUBLE"/></Input><Output><Field name="Q" type="DOUBLE"/></Output></Device>
    <Configuration name="C" id="1" sampling_us="1000">
      <Device name="MOTOR"><Endnode transfer="serial" address="/dev/ttyUSB0@9600" framing="raw"/></Device>
    </Configuration>
  </Subsystem>)";
  Mute protocol;
  for (const bool speaks : {false, true}) {
    Motor motor;
    motor.names = [&](Motor& own) {
      if (speaks) own.motor.speak(protocol);
      own.use_device("MOTOR", own.motor);
    };
    Rig rig{motor, raw};
    rig.set_state_now(State::PreOperational);
    EXPECT_EQ(rig.state(), speaks ? State::PreOperational : State::Offline);
    if (speaks) {
      EXPECT_EQ(rig.configure_now(1), "1 3 7");
      const auto line = rig.flows.open({Transfer::Serial, "/dev/ttyUSB0@9600", Framing::Raw}, FlowSide::Device).value();
      std::array<std::byte, 1024> heard{};
      rig.cycle(3);
      EXPECT_EQ(line->receive(heard).value().flow, Flow::None) << "what its protocol does not say nobody says";
    } else EXPECT_THAT(rig.explanations, ElementsAre(::testing::HasSubstr("does not speak() a protocol")));
  }
  Motor forgetful;
  forgetful.names = [](Motor&) {};
  Rig rig{forgetful, raw};
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(rig.explanations,
              ElementsAre(::testing::HasSubstr("use_device MOTOR: the device is used and has no port")))
      << "which protocol it would speak is not asked";
}

TEST(AuthorsMistakes, AreFoundWithoutAFlightAndNothingIsKept) {
  Motor motor;
  motor.names = [](Motor& own) { own.use_device("MOTOR", own.motor, {"STIFFNESS", "DAMPING"}); };
  Rig rig{motor, set_descriptor};
  for (int again = 0; again < 2; ++again) {
    const auto mistakes = rig.subsystem.try_introduction();
    ASSERT_EQ(mistakes.size(), 1U);
    EXPECT_EQ(mistakes.front().text, "nobody reads setting 'STIFNESS' of 'MOTOR'");
    EXPECT_EQ(mistakes.front().at, (descriptor::Location{6, 39}));
  }
  EXPECT_EQ(rig.state(), State::Offline);
}

TEST(AuthorsMistakes, ALinkPortOfAnotherLayoutFailsSoftwareInitWhateverConfigurationRequiresIt) {
  struct Wrong : Probe {
    LinkInput<Angle> short_hand;
    Result<Step> software_init() override {
      static_cast<void>(Probe::software_init());
      require_link("HAND", short_hand);
      return done;
    }
  } wrong;
  EXPECT_EQ(explanation_of(wrong),
            "PROBE: SoftwareInit failed: probe.xml:42:7: error: E0406: require_link HAND: the C++ type has 1 members, "
            "the descriptor declares 2 fields; give the C++ type a member for each <Field>, in their order and of "
            "their types");
}

TEST(AuthorsMistakes, ADevicePortOfAnotherLayoutFailsSoftwareInitWhateverConfigurationUsesIt) {
  struct Wrong : Probe {
    DevicePort<Angle, Lit> wrong_arm;
    Result<Step> software_init() override {
      static_cast<void>(Probe::software_init());
      use_device("ARM", wrong_arm);
      return done;
    }
  } wrong;
  EXPECT_THAT(explanation_of(wrong),
              StartsWith("PROBE: SoftwareInit failed: probe.xml:21:3: error: E0406: use_device ARM: output, field "
                         "TORQUE: C++ has UINT8[1], the descriptor declares DOUBLE[1]"));
}

TEST(AuthorsMistakes, APortThatIsNamedBehindSoftwareInitIsComparedBeforeItIsUsed) {
  struct Late : Probe {
    DevicePort<Angle, Lit> wrong_arm;
    Result<Step> hardware_init() override {
      use_device("ARM", wrong_arm);
      return Probe::hardware_init();
    }
  } late;
  EXPECT_EQ(configuration_mistake(late, 3),
            "PROBE: CONFIGURE WITH_ARM failed: use_device ARM: output, field TORQUE: C++ has UINT8[1], the descriptor "
            "declares DOUBLE[1]");
}

TEST(AuthorsMistakes, AreToldAllAtOnce) {
  struct Wrong : Probe {
    LinkInput<Hand> foot;
    DevicePort<Angle, Torque> leg;
    Result<Step> software_init() override {
      publish("CUR_VALUES", current);
      publish("DES_POSITION", goal);
      publish("KP", kp);
      publish("SPEED", kd);
      require_link("FOOT", foot);
      use_device("LEG", leg);
      on_function("JUMP", []() -> Result<> { return ok(); });
      on_function("SET_GOAL", [](float) -> Result<> { return ok(); });
      return done;
    }
  } wrong;
  Rig rig{wrong, probe_descriptor};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), StartsWith("1 3 8:0202"));
  const std::string begin = "PROBE: SoftwareInit failed: ";
  EXPECT_THAT(
      rig.explanations,
      ::testing::UnorderedElementsAre(
          begin + "SPEED: the descriptor declares no parameter of this name",
          begin + "require_link: no configuration requires a set 'FOOT'",
          begin + "use_device: the descriptor declares no device 'LEG'",
          begin + "on_function: the descriptor declares no function 'JUMP'",
          begin + "on_function SET_GOAL: argument 1, GOAL: the descriptor declares DOUBLE, -2..2; the handler takes "
                  "float, which does not hold every value",
          begin + "parameters declared but not published: KD, SEEN",
          begin + "function declared but without a handler: MOVE", begin + "event declared but never used: OWN",
          begin + "probe.xml:42:7: error: E0406: require_link HAND: the set is required and has no port; name a "
                  "LinkInput for it in software_init()",
          begin + "probe.xml:21:3: error: E0406: use_device ARM: the device is used and has no port; name a DevicePort "
                  "for it in software_init()",
          begin + "probe.xml:25:3: error: E0406: use_device LAMP: the device is used and has no port; name a "
                  "DevicePort for it in software_init()"));
}

/// One function whose argument is declared as `argument` says.
std::string function_of(const std::string& argument) {
  return R"(<Subsystem name="S" id="10"><FunctionService><Function name="F"><Argument name="A" )" + argument +
         R"(/></Function></FunctionService><Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)";
}

template <class T>
struct Takes final : Subsystem {
  Result<Step> software_init() override {
    on_function("F", [](T) -> Result<> { return ok(); });
    return done;
  }
};

template <class T>
bool taken(const std::string& argument) {
  Takes<T> author;
  Rig rig{author, function_of(argument)};
  return rig.set_state_now(State::PreOperational) == "1 3 7";
}

enum class Side : std::uint8_t { Left, Right };

TEST(AuthorsMistakes, AHandlerThatWouldNarrowAnArgumentIsNotTaken) {
  const auto argument = [](const char* type, const char* minimum, const char* maximum) {
    return std::string{"type=\""} + type + "\" minimum=\"" + minimum + "\" maximum=\"" + maximum + "\"";
  };
  const std::string real = argument("DOUBLE", "-1", "1"), single = argument("FLOAT", "0", "1"),
                    byte = argument("UINT8", "0", "255"), small = argument("INT8", "-128", "127"),
                    word = argument("UINT16", "0", "65535"), large = argument("UINT32", "0", "4294967295"),
                    flag = argument("UINT8", "0", "1"), low = argument("UINT32", "0", "255"),
                    above = argument("UINT32", "0", "256");
  EXPECT_TRUE(taken<double>(real));
  EXPECT_TRUE(taken<double>(large));
  EXPECT_TRUE(taken<float>(single));
  EXPECT_TRUE(taken<float>(word));
  EXPECT_TRUE(taken<std::uint8_t>(byte));
  EXPECT_TRUE(taken<Side>(byte));
  EXPECT_TRUE(taken<std::int32_t>(word));
  EXPECT_TRUE(taken<std::uint8_t>(low));
  EXPECT_TRUE(taken<bool>(flag));
  EXPECT_FALSE(taken<float>(real));
  EXPECT_FALSE(taken<float>(large));
  EXPECT_FALSE(taken<int>(real));
  EXPECT_FALSE(taken<int>(single));
  EXPECT_FALSE(taken<std::uint8_t>(word));
  EXPECT_FALSE(taken<std::uint8_t>(above));
  EXPECT_FALSE(taken<std::uint8_t>(small));
  EXPECT_FALSE(taken<std::int32_t>(large));
  EXPECT_FALSE(taken<bool>(byte));
}

TEST(AuthorsMistakes, OfADescriptorBuiltInCodeAreToldAndCrashNothing) {
  Probe probe;
  ManualClock clock;
  HeapMemory memory;
  LocalFlows flows;
  ChannelPair channels;
  VitalPage vital;
  const PermitPage permit;
  auto described = testing::read_descriptor(probe_descriptor);
  described.parameters.push_back(described.parameters.back());
  std::vector<std::string> told;
  GenericSubsystem subsystem{probe,
                             described,
                             {.clock = clock,
                              .memory = memory,
                              .flows = flows,
                              .explain = [&](std::string_view text) { told.emplace_back(text); }},
                             channels.subsystem_end(),
                             vital,
                             permit};
  const double target = static_cast<double>(State::PreOperational);
  const auto data = pus::encode_call(pus::common_functions()[0], std::span{&target, 1}).value();
  std::array<std::byte, 64> buffer;
  const auto packet = pus::write_telecommand(buffer, {.apid = 10, .service = 8, .subtype = 1, .source = 1}, data);
  ASSERT_TRUE(channels.supervisor_end().send({.packet = *packet}));
  for (int i = 0; i < 5; ++i) subsystem.service_step(clock.now());
  EXPECT_EQ(subsystem.state(), State::Offline);
  EXPECT_THAT(told, ::testing::Contains(::testing::HasSubstr("a second parameter of this name")));
}

}  // namespace
}  // namespace hirosco
