// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/simulated/channel_pair.hpp"
#include "hirosco/descriptor/mission.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/pus/describe.hpp"
#include "hirosco/subsystem/generic_subsystem.hpp"
#include "hirosco/subsystem/subsystem.hpp"
#include "supervisor/guard/guard.hpp"
#include "supervisor/platform/launcher.hpp"
#include "supervisor/platform/packet_log.hpp"
#include "supervisor/supervision/data_handling/ground_route.hpp"
#include "supervisor/supervision/data_handling/outstanding.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/modes/sequence.hpp"
#include "supervisor/supervision/realtime_links/link_handling.hpp"
#include "supervisor/supervision/subsystem_handling/member.hpp"
#include "supervisor/supervision/subsystem_handling/restarts.hpp"

/// The superior subsystem (paper 4.3). Itself a subsystem with APID 1: its functions are telecommands like any other,
/// its telemetry takes the same way through permission, log and route.
namespace hirosco::supervisor {

/// Who wants to see what happens: a console, a test. Called in the supervisor's thread; must not block.
struct Observer {
  virtual ~Observer() = default;
  /// One line of the story, as the log has it too.
  virtual void told(OnboardTime when, std::string_view line) = 0;
  /// Every telemetry packet that is routed.
  virtual void routed(const pus::TelemetryView& packet) { static_cast<void>(packet); }
};

/// Opens another database for SET_DATABASE; null when it cannot.
using DatabaseOpener = std::function<std::unique_ptr<Database>(DatabaseStrategy)>;

class Supervisor final : private Subsystem, private LinkOperator, private CommandDesk {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    World world;
    ProcessLauncher& launcher;
    Guard& guard;                          ///< stepped by its own thread, or by who steps the supervisor
    PacketLog& log;
    DatabaseOpener open_database;
    Observer& observer;
    std::uint16_t first_sequence_count{0};  ///< of its own telecommands (decision 27)
  };
  explicit Supervisor(const Parts& parts);
  ~Supervisor() override;

  /// Starts the subsystems of the mission and begins commissioning.
  void start();
  /// One step; returns when the next is due at the latest. Messages should wake it earlier.
  TimePoint step(TimePoint now);
  /// Orderly shutdown: every subsystem back to Offline, then this one.
  void request_shutdown();
  /// Whoever started it is alive and does not move: nobody would end what is left after this one.
  void keeper_stands_still();
  [[nodiscard]] bool finished() const noexcept { return finished_; }
  /// False when commissioning failed or the shutdown was not orderly.
  [[nodiscard]] bool succeeded() const noexcept { return !failed_; }

  [[nodiscard]] const std::vector<Member>& members() const noexcept { return members_; }
  [[nodiscard]] const descriptor::Mode& mode() const noexcept { return *mode_; }
  [[nodiscard]] const LinkGraph& links() const noexcept { return links_.graph(); }
  /// What commissioning waits for; empty when nothing.
  [[nodiscard]] std::string waiting_for() const { return sequence_.waiting_for(); }
  [[nodiscard]] State own_state() const noexcept { return engine_.state(); }
  [[nodiscard]] bool commissioned() const noexcept { return commissioned_; }
  [[nodiscard]] const VitalPage& own_vital() const noexcept { return *own_vital_; }
  /// False while what a member sends has to wait: its channel is not to wake anybody.
  [[nodiscard]] bool reads(const Member& member) const {
    if (!is_ground_link(member)) return true;
    const bool addressees_behind =
        outstanding_.size() >= most_outstanding && now_ - outstanding_moved_ < outstanding_patience;
    return !addressees_behind && ground_route_.takes_telecommands(now_);
  }

 private:
  // Subsystem
  Result<Step> software_init() override;
  Result<> pre_operational(const Cycle& cycle) noexcept override { return show(cycle); }
  Result<> safe_operational(const Cycle& cycle) noexcept override { return show(cycle); }
  Result<> operational(const Cycle& cycle) noexcept override { return show(cycle); }
  Result<> error_operational(const Cycle& cycle) noexcept override { return show(cycle); }
  Result<> show(const Cycle& cycle) noexcept;
  void show_members() noexcept;
  void show_links() noexcept;
  [[nodiscard]] const IncomingLink* consumer_of(const descriptor::MissionLink& link) const noexcept;
  void watch_memory();
  // LinkOperator
  void send_link_command(std::uint16_t apid, std::uint8_t subtype, Octets data, const MemoryHandle& memory) override;
  void link_changed(const descriptor::MissionLink& link, bool up, const std::string& text) override;
  // CommandDesk
  void command(std::uint16_t apid, std::string_view function, std::optional<double> argument,
               CommandDone done) override;

  // data handling
  struct Incoming {
    Octets packet;
    Sender sender{Sender::Ground};
    std::uint16_t source{0};         ///< APID of the sender, 0 = ground
    MemoryHandle memory;
  };
  void handle_telecommand(const Incoming& incoming);
  [[nodiscard]] std::expected<Permitted, pus::FailureNotice> judge(const pus::TelecommandView& telecommand,
                                                                   Sender sender) const;
  void answer_query(const Incoming& incoming, const pus::TelecommandView& query);
  void reject(const Incoming& incoming, const pus::Request& request, const pus::FailureNotice& notice);
  /// A permitted telecommand on its way to the addressee.
  struct Outgoing {
    std::uint16_t apid{};
    Octets packet;
    MemoryHandle memory;
    pus::Request request;
    std::uint32_t mode_epoch{0};     ///< at permission; 0 = not bound to the mode
    bool essential{false};
    bool releases_stop{false};
    std::uint64_t fences{0};         ///< of the addressee at permission
  };
  void forward(const Outgoing& outgoing);
  /// Functions of the supervisor that are carried out where they are received, by no cycle and no queue.
  bool carry_out_at_once(const Incoming& incoming, const pus::Request& request, std::string_view function);
  void forward_durable();
  void watch_log(TimePoint now);
  void handle_telemetry(std::uint16_t from, Octets packet);
  void interpret(std::uint16_t from, const pus::TelemetryView& report);
  void count_failure(const pus::TelemetryView& report);
  void count_rejection(pus::FailureCode code);
  void handle_verification(const pus::TelemetryView& report);
  void handle_event(std::uint16_t from, Octets message);
  void receive_from(Member& member);
  void receive_from_self();
  [[nodiscard]] bool is_ground_link(const Member& member) const;
  void serve_ground_route();
  [[nodiscard]] Situation situation_of(std::uint16_t apid) const;
  [[nodiscard]] Channel* channel_of(std::uint16_t apid);
  [[nodiscard]] Member* member(std::uint16_t apid);
  [[nodiscard]] std::string name_of(std::uint16_t apid) const;

  // event handling
  void react(Member& origin, std::string_view event, descriptor::Severity severity);
  void react_to_own(std::string_view event, descriptor::Severity severity);
  bool cancel_commissioning(std::string_view why);
  void shut_down_network(Member& origin, std::string_view plan);
  void bring_down(Member& member);
  void recover_to(std::uint16_t apid, State state, CommandDone done);
  void recovered(std::uint16_t apid, descriptor::Severity severity);

  // subsystem handling
  void count_unreadable(std::uint16_t from);
  void tell_unreadable(Member& subject);
  void watch_ends(bool all);  ///< or only those whose channel is closed
  void take_guard_findings();
  void hear_of(Member& member, GuardFinding::Kind what);
  void launch(Member& member);
  void restart_due(TimePoint now);
  void watch_ground_link(TimePoint now);
  void restore_ground_link(Member& member);
  void member_died(Member& member, const ProcessEnd& end);

  // power
  void observe_power();
  void tell_shortage(std::uint16_t apid, const pus::FailureNotice& notice);
  void set_power_budget(double budget_w);
  void shed_load();

  // modes and life
  void begin_commissioning();
  void begin_shutdown();
  void set_mode(const descriptor::Mode& mode);
  /// After everything was stopped: nothing starts it again, and the states follow.
  void after_stop(std::string_view why);
  void follow_stops();
  void expire_requests(TimePoint now);
  void fail_requests_to(std::uint16_t apid, const std::string& why);
  void tell(std::string_view line, std::uint16_t subject = 0);
  void send_own(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data, const MemoryHandle& memory,
                CommandDone done);

  Parts parts_;
  descriptor::Mission mission_;
  std::vector<Member> members_;
  const descriptor::Mode* mode_;
  std::uint32_t mode_epoch_{1};

  ChannelPair own_channels_;
  std::unique_ptr<VitalPage> own_vital_;
  std::unique_ptr<PermitPage> own_permit_;
  GenericSubsystem engine_;
  TimePoint next_cycle_{};
  bool own_cycle_running_{false};
  LinkHandling links_;
  Sequence sequence_;
  static constexpr Duration ground_link_pause = std::chrono::seconds{1};
  Sequence ground_link_;  ///< brings a lost ground link back
  std::optional<TimePoint> ground_link_lost_at_;
  Duration ground_link_patience_{ground_link_pause};  ///< longer after each time that it did not come back
  PowerLedger power_;
  pus::PacketDescriber describer_;

  struct OwnRequest {
    CommandDone done;
    TimePoint deadline{};
    std::string what;
    std::uint16_t apid{};
  };
  std::map<std::uint32_t, OwnRequest> own_requests_;
  std::uint16_t next_sequence_count_;
  struct Waiting {
    std::uint64_t number{};
    std::uint16_t apid{};
    std::vector<std::byte> packet;
    MemoryHandle memory;
    pus::Request request;
    std::uint32_t mode_epoch{0};
    TimePoint since{};
    bool releases_stop{false};
    std::uint64_t fences{0};
  };
  std::deque<Waiting> waiting_;
  bool log_failing_{false};
  std::uint64_t told_troubles_{0};   ///< of the log's store
  TimePoint trouble_told_{};
  Outstanding outstanding_;
  /// With so many under way the ground's next ones wait for a report instead of finding a full channel; but hardly for
  /// addressees that stand still: SAFE_ALL may be behind them.
  static constexpr std::size_t most_outstanding = 128;
  static constexpr Duration outstanding_patience = 1ms;
  TimePoint outstanding_moved_{};
  Restarts restarts_;
  struct PendingStop {
    std::uint64_t stop{0};
    std::optional<pus::Request> request;  ///< empty: asked for by signal or local socket
  };
  std::vector<PendingStop> stops_;
  GroundRoute ground_route_;
  GroundRoute::Lost ground_lost_told_{};
  TimePoint next_loss_told_{};

  TimePoint now_{};
  TimePoint next_watch_{};
  TimePoint shutdown_deadline_{};
  TimePoint report_window_{};
  int reports_in_window_{0};
  bool started_{false};
  bool commissioned_{false};
  bool shutting_down_{false};
  bool finished_{false};
  bool failed_{false};

  static constexpr std::size_t rejection_reasons = 17;
  Parameter<std::uint8_t> mode_parameter_;
  struct LinkCounts {
    std::uint32_t up{0};
    std::uint32_t defined{0};
  };
  Parameter<LinkCounts> links_parameter_;
  Parameter<std::array<std::uint32_t, rejection_reasons>> rejections_parameter_;
  struct Counts {
    std::uint32_t telecommands{0};
    std::uint32_t telemetry{0};
    std::uint32_t misdirected{0};  ///< packets that claimed another sender's APID
    std::uint32_t housekeeping_lost{0};  ///< on the way to the ground link, as the next
    std::uint32_t reports_lost{0};
  };
  Parameter<Counts> counts_parameter_;
  std::array<std::uint32_t, rejection_reasons> rejections_{};
  Counts counts_{};
  struct Power {
    float budget_w{0};  ///< 0 = not limited
    float reserved_w{0};
  };
  Parameter<Power> power_parameter_;
  /// What ground is told of everybody (housekeeping 4702); where a mission has more, only the first.
  static constexpr std::size_t told_members = 16;
  struct SubsystemsStatus {
    std::array<std::uint16_t, told_members> apid{};
    std::array<std::uint8_t, told_members> state{};  ///< 255 = not running
    std::array<std::uint8_t, told_members> configuration{};
    std::array<std::uint8_t, told_members> inhibited{};  ///< bits of Inhibition
    std::array<std::uint32_t, told_members> cycles{};
    std::array<std::uint32_t, told_members> overruns{};
    std::array<std::uint32_t, told_members> missed{};
    std::array<std::uint32_t, told_members> latency_max_ns{};
    std::array<std::uint32_t, told_members> execution_mean_ns{};
    std::array<std::uint32_t, told_members> memory_kb{};
  };
  std::array<std::uint32_t, told_members> memory_kb_{};  ///< in the order of subsystems_parameter_
  std::size_t memory_turn_{0};
  Parameter<SubsystemsStatus> subsystems_parameter_;
  struct LinksStatus {
    std::array<std::uint8_t, told_members> link{};
    std::array<std::uint8_t, told_members> up{};
    std::array<std::uint32_t, told_members> samples{};
    std::array<std::uint32_t, told_members> age_us{};
    std::array<std::uint32_t, told_members> lost{};
    std::array<std::uint32_t, told_members> latency_mean_ns{};
    std::array<std::uint32_t, told_members> latency_max_ns{};
  };
  Parameter<LinksStatus> link_status_parameter_;
  std::map<std::uint8_t, Mapping> watched_links_;  ///< memory of the links that are up
  std::optional<Call> link_call_;
};

}  // namespace hirosco::supervisor
