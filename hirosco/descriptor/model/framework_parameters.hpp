// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"

/// The parameters that every subsystem has without declaring them (docs/adr/0056), and the words for its ten states.
namespace hirosco::descriptor {

/// Of State; an author's fields may name it, too.
inline constexpr const char* states_enumeration = "STATES";

namespace framework_parameter {
/// hirosco::CycleStatistics
inline constexpr const char* cycle_stats = "CYCLE_STATS";
/// hirosco::CycleTimes
inline constexpr const char* cycle_times = "CYCLE_TIMES";
/// hirosco::CycleBudget
inline constexpr const char* cycle_budget = "CYCLE_BUDGET";
/// hirosco::CycleSpin
inline constexpr const char* cycle_spin = "CYCLE_SPIN";
/// hirosco::LoopStatistics
inline constexpr const char* loop_stats = "LOOP_STATS";
/// hirosco::LinkStatistics
inline constexpr const char* link_stats = "LINK_STATS";
/// hirosco::ResourceStatistics
inline constexpr const char* resource_stats = "RESOURCE_STATS";
/// hirosco::HeapUses
inline constexpr const char* heap_uses = "HEAP_USES";
/// hirosco::DescriptorInForce
inline constexpr const char* descriptor = "DESCRIPTOR";
}  // namespace framework_parameter

/// CYCLE_STATS, CYCLE_TIMES, CYCLE_BUDGET, CYCLE_SPIN, LINK_STATS, LOOP_STATS, RESOURCE_STATS, HEAP_USES and DESCRIPTOR, with the ids that are
/// theirs where a descriptor gives no other.
[[nodiscard]] std::vector<Parameter> framework_parameters();

/// "NAME_OUTPUT": what is put out to an actuator, or what its author would put out (adr 0073).
[[nodiscard]] std::string output_parameter(const Device& device);
/// Such a structure for each actuator, in their order, with the fields of its output.
[[nodiscard]] std::vector<Parameter> output_parameters(const std::vector<Device>& devices);
/// More actuators, or more output fields of one type, than these have no ids left.
inline constexpr std::size_t most_actuators = 200;
inline constexpr std::size_t most_output_fields = 200;

/// Names of those that the framework writes: all of the above.
[[nodiscard]] std::vector<std::string> built_in_parameters(const SubsystemDescriptor& subsystem);

/// Appends all of them and STATES; those that are there stay as they are.
void add_framework_parameters(SubsystemDescriptor& subsystem);

}  // namespace hirosco::descriptor
