# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A service of an author's own, declared in the descriptor of its subsystem. tests/author flies one, with page and client."""
WHO = "a PUS service of an author's own"
BEFORE = "not to be commanded"
GOAL = "own folder"
MOST_FILES, MOST_EDITED = 2, 0
FILES = {"outside/diary/diary.hpp": """\
#pragma once

#include "hirosco/subsystem/author/custom_service.hpp"

class Diary final : public hirosco::Subsystem {
  hirosco::Result<> offline() override {
    pages_.on_request("OPEN", [this](std::uint16_t number, hirosco::Call call) -> hirosco::Result<> {
      return pages_.report("PAGE", call, number);
    });
    provide(pages_);
    return hirosco::ok();
  }
  hirosco::CustomService pages_{"PAGES"};
};
""", "outside/diary/diary.xml": """\
<Subsystem name="DIARY" id="10">
  <CustomService name="PAGES" type="201">
    <Request name="OPEN" subtype="1"><Argument name="NUMBER" type="UINT16" minimum="1" maximum="9"/></Request>
    <Report name="PAGE" subtype="2"><Field name="NUMBER" type="UINT16"/></Report>
  </CustomService>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>
"""}
EDITS = []
SOURCES = []
TRY = """\
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "hirosco/pus/requests.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "outside/diary/diary.hpp"

TEST(OwnService, IsAnsweredAndKnownByName) {
  Diary author;
  std::ifstream file{HIROSCO_SOURCE_DIR "/outside/diary/diary.xml"};
  hirosco::testing::Rig rig{author, std::string{std::istreambuf_iterator<char>{file}, {}}};
  rig.set_state_now(hirosco::State::PreOperational);
  const std::array data{std::byte{0}, std::byte{7}};
  const auto sent = rig.send(201, 1, data);
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  EXPECT_EQ(rig.reports(201, 2).at(0), "0007");
  EXPECT_EQ(hirosco::pus::requests_of(rig.descriptor()).back().name, "OPEN");
}
"""
