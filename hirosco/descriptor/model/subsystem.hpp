// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/descriptor/model/bumpless.hpp"
#include "hirosco/descriptor/model/parameters.hpp"
#include "hirosco/descriptor/model/resources.hpp"
#include "hirosco/descriptor/model/service_list.hpp"
#include "hirosco/parameter/exact_number.hpp"
#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/time.hpp"

/// The subsystem descriptor in memory (paper 4.1, figure 3). Plain data: read once, checked whole, then constant.
/// All references are resolved: indices point into the vectors of the same descriptor.
namespace hirosco::descriptor {

/// Severity of an event (PUS ST[05]); the value is the message subtype of its report.
enum class Severity : std::uint8_t { Info = 1, Low = 2, Medium = 3, High = 4 };

/// One housekeeping report structure (Listing 2).
struct HousekeepingStructure {
  std::uint16_t id{};
  std::uint32_t interval_cycles{};
  bool enabled{true};  ///< periodic generation from Pre-Operational on
  std::vector<ParameterRef> sampled_once;
  struct SampledSet {
    std::uint16_t repetitions{};  ///< samples in one interval, spaced interval / repetitions
    std::vector<ParameterRef> parameters;
  };
  std::vector<SampledSet> sampled_repeatedly;
  Location at;
};

struct Event {
  std::string name;
  std::uint16_t id{};
  Severity severity{Severity::Info};
  std::vector<Field> arguments;  ///< auxiliary data, in order
  Location at;
  bool safety{false};  ///< nobody switches its report off (docs/adr/0091)
};

/// Requests that every subsystem has: no function or request of its own has one of these names.
inline constexpr std::array<std::string_view, 5> built_in_requests{"SET_STATE", "CONFIGURE", "PING", "SELF_TEST",
                                                                   "REPORT_SELF_TEST"};

/// A request by name: a function of ST[08], whose argument ids count from 1 in order, or of a subsystem's own service.
struct Function {
  std::string name;  ///< upper-case ASCII, at most 16 octets
  std::uint8_t service{8};
  std::uint8_t subtype{1};
  std::uint16_t states{0};  ///< bit n set: permitted in State n
  bool essential{false};  ///< forwarded before it is logged (decision 24)
  bool confirm{false};  ///< a person at a ground station is asked once more (docs/adr/0105)
  struct Argument {
    Field field;
    std::string of;  ///< parameter that gave type, unit, enumeration and range; empty = its own
    std::optional<Value> fallback;  ///< value, of each element, when the argument is absent from the request
    std::vector<EnumerationText> texts{};  ///< of an enumeration or BOOL: its values and their names; it has no others
    /// Most octets on the wire: words come behind their length (u16).
    [[nodiscard]] std::size_t octets() const noexcept {
      return field.octets() + (field.type == Type::Text ? sizeof(std::uint16_t) : 0);
    }
  };
  std::vector<Argument> arguments;
  std::string description;
  Location at;
  std::uint32_t sets{0};  ///< of ST[20]: the parameter that it sets, by ParameterId::wire(); 0: it is no setting
  /// Parameters that it sets and nobody sets again after a crash: those of its `sets`, and protections that an argument is `of`.
  /// Indices into `parameters` of its own descriptor, ascending. Who ran it moves again by command only (docs/adr/0170).
  std::vector<std::uint16_t> unrepeated{};
  [[nodiscard]] bool permitted_in(State state) const noexcept { return (states >> static_cast<int>(state) & 1) != 0; }
};

/// A PUS service of the subsystem's own (paper 4.1: "a list of services").
struct CustomService {
  std::string name;
  std::uint8_t type{};  ///< 192 to 255
  std::vector<Function> requests;  ///< their arguments stand in order, without ids
  struct Report {
    std::string name;
    std::uint8_t subtype{};
    std::vector<Function::Argument> fields;  ///< without fallback, and no range
  };
  std::vector<Report> reports;
  Location at;
};

enum class ByteOrder : std::uint8_t { Little = 1, Big = 2 };

/// What one side of a real-time link can do; lists are in order of preference, never empty.
struct LinkTerms {
  std::vector<LinkMethod> methods{LinkMethod::SharedMemory};
  std::vector<ByteOrder> byte_orders{ByteOrder::Little};
  std::vector<LinkKind> kinds{LinkKind::Latest};
  /// Samples are lent, not copied; then there is no other kind and no byte order but the machine's (adr 0070).
  [[nodiscard]] bool lent() const noexcept { return kinds.front() == LinkKind::Loaned; }
};

/// A set of data that a configuration provides over a real-time link: parameters, or fields of its own where it is lent.
struct Provides {
  std::string name;
  LinkTerms terms;
  std::vector<ParameterRef> parameters;
  std::vector<Field> fields;  ///< of a lent set, as they lie side by side in its sample
  Location at;
};

/// What a consumer does at the cycle when a required link is stale (decision 22).
enum class MissingPolicy : std::uint8_t { Inhibit, Hold };

/// A limit in the observer's own cycles: with real-time scheduling, and without it (decision 21).
struct CycleLimit {
  std::uint32_t realtime{};
  std::uint32_t reduced{};
};

/// A set of fields that a configuration requires over a real-time link. Fields are matched by name. It has one kind: who looks at
/// what is lent, or wants every sample, has another port than who wants the newest (adr 0070, 0072).
struct Requires {
  std::string name;
  std::string from;  ///< name of the producing subsystem, empty = any
  LinkTerms terms;
  std::uint32_t depth{0};  ///< of a queued set: samples that it may fall behind without a loss; of others 0
  bool required{true};  ///< false: useful, but Safe-Operational does not wait for it
  bool starts{false};  ///< its samples start the cycle of the configuration (Configuration::started_by)
  CycleLimit age{3, 40};
  MissingPolicy missing{MissingPolicy::Inhibit};
  std::vector<Field> fields;
  Location at;
  [[nodiscard]] LinkKind kind() const noexcept { return terms.kinds.front(); }
};

/// Address and means of transfer of a data flow (paper 4.1).
struct Endnode {
  Transfer transfer{Transfer::SharedMemory};
  std::string address;  ///< a name, a line, or host:port
  ByteOrder byte_order{ByteOrder::Little};
  Framing framing{Framing::Frames};  ///< Raw: by a protocol of the author's (adr 0112)
  Location at;
};

/// What is said of an endnode that the supervisor's side holds besides where it is (docs/adr/0237).
struct HeldTerms {
  std::vector<Endnode> fall_backs;  ///< other ways to the same inhibit or switch, in their order
  Duration silence{};  ///< oldest answer that counts, with real-time scheduling; 0: answers have no age limit
  Duration silence_reduced{};
  bool goes_on{false};  ///< of a second inhibit: who loses one way and has another is not stopped
};
/// Who goes on by another way has to be there before the device lets go by itself, 50 or 100 ms after the last command: less than that by three
/// steps of the guard.
inline constexpr Duration longest_silence_to_go_on = std::chrono::milliseconds{35};
inline constexpr Duration longest_silence_to_go_on_reduced = std::chrono::milliseconds{85};

/// What a device does by itself when its command is taken away: the inhibit falls, or its frames stay out. Its own duty; the guard compares it with
/// what the device says after a stop of everything (docs/adr/0213).
enum class StopKind : std::uint8_t {
  Drop,  ///< no force at once
  Controlled,  ///< comes to rest within `stop_within`, then no force or brake
  Hold,  ///< keeps its position
};

/// What a cycle exchanges frames with: a hardware device, or one endnode of it where it has several (adr 0079). Declared once
/// under <Subsystem>.
struct Device {
  std::string name;  ///< of an endnode: DEVICE.ENDNODE
  std::string part_of;  ///< the device whose endnode it is; empty: it is a whole device
  bool actuator{false};  ///< output is gated by the framework (decision 22)
  std::vector<Field> input;  ///< device -> subsystem
  struct Output {
    Field field;
    std::vector<double> safe;  ///< of an actuator: value in every state but Operational; `count` values
  };
  std::vector<Output> output;  ///< subsystem -> device
  StopKind stop{StopKind::Drop};
  Duration stop_within{};  ///< from the loss of the command to the stop; 0 = at once
  /// Second inhibit of an actuator, held by the supervisor's side and never handed to the subsystem; empty = none.
  std::optional<Endnode> enable;
  Location at;
  HeldTerms enable_terms{};
};

/// Most endnodes of one device.
inline constexpr std::size_t max_device_endnodes = 8;
/// Most fall-backs of one endnode.
inline constexpr std::size_t max_fall_backs = 7;

/// Switches a whole device on and off: an endnode that the supervisor's side holds and that is never handed to the subsystem.
struct PowerSwitch {
  std::string device;
  Endnode endnode;
  Location at;
  HeldTerms terms{};
};

/// Most that the fields of a device take in each direction, as a frame is carried by every data flow.
inline constexpr std::size_t max_device_octets = 1002;

/// Words for the author of a device, or of its simulation.
struct Setting {
  std::string name;
  std::string value;
  Location at;
};

/// Settings and endnode of a device in one configuration.
struct DeviceUse {
  std::uint16_t device{};  ///< index into SubsystemDescriptor::devices
  CycleLimit silence{
      3, 40};  ///< cycles without a valid frame until the device counts as lost, or its next fall-back is tried
  std::uint32_t every{1};  ///< cycles from one frame to the next
  std::uint32_t watchdog_us{10'000};  ///< device watchdog with real-time scheduling
  std::uint32_t watchdog_reduced_us{50'000};
  std::vector<Setting> settings;  ///< for its author: DevicePortBase::setting()
  Endnode endnode;
  std::vector<Endnode> fall_backs;  ///< in the order in which they are tried; byte order is the endnode's
  Location at;
};

/// Whether Operational waits for a pass of the author's self test.
enum class SelfTest : std::uint8_t { Optional, Required };
inline constexpr Duration default_self_test_within = std::chrono::seconds{10};

/// Shorter cycles cannot be kept, and somebody else would be told as hung for it.
inline constexpr Duration least_sampling = std::chrono::microseconds{50};
/// Above every cycle run the simulated devices and the supervisor's guard, which takes priority from a cycle that hangs.
inline constexpr int greatest_cycle_priority = 84;
/// A precise cycle looks at the clock no longer than this before it is due (adr 0104): what wakes later than that is not awake in time anyway.
inline constexpr Duration greatest_spin = std::chrono::milliseconds{1};
/// Most octets that the arguments of a function take together on their way to the cycle.
inline constexpr std::size_t max_argument_octets = 256;

struct Configuration {
  std::string name;
  std::uint8_t id{};
  int priority{0};  ///< SCHED_FIFO priority of the cycle; 0 = ordinary scheduling
  Duration sampling{};  ///< period of the cycle; of one that samples start, the longest that it waits for one
  std::string started_by;  ///< required set whose samples start the cycle; empty: the clock alone does (adr 0094)
  Duration least{};  ///< of one that samples start: from the start of a cycle to that of the next
  Duration budget{};  ///< most processor time that a cycle takes; 0 = not declared
  Duration
      spin{};  ///< of a precise one: so long before it is due it wakes and looks at the clock; 0 = it sleeps (adr 0104)
  double power_w{0};  ///< most that it draws from Safe- to Post-Operational; 0 = not accounted
  CycleLimit overruns{3, 20};  ///< overruns in a row until the overrun event
  SelfTest self_test{SelfTest::Optional};
  Duration self_test_within{default_self_test_within};  ///< one that takes longer has failed
  std::vector<HousekeepingStructure> housekeeping;
  std::vector<Provides> provides;
  std::vector<Requires> requires_;
  std::vector<DeviceUse> devices;
  struct Initial {
    ParameterRef parameter;
    std::vector<Value> values;  ///< as many as its fields have
  };
  std::vector<Initial> initial;  ///< parameter values that this configuration sets
  std::vector<ServiceUse> services;  ///< what it says of them otherwise than its subsystem
  std::vector<ServiceLoop>
      paces;  ///< the same of their loops, by name; what it leaves out is the subsystem's (docs/adr/0207)
  Location at;
  /// The shortest distance of two cycles: what they cost a processor at most is reckoned with it.
  [[nodiscard]] Duration shortest() const noexcept { return started_by.empty() ? sampling : least; }
  /// What a cycle takes of its processor at most, what it spins away before it included.
  [[nodiscard]] Duration load() const noexcept { return budget + spin; }
};

/// A failure code of the author's own, 0x8000 to 0xFFFF.
struct FailureName {
  std::uint16_t code{};
  std::string name;
};

/// One thing of another subsystem that a service of the framework is about (adr 0098).
struct Thing {
  enum class Kind : std::uint8_t {
    Set,  ///< a parameter, by ST[20]
    Read,  ///< likewise
    Housekeeping,  ///< a structure, by ST[03]; its name is its id
    Event,  ///< ST[05]
  };
  Kind kind{Kind::Set};
  std::string name;
  std::uint32_t id{0};  ///< on the wire; like the next not known before a mission says who the other is
  std::vector<Field> fields{};  ///< values of the parameter, of a report, arguments of the event
};

/// Whom a subsystem may command, and what for; whatever else it sends is refused (adr 0062).
struct Commands {
  std::string subsystem;  ///< as this descriptor calls it
  std::vector<std::string> functions;  ///< and requests of its own services, by name
  std::vector<Thing> things{};  ///< that the framework's services may be asked for
  Location at;
  std::uint16_t apid{0};  ///< as the mission has it, like the next two; 0 = not known yet
  std::filesystem::path file{};  ///< its descriptor
  std::vector<Function> requests{};  ///< what it says of `functions`, in their order
};

/// A parameter that has the value of one of another subsystem, heard by its housekeeping (adr 0103).
struct Foreign {
  std::uint16_t parameter{};  ///< index into SubsystemDescriptor::parameters
  std::string name;  ///< of the other's
  std::uint16_t structure{0};  ///< by which it is heard; like the next 0 before a mission says who the other is
  std::size_t offset{0};  ///< of the value, behind the id of the structure
};

/// Whose housekeeping and events it may have the supervisor pass on to it (adr 0098).
struct Subscribes {
  std::string subsystem;  ///< as this descriptor calls it
  std::vector<Thing> things;
  std::vector<Foreign> foreign{};
  Location at;
  std::uint16_t apid{0};  ///< as the mission has it, like the next; 0 = not known yet
  std::filesystem::path file{};  ///< its descriptor
};

/// A file of telecommands beside the descriptor, which the subsystem may read (docs/adr/0138); file_of() says where it is.
struct ScriptFile {
  std::string name;
  std::string file;
  Location at;
};

struct SubsystemDescriptor {
  std::string name;
  std::uint16_t id{};  ///< APID
  std::string description;
  std::filesystem::path file;  ///< where it was read from
  std::shared_ptr<const std::string> text;  ///< of that file, as it was read; null: it was made by hand
  std::vector<Enumeration> enumerations;
  std::vector<Parameter> parameters;
  std::vector<Event> events;  ///< the author's, then the framework's (framework_events.hpp)
  std::vector<Function> functions;  ///< the author's; SET_STATE and CONFIGURE are built in
  std::vector<CustomService> services;  ///< of its own, beside the framework's
  std::vector<FailureName> failures;
  std::vector<Commands> commands;  ///< no subsystem twice
  std::vector<Subscribes> subscribes{};  ///< likewise
  std::vector<HousekeepingStructure> housekeeping;  ///< valid in every configuration
  std::vector<Device> devices;
  std::vector<PowerSwitch> power_switches;  ///< at most one for each device
  std::vector<Configuration> configurations;
  CycleLimit hang{20, 200};  ///< cycles the vital page may stand still
  Resources resources;
  std::vector<ServiceLoop> service_loops;
  std::vector<ServiceUse> service_uses;  ///< of services that are not offered, or run in a loop of their own
  std::vector<Bumpless> bumpless;
  std::vector<ScriptFile> scripts;

  [[nodiscard]] const Parameter* find_parameter(std::string_view parameter) const noexcept;
  [[nodiscard]] const Event* find_event(std::string_view event) const noexcept;
  [[nodiscard]] const Function* find_function(std::string_view function) const noexcept;
  /// A service of its own, and a request of one. Null: it has none.
  [[nodiscard]] const CustomService* find_service(std::uint8_t type) const noexcept;
  [[nodiscard]] const CustomService* find_service(std::string_view service) const noexcept;
  [[nodiscard]] const Function* find_request(std::uint8_t service, std::uint8_t subtype) const noexcept;
  /// A function, or a request of a service of its own, by name: one set of names.
  [[nodiscard]] const Function* find_named(std::string_view request) const noexcept;
  [[nodiscard]] const Configuration* find_configuration(std::string_view configuration) const noexcept;
  [[nodiscard]] const Configuration* find_configuration(std::uint8_t configuration) const noexcept;
  /// Whether the service of this type is offered while the configuration is in force; null: none is. Of a type that it does not have
  /// at all nothing is said.
  [[nodiscard]] bool offers(std::uint8_t type, const Configuration* in_force) const noexcept;
  /// In which of its loops the service runs; -1: the service loop.
  [[nodiscard]] int loop_of(std::uint8_t type) const noexcept;
  /// Period, priority and budget of a loop, by its place, while the configuration is in force; null: none is.
  [[nodiscard]] const ServiceLoop& loop_in_force(std::size_t loop, const Configuration* in_force) const noexcept;
  /// What holds where one follows the other without a break; null: they are not declared compatible.
  [[nodiscard]] const Bumpless* bumpless_between(std::uint8_t one, std::uint8_t other) const noexcept;
};

/// Says who is commanded. The first of the functions that it does not have; empty when it has all.
[[nodiscard]] std::string_view resolve(Commands& commands, const SubsystemDescriptor& commanded);
/// Says whose things these are. The first that cannot be had, and why in words; null: all can.
struct NoThing {
  const Thing* thing{nullptr};
  std::string_view why{};
};
[[nodiscard]] NoThing resolve(std::vector<Thing>& things, const SubsystemDescriptor& other);
/// Says by which of the structures that are heard, and where in it, each foreign parameter comes. The first that does not, and why in
/// words.
struct NoForeign {
  const Foreign* foreign{nullptr};
  std::string why{};
};
[[nodiscard]] NoForeign resolve_foreign(const SubsystemDescriptor& own, Subscribes& heard,
                                        const SubsystemDescriptor& other);

/// Names of the actuator devices that have no second inhibit: nothing but their subsystem keeps them from moving.
[[nodiscard]] std::vector<std::string_view> actuators_without_enable(const SubsystemDescriptor& subsystem);

/// A parameter, or a member, by ParameterId::wire().
[[nodiscard]] std::optional<ParameterRef> find_parameter(const SubsystemDescriptor& subsystem, std::uint32_t wire);

}  // namespace hirosco::descriptor

namespace hirosco {
template <>
struct EnumTexts<descriptor::State> {
  using enum descriptor::State;
  static constexpr auto table = enum_table<descriptor::State>({
      {Offline, "Offline"},
      {SoftwareInit, "SoftwareInit"},
      {HardwareInit, "HardwareInit"},
      {PreOperational, "PreOperational"},
      {SafeOperational, "SafeOperational"},
      {Operational, "Operational"},
      {ErrorOperational, "ErrorOperational"},
      {PostOperational, "PostOperational"},
      {HardwareDeinit, "HardwareDeinit"},
      {SoftwareDeinit, "SoftwareDeinit"},
  });
  static_assert(table.size() == 10);
};
template <>
struct EnumTexts<descriptor::Severity> {
  using enum descriptor::Severity;
  static constexpr auto table =
      enum_table<descriptor::Severity>({{Info, "info"}, {Low, "low"}, {Medium, "medium"}, {High, "high"}});
};
template <>
struct EnumTexts<descriptor::ByteOrder> {
  using enum descriptor::ByteOrder;
  static constexpr auto table = enum_table<descriptor::ByteOrder>({{Little, "little"}, {Big, "big"}});
};
template <>
struct EnumTexts<descriptor::MissingPolicy> {
  using enum descriptor::MissingPolicy;
  static constexpr auto table = enum_table<descriptor::MissingPolicy>({{Inhibit, "inhibit"}, {Hold, "hold"}});
};
template <>
struct EnumTexts<descriptor::SelfTest> {
  using enum descriptor::SelfTest;
  static constexpr auto table = enum_table<descriptor::SelfTest>({{Optional, "optional"}, {Required, "required"}});
};
template <>
struct EnumTexts<descriptor::StopKind> {
  using enum descriptor::StopKind;
  static constexpr auto table =
      enum_table<descriptor::StopKind>({{Drop, "drop"}, {Controlled, "controlled"}, {Hold, "hold"}});
};
}  // namespace hirosco
