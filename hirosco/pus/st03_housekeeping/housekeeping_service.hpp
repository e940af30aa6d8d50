// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/st01_verification/instructions.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_layout.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/spsc_ring.hpp"

/// ST[03] housekeeping in two halves: the sampler in the cycle collects values and makes whole reports; the service in
/// the service loop answers telecommands and tells the sampler by commands (ECSS-E-ST-70-41C 8.3.2; README.md).
namespace hirosco::pus {

inline constexpr std::size_t max_housekeeping_structures = 32;

/// Where values come from.  Realtime: called in the cycle.
struct SampleSource {
  virtual ~SampleSource() = default;
  /// Writes the value (of one member, or whole with member -1) and returns its octets.
  [[nodiscard]] virtual std::size_t sample(std::uint16_t parameter, int member, MutableOctets big_endian) noexcept = 0;
};

/// Where finished reports go: source data of TM[3,25].  Realtime: called in the cycle.
struct SampleSink {
  virtual ~SampleSink() = default;
  /// Room for a report; empty when there is none, which loses this report.
  [[nodiscard]] virtual MutableOctets reserve(std::size_t octets) noexcept = 0;
  virtual void commit(std::uint16_t structure_id, std::size_t octets) noexcept = 0;
};

/// The cycle's half. Every `interval` cycles each enabled structure makes a report: a set with n repetitions is sampled
/// each interval / n cycles, the last time together with the report, where the once-values are sampled.
/// A fixed number of slots and report buffers is allocated at construction and nothing after it.
class HousekeepingSampler {
 public:
  HousekeepingSampler();
  ~HousekeepingSampler();
  HousekeepingSampler(const HousekeepingSampler&) = delete;
  HousekeepingSampler& operator=(const HousekeepingSampler&) = delete;

  /// Applies commands, samples and reports.  Realtime: bounded, does not allocate. Thread: the cycle.
  void tick(SampleSource& source, SampleSink& sink) noexcept;
  /// Applies commands only: for times without a cycle. Thread: the cycle's, or any while no cycle runs.
  void apply_commands() noexcept;

  /// Reports that found no room in the sink. Thread: any.
  [[nodiscard]] std::uint64_t lost_reports() const noexcept { return lost_reports_.load(std::memory_order_relaxed); }
  /// Values whose source gave another size than declared; they are reported as zeros. Thread: any.
  [[nodiscard]] std::uint64_t failed_samples() const noexcept {
    return failed_samples_.load(std::memory_order_relaxed);
  }

 private:
  friend class HousekeepingService;
  static constexpr std::size_t max_commands = 1024;  ///< several whole requests

  struct Command {
    enum class Kind : std::uint8_t { Install, Remove, Enable, Disable, OneShot, SetInterval };
    Kind kind{};
    std::uint8_t slot{};
    std::uint32_t interval{};
  };

  /// A report being filled.
  struct Collection {
    bool active{false};
    std::uint32_t phase{0};  ///< cycles of the interval that have passed
    std::uint32_t interval{1};
    std::unique_ptr<std::byte[]> buffer;
    void start(std::uint32_t cycles) noexcept;
  };

  struct Slot {
    /// Owned by the service while free and from `Install` on constant until the cycle sets `free` again.
    std::atomic<bool> free{true};
    HousekeepingLayout layout;
    // The cycle's own.
    bool installed{false};
    std::uint32_t interval{0};
    std::uint16_t one_shots{0};  ///< asked for and not begun
    Collection periodic;
    Collection one_shot;
  };

  // The service's side. Thread: the service loop.
  [[nodiscard]] std::size_t free_commands() const noexcept { return max_commands - commands_.size(); }
  [[nodiscard]] int find_free_slot() const noexcept;
  bool send(Command::Kind kind, std::size_t slot, std::uint32_t interval = 0) noexcept;
  void install(std::size_t slot, const HousekeepingLayout& layout) noexcept;

  void apply(const Command& command) noexcept;
  [[nodiscard]] bool advance(Slot& slot, Collection& collection, SampleSource& source, SampleSink& sink) noexcept;
  void sample_sets(Slot& slot, Collection& collection, SampleSource& source) noexcept;
  void sample_values(const HousekeepingLayout& layout, std::span<const std::uint32_t> places, MutableOctets to,
                     SampleSource& source) noexcept;
  void deliver(const Slot& slot, const Collection& collection, SampleSink& sink) noexcept;

  std::array<Slot, max_housekeeping_structures> slots_;
  SpscRing<Command, max_commands> commands_;
  std::atomic<std::uint64_t> lost_reports_{0};
  std::atomic<std::uint64_t> failed_samples_{0};
};

struct HousekeepingDefinition;

/// The service loop's half: TC[3,1], 3, 5, 6, 9, 27, 29, 31 and 33. What it accepts takes effect at the beginning of the
/// next cycle. What it takes from the heap it takes when it is made.  Thread: the service loop.
class HousekeepingService final : public Service {
 public:
  static constexpr std::uint8_t service_type = 3;
  enum Subtype : std::uint8_t {
    create_structure = 1,
    delete_structures = 3,
    enable_periodic = 5,
    disable_periodic = 6,
    report_structures = 9,
    structure_report = 10,
    parameter_report = 25,
    one_shot = 27,
    append_parameters = 29,
    modify_interval = 31,
    report_properties = 33,
    properties_report = 35,
  };

  /// `subsystem` gives the parameters; it and `sampler` outlive the service, behind whose end `sampler` ticks no more.
  HousekeepingService(const descriptor::SubsystemDescriptor& subsystem, HousekeepingSampler& sampler,
                      Verification& verification, TelemetrySink& sink);

  /// Adds predefined structures; one with an id that exists replaces it (a configuration overrides the subsystem).
  /// NotFound: a value that the subsystem does not have; OutOfRange: interval and repetitions do not fit; ResourceExhausted: too many structures or too long a report;
  /// Unavailable: the cycle has not yet taken earlier commands. Structures before the failed one stay.
  [[nodiscard]] Result<> load(std::span<const descriptor::HousekeepingStructure> structures);
  /// Removes all structures, before another configuration. Unavailable as above, and nothing is removed.
  [[nodiscard]] Result<> clear();

  static const ServiceKind service_kind;
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;

 private:
  struct Structure {
    std::uint16_t id{};
    std::size_t slot{};
    std::uint32_t interval{};
    bool enabled{false};
    bool predefined{false};
  };
  using Notice = std::optional<FailureNotice>;

  [[nodiscard]] Structure* find(std::uint16_t id) noexcept;
  /// Its place among the values.
  [[nodiscard]] std::optional<std::size_t> find_value(std::uint32_t wire) const noexcept;
  [[nodiscard]] const HousekeepingLayout& layout_of(const Structure& structure) const noexcept;
  [[nodiscard]] Result<> load_one(const descriptor::HousekeepingStructure& declared);
  [[nodiscard]] std::optional<std::size_t> resolve(const descriptor::ParameterRef& reference) const noexcept;

  void create(Octets data, const Request& request);
  void append(Octets data, const Request& request);
  void remove(Octets data, const Request& request);
  void switch_periodic(Octets data, const Request& request, bool enabled);
  void request_one_shots(Octets data, const Request& request);
  void modify_intervals(Octets data, const Request& request);
  void report_layouts(Octets data, const Request& request);
  void report_periodic_properties(Octets data, const Request& request);
  void send_layout(const Structure& structure, const Request& request);
  /// Adds to the draft what the definition says.
  [[nodiscard]] Notice extend(const HousekeepingDefinition& definition) noexcept;
  [[nodiscard]] Notice check_capacity(const HousekeepingLayout& layout) const noexcept;
  /// Unknown identifiers and want of room in the command queue, for lists of structure ids.
  [[nodiscard]] Notice check_known(std::size_t index, std::uint16_t id, std::size_t commands_before) noexcept;

  const descriptor::SubsystemDescriptor& subsystem_;
  HousekeepingSampler& sampler_;
  Verification& verification_;
  TelemetrySink& sink_;
  std::vector<SampledValue> values_;  ///< every parameter and member
  std::vector<Structure> structures_;
  HousekeepingLayout draft_;  ///< of the structure that is being made
};

}  // namespace hirosco::pus
