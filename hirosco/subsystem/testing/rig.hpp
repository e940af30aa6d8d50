// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/pages/inhibition.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {
class ChannelPair;
struct PermitPage;
struct VitalPage;
}  // namespace hirosco

/// One subsystem stepped by hand: the test is its supervisor, its clock, its threads and its devices. The parts around it
/// are the simulated set, no mocks. A simulated device goes on `flows`, at the address of its endnode, and is stepped with the rig's clock
/// after each cycle (templates/device/newpart_test.cpp); without Settings::enable, as no supervisor holds its second inhibit here.
/// An author includes this, so nothing of service loop and cycle stands here (docs/adr/0187): tests of these include inside.hpp.
namespace hirosco::testing {

/// A telecommand on its way: its acknowledgements are found by its request id.
struct Sent {
  std::uint32_t id{0};
};

struct Telemetry {
  std::uint8_t service{};
  std::uint8_t subtype{};
  std::uint16_t destination{};
  std::vector<std::byte> data;
};

/// An event as the supervisor hears of it.
struct Raised {
  descriptor::Severity severity{};
  pus::Reported reported{};
  std::uint16_t id{};
  std::vector<std::byte> auxiliary;
};

/// A telecommand of the subsystem to another one, as the supervisor takes it.
struct Asked {
  std::uint32_t id{};
  std::uint16_t apid{};
  std::uint16_t source{};
  std::uint8_t ack{};
  std::uint8_t service{};
  std::uint8_t subtype{};
  std::vector<std::byte> data;
  std::uint32_t known_stop{};  ///< Message::epoch
};

class Rig {
 public:
  static constexpr std::uint16_t source = 7;

  /// `wakes`: the test steps the service loop when the cycle has something to report (Platform::wakes).
  Rig(Subsystem& author, const std::string& descriptor_text, bool realtime = true, bool wakes = false);
  Rig(Subsystem& author, descriptor::SubsystemDescriptor described, bool realtime = true, bool wakes = false);
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;
  ~Rig();

  // --- stepping -----------------------------------------------------------------------------------------------------
  /// One step of the service loop; collects what the subsystem sent. The supervisor's heart beats unless it is silent.
  void service();
  /// What a cycle thread does: runs `count` cycles of the configuration while they are wanted, else parks. Throws std::runtime_error, which fails
  /// the test, where the author's code used the heap, locked or put out in one: which node or handler, and how often (docs/adr/0230). Seen where
  /// the hook is linked, as hirosco_subsystem() has it come with NAME_objects.
  void cycle(int count = 1);
  /// Both in turn until nothing can be under way any more.
  void settle(int rounds = 12);
  void advance(Duration span) { clock.advance(span); }
  /// One step of a loop of services of its own, from 0 on, that was due at `planned`; when the next is due.
  TimePoint own_loop(std::size_t loop, TimePoint planned);

  // --- commanding ---------------------------------------------------------------------------------------------------
  Sent send(std::uint8_t service, std::uint8_t subtype, Octets data, const MemoryHandle& memory = {},
            std::uint32_t mode_epoch = 0);
  /// A telecommand by the function's name, its numbers in the order of the descriptor. A value outside of its declared range is sent all the
  /// same: the subsystem refuses it, and outcome() says "1 4:0105..." with index and id of the argument. Throws std::runtime_error where
  /// nothing can be sent: no such function, too few or too many values, one that its type does not hold.
  Sent call(std::string_view function, std::initializer_list<double> arguments = {});
  /// The same with arguments of any type, arrays element by element.
  Sent call_with(std::string_view function, const std::vector<std::optional<Value>>& arguments);
  /// Sets a writable parameter by its name, or a part of one ("LAMP.LEVEL", "LAMP"), by TC[20,3] with the id on the wire that goes with it;
  /// as of call() values outside the range are sent and refused, and std::runtime_error is thrown where nothing can be sent.
  Sent set(std::string_view parameter, double value) { return set_with(parameter, {value}); }
  /// The same with values of any type, of an array or a structure one behind the other.
  Sent set_with(std::string_view parameter, const std::vector<std::optional<Value>>& values);
  Sent set_state(State target) { return call("SET_STATE", {static_cast<double>(target)}); }
  Sent configure(std::uint8_t id) { return call("CONFIGURE", {static_cast<double>(id)}); }
  /// Sends, settles, and gives outcome().
  std::string set_state_now(State target);
  std::string configure_now(std::uint8_t id);
  /// The orderly way up to a state in configuration `id`.
  void bring_to(State state, std::uint8_t id = 1);

  /// What another subsystem, or the supervisor, reports to this one.
  void answer(std::uint16_t from, std::uint8_t service, std::uint8_t subtype, Octets data,
              std::optional<std::uint16_t> destination = std::nullopt);
  /// TM[1,subtype] of whom it asked.
  void verify(const Asked& request, std::uint8_t subtype, Octets more = {}) {
    std::vector<std::byte> data(4 + more.size());
    OctetWriter{data}.put(request.id).put(more);
    answer(request.apid, 1, subtype, data);
  }

  /// The supervisor's stop: no output reaches an actuator from the next cycle on.
  void fence();

  // --- looking ------------------------------------------------------------------------------------------------------
  /// What it is described as.
  [[nodiscard]] const descriptor::SubsystemDescriptor& descriptor() const;
  /// The verification reports of a request: "1 3 7", "1 4:000a03" (subtype, colon, code and data of a failure).
  [[nodiscard]] std::string outcome(Sent request) const;
  /// Source data of all reports of a type, in order, as hexadecimal text.
  [[nodiscard]] std::vector<std::string> reports(std::uint8_t service, std::uint8_t subtype) const;
  /// How often the event with this number came.
  [[nodiscard]] int events(std::uint16_t id) const;
  void forget_telemetry() {
    telemetry.clear();
    raised.clear();
  }
  /// How often the supervisor heard of the event with this number.
  [[nodiscard]] int heard(std::uint16_t id) const {
    return static_cast<int>(std::ranges::count(raised, id, &Raised::id));
  }
  /// A lost device or link does not change it: its actuators are inhibited, the supervisor hears of that (`raised`) and acts by the mission's
  /// plans; here that is the test's part. So a test of a loss looks at inhibited().
  [[nodiscard]] State state() const;
  /// Why no output reaches an actuator, a bit for each reason (Inhibition); 0: it does, in Operational.
  [[nodiscard]] std::uint32_t inhibited() const;

  // --- a partner's end of a link ------------------------------------------------------------------------------------
  struct Partner {
    MemoryHandle memory;
    Mapping mapping;
    LatestWriter writer;
    LatestReader reader;
  };
  /// Attaches the subsystem's end of a link with the fields of the agreement; the test holds the other end.
  Partner attach(std::uint8_t link, pus::st128::Role role, std::string set,
                 std::vector<pus::st128::OfferedField> fields, std::string* outcome_text = nullptr,
                 Duration producer_period = 1ms);
  Sent detach(std::uint8_t link);

  ManualClock clock;
  HeapMemory memory;
  LocalFlows flows;
  std::vector<std::string> explanations;
  std::vector<Telemetry> telemetry;
  std::vector<Raised> raised;  ///< told to the supervisor, whatever ST[05] is told
  std::vector<Asked> asked;
  bool supervisor_silent{false};
  bool cycles_watched{true};  ///< false: the test's own code runs in cycles and may do what an author's must not
  std::uint32_t link_epoch{5};  ///< of the next attach()

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;  ///< goes first: what it is given stands above

 public:
  // --- what stands behind it: known to who includes hirosco/subsystem/testing/inside.hpp, in the repository alone --------
  ChannelPair& channels;
  VitalPage& vital;
  PermitPage& permit;
  GenericSubsystem& subsystem;

 private:
  std::uint16_t count_{0};
};

[[nodiscard]] std::string hex(Octets octets);
[[nodiscard]] descriptor::SubsystemDescriptor read_descriptor(const std::string& text);
/// The same of one that commands, or hears, those who have the other descriptors, under the names that these have.
[[nodiscard]] descriptor::SubsystemDescriptor read_descriptor(const std::string& text,
                                                              const std::vector<std::string>& commanded);

}  // namespace hirosco::testing
