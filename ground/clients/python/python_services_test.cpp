// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_services.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/standard_services.hpp"

namespace hirosco::ground {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A supervisor, and a subsystem that offers all but `without`.
descriptor::Mission mission_without(std::uint8_t without) {
  descriptor::Mission mission;
  mission.supervisor.name = "SUPERVISOR";
  mission.supervisor.id = 1;
  descriptor::MissionSubsystem member;
  member.subsystem.name = "ARM";
  member.subsystem.id = 10;
  if (without != 0) member.subsystem.service_uses.push_back({.type = without, .offered = false});
  mission.subsystems.push_back(member);
  return mission;
}

ServiceMethods methods_of(const Catalogue& catalogue, std::string_view subsystem) {
  PythonNames names{{}};
  return service_methods(catalogue, *catalogue.find(subsystem), names);
}

TEST(PythonServices, StandInTheirTablesAsTheyDescribeThemselves) {
  const std::string text = service_tables();
  EXPECT_THAT(text, HasSubstr(R"(_r.ServiceRequest("TC[3,5] ENABLE_PERIODIC", 3, 5, )"
                              R"(parts=(_r.Part("STRUCTURES", "LIST", (_r.Field("STRUCTURE", "UINT16"),)),)),)"));
  EXPECT_THAT(text,
              HasSubstr(R"(_r.ServiceRequest("TC[3,31] MODIFY_INTERVAL", 3, 31, parts=(_r.Part("STRUCTURES", "LIST", )"
                        R"((_r.Field("STRUCTURE", "UINT16"), _r.Field("INTERVAL", "UINT32"),)),)),)"));
  EXPECT_THAT(text, HasSubstr(R"(_r.ServiceRequest("TC[5,7] REPORT_DISABLED", 5, 7, parts=()),)"));
  EXPECT_THAT(
      text,
      HasSubstr(R"(_r.Part("PARAMETERS", "LIST", (_r.Part("PARAMETER", "PARAMETER"), _r.Part("VALUE", "VALUE"),)))"));
  EXPECT_THAT(
      text,
      HasSubstr(
          R"(_r.ReportKind(5, 8, "DISABLED", fields=(_r.Part("EVENTS", "LIST", (_r.Part("EVENT", "EVENT"),)),)),)"));
}

TEST(PythonServices, AskedOfTheSupervisorLeaveTheIdsOfOthersNumbers) {
  EXPECT_THAT(service_tables(),
              HasSubstr(R"(_r.ServiceRequest("TC[129,6] PREVIEW_PLAN", 129, 6, )"
                        R"(parts=(_r.Field("SUBSYSTEM", "UINT16"), _r.Field("EVENT", "UINT16"),)),)"));
}

TEST(PythonServices, HintAtNoNameWhereAValueHasNone) {
  EXPECT_THAT(service_tables(), HasSubstr(R"(_r.Field("WHAT", "UINT8", texts=((1, "structure"), (2, "event"),)))"));
}

TEST(PythonServices, AreAskedByAMethodThatSaysWhatIsWanted) {
  const Catalogue catalogue{mission_without(0)};
  const ServiceMethods arm = methods_of(catalogue, "ARM");
  EXPECT_EQ(arm.tables, "*_st3, *_st5, *_st20, ");
  EXPECT_THAT(
      arm.methods,
      HasSubstr("    def enable_periodic(self, structures: _t.Sequence[int], *, wait: _t.Optional[float] = 70.0) "
                "-> _r.Request:\n"
                "        \"\"\"TC[3,5] ENABLE_PERIODIC, service of housekeeping.\n\n"
                "        structures: a list: each UINT16\n        \"\"\"\n"
                "        return self._ask(\"TC[3,5] ENABLE_PERIODIC\", (structures, ), wait)\n"));
  EXPECT_THAT(arm.methods, HasSubstr("modify_interval(self, structures: _t.Sequence[_t.Mapping[str, _t.Any]], *"));
  EXPECT_THAT(arm.methods, HasSubstr("disable_events(self, events: _t.Sequence[_t.Union[int, str]], *"));
  EXPECT_THAT(
      methods_of(catalogue, "SUPERVISOR").methods,
      HasSubstr("retrieve(self, from_2: float, to: float, housekeeping: _t.Union[int, _t.Literal[\"no\", \"yes\"]]"));
}

TEST(PythonServices, ThatSomebodyMayAskAreAllThereAndNoOthers) {
  const Catalogue catalogue{mission_without(0)};
  const std::string text = service_tables();
  const std::string asked = methods_of(catalogue, "ARM").methods + methods_of(catalogue, "SUPERVISOR").methods;
  for (const pus::ServiceKind* service : pus::standard_services())
    for (const pus::RequestKind& request : service->requests) {
      const bool by_name = !request.words.empty() || service->type == 8;
      const bool may = !by_name && service->needs_of(request.subtype) != pus::Needs::SupervisorAsks;
      const std::string called = fmt::format("\"TC[{},{}] {}\"", service->type, request.subtype, request.name);
      EXPECT_EQ(text.find(called) != std::string::npos, may) << called;
      EXPECT_EQ(asked.find("self._ask(" + called) != std::string::npos, may) << called;
    }
}

TEST(PythonServices, AreThoseThatTheSubsystemOffers) {
  const Catalogue without{mission_without(5)};
  EXPECT_EQ(methods_of(without, "ARM").tables, "*_st3, *_st20, ");
  EXPECT_THAT(methods_of(without, "ARM").methods, Not(HasSubstr("def enable_events")));
  EXPECT_THAT(methods_of(without, "SUPERVISOR").tables, HasSubstr("*_st129, ")) << "it alone answers that one";
  auto mission = mission_without(5);
  descriptor::Configuration speaking;
  speaking.id = 1;
  speaking.services.push_back({.type = 5, .offered = true});
  mission.subsystems[0].subsystem.configurations.push_back(speaking);
  EXPECT_EQ(methods_of(Catalogue{mission}, "ARM").tables, "*_st3, *_st5, *_st20, ") << "in one configuration";
}

TEST(PythonServices, TakeNoNameFromWhatADescriptorHas) {
  const Catalogue catalogue{mission_without(0)};
  PythonNames names{{"one_shot"}};
  const std::string text = service_methods(catalogue, *catalogue.find("ARM"), names).methods;
  EXPECT_THAT(text, HasSubstr("def one_shot_2(self, structures"));
  EXPECT_THAT(text, Not(HasSubstr("def one_shot(")));
}

}  // namespace
}  // namespace hirosco::ground
