// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/kept_store.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

namespace hirosco::supervisor {
namespace {

/// A message: the slot, and a descriptor for each role beside it; none: the slot is given back.
using SlotNumber = std::uint32_t;
using Numbers = std::array<int, kept_roles>;
/// More than one message of ours may carry, so that a surplus is seen; the kernel closes what does not fit.
constexpr std::size_t noticed = kept_roles + 4;
constexpr std::size_t process_place = static_cast<std::size_t>(KeptRole::Process);

/// What came beside a message, owned.
[[nodiscard]] std::size_t take_descriptors(msghdr& header, std::array<FileDescriptor, noticed>& into) noexcept {
  std::size_t count = 0;
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t here = (part->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < here; ++i) {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(part) + i * sizeof number, sizeof number);
      // The room for them is rounded up: one more may have come than is counted.
      FileDescriptor owned{number};
      if (count < into.size()) into[count++] = std::move(owned);
    }
  }
  return count;
}

[[nodiscard]] Result<> send(int socket, SlotNumber slot, std::span<const int> numbers) noexcept {
  iovec text{&slot, sizeof slot};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(Numbers))> control{};
  msghdr header{};
  header.msg_iov = &text;
  header.msg_iovlen = 1;
  if (!numbers.empty()) {
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    cmsghdr* const part = CMSG_FIRSTHDR(&header);
    part->cmsg_level = SOL_SOCKET;
    part->cmsg_type = SCM_RIGHTS;
    part->cmsg_len = CMSG_LEN(numbers.size_bytes());
    std::memcpy(CMSG_DATA(part), numbers.data(), numbers.size_bytes());
  }
  if (::sendmsg(socket, &header, MSG_DONTWAIT | MSG_NOSIGNAL) < 0)
    return fail(ErrorCode::Unavailable, "the keeper takes nothing", errno);
  return ok();
}

}  // namespace

Result<std::pair<FileDescriptor, FileDescriptor>> KeptStore::make_socket() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0)
    return fail(ErrorCode::SystemFailure, "socket of the store", errno);
  return std::pair{FileDescriptor{ends[0]}, FileDescriptor{ends[1]}};
}

void KeptStore::take() noexcept {
  for (;;) {
    SlotNumber slot = 0;
    iovec text{&slot, sizeof slot};
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(noticed * sizeof(int))> control{};
    msghdr header{};
    header.msg_iov = &text;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    const auto octets = ::recvmsg(socket_.get(), &header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (octets < 0 && errno == EINTR) continue;
    if (octets <= 0) return;
    std::array<FileDescriptor, noticed> came;
    const std::size_t count = take_descriptors(header, came);
    if (octets != sizeof slot || slot >= most_kept || (header.msg_flags & MSG_TRUNC) != 0) continue;
    // Where this process has no descriptor free, the system drops them and says so here only.
    const bool dropped = (header.msg_flags & MSG_CTRUNC) != 0;
    if (dropped || (count != 0 && count != kept_roles)) {
      // They come in their order: where but the last is lacking, by the new one's handle it can still be ended.
      if (dropped && count > process_place && count < kept_roles)
        slots_[slot][process_place] = std::move(came[process_place]);
      not_taken(slot);
      continue;
    }
    Slot& place = slots_[slot];
    for (std::size_t i = 0; i < kept_roles; ++i) place[i] = std::move(came[i]);
    if (page_ != nullptr) page_->not_taken[slot].store(0, std::memory_order_release);
  }
}

void KeptStore::not_taken(std::size_t slot) noexcept {
  Slot& place = slots_[slot];
  FileDescriptor handle = std::move(place[process_place]);
  place = {};
  place[process_place] = std::move(handle);
  if (page_ != nullptr) page_->not_taken[slot].store(1, std::memory_order_release);
}

bool KeptStore::is_of_before(std::size_t slot) const noexcept {
  return page_ != nullptr && page_->not_sent[slot].load(std::memory_order_acquire) != 0;
}

void KeptStore::pass_on(std::vector<ProcessStart::Inherited>& inherited) const {
  for (std::size_t slot = 0; slot < most_kept; ++slot) {
    const FileDescriptor& handle = slots_[slot][process_place];
    if (!handle) continue;
    for (std::size_t role = 0; role < kept_roles; ++role) {
      const FileDescriptor& kept = slots_[slot][role];
      const bool counts = kept && !is_of_before(slot);
      inherited.push_back({counts ? kept.get() : handle.get(), kept_descriptor(slot, static_cast<KeptRole>(role))});
    }
  }
}

Result<> StoreClient::keep(std::size_t slot, const std::array<int, kept_roles>& descriptors) noexcept {
  if (slot >= most_kept) return fail(ErrorCode::OutOfRange, "slot of the store", static_cast<std::int64_t>(slot));
  if (socket_ < 0) return fail(ErrorCode::Unavailable, "there is no keeper");
  const auto mark = [&](std::uint8_t not_sent) {
    if (page_ != nullptr) page_->not_sent[slot].store(not_sent, std::memory_order_release);
  };
  mark(1);
  const auto sent = send(socket_, static_cast<SlotNumber>(slot), descriptors);
  if (sent) mark(0);
  return sent;
}

void StoreClient::forget(std::size_t slot) noexcept {
  if (socket_ >= 0 && slot < most_kept) static_cast<void>(send(socket_, static_cast<SlotNumber>(slot), {}));
}

InheritedParts StoreClient::inherited() {
  std::map<std::size_t, std::array<FileDescriptor, kept_roles>> found;
  for (std::size_t slot = 0; slot < most_kept; ++slot) {
    std::array<FileDescriptor, kept_roles> here;
    bool whole = true;
    for (std::size_t role = 0; role < kept_roles; ++role) {
      const int number = kept_descriptor(slot, static_cast<KeptRole>(role));
      if (::fcntl(number, F_GETFD) < 0) whole = false;
      else ::fcntl(number, F_SETFD, FD_CLOEXEC);  // nobody whom this process starts gets it
      if (whole) here[role].reset(number);
    }
    if (whole) found.emplace(slot, std::move(here));
  }
  return found;
}

}  // namespace hirosco::supervisor
