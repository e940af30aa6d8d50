// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/resource/quota.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

/// What the cycle moves between the author's ports and other subsystems: one slot per required set and provided set.
/// Slots are built by the service loop while the cycle rests; step functions run in the cycle and are bounded.
namespace hirosco {

/// One end of an established link: made by the service loop, used by the cycle, freed by the service loop.
struct AttachedLink {
  Quota::Held port{};  ///< of a link by UDP; given back after its ends, which stand below
  std::uint8_t id{0};                    ///< in the mission
  pus::st128::Agreement agreement;
  std::unique_ptr<LinkWriter> writer;    ///< producer
  std::unique_ptr<LinkReader> reader;    ///< consumer
  std::shared_ptr<LoanWriter>
      lender;    ///< instead of `writer`, where samples are lent: all links into one memory have it
  std::uint32_t made{0};                 ///< of the memory, as long as a link holds it
  std::unique_ptr<LoanReader> borrower;  ///< instead of `reader`
  LinkStatus told{LinkStatus::None};     ///< producer that lends: as consumers know it
  AttachedLink* next{nullptr};           ///< producer: of the same set; the cycle's
  std::vector<LayoutField> scatter;      ///< consumer: where each agreed field goes in the port, size 0 = unused
  std::vector<std::size_t> wire_offset;  ///< consumer: of each entry of `scatter`
  std::vector<std::byte> payload;        ///< consumer
  std::vector<std::byte> places;  ///< consumer that wants all samples: objects of the port, as many as the link is deep
  std::endian order{std::endian::little};
  void count_in(Duration consumer_period) noexcept;
  std::uint32_t producer_cycles_per_sample{1};  ///< own cycles that one sample of a slower producer may take
};

/// Tells consumers, of the producer's end.
void set_status(AttachedLink& link, LinkStatus status) noexcept;

/// A required set of real-time data.
class LinkInputSlot {
 public:
  LinkInputSlot(const descriptor::Requires& terms, LinkInputPort* port, bool realtime) noexcept;
  [[nodiscard]] const descriptor::Requires& terms() const noexcept { return *terms_; }
  [[nodiscard]] LinkInputPort* port() const noexcept { return port_; }
  [[nodiscard]] bool attached() const noexcept { return link_ != nullptr; }
  /// Prepares the scatter list of a link for the port, and the places of what is queued. Mismatch: the agreement lacks a field, or,
  /// of what is lent, has any other field; it is of another kind than the port. ResourceExhausted: the places take too much.
  [[nodiscard]] Result<> plan(AttachedLink& link) const;
  void attach(AttachedLink* link) noexcept;
  /// Lets go of this link; of another one it keeps hold.
  void detach(const AttachedLink* link) noexcept;
  /// The port outlives all links.
  void release() noexcept { detach(link_); }
  /// The cycle has another period from now on: ages count in its cycles.
  void follow(Duration sampling) noexcept;
  /// Reads the link into the port, in the cycle that started at `now`. `counts`: a sample that stays out makes the newest one older
  /// by a cycle; of cycles that samples start only some do (CyclePace).
  void read(TimePoint now, bool counts) noexcept;
  /// Where it shows that a sample arrived. Null: no link, or one that wakes nobody.
  [[nodiscard]] const std::uint32_t* arrival_word() const noexcept;
  /// From the instant that the newest sample is of to the cycle that took it; empty: none was new in this cycle.
  [[nodiscard]] std::optional<Duration> newest_latency() const noexcept { return newest_latency_; }
  /// Tells how the link does.
  void tell(IncomingLink& page) const noexcept;
  /// Tells how long its samples took: stores the bins that have changed since it told last.
  void tell(LinkLatencies& page) noexcept;
  /// Its producer says that what it sends is to be relied on.
  [[nodiscard]] bool reliable() const noexcept {
    return port_->status_ == LinkStatus::Valid || port_->status_ == LinkStatus::Degraded;
  }
  /// Too old, reported faulty or absent: what a required set must not be while actuators move.
  [[nodiscard]] bool stale() const noexcept { return !port_->valid_; }
  /// A slower producer has not had its turn yet since control began: no good sample came, and for no longer than one may be old.
  /// Once in each cycle, after read(); `counts` as there.
  [[nodiscard]] bool awaits_first(bool controlling, bool counts) noexcept;
  /// Its producer or the supervisor has ended it in order: no reason for an alarm.
  [[nodiscard]] bool ended() const noexcept { return link_ == nullptr || port_->status_ == LinkStatus::Stopping; }

 private:
  [[nodiscard]] LinkSample read_newest(TimePoint now) noexcept;
  [[nodiscard]] LinkSample read_all(TimePoint now) noexcept;
  void take(const LinkSample& sample, MutableOctets into, TimePoint now) noexcept;

  const descriptor::Requires* terms_;
  LinkInputPort* port_;
  std::uint32_t age_limit_;
  std::uint32_t awaited_cycles_{0};
  bool came_{false};  ///< a good one, since control began
  AttachedLink* link_{nullptr};
  std::optional<Duration> newest_latency_;
  Duration latency_before_{};
  double jitter_ns_{0.0};
  TimePoint newest_at_{};
  TimePoint read_at_{};
  double latency_mean_ns_{0.0};
  std::uint32_t latency_max_ns_{0};
  void forget_latencies() noexcept;
  std::array<std::uint32_t, latency_bins> latencies_{};
  std::uint32_t untold_bins_{all_bins};  ///< a bit for each bin
  static constexpr std::uint32_t all_bins = (1U << latency_bins) - 1;
};

/// A provided set of real-time data. A set may have any number of consumers, one link each: what they get is encoded once.
/// A lent set has a port: its samples are made in the memory that its links have in common.
class LinkOutputSlot {
 public:
  LinkOutputSlot(const descriptor::SubsystemDescriptor& subsystem, const descriptor::Provides& terms,
                 Dictionary& dictionary, LoanOutputPort* port = nullptr);
  [[nodiscard]] const descriptor::Provides& terms() const noexcept { return *terms_; }
  [[nodiscard]] const std::vector<pus::st128::OfferedField>& fields() const noexcept { return fields_; }
  void attach(AttachedLink* link) noexcept;
  void detach(AttachedLink* link) noexcept;
  /// The port outlives all links.
  void release() noexcept;
  void write(TimePoint now, LinkStatus status) noexcept;

 private:
  struct Source {
    const ParameterCell* cell;
    LayoutField field;
  };
  const descriptor::Provides* terms_;
  std::vector<pus::st128::OfferedField> fields_;
  std::vector<Source> sources_;
  void encode_for(std::endian order) noexcept;
  void hand_on(TimePoint now, LinkStatus status) noexcept;
  void lend_first() noexcept;
  [[nodiscard]] bool has_told(const AttachedLink& link) const noexcept;
  [[nodiscard]] MutableOctets payload(std::endian order) noexcept {
    return payloads_[order == std::endian::big ? 1 : 0];
  }

  std::array<std::vector<std::byte>, 2> payloads_;  ///< little and big endian
  AttachedLink* first_{nullptr};  ///< in the order in which they were attached
  LoanOutputPort* port_;
};

}  // namespace hirosco
