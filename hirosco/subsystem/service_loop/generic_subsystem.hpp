// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/pus/service/service_table.hpp"
#include "hirosco/pus/st03_housekeeping/configured_housekeeping.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st130_descriptor/descriptor_service.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "hirosco/subsystem/service_loop/cycle_reports.hpp"
#include "hirosco/subsystem/service_loop/descriptor_changes.hpp"
#include "hirosco/subsystem/service_loop/incoming.hpp"
#include "hirosco/subsystem/service_loop/loop_parameters.hpp"
#include "hirosco/subsystem/service_loop/state_machine.hpp"

namespace hirosco {

/// The active part of the component framework (paper 4.1 and 4.2): standard behaviour of every subsystem around one
/// author's class. Driven from outside: by service_step(), while cycle_demand() asks for it by cycle_step(), and by own_loop_step()
/// where its descriptor has loops of services of their own.
class GenericSubsystem final : private pus::FunctionExecutor, private pus::SelfTest, private pus::ServiceHome {
 public:
  /// `vital` and `permit` are the mapped pages, at least as large as VitalPage and PermitPage and initialised.
  GenericSubsystem(Subsystem& author, descriptor::SubsystemDescriptor descriptor, const Platform& platform,
                   Channel& channel, VitalPage& vital, const PermitPage& permit);
  ~GenericSubsystem() override;

  /// One step of the service loop; returns when the next is due at the latest.  Realtime: allocates before it is commissioned. Thread: service.
  TimePoint service_step(TimePoint now);

  /// False while what the supervisor sends has to wait for the supervisor to take what was said: its channel is not to wake
  /// the service loop for being readable, only for being writable.  Thread: service.
  [[nodiscard]] bool reads() const noexcept { return reports_.answers_have_room(); }
  /// What the author's work in the service loop waits for.  Thread: service.
  [[nodiscard]] ServiceWake service_wake() const { return author_.service_wake(); }
  /// The cycle, or a loop of services of its own, has reported what the service loop has not taken yet.
  /// Realtime: wait-free. Thread: any.
  [[nodiscard]] bool has_reports() const noexcept { return rings_.reports_wait() || loops_.has_reports(); }

  /// Loops of services of its own (adr 0096), from 0 on; each is stepped by a thread of its own, from now to the end.
  [[nodiscard]] std::size_t own_loops() const noexcept { return loops_.all().size(); }
  [[nodiscard]] OwnLoop& own_loop(std::size_t loop) const noexcept { return *loops_.all()[loop]; }
  /// One step that was due at `planned`, or is sooner by now; returns when the next is due.  Realtime: allocates. Thread: that loop's.
  TimePoint own_loop_step(std::size_t loop, TimePoint planned) { return loops_.all()[loop]->step(planned); }

  /// What the cycle thread is to do.  Realtime: wait-free. Thread: the cycle's, or the service loop's.
  struct Demand : CycleOrders::Order {
    Duration period{};
    int priority{0};
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
  void cycle_parked(std::uint32_t ticket) noexcept { orders_.parked(ticket); }

  /// Offline again after the supervisor went away or said so: the process may end.
  [[nodiscard]] bool finished() const noexcept { return states_.finished(); }
  [[nodiscard]] State state() const noexcept override { return at_.state; }
  [[nodiscard]] const descriptor::SubsystemDescriptor& descriptor() const noexcept override { return descriptor_; }
  /// All that Software-Init finds, tried in Offline before any flight. Nothing is kept of it.
  [[nodiscard]] std::vector<Mistake> try_introduction() { return introduction_.try_all(); }

  // --- for Subsystem, and for one that checks requests of others (the supervisor) ---------------------------------------
  [[nodiscard]] Introduction& introduction() noexcept { return introduction_; }
  [[nodiscard]] Reports& reports() noexcept { return reports_; }
  [[nodiscard]] CycleLoop& cycle() noexcept { return cycle_; }
  [[nodiscard]] Subscriber& subscriber() noexcept { return subscriber_; }
  [[nodiscard]] ResourceMeter& meter() noexcept { return resources_; }
  /// Reports stamped with this APID.
  [[nodiscard]] pus::Verification& verification() noexcept override { return reports_.verification(); }
  [[nodiscard]] pus::TelemetrySink& telemetry() noexcept override { return reports_; }
  Result<std::uint32_t> send_request(const RequestPort& asked, pus::GivenValues values);
  Result<> submit_ground_telecommand(std::uint16_t client, Octets packet, std::uint32_t known_stop);
  [[nodiscard]] std::uint32_t newest_stop() const noexcept {
    return permit_.page().newest_stop.load(std::memory_order_acquire);
  }

 private:
  // FunctionExecutor
  std::expected<void, pus::FailureNotice> submit(const pus::FunctionCall& call, const pus::Request& request) override;
  // SelfTest
  std::expected<void, pus::FailureNotice> begin_self_test(const pus::Request& request) override;
  [[nodiscard]] pus::SelfTestRecord newest_self_test() const override {
    return self_tests_.record(cycle_.self_test_passed());
  }
  // ServiceHome
  [[nodiscard]] pus::SelfTest& self_test() noexcept override { return *this; }
  [[nodiscard]] pus::FailureNotice refusal(pus::FailureCode code, const Error& why) const override {
    return reports_.notice_of(static_cast<std::uint16_t>(code), {why.code, why.value, why.text});
  }
  Result<> store(const ParameterCell& parameter, Octets big_endian) override {
    return values_.store(parameter, big_endian);
  }
  Result<> raise(std::string_view event, Octets auxiliary) override;

  [[nodiscard]] bool commissioned() const noexcept;
  TimePoint step_services(TimePoint now);
  pus::ParameterAccess& parameters_for_its_loop() noexcept;
  void look_at_resources(TimePoint now);

  Subsystem& author_;
  descriptor::SubsystemDescriptor descriptor_;
  Platform platform_;
  Channel& channel_;
  VitalPage& vital_;
  Situation at_;
  LoopRings rings_;
  CycleOrders orders_;
  Reports reports_;
  ResourceMeter resources_;
  TimePoint look_at_resources_at_{};
  PermitPages permit_;  ///< before all that looks at a page
  ParameterValues values_;
  LoopMeter loop_meter_;
  OwnLoops loops_;
  LoopParameters loop_parameters_;  ///< where ST[20] is in one of them
  CycleLoop cycle_;
  LinkEnds links_;
  DescriptorChanges descriptor_changes_;
  SelfTests self_tests_;
  pus::FunctionService function_service_;
  pus::ParameterService parameter_service_;
  pus::ConfiguredHousekeeping housekeeping_service_;
  pus::DescriptorService descriptor_service_;
  std::vector<std::unique_ptr<pus::Service>> made_services_;  ///< by their kinds
  pus::ServiceTable services_;  ///< the framework's, then the author's
  Requester requester_;
  Subscriber subscriber_;
  ForeignParameters foreign_;
  IntroducedPorts ports_;
  Introduction introduction_;
  OpenCalls calls_;
  Bumpless bumpless_;
  Configurations configurations_;
  StateMachine states_;
  CycleReports cycle_reports_;
  Incoming incoming_;
  HeapWatch heap_watch_;
  std::uint32_t known_stop_{0};  ///< before this step of the service loop
};

}  // namespace hirosco
