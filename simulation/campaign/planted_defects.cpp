// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/planted_defects.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/crc16.hpp"
#include "hirosco/utilities/octets.hpp"
#include "simulation/campaign/plan.hpp"
#include "simulation/campaign/tampering.hpp"

namespace hirosco::campaign {
namespace {

using descriptor::State;
using Hooks = TamperedChannel::Hooks;
using MakeDefect = std::function<void(PlantedDefect&)>;

/// Members of the mission by what they are in it.
enum class Whose : std::uint8_t { GroundLink, Others, FirstOther };

[[nodiscard]] std::vector<std::string_view> members(const PlantedDefect& defect, Whose whose) {
  std::vector<std::string_view> found;
  for (const auto& member : defect.mission->subsystems)
    if ((member.subsystem.name == defect.mission->ground.subsystem) == (whose == Whose::GroundLink))
      found.push_back(member.subsystem.name);
  if (whose == Whose::FirstOther && !found.empty()) found.resize(1);
  return found;
}

void on_channel(PlantedDefect& defect, Whose whose, Hooks hooks) {
  defect.wrap_channel = [&defect, whose, hooks = std::move(hooks)](
                            std::string_view name, std::unique_ptr<Channel> channel) -> std::unique_ptr<Channel> {
    if (std::ranges::count(members(defect, whose), name) == 0) return channel;
    return std::make_unique<TamperedChannel>(std::move(channel), hooks);
  };
}

/// Each device meets commands that were changed on their way; `change` has a state of its own for each.
void on_devices(PlantedDefect& defect, const std::function<TamperedFlows::Change()>& make_change) {
  defect.devices = [make_change, kept = std::make_shared<std::vector<std::unique_ptr<TamperedFlows>>>()](
                       simulation::DeviceCatalogue& catalogue) {
    for (auto& [name, make] : catalogue)
      make = [make, make_change, kept](FlowFactory& flows, const FlowAddress& address,
                                       const simulation::SimulatedDevice::Settings& settings) {
        kept->push_back(std::make_unique<TamperedFlows>(flows, make_change()));
        return make(*kept->back(), address, settings);
      };
  };
}

void each_requirement(descriptor::Mission& mission, const std::function<void(descriptor::Requires&)>& change) {
  for (auto& member : mission.subsystems)
    for (auto& configuration : member.subsystem.configurations)
      for (auto& wanted : configuration.requires_) change(wanted);
}

[[nodiscard]] bool is_final_report(const pus::TelemetryView& report) {
  return report.service() == 1 && (report.subtype() == 7 || report.subtype() == 8);
}

// --- one for each invariant --------------------------------------------------------------------------------------------

/// A death takes a bystander along.
void i1(PlantedDefect& defect) {
  defect.after_action = [&defect](const std::vector<std::string>& words) {
    if (words[0] != "kill") return;
    const auto others = members(defect, Whose::Others);
    const auto bystander = std::ranges::find_if(others, [&](std::string_view name) { return name != words[1]; });
    if (bystander != others.end()) defect.craft->kill(*bystander);
  };
}

/// Every fifth final report is lost.
void i2(PlantedDefect& defect) {
  on_channel(defect, Whose::Others, {.receives = [seen = 0](Message& message, MessageBuffer&) mutable {
               const auto report = pus::TelemetryView::parse(message.packet);
               return !report || !is_final_report(*report) || ++seen % 5 != 0;
             }});
}

/// Every fiftieth report is not stored, and no gap says so.
void i3(PlantedDefect& defect) {
  defect.keeps = [seen = 0](const supervisor::LogRecord& record) mutable {
    return record.kind != supervisor::LogKind::Telemetry || ++seen % 50 != 0;
  };
}

/// Devices take Off for Active, with what they were last told to do, and have no second inhibit: with one they stay still.
void i4(PlantedDefect& defect) {
  defect.edit = [](descriptor::Mission& mission) {
    for (auto& member : mission.subsystems)
      for (auto& device : member.subsystem.devices) device.enable.reset();
  };
  on_devices(defect, [] {
    return [payload = std::vector<std::byte>{}](DeviceCommand& command) mutable {
      if (command.mode == DeviceMode::Active) payload.assign(command.payload.begin(), command.payload.end());
      if (command.mode == DeviceMode::Active || payload.empty()) return;
      command.mode = DeviceMode::Active;
      command.payload = payload;
    };
  });
}

/// Stale samples are used on where the descriptor says that they inhibit, nobody finds them stale and who stands still is not missed for a
/// hundred cycles: otherwise the guard stops the network before it matters.
void i5(PlantedDefect& defect) {
  defect.edit = [](descriptor::Mission& mission) {
    constexpr std::uint32_t cycles = 100;
    for (auto& member : mission.subsystems) member.subsystem.hang = {.realtime = cycles, .reduced = cycles};
    each_requirement(mission, [](descriptor::Requires& wanted) {
      wanted.missing = descriptor::MissingPolicy::Hold;
      wanted.age = {.realtime = cycles, .reduced = cycles};
    });
  };
}

/// The supervisor does not listen to the ground link in half of all seconds.
void i6(PlantedDefect& defect) {
  on_channel(defect, Whose::GroundLink,
             {.holds_back = [&defect] { return static_cast<int>(2 * defect.now_s()) % 2 == 1; }});
}

/// Every mode permits everything.
void i8(PlantedDefect& defect) {
  defect.edit = [](descriptor::Mission& mission) {
    for (auto& mode : mission.modes) {
      descriptor::Permit all;
      all.subsystem = "*";
      all.functions = {"*"};
      all.services = {3, 5, 8, 17, 20};
      mode.permits.push_back(all);
    }
  };
}

/// One state is told for another: from Offline straight to Operational.
void i9(PlantedDefect& defect) {
  defect.each_instant = [&defect, done = false]() mutable {
    auto* page = const_cast<VitalPage*>(defect.craft->vital(members(defect, Whose::Others).back()));
    if (done || defect.now_s() < 3 || page == nullptr ||
        page->state.load() != static_cast<std::uint32_t>(State::Operational))
      return;
    page->state.store(static_cast<std::uint32_t>(State::HardwareInit));
    done = true;
  };
}

/// A subsystem is deaf after the second fault that strikes it.
void i10(PlantedDefect& defect) {
  auto struck = std::make_shared<int>(0);
  defect.after_action = [struck](const std::vector<std::string>& words) {
    *struck += words[0] == "fault" || words[0] == "stop" || words[0] == "strain" ? 1 : 0;
  };
  on_channel(defect, Whose::FirstOther, {.sends = [struck](const Message&) { return *struck < 2; }});
}

/// Every hundredth report bears a count that was used before.
void i11(PlantedDefect& defect) {
  on_channel(defect, Whose::Others, {.receives = [seen = 0](Message& message, MessageBuffer& buffer) mutable {
               const std::size_t size = message.packet.size();
               if (++seen % 100 != 0 || !pus::TelemetryView::parse(message.packet)) return true;
               MutableOctets octets = MutableOctets{buffer.octets}.first(size);
               octets[3] ^= std::byte{0x04};
               OctetWriter writer{octets.last(2)};
               writer.put(crc16(octets.first(size - 2)));
               message.packet = octets;
               return true;
             }});
}

/// Nothing that is required is required.
void i12(PlantedDefect& defect) {
  defect.edit = [](descriptor::Mission& mission) {
    each_requirement(mission, [](descriptor::Requires& wanted) { wanted.required = false; });
  };
}

/// A device's clock runs 1.25 times too fast.
void i13(PlantedDefect& defect) {
  defect.clock_percent = 125;
  defect.devices = [](simulation::DeviceCatalogue& catalogue) {
    for (auto& [name, make] : catalogue)
      make = [make](FlowFactory& flows, const FlowAddress& address, simulation::SimulatedDevice::Settings settings) {
        settings.cycle = settings.cycle * 100 / 125;
        return make(flows, address, settings);
      };
  };
}

/// Every fortieth report that comes down again is lost between supervisor and ground link.
void i14(PlantedDefect& defect) {
  on_channel(defect, Whose::GroundLink, {.sends = [seen = 0](const Message& message) mutable {
               const auto report = pus::TelemetryView::parse(message.packet);
               return !report || !pus::st129::is_retrieved(*report) || ++seen % 40 != 0;
             }});
}

/// When there was no supervisor last.
class LastAbsence {
 public:
  void look(const PlantedDefect& defect) {
    if (!defect.craft->supervised()) last_ = defect.craft->now();
  }
  /// Another one has begun, no longer than that ago.
  [[nodiscard]] bool ended_within(Duration span, const PlantedDefect& defect) const {
    return last_ && defect.craft->now() - *last_ < span;
  }

 private:
  std::optional<TimePoint> last_;
};

/// What the next supervisor finds is stopped in its first 50 ms, whatever permission it had.
void i15(PlantedDefect& defect) {
  defect.each_instant = [&defect, absence = LastAbsence{},
                         taken = std::map<std::string_view, std::uint64_t>{}]() mutable {
    absence.look(defect);
    const bool stops = defect.craft->supervised() && absence.ended_within(50ms, defect);
    for (const std::string_view name : members(defect, Whose::Others)) {
      auto* page = defect.craft->permit(name);
      if (page == nullptr) continue;
      if (stops) {
        if (const auto word = page->go.exchange(0); word != 0) taken[name] = word;
      } else if (const auto its = taken.extract(name); !its.empty()) {
        page->go.store(its.mapped());
      }
    }
  };
}

/// Somebody beats on for a supervisor that is gone, and no second inhibit ends.
void i16(PlantedDefect& defect) {
  defect.edit = [](descriptor::Mission& mission) {
    for (auto& member : mission.subsystems)
      for (auto& device : member.subsystem.devices) device.enable.reset();
  };
  defect.each_instant = [&defect] {
    if (defect.craft->supervised()) return;
    for (const auto& member : defect.mission->subsystems)
      if (auto* page = defect.craft->permit(member.subsystem.name)) page->heartbeat.fetch_add(1);
  };
}

/// The telecommands that the next supervisor finds in the ground link's channel are lost.
void i17(PlantedDefect& defect) {
  auto absence = std::make_shared<LastAbsence>();
  defect.each_instant = [&defect, absence] { absence->look(defect); };
  on_channel(defect, Whose::GroundLink, {.receives = [&defect, absence](const Message& message, MessageBuffer&) {
               return !absence->ended_within(1s, defect) || !pus::TelecommandView::parse(message.packet);
             }});
}

/// Whoever is to fall back or to go down when it has held on for its time does neither.
void i18(PlantedDefect& defect) {
  defect.edit = [](descriptor::Mission& mission) {
    for (auto& link : mission.links) {
      if (link.on_loss == descriptor::OnLoss::Fallback) link.on_loss = descriptor::OnLoss::Ignore;
      link.hold += std::chrono::minutes{1};
    }
  };
}

/// Each five-hundredth sample of a queue is swallowed.
void i19(PlantedDefect& defect) {
  static constexpr std::uint64_t every = 500;
  defect.tampered_links.assign(defect.links.begin(), defect.links.end());
  for (const LinkMechanism*& mechanism : defect.tampered_links)
    if (mechanism->kind() == LinkKind::Queued)
      mechanism = defect.lossy_queue.emplace_back(std::make_unique<LossyQueue>(*mechanism, every)).get();
  defect.links = defect.tampered_links;
}

/// Of a descriptor that was edited is read what nobody wrote.
void i20(PlantedDefect& defect) {
  defect.reads = [](std::string text) { return std::move(text) + "<!-- and more -->\n"; };
}

/// In place of one version another one is started.
void i21(PlantedDefect& defect) {
  defect.mistake_version = [](const std::string& version) { return version == "2" ? std::string{"3"} : version; };
}

const std::map<std::string_view, MakeDefect>& planted_defects() {
  static const std::map<std::string_view, MakeDefect> all{
      {"I1", i1},   {"I2", i2},   {"I3", i3},   {"I4", i4},   {"I5", i5},   {"I6", i6},   {"I8", i8},
      {"I9", i9},   {"I10", i10}, {"I11", i11}, {"I12", i12}, {"I13", i13}, {"I14", i14}, {"I15", i15},
      {"I16", i16}, {"I17", i17}, {"I18", i18}, {"I19", i19}, {"I20", i20}, {"I21", i21}};
  return all;
}

}  // namespace

double PlantedDefect::now_s() const { return craft != nullptr ? seconds(craft->now() - start_of_flight) : 0; }

std::unique_ptr<PlantedDefect> defect_named(std::string_view name) {
  const auto found = planted_defects().find(name);
  if (found == planted_defects().end()) return nullptr;
  auto defect = std::make_unique<PlantedDefect>();
  found->second(*defect);
  return defect;
}

std::vector<std::string_view> defect_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, make] : planted_defects()) names.push_back(name);
  return names;
}

}  // namespace hirosco::campaign
