// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/unprovided_fields.hpp"

#include <gmock/gmock.h>

#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

[[nodiscard]] descriptor::Field field(const char* name, Type type = Type::Double) {
  descriptor::Field made;
  made.name = name;
  made.type = type;
  return made;
}

/// HAND reads ANGLE and SPEED of ARM's set by link 1, in two configurations.
struct UnprovidedFields : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  descriptor::SubsystemDescriptor& producer = mission.subsystems[0].subsystem;

  UnprovidedFields() {
    descriptor::Requires wanted;
    wanted.name = "ARM_STATE";
    wanted.fields = {field("ANGLE"), field("SPEED")};
    mission.subsystems[1].subsystem.configurations.resize(2);
    for (auto& configuration : mission.subsystems[1].subsystem.configurations) configuration.requires_ = {wanted};
    mission.subsystems[0].subsystem.configurations[0].requires_.clear();
  }
  void provides(std::initializer_list<descriptor::Field> fields, const char* set = "ARM_STATE") {
    descriptor::Provides made;
    made.name = set;
    for (const auto& each : fields) {
      descriptor::Parameter parameter;
      parameter.field = each;
      producer.parameters.push_back(parameter);
      descriptor::ParameterRef place;
      place.parameter = static_cast<std::uint16_t>(producer.parameters.size() - 1);
      made.parameters.push_back(place);
    }
    producer.configurations[0].provides.push_back(made);
  }
};

TEST_F(UnprovidedFields, AreNoneWhereItProvidesWhatIsReadAndMore) {
  provides({field("ANGLE"), field("MORE"), field("SPEED")});
  EXPECT_THAT(unprovided_fields(mission, producer), IsEmpty());
}

TEST_F(UnprovidedFields, AreEachNamedOnceWithWhoReadsThem) {
  provides({field("ANGLE")});
  provides({field("SPEED")}, "OTHER");
  EXPECT_THAT(unprovided_fields(mission, producer), ElementsAre("HAND reads SPEED of ARM.ARM_STATE (link 1)"));
}

TEST_F(UnprovidedFields, AreThoseOfAnotherTypeToo) {
  provides({field("ANGLE", Type::Float), field("SPEED")});
  EXPECT_THAT(unprovided_fields(mission, producer), ElementsAre("HAND reads ANGLE of ARM.ARM_STATE (link 1)"));
}

}  // namespace
}  // namespace hirosco::supervisor
