// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/plants.hpp"

#include <array>
#include <map>
#include <set>

#include "hirosco/pus/packet.hpp"
#include "hirosco/utilities/crc16.hpp"
#include "hirosco/utilities/octets.hpp"
#include "simulation/campaign/plan.hpp"
#include "simulation/campaign/tampering.hpp"

namespace hirosco::campaign {
namespace {

using descriptor::State;
using Hooks = TamperedChannel::Hooks;
using MakePlant = std::function<void(Plant&)>;

constexpr std::uint16_t supervisor_apid = 1;

/// Hooks for the channel of one member; "*": of each but the ground link's.
void on_channel(Plant& plant, std::string member, Hooks hooks) {
  plant.wrap_channel = [member = std::move(member), hooks = std::move(hooks)](
                           std::string_view name, std::unique_ptr<Channel> channel) -> std::unique_ptr<Channel> {
    const bool concerned = member == "*" ? name != "COMMUNICATION" : name == member;
    if (!concerned) return channel;
    return std::make_unique<TamperedChannel>(std::move(channel), hooks);
  };
}

/// Each device meets commands that were changed on their way; `change` has a state of its own for each.
void on_devices(Plant& plant, const std::function<TamperedFlows::Change()>& make_change) {
  plant.devices = [make_change, kept = std::make_shared<std::vector<std::unique_ptr<TamperedFlows>>>()](
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

/// Function name and first octet of its first argument, of a telecommand.
struct Called {
  std::uint16_t apid{};
  std::string name;
  int argument{-1};
};
[[nodiscard]] Called called_by(Octets packet) {
  const auto telecommand = pus::TelecommandView::parse(packet);
  if (!telecommand || telecommand->service() != 8) return {};
  const Octets data = telecommand->application_data();
  Called called{.apid = telecommand->apid(), .name = {}, .argument = -1};
  for (std::size_t i = 0; i < 16 && i < data.size() && data[i] != std::byte{0}; ++i)
    called.name += static_cast<char>(data[i]);
  if (data.size() == 19) called.argument = std::to_integer<int>(data[18]);
  return called;
}

// --- one for each invariant --------------------------------------------------------------------------------------------

/// A death takes a bystander along.
void i1(Plant& plant) {
  plant.after_action = [&plant](const std::vector<std::string>& words) {
    if (words[0] == "kill") plant.craft->kill(words[1] == "MANIPULATOR" ? "JOYSTICK" : "MANIPULATOR");
  };
}

/// Every fifth final report is lost.
void i2(Plant& plant) {
  on_channel(plant, "*", {.receives = [seen = 0](Message& message, MessageBuffer&) mutable {
               const auto report = pus::TelemetryView::parse(message.packet);
               return !report || !is_final_report(*report) || ++seen % 5 != 0;
             }});
}

/// Every fiftieth report is not stored, and no gap says so.
void i3(Plant& plant) {
  plant.keeps = [seen = 0](const supervisor::LogRecord& record) mutable {
    return record.kind != supervisor::LogKind::Telemetry || ++seen % 50 != 0;
  };
}

/// Devices take Off for Active, with what they were last told to do, and have no second inhibit: with one they stay still.
void i4(Plant& plant) {
  plant.edit = [](descriptor::Mission& mission) {
    for (auto& member : mission.subsystems)
      for (auto& device : member.subsystem.devices) device.enable.reset();
  };
  on_devices(plant, [] {
    return [payload = std::vector<std::byte>{}](DeviceCommand& command) mutable {
      if (command.mode == DeviceMode::Active) payload.assign(command.payload.begin(), command.payload.end());
      if (command.mode == DeviceMode::Active || payload.empty()) return;
      command.mode = DeviceMode::Active;
      command.payload = payload;
    };
  });
}

/// Stale samples are used on where the descriptor says that they inhibit.
void i5(Plant& plant) {
  plant.edit = [](descriptor::Mission& mission) {
    each_requirement(mission, [](descriptor::Requires& wanted) { wanted.missing = descriptor::MissingPolicy::Hold; });
  };
}

/// The supervisor does not listen to the ground link in half of all seconds.
void i6(Plant& plant) {
  on_channel(plant, "COMMUNICATION", {.holds_back = [&plant] { return static_cast<int>(2 * plant.now_s()) % 2 == 1; }});
}

/// Every mode permits everything.
void i8(Plant& plant) {
  plant.edit = [](descriptor::Mission& mission) {
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
void i9(Plant& plant) {
  plant.each_instant = [&plant, done = false]() mutable {
    auto* page = const_cast<VitalPage*>(plant.craft->vital("JOYSTICK"));
    if (done || plant.now_s() < 3 || page == nullptr ||
        page->state.load() != static_cast<std::uint32_t>(State::Operational))
      return;
    page->state.store(static_cast<std::uint32_t>(State::HardwareInit));
    done = true;
  };
}

/// A subsystem is deaf after the second fault that strikes it.
void i10(Plant& plant) {
  auto struck = std::make_shared<int>(0);
  plant.after_action = [struck](const std::vector<std::string>& words) {
    *struck += words[0] == "fault" || words[0] == "stop" || words[0] == "strain" ? 1 : 0;
  };
  on_channel(plant, "MANIPULATOR", {.sends = [struck](const Message&) { return *struck < 2; }});
}

/// Every hundredth report bears a count that was used before.
void i11(Plant& plant) {
  on_channel(plant, "*", {.receives = [seen = 0](Message& message, MessageBuffer& buffer) mutable {
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
void i12(Plant& plant) {
  plant.edit = [](descriptor::Mission& mission) {
    each_requirement(mission, [](descriptor::Requires& wanted) { wanted.required = false; });
  };
}

/// A device's clock runs 1.25 times too fast.
void i13(Plant& plant) {
  plant.clock_percent = 125;
  plant.devices = [](simulation::DeviceCatalogue& catalogue) {
    for (auto& [name, make] : catalogue)
      make = [make](FlowFactory& flows, const FlowAddress& address, simulation::SimulatedDevice::Settings settings) {
        settings.cycle = settings.cycle * 100 / 125;
        return make(flows, address, settings);
      };
  };
}

// --- findings as they were, seen from outside --------------------------------------------------------------------------

/// SF1: a state of the supervisor that ground commanded makes it refuse SAFE_ALL.
void sf1(Plant& plant) {
  on_channel(plant, "COMMUNICATION", {.receives = [down = false](Message& message, MessageBuffer&) mutable {
               const Called called = called_by(message.packet);
               if (called.apid != supervisor_apid) return true;
               const bool towards_safety = called.argument == static_cast<int>(State::ErrorOperational) ||
                                           called.argument == static_cast<int>(State::PostOperational);
               down = down || (called.name == "SET_STATE" && towards_safety);
               return !down || (called.name != "SAFE_ALL" && called.name != "SHUTDOWN" && called.name != "SET_MODE");
             }});
}

/// SF4: SET_STATE(Operational) of before a SAFE_ALL takes effect after it.
void sf4(Plant& plant) {
  struct Held {
    std::map<std::string, Channel*, std::less<>> channels;
    std::map<std::string, std::vector<std::byte>, std::less<>> up;
    double safe_all_s{-1};
  };
  auto held = std::make_shared<Held>();
  plant.wrap_channel = [&plant, held](std::string_view name, std::unique_ptr<Channel> channel) {
    const std::string member{name};
    held->channels[member] = channel.get();
    Hooks hooks;
    hooks.sends = [held, member](const Message& message) {
      const Called called = called_by(message.packet);
      if (called.name == "SET_STATE" && called.argument == static_cast<int>(State::Operational))
        held->up[member].assign(message.packet.begin(), message.packet.end());
      return true;
    };
    hooks.receives = [held, &plant](Message& message, MessageBuffer&) {
      if (called_by(message.packet).name == "SAFE_ALL") held->safe_all_s = plant.now_s();
      return true;
    };
    return std::make_unique<TamperedChannel>(std::move(channel), std::move(hooks));
  };
  plant.each_instant = [&plant, held] {
    constexpr double held_back_s = 0.1;
    if (held->safe_all_s < 0 || plant.now_s() < held->safe_all_s + held_back_s) return;
    held->safe_all_s = -1;
    for (const auto& [member, packet] : held->up) {
      if (!plant.craft->alive(member)) continue;
      if (PermitPage* page = plant.craft->permit(member)) page->release();
      static_cast<void>(held->channels[member]->send({.packet = packet}));
    }
  };
}

/// SF5: a death is not heard of while something else goes on, here for five seconds.
void sf5(Plant& plant) {
  auto died_s = std::make_shared<std::map<std::string, double, std::less<>>>();
  constexpr double deaf_s = 5;
  plant.tell_end = [&plant, died_s](std::string_view name, std::optional<supervisor::ProcessEnd> end) {
    if (!end) return end;
    const double since = died_s->try_emplace(std::string{name}, plant.now_s()).first->second;
    return plant.now_s() < since + deaf_s ? std::nullopt : end;
  };
  plant.wrap_channel = [&plant, died_s](std::string_view name, std::unique_ptr<Channel> channel) {
    Hooks hooks;
    hooks.hides_closing = [&plant, died_s, member = std::string{name}] {
      const double since = died_s->try_emplace(member, plant.now_s()).first->second;
      return plant.now_s() < since + deaf_s;
    };
    return std::make_unique<TamperedChannel>(std::move(channel), std::move(hooks));
  };
}

/// SF6: an event whose report is switched off is not reacted to either.
void sf6(Plant& plant) {
  auto off = std::make_shared<std::set<std::uint16_t>>();
  on_channel(plant, "*",
             {.sends =
                  [off](const Message& message) {
                    const auto telecommand = pus::TelecommandView::parse(message.packet);
                    if (!telecommand || telecommand->service() != 5 || telecommand->subtype() != 6) return true;
                    OctetReader reader{telecommand->application_data()};
                    for (int left = reader.get<std::uint8_t>(); left > 0 && reader.good(); --left)
                      off->insert(reader.get<std::uint16_t>());
                    return true;
                  },
              .receives =
                  [off](Message& message, MessageBuffer&) {
                    if (message.kind == MessageKind::Packet || message.kind == MessageKind::GroundTelecommand)
                      return true;
                    // An event message: severity, whether it is reported, id.
                    OctetReader reader{message.packet};
                    static_cast<void>(reader.get<std::uint16_t>());
                    return !off->contains(reader.get<std::uint16_t>());
                  }});
}

/// SF14: nothing raises the epoch on the way up, so that a device that let go stays so.
void sf14(Plant& plant) {
  on_devices(plant, [] {
    return [first = std::optional<std::uint32_t>{}](DeviceCommand& command) mutable {
      if (!first) first = command.epoch;
      command.epoch = *first;
    };
  });
}

/// LW1: what the dead were asked has no end: no report of the supervisor about another's telecommand comes through.
void lw1(Plant& plant) {
  const auto speaks_for_another = [](Octets packet) {
    const auto report = pus::TelemetryView::parse(packet);
    if (!report || report->apid() != supervisor_apid || !is_final_report(*report)) return false;
    OctetReader reader{report->source_data()};
    return (reader.get<std::uint32_t>() >> 16 & 0x7FF) != supervisor_apid;
  };
  on_channel(plant, "COMMUNICATION",
             {.sends = [=](const Message& message) { return !speaks_for_another(message.packet); }});
  plant.keeps = [=](const supervisor::LogRecord& record) { return !speaks_for_another(record.packet); };
}

/// LW13: a device whose subsystem is slower than it gets one cycle too many with each exchange: the joystick in REMOTE.
void lw13(Plant& plant) { i13(plant); }

const std::map<std::string_view, MakePlant>& plants() {
  static const std::map<std::string_view, MakePlant> all{
      {"I1", i1},   {"I2", i2},   {"I3", i3},     {"I4", i4},   {"I5", i5},    {"I6", i6},   {"I8", i8},
      {"I9", i9},   {"I10", i10}, {"I11", i11},   {"I12", i12}, {"I13", i13},  {"SF1", sf1}, {"SF4", sf4},
      {"SF5", sf5}, {"SF6", sf6}, {"SF14", sf14}, {"LW1", lw1}, {"LW13", lw13}};
  return all;
}

}  // namespace

double Plant::now_s() const { return craft != nullptr ? seconds(craft->now() - start_of_flight) : 0; }

std::unique_ptr<Plant> plant_named(std::string_view name) {
  const auto found = plants().find(name);
  if (found == plants().end()) return nullptr;
  auto plant = std::make_unique<Plant>();
  found->second(*plant);
  return plant;
}

std::vector<std::string_view> plant_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, make] : plants()) names.push_back(name);
  return names;
}

}  // namespace hirosco::campaign
