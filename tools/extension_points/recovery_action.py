# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A kind of step that no mission flies: the process of its subject is ended. Code that names it needs the first edit only; the
second is the word that plans of missions write."""
WHO = "a recovery / mode action"
BEFORE = "0 + 8"
GOAL = "1 file + 1 row; where missions may write it + 1 row, its word in the schema"
MOST_FILES, MOST_EDITED, MOST_ASKED = 1, 2, 1
ASKED = [
    ("hirosco/descriptor/mission.xsd", '<xs:enumeration value="run"/>', '<xs:enumeration value="run"/><xs:enumeration value="dismiss"/>',
     "descriptor_test Schema.HasTheWordsOfEachEnumerationThatTheReaderTakesAndNoOthers"),
]
MADE = [("docs/interfaces/schema.md", "tools/check_schema.py")]
FILES = {"supervisor/supervision/procedures/steps/dismiss.hpp": """\
#pragma once

#include <string>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// Its subject's process ends.
inline constexpr StepKind dismiss{
    .name = "dismiss",
    .text = [](const ProcedureStep&, const descriptor::Mission&) { return std::string{"ended"}; },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          const Member* subject = means.craft.member(step.subject);
          if (subject == nullptr || !subject->alive()) return done(false, "it does not run");
          means.craft.launcher.kill(subject->process());
          done(true, {});
        },
};

}  // namespace hirosco::supervisor::steps
"""}
EDITS = [
    ("supervisor/supervision/procedures/steps/step_kinds.hpp", '#include "supervisor/supervision/procedures/steps/link.hpp"\n',
     '#include "supervisor/supervision/procedures/steps/dismiss.hpp"\n#include "supervisor/supervision/procedures/steps/link.hpp"\n'),
    ("supervisor/supervision/procedures/steps/step_kinds.hpp", "step_kinds{", "step_kinds{&steps::dismiss, "),
    ("hirosco/descriptor/model/plan_steps.hpp", '    StepWord{.name = "log"},\n', '    StepWord{.name = "log"},\n    StepWord{.name = "dismiss"},\n'),
]
SOURCES = ["hirosco/descriptor/read/read_plans.cpp", "supervisor/supervision/event_handling/reactions.cpp"]
TRY = """\
#include "supervisor/supervision/procedures/steps/step_kinds.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;

struct NewKind : PartsTest {
  std::vector<descriptor::Plan> plans() {
    const descriptor::FileSource source = [](const std::filesystem::path& file) {
      auto text = descriptor::file_system()(file);
      constexpr std::string_view now = "action=\\"log\\"", then = "action=\\"dismiss\\"";
      if (file.filename() == "mission.xml") text->replace(text->find(now), now.size(), then);
      return text;
    };
    const auto reading = descriptor::read_mission(HIROSCO_SOURCE_DIR "/hirosco/descriptor/testdata/mission.xml", source);
    for (const auto& problem : reading.problems) ADD_FAILURE() << problem.message;
    return reading.value ? reading.value->plans : std::vector<descriptor::Plan>{};
  }
};

TEST_F(NewKind, IsReadFromAMissionAndDone) {
  const auto read = plans();
  ASSERT_FALSE(read.empty());
  start_all(State::Operational);
  descriptor::Plan plan = read.back();
  EXPECT_EQ(plan.steps.front().kind, "dismiss");
  plan.severities.clear();
  craft.mission.plans = {plan};
  parts.reactions.react(*craft.member(arm), "HOT", Severity::High);
  EXPECT_THAT(killed, ::testing::ElementsAre(arm + 1000U));
}

TEST_F(NewKind, IsAStepOfAnyProcedure) {
  start_all(State::Operational);
  craft.member(hand)->died();
  std::string end;
  ProcedureRunner{means_with(parts.own_telecommands)}.start(
      {.stages = {{step("dismiss", hand, {})}}, .finished = [&](const ProcedureEnd& ended) { end = ended.text(); }});
  EXPECT_EQ(end, "HAND ended: it does not run");
}

}  // namespace
}  // namespace hirosco::supervisor
"""
