// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/utilities/enum_text.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// The real-time link as a contract (paper 4.1): whoever makes, uses or watches a link knows what stands here and no mechanism
/// by name. A mechanism is a class beside this file and a row in the table of each backend that has it (`*_mechanisms.cpp`).
///
/// A sample's way: parameters -> LinkOutputSlot::write (`subsystem/cycle/link_slots.cpp`) -> LinkWriter -> shared memory, or
/// datagrams (`udp_link.cpp`) -> LinkReader -> LinkInputSlot::read -> the author's LinkInput. Both ends are attached by
/// `service_loop/link_ends.cpp` of the subsystem, after the handshake of `realtime_links/link_handshakes.cpp` of the supervisor.
namespace hirosco {

struct Sandbox;

/// How samples travel.
enum class LinkMethod : std::uint8_t { SharedMemory = 1, Udp = 2, Tcp = 3, Unix = 4, Dds = 5, Tipc = 6 };
/// Which samples a consumer gets: the newest one, every one in order, or the newest large one, which is made and looked at
/// in the link's own memory.
enum class LinkKind : std::uint8_t { Latest = 1, Queued = 2, Loaned = 3 };

/// Where the ends of a link stand: in memory alone, or at internet addresses, which a mission may say and of which each is a port of its subsystem's.
enum class LinkEndsAt : std::uint8_t { Memory, Addresses };

/// Octets of one sample, at most: of one that is copied, and of one that is lent.
inline constexpr std::uint32_t max_link_payload_octets = 65'536;
inline constexpr std::uint32_t max_loaned_payload_octets = 16U << 20;
[[nodiscard]] constexpr std::uint32_t max_payload_octets(LinkKind kind) noexcept {
  return kind == LinkKind::Loaned ? max_loaned_payload_octets : max_link_payload_octets;
}

/// Samples that a link of kind Queued keeps for a consumer that is behind, and the octets of all of them, at most.
inline constexpr std::uint32_t min_link_depth = 2;
inline constexpr std::uint32_t max_link_depth = 4096;
inline constexpr std::uint32_t default_link_depth = 64;
inline constexpr std::uint32_t max_queue_octets = 64U << 20;
[[nodiscard]] constexpr bool queue_fits(std::uint32_t depth, std::uint32_t payload_octets) noexcept {
  return depth >= min_link_depth && depth <= max_link_depth &&
         std::uint64_t{depth} * payload_octets <= max_queue_octets;
}

/// Written by the producer beside each sample. The larger of two is the worse to rely on. What no producer wrote is read as
/// Fault: no damage of the word turns a fault into something to rely on (hazard SF19).
enum class LinkStatus : std::uint32_t { None = 0, Valid = 1, Degraded = 2, Stopping = 3, Fault = 4 };

/// Where the ends of a link are that is not memory, each in the words of its method; of a link in memory nothing. An address
/// without a port is where an end is to stand, with one where it does.
struct LinkRoute {
  std::uint8_t link{0};  ///< in the mission
  std::string producer{}, consumer{};  ///< addresses, empty = not known yet
  std::uint64_t key{0};  ///< drawn by the producer: what an earlier one sent, or another's, is not taken for its own
  friend bool operator==(const LinkRoute&, const LinkRoute&) = default;
};

/// What both sides agreed on and find again at the other end.
struct LinkLayout {
  std::uint32_t epoch{};  ///< of the handshake that made this link
  std::uint32_t payload_octets{};  ///< of one sample, 1 .. max_payload_octets(kind)
  std::uint64_t layout_hash{};  ///< of the agreed fields, byte order and kind
  Duration period{};  ///< of the producer
  std::uint32_t depth{0};  ///< of kind Queued: samples kept, min_link_depth .. max_link_depth; of others 0
  LinkRoute route{};  ///< of a link that is not memory
  /// The consumer's cycle starts with a sample: its producer wakes it after each (adr 0094).
  bool wakes{false};
};

/// What a read found. `flow` None: never a sample yet. Old: the same sample as last time, or none could be had whole and
/// `payload` still holds the reader's last copy.
struct LinkSample {
  Flow flow{Flow::None};
  /// As the producer told it last; of kind Queued that, or what it wrote beside the sample, whichever is worse: a fault is told
  /// ahead of the samples that wait, and no later one makes good what came of it.
  LinkStatus status{LinkStatus::None};
  std::uint64_t count{0};  ///< of the sample in `payload`
  std::uint64_t lost{0};  ///< samples never seen between this and the one before
  TimePoint sampled_at{};
};

/// How a link is doing, for displays. The two values may be of neighbouring samples.
struct LinkGlance {
  std::uint64_t count{0};  ///< samples written so far
  TimePoint sampled_at{};  ///< of the newest
};

/// The producer's end.  Realtime: bounded, never waits for a consumer. Thread: one.
class LinkWriter {
 public:
  virtual ~LinkWriter() = default;
  /// Publishes one sample. `payload` has the agreed size (invariant). Counts from 1.
  virtual void write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept = 0;
  /// Changes the status without a new sample (stopping, fault).
  virtual void set_status(LinkStatus status) noexcept = 0;
  /// What a consumer has to know to hear this end; of a link in memory nothing.  Realtime: allocates. Thread: any.
  [[nodiscard]] virtual LinkRoute route() const { return {}; }
  /// From now on samples go to where a consumer stands (its route()'s `consumer`). Mismatch: they do not fit the way to it.
  /// Realtime: system calls. Thread: any one, beside write().
  [[nodiscard]] virtual Result<> reach(const std::string&) {
    return fail(ErrorCode::NotPermitted, "who is joined by memory is reached already");
  }
};

/// A consumer's end. Keeps the last whole sample itself, so that no producer can take it away. What is next depends on the
/// kind: the newest sample there is; of kind Queued the one after that which was read last. A consumer of that kind that is
/// more than `depth` samples behind goes on with the oldest of the newest `depth`, and `lost` tells exactly how many it missed.
/// Realtime: bounded, never waits for the producer. Thread: one.
class LinkReader {
 public:
  virtual ~LinkReader() = default;
  /// Copies the next sample into `payload` (agreed size, invariant), never a torn one, none twice and none after a later
  /// one; on Old the last one again, on None nothing.
  virtual LinkSample read(MutableOctets payload) noexcept = 0;
  /// What the producer has to know to reach this end; of a link in memory nothing.  Realtime: allocates. Thread: any.
  [[nodiscard]] virtual LinkRoute route() const { return {}; }
  /// Where a consumer that sleeps sees that a sample was published (utilities/os/word_wait.hpp), as long as this end lives: another
  /// word than before, of which nothing else is to be believed. It may change without a sample, too. Null: of a mechanism that wakes
  /// nobody.  Realtime: wait-free.
  [[nodiscard]] virtual const std::uint32_t* arrival_word() const noexcept { return nullptr; }
};

/// The producer's end of a link that lends: a sample is made where its consumers look at it, all of them, and nothing is copied.
/// Realtime: wait-free; never waits for a consumer. Thread: one.
class LoanWriter {
 public:
  virtual ~LoanWriter() = default;
  /// A place of exactly the agreed size that nobody looks at as the newest, on a cache line; the same one until it is
  /// published. What stands in it is of an earlier sample, or zero.
  [[nodiscard]] virtual MutableOctets lend() noexcept = 0;
  /// Makes the lent place the newest sample. Counts from 1. Nothing when nothing is lent.
  virtual void publish(TimePoint sampled_at, LinkStatus status) noexcept = 0;
  /// Changes the status without a new sample (stopping, fault).
  virtual void set_status(LinkStatus status) noexcept = 0;
  /// One of its consumers sleeps until a sample comes: from now on each is told with a wake. Thread: any one, beside the others.
  virtual void start_waking() noexcept = 0;
};

/// A consumer's end of a link that lends. It keeps no copy: the producer makes the place that is looked at anew when it
/// has published at least twice since and lends again, and whole() tells so.
/// Realtime: wait-free (bounded retries); never waits for the producer. Thread: one.
class LoanReader {
 public:
  virtual ~LoanReader() = default;
  /// Tells the newest sample, as LinkReader::read does, and leaves what is looked at alone.
  virtual LinkSample newest() noexcept = 0;
  /// The sample that newest() told last, where it lies; empty before the first. What is read of it may be torn, and holds
  /// nothing to rely on, until whole() was asked after the reading.
  [[nodiscard]] virtual Octets look() noexcept = 0;
  /// Whether all that was read since look() is of that one sample.
  [[nodiscard]] virtual bool whole() const noexcept = 0;
  /// As LinkReader has it.
  [[nodiscard]] virtual const std::uint32_t* arrival_word() const noexcept { return nullptr; }
};

/// A look at a link from outside: no sample is read, no reader's count moves.  Realtime: wait-free. Thread: one.
class LinkView {
 public:
  virtual ~LinkView() = default;
  /// Empty: nothing was ever produced, or it cannot be told.
  [[nodiscard]] virtual std::optional<LinkGlance> glance() const noexcept = 0;
};

/// One way to carry a link. The supervisor establishes what both ends share and hands it to them beside ST[128] attach;
/// each end makes of it what it needs.  Realtime: allocates, system calls. Thread: any.
class LinkMechanism {
 public:
  virtual ~LinkMechanism() = default;
  [[nodiscard]] virtual LinkMethod method() const noexcept = 0;
  [[nodiscard]] virtual LinkKind kind() const noexcept = 0;
  /// Both ends and the supervisor share memory. False: they share addresses (LinkRoute), there is nothing to hand over and
  /// nothing to look at, and the producer is told afterwards where its consumer is.
  [[nodiscard]] virtual bool in_memory() const noexcept { return true; }
  /// What stands in for another mechanism in one process says what that one does.
  [[nodiscard]] virtual LinkEndsAt ends_at() const noexcept { return LinkEndsAt::Memory; }
  /// Adds what its ends need of a sandbox, and no more (docs/adr/0175). Of one that says nothing: nothing, as memory is handed over.
  virtual void let_in(Sandbox& /*sandbox*/) const {}
  /// Its producer can wake a consumer that sleeps, where the layout says so.
  [[nodiscard]] virtual bool wakes() const noexcept { return false; }
  /// Octets of one sample, at most.
  [[nodiscard]] virtual std::uint32_t max_payload() const noexcept { return max_payload_octets(kind()); }
  /// Mismatch: the layout is impossible.
  [[nodiscard]] virtual Result<MemoryHandle> establish(MemoryProvider& provider, const LinkLayout& layout) const = 0;
  /// From now on nobody else can become the producer. Mismatch: what was handed over is not what such a link needs.
  [[nodiscard]] virtual Result<std::unique_ptr<LinkWriter>> produce(MemoryProvider& provider,
                                                                    const MemoryHandle& shared,
                                                                    const LinkLayout& layout) const = 0;
  /// Mismatch: what was handed over is not what was agreed, or a second producer may yet come.
  [[nodiscard]] virtual Result<std::unique_ptr<LinkReader>> consume(MemoryProvider& provider,
                                                                    const MemoryHandle& shared,
                                                                    const LinkLayout& layout) const = 0;
  [[nodiscard]] virtual Result<std::unique_ptr<LinkView>> look(MemoryProvider& provider,
                                                               const MemoryHandle& shared) const = 0;
  /// Of kind Loaned: as produce() and consume(), ends that copy nothing. NotPermitted: of another kind.
  [[nodiscard]] virtual Result<std::unique_ptr<LoanWriter>> lend(MemoryProvider&, const MemoryHandle&,
                                                                 const LinkLayout&) const {
    return fail(ErrorCode::NotPermitted, "such a link lends nothing");
  }
  [[nodiscard]] virtual Result<std::unique_ptr<LoanReader>> borrow(MemoryProvider&, const MemoryHandle&,
                                                                   const LinkLayout&) const {
    return fail(ErrorCode::NotPermitted, "such a link lends nothing");
  }
};

/// The mechanisms of a platform.
using LinkMechanisms = std::span<const LinkMechanism* const>;
/// Those that are built in, one row each in `*_mechanisms.cpp`; through shared memory by `latest_link.cpp`, `queued_link.cpp`, `loaned_link.cpp`.
[[nodiscard]] LinkMechanisms standard_link_mechanisms() noexcept;
/// Of the same methods and kinds, for a craft in one process on virtual time: in memory, whatever their method, so that
/// nothing depends on the host's network.
[[nodiscard]] LinkMechanisms local_link_mechanisms() noexcept;
/// Null: there is none for this method and kind.
[[nodiscard]] const LinkMechanism* find_link_mechanism(LinkMechanisms mechanisms, LinkMethod method,
                                                       LinkKind kind) noexcept;
/// Where the ends of a link by this method stand, whatever its kind.
[[nodiscard]] LinkEndsAt ends_of(LinkMechanisms mechanisms, LinkMethod method) noexcept;

template <>
struct EnumTexts<LinkMethod> {
  using enum LinkMethod;
  static constexpr auto table = enum_table<LinkMethod>(
      {{SharedMemory, "shared_memory"}, {Udp, "udp"}, {Tcp, "tcp"}, {Unix, "unix"}, {Dds, "dds"}, {Tipc, "tipc"}});
};
template <>
struct EnumTexts<LinkKind> {
  using enum LinkKind;
  static constexpr auto table = enum_table<LinkKind>({{Latest, "latest"}, {Queued, "queued"}, {Loaned, "loaned"}});
};

}  // namespace hirosco
