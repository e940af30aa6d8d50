// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/parameter/write_queue.hpp"
#include "hirosco/pus/packet/packet_counters.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st03_housekeeping/configured_housekeeping.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st130_descriptor/descriptor_service.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/cycle/cycle.hpp"
#include "hirosco/subsystem/cycle/reconfiguration.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/subsystem/service_loop/backlog.hpp"
#include "hirosco/subsystem/service_loop/failure.hpp"
#include "hirosco/subsystem/service_loop/foreign_parameters.hpp"
#include "hirosco/subsystem/service_loop/own_loop.hpp"
#include "hirosco/subsystem/service_loop/requester.hpp"
#include "hirosco/subsystem/service_loop/self_tests.hpp"
#include "hirosco/subsystem/service_loop/st128_link_service.hpp"
#include "hirosco/subsystem/service_loop/subscriber.hpp"

/// The active part of the component framework (paper 4.1 and 4.2): standard behaviour of every subsystem around one
/// author's class. Two steps, driven from outside: service_step() and, while cycle_demand() asks for it, cycle_step().
namespace hirosco {

/// Everything a subsystem needs from outside (architecture, rule 3).
struct Platform {
  const Clock& clock;
  MemoryProvider& memory;
  FlowFactory& flows;
  bool realtime{true};               ///< SCHED_FIFO is granted; false: the reduced limits hold (decision 21)
  /// A cycle that asks for it may spin until it is due (docs/adr/0104): it has real-time rights, and whoever is no cycle another processor.
  bool precise{false};
  /// Whoever drives the service loop steps it when the cycle has something to report (has_reports()), so that it need not look every
  /// millisecond while a cycle runs (adr 0071).
  bool wakes{false};
  /// Explains to a developer why something was refused (standard error, a test's list). Service loop only.
  std::function<void(std::string_view)> explain{};
  LinkMechanisms links{standard_link_mechanisms()};
  /// What the process has taken, empty when nobody can tell; asked ten times in a second. Service loop only.
  std::function<std::optional<ProcessUsage>()> usage{};
  /// Reads another text of its descriptor, with what its mission changes applied (docs/adr/0095). Service loop only; null: it keeps
  /// the one that it began with.
  std::function<descriptor::Reading<descriptor::SubsystemDescriptor>(std::string_view text)> read_again{};
};

/// The descriptor in force, as housekeeping.
struct DescriptorInForce {
  std::uint32_t hash{};  ///< CRC-32 of its text
  std::uint16_t changes{};  ///< taken since the process started
};

/// What an author did not do as the descriptor says, in words.
struct Mistake {
  std::string text;
  std::optional<descriptor::Location> at{};  ///< of a setting that nobody reads (E0405): in the descriptor
  friend bool operator==(const Mistake& a, const Mistake& b) { return a.text == b.text && a.at == b.at; }
};

class GenericSubsystem final : private pus::TelemetrySink,
                               private pus::FunctionExecutor,
                               private pus::ParameterAccess,
                               private LinkServiceOwner,
                               private pus::SelfTest,
                               private pus::DescriptorOwner,
                               private pus::ServiceHome {
 public:
  /// `vital` and `permit` are the mapped pages, at least as large as VitalPage and PermitPage and initialised.
  GenericSubsystem(Subsystem& author, descriptor::SubsystemDescriptor descriptor, const Platform& platform,
                   Channel& channel, VitalPage& vital, const PermitPage& permit);
  ~GenericSubsystem() override;

  /// One step of the service loop; returns when the next is due at the latest.  Realtime: allocates. Thread: service.
  TimePoint service_step(TimePoint now);

  /// False while what the supervisor sends has to wait for the supervisor to take what was said: its channel is not to wake
  /// the service loop for being readable, only for being writable.  Thread: service.
  [[nodiscard]] bool reads() const noexcept { return backlog_.answers_have_room(); }
  /// What the author's work in the service loop waits for.  Thread: service.
  [[nodiscard]] ServiceWake service_wake() const { return author_.service_wake(); }
  /// The cycle, or a loop of services of its own, has reported what the service loop has not taken yet.
  /// Realtime: wait-free. Thread: any.
  [[nodiscard]] bool has_reports() const noexcept;

  /// Loops of services of its own (adr 0096), from 0 on; each is stepped by a thread of its own, from now to the end.
  [[nodiscard]] std::size_t own_loops() const noexcept { return loops_.size(); }
  [[nodiscard]] const descriptor::ServiceLoop& own_loop(std::size_t loop) const noexcept {
    return loops_[loop]->declared();
  }
  /// One step that was due at `planned`; returns when the next is due.  Realtime: allocates. Thread: that loop's.
  TimePoint own_loop_step(std::size_t loop, TimePoint planned) { return loops_[loop]->step(planned); }

  /// What the cycle thread is to do.
  struct Demand {
    bool wanted{false};
    Duration period{};
    int priority{0};
    std::uint32_t generation{0};  ///< rises with every new configuration
    /// Of the newest order to rest: goes back with cycle_parked(), also when the cycle was wanted and called off again
    /// before its thread could see it.
    std::uint32_t ticket{0};
  };
  [[nodiscard]] Demand cycle_demand() const noexcept;
  /// One cycle; call only while cycle_demand().wanted.  Realtime: bounded, no allocation. Thread: cycle.
  /// `spun_from`: of the thread, its processor time when it began to spin until this cycle; empty: it has not.
  TimePoint cycle_step(TimePoint planned, std::optional<Duration> spun_from = {}) noexcept {
    return cycle_.step(planned, spun_from);
  }
  /// What may start the next one before it is due.  Realtime: wait-free. Thread: cycle.
  [[nodiscard]] CycleWait cycle_wait() const noexcept { return cycle_.wait(); }
  /// The cycle thread has seen that no cycle is wanted and rests.  Thread: cycle.
  void cycle_parked(std::uint32_t ticket) noexcept {
    // Told by who rests, not by who ordered it: one that spins after the order is watched until it is ended. Once for a
    // ticket: with that the next configuration may have begun.
    if (parked_ticket_.load(std::memory_order_relaxed) == ticket) return;
    vital_.cycling.store(0, std::memory_order_release);
    parked_ticket_.store(ticket, std::memory_order_release);
  }

  /// Offline again after the supervisor went away or said so: the process may end.
  [[nodiscard]] bool finished() const noexcept { return finished_; }
  [[nodiscard]] State state() const noexcept override { return state_; }
  [[nodiscard]] const descriptor::SubsystemDescriptor& descriptor() const noexcept override { return descriptor_; }

  // --- for Subsystem ----------------------------------------------------------------------------------------------
  void publish(std::string_view name, ParameterCell& parameter);
  void require_link(std::string_view set, LinkInputPort& port);
  void lend_link(std::string_view set, LoanOutputPort& port);
  void use_device(std::string_view name, DevicePortBase& port, std::span<const std::string_view> settings);
  void provide(CustomService& service);
  void use_event(EventPort& event);
  void use_request(const RequestPort& request, RequestHandler handler, Duration patience);
  Result<std::uint32_t> send_request(const RequestPort& asked, pus::GivenValues values);
  void use_subscription(SubscriptionPort& heard);
  Result<> set_subscription(SubscriptionPort& heard, bool wanted) { return subscriber_.set(heard, wanted); }
  /// An event with its auxiliary data, from the service loop in any state: before Software-Init it is not bound yet.
  void raise_named(std::string_view event, Octets auxiliary);
  /// For one that announces its events by name: each that it declares counts as used.
  void uses_all_events() noexcept { uses_all_events_ = true; }
  void bind_function(std::string_view name, BoundHandler handler);
  [[nodiscard]] CycleLoop& cycle() noexcept { return cycle_; }
  [[nodiscard]] PoolResource& resources() noexcept { return resources_.pools(); }
  [[nodiscard]] ResourceMeter& meter() noexcept { return resources_; }

  /// All that Software-Init finds, tried in Offline before any flight. Nothing is kept of it.
  [[nodiscard]] std::vector<Mistake> try_introduction();
  /// For a subsystem that checks requests of others (the supervisor): reports stamped with this APID.
  [[nodiscard]] pus::Verification& verification() noexcept override { return verification_; }
  [[nodiscard]] pus::TelemetrySink& telemetry() noexcept override { return *this; }
  Result<> submit_ground_telecommand(std::uint16_t client, Octets packet, std::uint32_t known_stop);
  [[nodiscard]] std::uint32_t newest_stop() const noexcept {
    return permit_->newest_stop.load(std::memory_order_acquire);
  }
  void raise_in_service(std::uint16_t event, std::span<const double> arguments);
  /// An event of the descriptor by its name; nothing when it declares none.
  void announce(std::string_view event_name, std::initializer_list<double> arguments = {});

 private:
  // TelemetrySink
  void report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets source_data) override;
  // FunctionExecutor
  std::expected<void, pus::FailureNotice> submit(const pus::FunctionCall& call, const pus::Request& request) override;
  // ParameterAccess
  std::expected<std::size_t, ErrorCode> read(std::uint32_t parameter, MutableOctets big_endian) override;
  std::size_t size_of(std::uint32_t parameter) override;
  std::expected<void, pus::FailureCode> check_write(std::uint32_t parameter, Octets value) override;
  std::expected<void, pus::FailureCode> submit_write(std::span<const pus::ParameterAccess::Write> writes,
                                                     const pus::Request& request) override;
  // LinkServiceOwner
  const descriptor::Requires* find_required(std::string_view set) override;
  const LinkOutputSlot* find_provided(std::string_view set) override;
  std::string refuse_link(pus::st128::Role role, std::string_view set, std::uint8_t link) override;
  Duration period() override;
  bool carries(LinkMethod method, LinkKind kind, bool wakes) override;
  Result<LinkRoute> attach(const pus::st128::AttachRequest& request, const MemoryHandle& memory) override;
  Result<LinkRoute> reach(const pus::st128::ReachRequest& request) override;
  bool detach(std::uint8_t link) override;

  // SelfTest
  std::expected<void, pus::FailureNotice> begin_self_test(const pus::Request& request) override;
  [[nodiscard]] pus::SelfTestRecord newest_self_test() const override {
    return self_tests_.record(cycle_.self_test_passed());
  }

  // DescriptorOwner
  std::optional<pus::FailureNotice> judge(std::size_t octets, const MemoryHandle& text) override;
  std::optional<pus::FailureNotice> take() override;

  // ServiceHome
  [[nodiscard]] pus::SelfTest& self_test() noexcept override { return *this; }
  [[nodiscard]] pus::FailureNotice refusal(pus::FailureCode code, const Error& why) const override {
    return notice_of(static_cast<std::uint16_t>(code), {why.code, why.text, why.value});
  }

  [[nodiscard]] std::optional<pus::FailureNotice> against(const descriptor::SubsystemDescriptor& fresh);
  [[nodiscard]] std::optional<pus::FailureNotice> left_outside(const descriptor::SubsystemDescriptor& fresh);
  void tell_descriptor();
  void receive_messages();
  void dispatch(const Message& message);
  Result<> store(const ParameterCell& parameter, Octets big_endian) override;
  Result<> raise(std::string_view event, Octets auxiliary) override;

  [[nodiscard]] std::vector<std::unique_ptr<OwnLoop>> make_loops();
  /// Where the service of this type is at home: in one of the loops, or here.
  [[nodiscard]] pus::ServiceHome& home_of(std::uint8_t type) noexcept;
  [[nodiscard]] OwnLoop* loop_of(std::uint8_t type) noexcept;
  /// What the services in loops of their own have said.
  void take_loop_reports();
  /// False while one of them stands still within a step: then the supervisor's guard sees the service loop stand still.
  [[nodiscard]] bool loops_move(TimePoint now);
  void take_permit_page(const MemoryHandle& memory);
  void confirm_permit_page();
  void take_cycle_reports();
  void take_cycle_report(const CycleReport& report, Octets payload);
  void watch_supervisor(TimePoint now);

  std::expected<void, pus::FailureNotice> command_state(State target, const pus::Request& request);
  std::expected<void, pus::FailureNotice> command_configuration(std::uint8_t id, const pus::Request& request);
  std::expected<void, pus::FailureNotice> command_bumpless(const descriptor::Configuration& wanted,
                                                           const pus::Request& request);
  /// How the cycle has taken it.
  void reconfigured(std::uint8_t id, const std::optional<Failure>& why);
  void give_up_reconfiguration(pus::FailureCode code);
  void advance(TimePoint now);
  void go(State target, std::optional<pus::Request> request);
  bool run_phase(State next, TimePoint now);
  void arrive(State state);
  void be_in(State state);
  void arrive_transient(State state);
  void go_down_from(State failed);
  void fail_transition(State state, const Failure& why);
  void look_for_first_answer();
  [[nodiscard]] Failure never_answered_failure(const CycleLoop::NeverAnswered& device) const;
  Result<Step> enter_transient(State state);
  Result<Step> initialise_software();
  void remember_persistent();
  Result<Step> leave_cycle();
  [[nodiscard]] Result<std::vector<DeviceSlot::Way>> open_ways(const descriptor::DeviceUse& use,
                                                               const DevicePortBase& port);
  /// Whether the switches of its devices say so; for who has none: always.
  [[nodiscard]] bool powered(Power wanted) const noexcept;
  [[nodiscard]] bool power_takes_too_long() const noexcept;
  [[nodiscard]] std::optional<Failure> apply_configuration(const descriptor::Configuration& configuration);
  void end_configuration();
  void release_configuration();
  void release_late();
  [[nodiscard]] bool cycle_rests() const noexcept;
  bool push(const CycleCommand& command);
  bool close_call(const pus::Request& request);
  [[nodiscard]] std::shared_ptr<LoanWriter> lender_of(std::uint16_t slot, const LinkLayout& layout);
  bool withdraw(std::uint8_t link);
  [[nodiscard]] bool required_links_attached() const noexcept;
  /// The refusal of what the present state does not permit.
  [[nodiscard]] pus::FailureNotice wrong_state() const;
  [[nodiscard]] pus::FailureNotice notice_of(std::uint16_t code, const Failure& why) const;
  void mistake(std::string problem, std::optional<descriptor::Location> at = {});
  void check_introduction();
  void check_settings();
  [[nodiscard]] std::string words_of(const Mistake& mistake) const;
  [[nodiscard]] std::string short_words_of(const Mistake& mistake) const;
  void forget_introduction();
  void raise_event(std::uint16_t event, Octets auxiliary);
  /// STATE_FAILED and CONFIGURATION_FAILED of `what`.
  void raise_failure(std::uint16_t event, std::uint8_t what, const Failure& why);
  void tell_losses(TimePoint now);
  void look_at_resources(TimePoint now);
  [[nodiscard]] bool commissioned() const noexcept;
  TimePoint step_services(TimePoint now);
  [[nodiscard]] ForeignParameters::Home foreign_home();

  Subsystem& author_;
  descriptor::SubsystemDescriptor descriptor_;
  Platform platform_;
  Channel& channel_;
  VitalPage& vital_;
  const PermitPage* permit_;
  /// Of a permit page that came by the channel, and of the one before, at which the cycle or another loop may just look.
  Mapping permit_memory_, permit_before_;
  bool permit_owed_{false};  ///< the supervisor has not been told yet that it is in force

  /// Of the descriptor: no Software-Init succeeds. Before the dictionary, whose making may fill it.
  std::string dictionary_problem_;
  Dictionary dictionary_;
  bool initialised_{false};  ///< the dictionary holds values, not only places for them
  WriteQueue writes_;
  LoopRings rings_;
  ResourceMeter resources_;
  TimePoint look_at_resources_at_{};
  LoopMeter loop_meter_;
  std::vector<std::unique_ptr<OwnLoop>> loops_;
  TimePoint loops_looked_at_{};
  CycleLoop cycle_;
  pus::PacketCounters counters_;
  pus::Verification verification_;
  pus::EventService event_service_;
  pus::FunctionService function_service_;
  pus::ParameterService parameter_service_;
  pus::ConfiguredHousekeeping housekeeping_service_;
  LinkService link_service_;
  pus::DescriptorService descriptor_service_;
  std::optional<descriptor::SubsystemDescriptor> coming_;  ///< judged, and not taken yet
  Parameter<DescriptorInForce> descriptor_in_force_;
  std::uint16_t descriptor_changes_{0};
  SelfTests self_tests_;
  std::vector<std::unique_ptr<pus::Service>> made_services_;  ///< by their kinds
  std::vector<pus::Service*> services_;  ///< the framework's, then the author's
  std::vector<CustomService*> own_services_;

  std::map<std::string, LinkInputPort*, std::less<>> link_ports_;
  std::map<std::string, LoanOutputPort*, std::less<>> lent_ports_;
  std::map<std::string, DevicePortBase*, std::less<>> device_ports_;
  struct LinkEnd {
    std::unique_ptr<AttachedLink> link;
    pus::st128::Role role{};
    std::uint32_t epoch{0};
    std::uint16_t slot{0};
  };
  std::map<std::uint8_t, LinkEnd> link_ends_;
  std::vector<std::unique_ptr<AttachedLink>> leaving_links_;
  std::string refusal_;  ///< of an error, which does not own its words
  std::vector<pus::Request> open_calls_;  ///< functions that run: each gets exactly one final report

  std::vector<std::uint16_t> used_events_;
  bool uses_all_events_{false};
  std::vector<Mistake> problems_;  ///< of publish() and its kin: all of them fail the same Software-Init
  std::string problems_text_;  ///< of an error, which does not own its words

  State state_{State::Offline};
  const descriptor::Configuration* configuration_{nullptr};
  /// On its way to the cycle, or taken by one that has not said so; nobody waits for it any more without a request.
  std::unique_ptr<Reconfiguration> reconfiguration_;
  std::optional<pus::Request> reconfiguration_request_;
  TimePoint reconfiguration_deadline_{};
  std::optional<Route> way_;
  std::uint8_t way_at_{0};
  std::optional<pus::Request> way_request_;
  bool phase_entered_{false};
  bool awaiting_cycle_{false};
  bool answer_owed_{false};  ///< the cycle is where it was sent, and waits for the first answer of a device
  bool release_owed_{false};  ///< the cycle still holds the configuration that Post-Operational was to give back
  TimePoint phase_deadline_{};

  std::atomic<bool> wanted_{false};
  // A late answer to an earlier order must not pass for one to the newest: orders to rest are numbered.
  std::atomic<std::uint32_t> rest_ticket_{0};
  std::atomic<std::uint32_t> parked_ticket_{0};
  std::uint32_t generation_{0};
  Backlog backlog_;
  Requester requester_;
  Subscriber subscriber_;
  HeapWatch heap_watch_;
  ForeignParameters foreign_;
  std::array<std::uint64_t, 6> told_losses_{};
  TimePoint losses_told_at_{};
  std::uint64_t last_heartbeat_{0};
  std::uint32_t known_stop_{0};  ///< before this step of the service loop
  TimePoint watched_supervisor_at_{};
  Duration supervisor_silent_for_{};  ///< since its heartbeat moved last, in watched time
  bool supervisor_lost_{false};
  bool finished_{false};
};

}  // namespace hirosco
