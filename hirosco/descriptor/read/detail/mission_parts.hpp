// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/read/detail/mission_draft.hpp"

/// Parts of a mission that are read, or checked, each by itself.
namespace hirosco::descriptor::detail {

/// What is wrong with a path that must stay inside, `above` folders up; empty when nothing is.
[[nodiscard]] std::string_view refuse_path(std::string_view text, int above);

/// What electrical power there is.
void read_power(const xml::Element& element, MissionDraft& draft);
/// What all subsystems together may take.
void read_resources(const xml::Element& element, Mission& mission, Problems& problems);
/// And whether what they say they take fits into it.
void check_resources(const xml::Element& element, const Mission& mission, Problems& problems);
/// Which cores a subsystem has.
void read_cores(Attributes& attributes, MissionSubsystem& member, Problems& problems);
/// And a simulated device.
[[nodiscard]] std::optional<std::uint16_t> read_core(Attributes& attributes);
/// Nobody claims a core that is another's alone. Behind all subsystems and simulated devices of the mission, whose element this is.
void check_cores(const xml::Element& root, MissionDraft& draft);
/// Whether subsystems fly where this computer cannot isolate them, and as which users. Behind all subsystems and their devices.
void read_isolation(const xml::Element& element, MissionDraft& draft);
/// What may be started.
void read_manifest(const xml::Element& element, MissionDraft& draft, const FileSource& source);
/// All <SimulatedDevice> of the mission.
void read_simulated_devices(const std::vector<const xml::Element*>& elements, MissionDraft& draft);
/// What the live line of a terminal shows.
void read_console(const xml::Element& element, MissionDraft& draft);

/// How the links of each subsystem may travel, and who carries the ground link.
void note_sockets(Mission& mission);
/// Nobody's sandbox lets it in where the supervisor's side holds an endnode.
void check_reach(MissionDraft& draft);

}  // namespace hirosco::descriptor::detail
