// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/shared_memory_flow.hpp"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/private_folder.hpp"
#include "hirosco/data_transfer/device/private_memory_folder.hpp"
#include "hirosco/data_transfer/device/side_lock.hpp"

// Invariants:
//  1. A segment of zeroes is a valid one, so it does not matter who makes it or how far he came.
//  2. A side belongs to whoever has the lock on its octet of the file. The system frees it with the process, so a stale
//     segment needs no repair but that of 4 and of the opening count.
//  3. `opened` of a side is odd while it is open; it grows at each opening and closing.
//  4. A mailbox has one writer, the owner of the side opposite. Its sequence follows the rules of latest_link.cpp; a
//     writer that takes over from one killed in the middle goes on from the next even number.
//  5. A side begins with what is in its mailbox marked as seen, before it says that it is open.
//  6. Who closes has the turn to close. The last one removes the name only while it has both locks; who opens makes sure
//     after its lock that the name still means the file it has locked.
namespace hirosco {
namespace {

using Word = std::uint64_t;
static_assert(std::atomic<Word>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

constexpr Word magic = 0x0001'574F'4C46'5348;  // "HSFLOW", version 1
constexpr int reading_attempts = 8;
constexpr int opening_attempts = 200;
constexpr std::size_t octet_of_closing = 2;  ///< those before it are the sides

long futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value, const timespec* timeout) noexcept {
  return ::syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word), operation, value, timeout, nullptr, 0);
}

std::int64_t now_ns() noexcept {
  timespec now{};
  (void)::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

bool names(const std::string& path, int file) noexcept {
  const FileDescriptor named{::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW)};
  struct stat ours{};
  struct stat theirs{};
  return named && ::fstat(file, &ours) == 0 && ::fstat(named.get(), &theirs) == 0 && ours.st_ino == theirs.st_ino;
}

}  // namespace

struct SharedMemoryFlow::Mailbox {
  alignas(64) std::atomic<Word> sequence;
  std::atomic<Word> octets;
  std::array<std::atomic<Word>, max_frame_octets / sizeof(Word)> words;
  alignas(64) std::atomic<std::uint32_t> bell;  ///< futex of the reader
  std::atomic<std::uint32_t> waiting;
};

struct SharedMemoryFlow::Segment {
  std::atomic<Word> magic;
  alignas(64) std::array<std::atomic<Word>, 2> opened;
  std::array<Mailbox, 2> mailboxes;  ///< to side 0, to side 1
};

Result<std::unique_ptr<DataFlow>> SharedMemoryFlow::open(const std::string& address, FlowSide side, FlowHolder holder) {
  if (address.empty() || address.size() > 200 || address.find('\0') != std::string::npos)
    return fail(ErrorCode::InvalidArgument, "address of shared memory");
  const std::string path = device_memory_file(address, holder);
  // A peer that closes holds both locks for a moment, so a claim that fails is tried again before it is believed.
  Result<std::unique_ptr<SharedMemoryFlow>> opened = fail(ErrorCode::Unavailable, "shared memory");
  for (int i = 0; i < opening_attempts; ++i) {
    // Each time anew: a flight of this name that ends takes away what is empty.
    if (holder == FlowHolder::Subsystem) HIROSCO_TRY(make_device_memory_folder(address));
    opened = try_open(path, side);
    if (opened || (opened.error().code != ErrorCode::AlreadyExists && opened.error().code != ErrorCode::Unavailable))
      break;
    pause_for_peer();
  }
  if (!opened) return fail(opened.error());
  return std::unique_ptr<DataFlow>{std::move(*opened)};
}

Result<std::unique_ptr<SharedMemoryFlow>> SharedMemoryFlow::try_open(const std::string& path, FlowSide side) {
  FileDescriptor file;
  {
    const OpenInPrivate opening{path};
    file.reset(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, opening.mode()));
  }
  if (!file)
    return fail(errno == ENOENT ? ErrorCode::Unavailable : ErrorCode::SystemFailure, "open shared memory", errno);
  if (!lock_side(file.get(), side == FlowSide::Subsystem ? 0 : 1))
    return fail(ErrorCode::AlreadyExists, "this side of the flow is open");
  if (!names(path, file.get())) return fail(ErrorCode::Unavailable, "shared memory was removed");
  HIROSCO_TRY(os_detail::give_size(file.get(), sizeof(Segment)));
  HIROSCO_TRY_LET(MappedMemory memory, MappedMemory::map(file.get(), sizeof(Segment), MapMode::ReadWrite));
  auto& segment = *reinterpret_cast<Segment*>(memory.octets().data());
  Word found = 0;
  if (!segment.magic.compare_exchange_strong(found, magic) && found != magic)
    return fail(ErrorCode::Mismatch, "shared memory is not a flow's", static_cast<std::int64_t>(found));
  std::unique_ptr<SharedMemoryFlow> flow{new SharedMemoryFlow{path, std::move(file), std::move(memory), side}};
  flow->take_over();
  return flow;
}

SharedMemoryFlow::SharedMemoryFlow(std::string path, FileDescriptor file, MappedMemory memory, FlowSide side) noexcept
    : path_{std::move(path)},
      file_{std::move(file)},
      memory_{std::move(memory)},
      segment_{*reinterpret_cast<Segment*>(memory_.octets().data())},
      own_{side == FlowSide::Subsystem ? 0U : 1U} {}

void SharedMemoryFlow::take_over() noexcept {
  const std::size_t peer = 1 - own_;
  Word peers = segment_.opened[peer].load();
  // A killed peer left its count odd.
  if (peers % 2 == 1 && !is_locked_by_another(file_.get(), peer))
    (void)segment_.opened[peer].compare_exchange_strong(peers, peers + 1);
  peers = segment_.opened[peer].load();
  peer_at_start_ = peers - peers % 2;
  sent_sequence_ = segment_.mailboxes[peer].sequence.load();
  sent_sequence_ += sent_sequence_ % 2;
  segment_.mailboxes[peer].sequence.store(sent_sequence_);
  seen_sequence_ = segment_.mailboxes[own_].sequence.load();
  seen_sequence_ += seen_sequence_ % 2;
  segment_.opened[own_].store((segment_.opened[own_].load() | 1) + 2);
}

SharedMemoryFlow::~SharedMemoryFlow() {
  const std::size_t peer = 1 - own_;
  segment_.opened[own_].fetch_add(1);
  segment_.mailboxes[peer].bell.fetch_add(1);
  (void)futex(segment_.mailboxes[peer].bell, FUTEX_WAKE, 1, nullptr);
  if (!take_turn_to_close(file_.get(), octet_of_closing)) return;
  if (lock_side(file_.get(), peer) && names(path_, file_.get())) (void)::unlink(path_.c_str());
  free_side(file_.get(), own_);
}

Result<> SharedMemoryFlow::do_send(Octets frame) noexcept {
  if (frame.size() > max_frame_octets)
    return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
  const std::size_t peer = 1 - own_;
  if (segment_.opened[peer].load(std::memory_order_acquire) % 2 == 0)
    return fail(ErrorCode::Unavailable, "nobody listens");
  Mailbox& mailbox = segment_.mailboxes[peer];
  mailbox.sequence.store(sent_sequence_ + 1, std::memory_order_relaxed);
  mailbox.octets.store(frame.size(), std::memory_order_release);
  for (std::size_t at = 0; at < frame.size(); at += sizeof(Word)) {
    Word word = 0;
    std::memcpy(&word, frame.data() + at, std::min(sizeof word, frame.size() - at));
    mailbox.words[at / sizeof(Word)].store(word, std::memory_order_release);
  }
  sent_sequence_ += 2;
  mailbox.sequence.store(sent_sequence_, std::memory_order_release);
  // The waiter raises its flag before it looks at the bell, we ring before we look at the flag: one sees the other.
  mailbox.bell.fetch_add(1);
  if (mailbox.waiting.load() != 0) (void)futex(mailbox.bell, FUTEX_WAKE, 1, nullptr);
  return ok();
}

Result<Received> SharedMemoryFlow::do_receive(MutableOctets buffer) noexcept {
  Mailbox& mailbox = segment_.mailboxes[own_];
  std::array<Word, max_frame_octets / sizeof(Word)> copy;
  for (int attempt = 0; attempt < reading_attempts; ++attempt) {
    const Word sequence = mailbox.sequence.load(std::memory_order_acquire);
    if (sequence == seen_sequence_) break;
    if (sequence % 2 == 1) continue;
    const Word octets = mailbox.octets.load(std::memory_order_acquire);
    const bool fits = octets <= buffer.size() && octets <= max_frame_octets;
    const std::size_t words = fits ? (octets + sizeof(Word) - 1) / sizeof(Word) : 0;
    for (std::size_t i = 0; i < words; ++i) copy[i] = mailbox.words[i].load(std::memory_order_acquire);
    if (mailbox.sequence.load(std::memory_order_relaxed) != sequence) continue;
    seen_sequence_ = sequence;
    if (!fits) return fail(ErrorCode::Malformed, "frame is longer than expected", static_cast<std::int64_t>(octets));
    if (octets != 0) std::memcpy(buffer.data(), copy.data(), octets);
    return Received{Flow::New, octets};
  }
  if (peer_hung_up()) return fail(ErrorCode::Unavailable, "peer has hung up");
  return Received{};
}

bool SharedMemoryFlow::peer_hung_up() const noexcept {
  const Word opened = segment_.opened[1 - own_].load(std::memory_order_acquire);
  return opened % 2 == 0 && opened != peer_at_start_;
}

bool SharedMemoryFlow::something_to_tell() const noexcept {
  const Word sequence = segment_.mailboxes[own_].sequence.load(std::memory_order_acquire);
  return (sequence % 2 == 0 && sequence != seen_sequence_) || peer_hung_up();
}

bool SharedMemoryFlow::do_wait(Duration timeout) noexcept {
  Mailbox& mailbox = segment_.mailboxes[own_];
  const std::int64_t start = now_ns();
  mailbox.waiting.store(1);
  bool found = false;
  for (;;) {
    const std::uint32_t rung = mailbox.bell.load();
    found = something_to_tell();
    const std::int64_t left = timeout.count() - (now_ns() - start);
    if (found || left <= 0) break;
    const timespec rest{left / 1'000'000'000, left % 1'000'000'000};
    (void)futex(mailbox.bell, FUTEX_WAIT, rung, &rest);
  }
  mailbox.waiting.store(0);
  return found;
}

void let_in_shared_memory(const std::string& address, Sandbox& sandbox) {
  let_write(device_memory_folder(address), sandbox);
}

bool is_reached_by_shared_memory(const std::string& address, const Sandbox& sandbox) {
  return may_write(device_memory_file(address, FlowHolder::Supervisor), sandbox);
}

Result<> make_own_memory_folder(const std::string& address, const OwnGroup& own) {
  return make_private_memory_folder(address, own.group);
}

}  // namespace hirosco
