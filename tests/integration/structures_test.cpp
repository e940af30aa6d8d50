// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>

#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "tests/integration/flight.hpp"

/// A structure in a structure, and an array of them, from the descriptor to the author's cycle and back to the ground (docs/adr/0103).
namespace hirosco::testing {
namespace {

constexpr auto structured_mission_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Mission name="STRUCTURED">
  <Supervisor descriptor="../../supervisor/supervisor.xml">
    <Database strategy="sqlite" path="log/structured.db"/>
    <Ground subsystem="COMMUNICATION" telemetry="127.0.0.1:10015" telecommand="127.0.0.1:10025"/>
  </Supervisor>
  <Subsystem executable="hirosco-communication" descriptor="../../subsystems/communication/communication.xml"/>
  <Subsystem executable="arm" descriptor="arm.xml"><Set parameter="CONTROLLER.JOINTS[1].GAINS" value="5 6"/></Subsystem>
  <Modes initial="open" start="open">
    <Mode name="open">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="ARM" configuration="NOMINAL" state="Operational"/>
      <Permit subsystem="*" functions="*"/>
      <Permit subsystem="*" services="3 5 17 20" parameters="CONTROLLER"/>
    </Mode>
  </Modes>
  <Recovery><Plan name="note"><When severity="low info"/><Do action="log"/></Plan></Recovery>
</Mission>
)";

constexpr auto structured_arm_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Subsystem name="ARM" id="20">
  <Enumeration name="LAWS"><Text value="0">rest</Text><Text value="1">follow</Text></Enumeration>
  <StructRef name="CONTROLLER" id="0" writable="PreOperational SafeOperational Operational" persistent="yes">
    <ParamRef name="LAW" id="0" type="UINT8" enumeration="LAWS" minimum="0" maximum="1" init="follow"/>
    <StructRef name="JOINTS" id="1" count="2">
      <ParamRef name="ON" id="0" type="BOOL" init="on"/>
      <ParamRef name="TOOL" id="0" type="TEXT" octets="12" init="none"/>
      <StructRef name="GAINS" id="3">
        <ParamRef name="P" id="0" type="DOUBLE" minimum="0" maximum="100" init="20"/>
        <ParamRef name="D" id="1" type="DOUBLE" minimum="0" maximum="10" init="2"/>
      </StructRef>
    </StructRef>
  </StructRef>
  <Configuration name="NOMINAL" id="1" sampling_us="1000">
    <HKService id="4801" interval="10"><SampledOnce>
      <ParamRef name="CONTROLLER"/><ParamRef name="CONTROLLER.JOINTS[1].GAINS"/>
    </SampledOnce></HKService>
  </Configuration>
</Subsystem>
)";

struct JointGains {
  double p;
  double d;
};
struct GainedJoint {
  bool on;
  Text<12> tool;
  JointGains gains;
};
struct JointController {
  std::uint8_t law;
  std::array<GainedJoint, 2> joints;
};

class StructuredArm final : public Subsystem {
 public:
  explicit StructuredArm(JointController& seen) : seen_{seen} {}

 private:
  Result<Step> software_init() override {
    publish("CONTROLLER", controller_);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return look(); }
  Result<> safe_operational(const Cycle&) noexcept override { return look(); }
  Result<> operational(const Cycle&) noexcept override { return look(); }
  Result<> look() noexcept {
    seen_ = controller_.load();
    return ok();
  }

  JointController& seen_;  ///< as its cycle has it
  Parameter<JointController> controller_;
};

/// One flight of several; without a store it has no past and no future.
struct Structured {
  explicit Structured(supervisor::ValueStore* store = nullptr)
      : flight{{.mission = "hello",  // its folder: the texts stand in for the files there
                .subsystems = {{"arm", [this] { return std::make_unique<StructuredArm>(seen); }}},
                .files = {{"mission.xml", structured_mission_text}, {"arm.xml", structured_arm_text}},
                .values = store}},
        decoder{flight.mission().find_subsystem("ARM")->subsystem} {
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) {
      if (report.apid() != 20 || report.service() != 3 || report.subtype() != 25) return;
      const auto values = decoder.decode(report.source_data());
      told.clear();
      if (values)
        for (const auto& value : *values) told += value.name + "=" + value.texts().front() + " ";
    };
    commissioned = flight.commission();
  }
  simulation::CommandOutcome set(std::string_view what, const std::vector<Value>& values) {
    auto outcome = flight.craft().command("ARM", "SET:CONTROLLER" + std::string{what}, values, 1s);
    flight.craft().run(100ms);
    return outcome;
  }

  JointController seen{};
  Flight flight;
  pus::HousekeepingDecoder decoder;
  std::string told;  ///< the newest report of structure 4801
  bool commissioned{false};
};

TEST(Structures, BeginAsDescriptorAndMissionSayAndAreToldWholeAndInPart) {
  Structured arm;
  ASSERT_TRUE(arm.commissioned) << arm.flight.story().text();
  arm.flight.craft().run(100ms);
  EXPECT_EQ(arm.seen.joints[0].gains.p, 20);
  EXPECT_EQ(arm.seen.joints[1].gains.p, 5);
  EXPECT_EQ(arm.told,
            "CONTROLLER.LAW=1 CONTROLLER.JOINTS[0].ON=on CONTROLLER.JOINTS[0].TOOL='none' "
            "CONTROLLER.JOINTS[0].GAINS.P=20 CONTROLLER.JOINTS[0].GAINS.D=2 CONTROLLER.JOINTS[1].ON=on "
            "CONTROLLER.JOINTS[1].TOOL='none' CONTROLLER.JOINTS[1].GAINS.P=5 "
            "CONTROLLER.JOINTS[1].GAINS.D=6 CONTROLLER.JOINTS[1].GAINS.P=5 CONTROLLER.JOINTS[1].GAINS.D=6 ");
}

TEST(Structures, AreSetWholeAndInPart) {
  Structured arm;
  ASSERT_TRUE(arm.commissioned) << arm.flight.story().text();
  EXPECT_TRUE(arm.set(".JOINTS[0].GAINS", {30.0, 3.0}).completed);
  EXPECT_EQ(arm.seen.joints[0].gains.p, 30);
  EXPECT_EQ(arm.seen.joints[0].gains.d, 3);
  EXPECT_EQ(arm.seen.joints[1].gains.p, 5) << "its neighbour is as it was";
  EXPECT_TRUE(arm.set(".JOINTS[1].ON", {0.0}).completed);
  EXPECT_FALSE(arm.seen.joints[1].on);
  EXPECT_TRUE(arm.set("", {0.0, 1.0, "saw", 1.0, 1.5, 1.0, "file", 2.0, 2.5}).completed);
  EXPECT_EQ(arm.seen.law, 0);
  EXPECT_TRUE(arm.seen.joints[1].on);
  EXPECT_EQ(arm.seen.joints[1].gains.d, 2.5);
  EXPECT_EQ(arm.seen.joints[1].tool, "file");
  EXPECT_NE(arm.told.find("CONTROLLER.JOINTS[1].GAINS.D=2.5"), std::string::npos) << arm.told;
}

TEST(Structures, OneValueThatIsOutsideItsRangeLeavesTheRestAsItWas) {
  Structured arm;
  ASSERT_TRUE(arm.commissioned) << arm.flight.story().text();
  // As no decent ground would send it: D of the second joint is above 10.
  // Structures of an element have the ids 1 and 3: those of the next one 4 and 6.
  const auto id = ParameterId{20, Type::Struct, 6}.wire();
  std::array<std::byte, 1 + 4 + 16> data;
  OctetWriter{data}.put(std::uint8_t{1}).put(id).put(50.0).put(11.0);
  std::array<std::byte, 64> buffer;
  const auto packet =
      pus::write_telecommand(buffer, {.apid = 20, .ack = pus::ack_all, .service = 20, .subtype = 3, .source = 7}, data);
  ASSERT_TRUE(packet);
  EXPECT_EQ(arm.flight.send(*packet).subtype, 4) << "start failed";
  arm.flight.craft().run(100ms);
  EXPECT_EQ(arm.seen.joints[1].gains.p, 5);
  EXPECT_EQ(arm.seen.joints[1].gains.d, 6);
}

TEST(Structures, OutliveTheFlightWholeWhenOnePartOfThemWasSet) {
  supervisor::MemoryValueDisk disk;
  supervisor::DirectValueStore store{disk, "values"};
  {
    Structured arm{&store};
    ASSERT_TRUE(arm.commissioned) << arm.flight.story().text();
    ASSERT_TRUE(arm.set(".JOINTS[0].GAINS.P", {33.0}).completed);
    ASSERT_TRUE(arm.set(".JOINTS[1].TOOL", {"saw no. 2"}).completed);
    arm.flight.craft().run(1s);
  }
  Structured next{&store};
  ASSERT_TRUE(next.commissioned) << next.flight.story().text();
  next.flight.craft().run(100ms);
  EXPECT_EQ(next.seen.joints[0].gains.p, 33);
  EXPECT_EQ(next.seen.joints[1].tool, "saw no. 2");
  EXPECT_EQ(next.seen.joints[0].tool, "none") << "what the descriptor says of the rest";
  EXPECT_EQ(next.seen.joints[1].gains.p, 5) << "and the mission";
  EXPECT_TRUE(next.flight.story().has("ARM takes over 1 stored value, of ")) << next.flight.story().text();
}

TEST(Structures, WithWordsAreNeverTakenFromADamagedCopy) {
  supervisor::MemoryValueDisk disk;
  supervisor::DirectValueStore store{disk, "values"};
  const supervisor::ValueCopies copies{disk, "values/ARM"};
  {
    Structured arm{&store};
    ASSERT_TRUE(arm.set(".JOINTS[1].TOOL", {"saw"}).completed) << arm.flight.story().text();
    arm.flight.craft().run(1s);
  }
  const auto damage = [&](std::size_t copy) {
    auto octets = disk.read(copies.path(copy), 4096).value();
    const auto words = std::ranges::search(octets, std::as_bytes(std::span{"saw", 3}));
    ASSERT_FALSE(words.empty());
    words.front() = std::byte{'p'};  // words still, but nobody set them
    ASSERT_TRUE(disk.create(copies.path(copy), octets));
  };
  const auto begins_with = [&] {
    Structured next{&store};
    EXPECT_TRUE(next.commissioned) << next.flight.story().text();
    next.flight.craft().run(100ms);
    EXPECT_TRUE(next.flight.story().has("of ARM's stored values is not used: damaged"));
    return std::string{next.seen.joints[1].tool.view()};
  };
  damage(0);
  EXPECT_EQ(begins_with(), "saw") << "the other copy is whole";
  damage(0);  // it was made whole again
  damage(1);
  EXPECT_EQ(begins_with(), "none");
}

}  // namespace
}  // namespace hirosco::testing
