// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/further_ends.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hirosco::simulation {
namespace {

/// Flags of the endnode that a command was for, not of the device.
constexpr std::uint16_t flags_of_an_endnode = device_flag::watchdog_tripped | device_flag::old_epoch_refused;

[[nodiscard]] std::uint16_t flags_at(const Obedience& obedience, std::uint16_t of_device) noexcept {
  return static_cast<std::uint16_t>((of_device & ~flags_of_an_endnode) | obedience.flags());
}

}  // namespace

Result<> FurtherPayloads::take_at(std::string_view, OctetReader payload) noexcept {
  return payload.remaining() == 0 ? ok() : fail(ErrorCode::Malformed, "this endnode takes nothing");
}
void FurtherPayloads::write_sensors_at(std::string_view, OctetWriter&) noexcept {}
bool FurtherPayloads::can_at(std::string_view, DeviceStop) const noexcept { return false; }

FurtherEnds::Drive::Drive(const FurtherEndnode& described, Duration watchdog, Duration enable_limit)
    : name{described.name},
      stop{described.actuator->stop},
      inhibit{described.actuator->enable, enable_limit, described.actuator->enable_fall_backs},
      obedience{{.actuator = true, .watchdog = watchdog, .stop = stop, .stop_within = described.actuator->stop_within},
                inhibit} {}

FurtherEnds::FurtherEnds(std::span<const FurtherEndnode> described, Duration watchdog, Duration enable_limit,
                         FurtherPayloads& device)
    : device_{device} {
  for (const FurtherEndnode& each : described)
    if (each.actuator) drives_.push_back(std::make_unique<Drive>(each, watchdog, enable_limit));
}

Result<> FurtherEnds::open(FlowFactory& flows) {
  for (const auto& drive : drives_) {
    if (!device_.can_at(drive->name, drive->stop))
      return fail(ErrorCode::InvalidArgument,
                  "a further endnode with an actuator, or its stop, that this device does not have");
    HIROSCO_TRY(drive->inhibit.open(flows));
  }
  return ok();
}

EndnodeWays* FurtherEnds::inhibit_ways(std::string_view endnode) noexcept {
  Drive* const drive = drive_of(endnode);
  return drive != nullptr ? drive->inhibit.ways() : nullptr;
}

void FurtherEnds::heal() noexcept {
  for (const auto& drive : drives_)
    if (EndnodeWays* const ways = drive->inhibit.ways()) ways->heal();
}

Duration FurtherEnds::forgive(const WorldClock::Held& held) noexcept {
  Duration most{};
  for (const auto& drive : drives_) {
    const Duration forgiven = drive->obedience.forgive(held);
    drive->inhibit.prolong(held.pause + forgiven);
    most = std::max(most, forgiven);
  }
  return most;
}

bool FurtherEnds::receive(std::span<FurtherExchange> ends, TimePoint now, bool powered) noexcept {
  for (const auto& drive : drives_) drive->inhibit.receive(now, powered && !ends.empty());
  bool any = false;
  for (FurtherExchange& end : ends)
    if (Drive* const drive = drive_of(end.name())) {
      const bool came = receive(end, *drive, now, powered);
      drive->asked = drive->asked || came;
      any = any || came;
    }
  return any;
}

/// As SimulatedDevice has it at the endnode that drives it.
bool FurtherEnds::receive(FurtherExchange& end, Drive& drive, TimePoint now, bool powered) noexcept {
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto received = end.ways().receive(buffer);
  if (!received || received->flow != Flow::New || !powered) return false;
  const auto command = read_command(Octets{buffer}.first(std::min(received->octets, buffer.size())));
  using enum Obedience::Verdict;
  const auto refuse = [this] {
    ++damaged_commands_;
    return false;
  };
  if (!command) return refuse();
  const Obedience::Judgement judgement = drive.obedience.judge(*command, now);
  if (judgement.verdict == Refused) {
    drive.asked =
        true;  // it is told so, by a flag and the sequence that counts: nobody else is, nor would hear of it otherwise
    return false;
  }
  if (judgement.verdict == Heard) return true;
  if (judgement.verdict == Obeyed && !device_.take_at(drive.name, OctetReader{command->payload, end.byte_order()}))
    return refuse();
  drive.obedience.accept(*command, judgement, now);
  return true;
}

void FurtherEnds::choose_output(TimePoint now) noexcept {
  for (const auto& drive : drives_) {
    drive->obedience.watch(now);
    drive->obedience.choose_output(now);
  }
}

void FurtherEnds::count_down(Duration cycle) noexcept {
  for (const auto& drive : drives_) drive->obedience.count_down(cycle);
}

/// Whether one without an actuator is to answer. What was not taken is not answered, so that its subsystem hears of it.
bool FurtherEnds::asked(FurtherExchange& end, bool powered) noexcept {
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto command = end.hear(buffer);
  if (!command || !powered) return false;
  if (command->mode != DeviceMode::Active ||
      device_.take_at(end.name(), OctetReader{command->payload, end.byte_order()}))
    return true;
  ++damaged_commands_;
  return false;
}

void FurtherEnds::answer(std::span<FurtherExchange> ends, const Said& said) noexcept {
  for (FurtherExchange& end : ends) {
    Drive* const drive = drive_of(end.name());
    if (drive != nullptr ? !std::exchange(drive->asked, false) : !asked(end, said.powered)) continue;
    std::array<std::byte, max_device_payload_octets> payload;
    OctetWriter writer{payload, end.byte_order()};
    device_.write_sensors_at(end.name(), writer);
    if (said.silent) continue;
    if (drive == nullptr) end.answer(writer.written(), said.flags);
    else
      end.answer({.epoch = drive->obedience.epoch(),
                  .sequence = drive->obedience.sequence(),
                  .flags = flags_at(drive->obedience, said.flags),
                  .payload = writer.written()});
  }
  for (const auto& drive : drives_)
    drive->inhibit.answer(said.plugged, {.output = drive->obedience.output(),
                                         .flags = flags_at(drive->obedience, said.flags),
                                         .epoch = drive->obedience.epoch()});
}

void FurtherEnds::begin_anew() noexcept {
  for (const auto& drive : drives_) {
    drive->obedience.begin_anew();
    drive->inhibit.forget();
    drive->asked = false;
  }
}

void FurtherEnds::withdraw() noexcept {
  for (const auto& drive : drives_) {
    drive->inhibit.withdraw();
    drive->asked = false;
  }
}

FurtherEnds::Drive* FurtherEnds::drive_of(std::string_view endnode) const noexcept {
  const auto found = std::ranges::find_if(drives_, [&](const auto& drive) { return drive->name == endnode; });
  return found != drives_.end() ? found->get() : nullptr;
}

DeviceOutput FurtherEnds::output(std::string_view endnode) const noexcept {
  const Drive* const drive = drive_of(endnode);
  return drive != nullptr ? drive->obedience.output() : DeviceOutput::Off;
}

Duration FurtherEnds::stop_left(std::string_view endnode) const noexcept {
  const Drive* const drive = drive_of(endnode);
  return drive != nullptr ? drive->obedience.stop_left() : Duration{};
}

bool FurtherEnds::active() const noexcept {
  return std::ranges::any_of(drives_,
                             [](const auto& drive) { return drive->obedience.output() == DeviceOutput::Active; });
}

TimePoint FurtherEnds::next_wake() const noexcept {
  TimePoint wake = TimePoint::max();
  for (const auto& drive : drives_) {
    wake = std::min(wake, drive->obedience.trips_at());
    if (drive->obedience.output() == DeviceOutput::Active) wake = std::min(wake, drive->inhibit.ends_at());
  }
  return wake;
}

std::uint64_t FurtherEnds::damaged_commands() const noexcept {
  std::uint64_t sum = damaged_commands_;
  for (const auto& drive : drives_) sum += drive->inhibit.damaged_commands();
  return sum;
}

}  // namespace hirosco::simulation
