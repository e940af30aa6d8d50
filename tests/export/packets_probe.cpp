// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>

#include "hirosco/pus/requests.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

// Flies a mission on virtual time, asks it for reports of every kind that it has, and prints each packet that it routes to the ground, in
// hexadecimal, a line each: of rokviss what it has to tell, of others every request that has a name.
namespace hirosco {
namespace {

using simulation::Flight;

class Questions {
 public:
  explicit Questions(Flight& flight) : flight_{flight} {}

  void ask(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = apid,
                                                .sequence_count = count_++,
                                                .ack = pus::ack_all,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = 0x1000},
                                               data);
    if (!packet) throw std::runtime_error{"a telecommand that is too long"};
    (void)flight_.send(*packet);
    flight_.craft().run(50ms);
  }
  template <class... Numbers>
  [[nodiscard]] static std::vector<std::byte> octets(Numbers... numbers) {
    std::array<std::byte, 256> buffer;
    OctetWriter writer{buffer};
    (writer.put(numbers), ...);
    return {writer.written().begin(), writer.written().end()};
  }

 private:
  Flight& flight_;
  std::uint16_t count_{9000};
};

constexpr std::uint16_t supervisor = 1, manipulator = 10;

void structures(Questions& questions) {
  using U8 = std::uint8_t;
  using U16 = std::uint16_t;
  using U32 = std::uint32_t;
  const auto one = Questions::octets(U8{1}, U16{4711});
  for (const auto subtype : {U8{9}, U8{33}, U8{27}}) questions.ask(manipulator, 3, subtype, one);
  questions.ask(manipulator, 3, 33, Questions::octets(U8{2}, U16{4711}, U16{4712}));
  questions.ask(supervisor, 3, 9, Questions::octets(U8{1}, U16{4702}));
  // Refused: no such structure; no list at all; a length that its count belies.
  questions.ask(manipulator, 3, 27, Questions::octets(U8{1}, U16{1}));
  questions.ask(manipulator, 3, 27, Questions::octets(U8{0}));
  questions.ask(manipulator, 3, 27, Questions::octets(U8{3}, U16{1}));
  questions.ask(manipulator, 5, 6, Questions::octets(U8{1}, U16{1001}));
  questions.ask(manipulator, 5, 7, {});
  questions.ask(manipulator, 5, 5, Questions::octets(U8{1}, U16{1001}));
  questions.ask(manipulator, 5, 7, {});
  const auto id = [](Type type, U8 number) { return ParameterId{manipulator, type, number}.wire(); };
  questions.ask(manipulator, 20, 1, Questions::octets(U8{1}, id(Type::Double, 3)));
  questions.ask(manipulator, 20, 1, Questions::octets(U8{1}, id(Type::Double, 100)));
  questions.ask(manipulator, 20, 1, Questions::octets(U8{1}, id(Type::Struct, 0)));
  questions.ask(manipulator, 20, 1, Questions::octets(U8{2}, id(Type::Double, 3), id(Type::Float, 7)));
  questions.ask(manipulator, 20, 3, Questions::octets(U8{1}, id(Type::Double, 3), 1.0));
  questions.ask(manipulator, 20, 1, Questions::octets(U8{1}, U32{7}));
  // Whether two would be permitted, and the answers; the previews of modes and plans, of services that nobody has, of an APID that is nobody's.
  for (const std::uint8_t service : {U8{17}, U8{99}}) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto asked = pus::write_telecommand(
        buffer, {.apid = manipulator, .ack = pus::ack_all, .service = service, .subtype = 1, .source = 0x1000}, {});
    questions.ask(supervisor, 129, 1, {asked->begin(), asked->end()});
  }
  questions.ask(supervisor, 129, 4, Questions::octets(U8{2}));
  questions.ask(supervisor, 129, 6, Questions::octets(U16{manipulator}, U16{1021}));
  questions.ask(manipulator, 99, 1, {});
  questions.ask(manipulator, 17, 99, {});
  questions.ask(77, 17, 1, {});
}

void fly(Flight& flight) {
  if (!flight.commission()) throw std::runtime_error{"rokviss was not commissioned"};
  Questions questions{flight};
  auto& craft = flight.craft();
  for (const char* name : {"SUPERVISOR", "COMMUNICATION", "MANIPULATOR", "JOYSTICK"}) {
    (void)craft.command(name, "PING", {});
    (void)craft.command(name, "REPORT_SELF_TEST", {});
  }
  structures(questions);
  (void)craft.command("MANIPULATOR", "MOVE_TO", {0.1, 1.2, 2.0});  // in this mode the robot follows the joystick
  craft.run(10s);
  (void)flight.set_mode("standalone");
  (void)craft.command("MANIPULATOR", "MOVE_TO", {-0.9, 1.5, 2.0});
  (void)craft.command("MANIPULATOR", "MOVE_TO", {-0.8, 1.6, 0.1});  // too fast
  (void)craft.command("MANIPULATOR", "HOOK_SPRING", {1.0});
  structures(questions);
  (void)flight.set_state("MANIPULATOR", State::SafeOperational);
  (void)craft.command("MANIPULATOR", "SELF_TEST", {}, 20s);
  (void)craft.command("MANIPULATOR", "REPORT_SELF_TEST", {});
  (void)flight.set_mode("telepresence");
  craft.run(2s);
  (void)craft.device("joystick")->fault("unplug");
  craft.run(5s);
  (void)craft.command("SUPERVISOR", "SAFE_ALL", {});
  craft.kill("JOYSTICK");
  craft.run(5s);
}

[[nodiscard]] std::vector<Value> some_arguments(const descriptor::Function& function) {
  std::vector<Value> values;
  for (const auto& argument : function.arguments)
    for (std::uint32_t i = 0; i < argument.field.values(); ++i) {
      if (argument.field.type == Type::Text) values.emplace_back(std::string{"w"});
      else if (!argument.texts.empty()) values.emplace_back(Number{argument.texts.front().value});
      else values.emplace_back(argument.field.minimum.value_or(Number{1}));
    }
  return values;
}

void ask_by_name(Flight& flight) {
  if (!flight.commission()) throw std::runtime_error{"the mission was not commissioned"};
  for (const auto* subsystem : flight.mission().everybody())
    for (const auto& request : pus::requests_of(*subsystem)) {
      // What ends the flight, or lets nothing through any more.
      constexpr std::array left_out{"SHUTDOWN", "SAFE_ALL", "SET_STATE", "SET_MODE", "ENTER_MODE"};
      const bool ends = std::ranges::find(left_out, request.name) != left_out.end();
      if (!ends) (void)flight.craft().command(subsystem->name, request.name, some_arguments(request), 2s);
    }
  flight.craft().run(5s);
}

}  // namespace
}  // namespace hirosco

int main(int argc, char** argv) {
  using namespace hirosco;
  if (argc != 2) return 2;
  try {
    simulation::Flight flight{{.mission = argv[1]}};
    flight.story().on_telemetry = [](const pus::TelemetryView& told) {
      for (const std::byte octet : told.packet()) fmt::print("{:02x}", std::to_integer<unsigned>(octet));
      fmt::print("\n");
    };
    if (flight.mission().name == "ROKVISS") fly(flight);
    else ask_by_name(flight);
  } catch (const std::exception& error) {
    fmt::print(stderr, "packets_probe: {}\n", error.what());
    return 1;
  }
  return 0;
}
