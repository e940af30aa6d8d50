// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/in_flight.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"

/// What REREAD and REPLACE have in common: a text of a descriptor that takes the place of the one in force (docs/adr/0095, 0214).
/// What may differ between the two, and what may come to it: `hirosco/descriptor/model/in_flight.hpp`.
/// Thread: the supervisor's.
namespace hirosco::supervisor {

/// As descriptor::Mission has them.
using MissionTexts = std::map<std::filesystem::path, std::shared_ptr<const std::string>>;
using DescriptorProblems = std::vector<descriptor::Diagnostic>;

/// E0380, once for all who fly the file.
void add_problem(DescriptorProblems& problems, const std::filesystem::path& file, descriptor::Location at,
                 std::string message, std::string_view hint);
/// The same of each obstacle.
void add_obstacles(DescriptorProblems& problems, const std::filesystem::path& file,
                   const std::vector<descriptor::Obstacle>& obstacles);

/// What telecommands have set of persistent parameters goes on in `fresh`; what does not fit is a problem.
void carry_values(const descriptor::MissionSubsystem& flown, descriptor::MissionSubsystem& fresh,
                  DescriptorProblems& problems);

/// Each problem reaches whoever asked, in a TM[129,10]; the story has all of them, in which `apid` keeps its descriptor.
void tell_problems(Craft& craft, OwnSubsystem& own, std::uint16_t apid, std::uint16_t asked_by,
                   const DescriptorProblems& problems);

/// The supervisor's own copy, in this one step: permission, modes, ledger, forms of its story, and with what the next process starts.
/// `fresh`: with the values that go on; `how`: whether its file says so now. Who runs with it meanwhile, and the texts of the mission, are the caller's.
void put_in_force(Craft& craft, OwnSubsystem& own, descriptor::MissionSubsystem& flown,
                  descriptor::MissionSubsystem&& fresh, const std::string& text, std::string_view how = "as it is now");

/// Among the texts of the mission that of this file, and of `read` with it those of files that bring others along: all other descriptors are
/// what flies by now, which may be another text than was read.
void take_texts(Craft& craft, const std::filesystem::path& file, std::shared_ptr<const std::string> text,
                MissionTexts&& read);

}  // namespace hirosco::supervisor
