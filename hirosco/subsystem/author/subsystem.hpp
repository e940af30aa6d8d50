// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/resource/quota.hpp"
#include "hirosco/subsystem/author/event_port.hpp"
#include "hirosco/subsystem/author/handler.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/author/request_port.hpp"
#include "hirosco/subsystem/author/service_wake.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/subsystem/author/subscription_port.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// What a subsystem's author inherits and fills in (paper 4.2): one method per node of figure 4.
namespace hirosco {

class CustomService;
class GenericSubsystem;
class PoolResource;

/// Outcome of one phase of a transient state.
enum class Step : std::uint8_t { Again, Done };
inline constexpr Step again = Step::Again;
inline constexpr Step done = Step::Done;

/// The cycle that a steady state's node is called in.
struct Cycle {
  TimePoint planned{};               ///< when it was due
  Duration period{};
  std::uint64_t count{0};            ///< since the configuration was applied
  State state{State::PreOperational};
  bool first{false};                 ///< first cycle in this state
  bool active{false};                ///< Operational and not inhibited: what is put out reaches the actuators
};

/// Base of every subsystem. Steady nodes run in the cycle: noexcept, no allocation, no lock, no I/O. Everything else
/// runs in the service loop.
class Subsystem {
 public:
  Subsystem() = default;
  Subsystem(const Subsystem&) = delete;
  Subsystem& operator=(const Subsystem&) = delete;
  virtual ~Subsystem() = default;

 protected:
  // --- the nodes of figure 4 ------------------------------------------------------------------------------------
  /// Called once, when the subsystem has been made and nothing else of it was called: custom services are provided here. Not again where it comes
  /// back to Offline. An error fails its first Software-Init.
  virtual Result<> offline() { return ok(); }
  /// Publishes parameters, functions, links and devices: those of all configurations. Called again while it returns `again`, within 10 s.
  virtual Result<Step> software_init() { return done; }
  /// Powers and tests hardware.
  virtual Result<Step> hardware_init() { return done; }
  /// Pre-Operational, once per CONFIGURE: parameters, links and devices of the configuration are already in place.
  virtual Result<> configure(const descriptor::Configuration&) { return ok(); }
  /// Another configuration follows the one in force while the subsystem is in Safe-Operational or Operational (<Bumpless> of the
  /// descriptor, adr 0096). Called in the cycle, once, before the node that works by `to` for the first time: parameters have the
  /// values of `to`, devices and links stay as they are, configure() is not called. Takes over what the law remembers, so
  /// that no output jumps further than its <Step>: one that does inhibits the actuators. An error leaves `from` in force, with its values.
  /// As the nodes: no allocation, no lock, no I/O.
  virtual Result<> bumpless(const descriptor::Configuration& from, const descriptor::Configuration& to,
                            const Cycle&) noexcept {
    static_cast<void>(from), static_cast<void>(to);
    return fail(ErrorCode::NotPermitted, "it has no bumpless()");
  }
  virtual Result<> pre_operational(const Cycle&) noexcept { return ok(); }
  virtual Result<> safe_operational(const Cycle&) noexcept { return ok(); }
  virtual Result<> operational(const Cycle&) noexcept { return ok(); }
  virtual Result<> error_operational(const Cycle&) noexcept { return ok(); }
  /// The author's self test, which ST[17] asks for: called in Safe-Operational behind its node, each cycle until it is done or
  /// fails, within the time of <TestService self_test_within_ms>. `cycle.first`: of this run. What the node has put out stands
  /// in the ports and reaches no actuator. As the nodes: no allocation, no lock, no I/O.
  virtual Result<Step> self_test(const Cycle&) noexcept { return fail(ErrorCode::NotFound, "it has no self test"); }
  virtual Result<Step> post_operational() { return done; }
  virtual Result<Step> hardware_deinit() { return done; }
  virtual Result<Step> software_deinit() { return done; }
  /// Every step of the service loop, in all states: work that is not real-time.
  virtual void service(TimePoint) {}
  /// When `service` is called besides; asked for after each call. Not overridden: every 10 ms at least, and after each message
  /// and report.
  [[nodiscard]] virtual ServiceWake service_wake() const { return {}; }
  /// Telemetry that the supervisor routes to this subsystem (that of the mission's ground link).
  virtual void telemetry(Octets) {}

  // --- in offline() ----------------------------------------------------------------------------------------------------
  /// A service of its own, which its descriptor declares; `service` lives as long as this subsystem.
  void provide(CustomService& service);

  // --- in software_init() -----------------------------------------------------------------------------------------
  /// Makes a parameter known under its descriptor name. A layout that differs from the descriptor's fails Software-Init.
  void publish(std::string_view name, ParameterCell& parameter);
  /// Names the author's view of a required set of real-time data: a LinkInput, a QueueInput where every sample is wanted, or a
  /// LoanInput where samples are lent. A set that some configuration requires and that has none, or one of other fields or of another
  /// kind, fails Software-Init.
  void require_link(std::string_view set, LinkInputPort& port);
  /// Names the place where the samples of a provided set that is lent are made (LoanOutput). Fields that differ from the
  /// descriptor's fail Software-Init.
  void lend_link(std::string_view set, LoanOutputPort& port);
  /// Names the author's view of a device, and which of its settings the author reads: another that a configuration gives
  /// fails Software-Init (E0405), and so does a device that some configuration uses and that has no port, or one of other
  /// fields (E0406). All are string literals.
  void use_device(std::string_view name, DevicePortBase& port, std::initializer_list<std::string_view> settings = {});
  /// Names an event that the author raises. Arguments that differ from the descriptor's fail Software-Init.
  void use_event(EventPort& event);
  static constexpr Duration request_patience = hirosco::request_patience;
  /// Names what is asked of another subsystem. What <Commands> of the descriptor does not say, and arguments that differ
  /// from the other's descriptor, fail Software-Init. The handler hears each stage of each such request, in the service
  /// loop, and one end: completed, refused or failed with the reason, or not in `patience`.
  void use_request(RequestPort& request, RequestHandler handler, Duration patience = request_patience);
  /// Names what is heard of another subsystem: a Subscription of a housekeeping structure, or an EventSubscription. What <Subscribes>
  /// of the descriptor does not say, and values that differ from the other's descriptor, fail Software-Init. From then on to
  /// Software-Deinit the handler is called in the service loop with each report that the supervisor passes on, through deaths and
  /// restarts of the other: periodic housekeeping while it is switched on there, every event.
  template <class Port>
  void use_subscription(Port& heard, typename Port::Handler handler) {
    heard.handle(std::move(handler));
    bind_subscription(heard);
  }
  /// Gives a function of the descriptor its handler: a callable that takes its arguments in order (numbers, enumerations,
  /// bool, std::array or Sized of those, std::string_view for text, which lasts until the handler returns) and, last, a
  /// Call if it wants to report later. Returns Result<> or Outcome. Runs at a cycle boundary; must not throw. Each C++ type
  /// holds every value that the descriptor permits, or Software-Init fails. A handler that takes FunctionValues instead
  /// gets all numbers, as many as the descriptor declares.
  template <class Handler>
  void on_function(std::string_view name, Handler handler) {
    bind_function(name, detail::bound(std::move(handler)));
  }

  // --- in the cycle and in function handlers ----------------------------------------------------------------------
  /// Reports an event; arguments in the unit of the descriptor.  Realtime: wait-free.
  template <class... Arguments>
  void raise(const Event<Arguments...>& event, const std::type_identity_t<Arguments>&... arguments) noexcept {
    raise_encoded(event.id(), event.encode(arguments...));
  }
  /// Latches "actuators inhibited" in this cycle; released by the next entry into Operational.  Realtime: wait-free.
  void inhibit_actuators() noexcept;
  /// Later reports of a running function.  Realtime: wait-free.
  void progress(const Call& call, std::uint16_t step) noexcept;
  /// One of its steps has failed, TM[1,6], and it goes on: its end is told by finish() or abort() all the same. Words as of abort().
  template <FailureEnumeration E>
  void progress_failed(const Call& call, std::uint16_t step, E code, const char* text = "",
                       std::int64_t number = 0) noexcept {
    fail_step(call, step, static_cast<pus::FailureCode>(code), {ErrorCode::Internal, text, number});
  }
  void progress_failed(const Call& call, std::uint16_t step, const Error& why) noexcept;
  void finish(const Call& call) noexcept;
  /// `text` is a string literal; it reaches ground with `number`.
  template <FailureEnumeration E>
  void abort(const Call& call, E code, const char* text = "", std::int64_t number = 0) noexcept {
    abort_call(call, static_cast<pus::FailureCode>(code), {ErrorCode::Internal, text, number});
  }
  void abort(const Call& call, const Error& why) noexcept;

  // --- in the service loop ----------------------------------------------------------------------------------------
  /// Asks another subsystem, through permission, log and route; what comes of it is heard by the handler under the number
  /// that is returned. NotPermitted: it is not bound; ResourceExhausted: 16 are under way, 100 went in this second, or the
  /// supervisor is behind: ask again later; InvalidArgument, OutOfRange: of the arguments.
  template <class... Arguments>
  Result<std::uint32_t> request(const Request<Arguments...>& asked,
                                const std::type_identity_t<Arguments>&... arguments) {
    return send_request(asked, detail::views_of<Arguments...>(arguments...));
  }
  /// The same of one whose form is the other's descriptor's alone.
  Result<std::uint32_t> request(const OpenRequest& asked, pus::GivenValues values) {
    return send_request(asked, values);
  }
  /// What was named by use_subscription() is heard, or not, from now on. NotPermitted: it was not named.
  Result<> subscribe(SubscriptionPort& heard) { return set_subscription(heard, true); }
  Result<> unsubscribe(SubscriptionPort& heard) { return set_subscription(heard, false); }
  /// Reports an event from the service loop, in any state.
  template <class... Arguments>
  void raise_in_service(const Event<Arguments...>& event, const std::type_identity_t<Arguments>&... arguments) {
    raise_encoded_in_service(event, event.encode(arguments...));
  }
  /// The pools of its descriptor's <Resources> (hirosco/resource/pool_resource.hpp): for the containers of std::pmr, by try_allocate() and
  /// make_counted<T>(resources(), ...). There from the first call of software_init() to the last of software_deinit(), which gives back all that
  /// was taken: blocks that are held then fail Software-Deinit, with how many. What they refuse is never taken from elsewhere; Offline has
  /// none, and without pools everything is refused.  Realtime: lock-free, but a refusal to a container throws. Thread: any.
  [[nodiscard]] PoolResource& resources() noexcept;
  /// One port or file of those that its descriptor's <Resources> permits (`ports`, `files`; all, where it does not say): taken before
  /// the socket or file is opened, held as long as that. ResourceExhausted: all are held, with their number.
  /// Realtime: lock-free. Thread: any.
  [[nodiscard]] Result<Quota::Held> acquire_port() noexcept;
  [[nodiscard]] Result<Quota::Held> acquire_file() noexcept;
  [[nodiscard]] State state() const noexcept;
  [[nodiscard]] const descriptor::SubsystemDescriptor& own_descriptor() const noexcept;

 private:
  // Who calls what an author overrides, from the service loop and from the cycle.
  friend class GenericSubsystem;
  friend class Incoming;
  friend class Introduction;
  friend class Configurations;
  friend class StateMachine;
  friend class CycleLoop;
  friend class BumplessChange;
  friend class GroundLink;  // and nobody else: who holds a ground link cannot forget what it has to say of a stop
  void bind_function(std::string_view name, BoundHandler handler);
  void raise_encoded(std::uint16_t event, Octets auxiliary) noexcept;
  void raise_encoded_in_service(const EventPort& event, Octets auxiliary);
  Result<std::uint32_t> send_request(const RequestPort& asked, pus::GivenValues values);
  void bind_subscription(SubscriptionPort& heard);
  Result<> set_subscription(SubscriptionPort& heard, bool wanted);
  void abort_call(const Call& call, pus::FailureCode code, const Error& why) noexcept;
  void fail_step(const Call& call, std::uint16_t step, pus::FailureCode code, const Error& why) noexcept;
  /// The number of the newest stop of everything that is known here, never 0 in a flight (PermitPage::newest_stop).
  [[nodiscard]] std::uint32_t newest_stop() const noexcept;
  /// Sends a telecommand that came from the ground link client `client` to the supervisor. `known_stop`: newest_stop() as it was before the
  /// packet came, 0 = nobody knows; behind a later stop it lets nobody move (docs/adr/0156). ResourceExhausted: the supervisor is behind;
  /// offer it again.
  Result<> submit_ground_telecommand(std::uint16_t client, Octets packet, std::uint32_t known_stop);
  GenericSubsystem* framework_{nullptr};
  std::shared_ptr<const void> pools_left_;  ///< of frameworks that have ended while this still held blocks of them
};

}  // namespace hirosco
