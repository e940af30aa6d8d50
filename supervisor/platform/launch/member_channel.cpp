// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/member_channel.hpp"

namespace hirosco::supervisor {
namespace {

[[nodiscard]] bool is_full(const Result<>& sent) noexcept {
  return !sent && sent.error().code == ErrorCode::ResourceExhausted;
}

}  // namespace

bool MemberChannel::send_kept() {
  while (!kept_.empty()) {
    Message message = kept_.front().message;
    message.packet = kept_.front().packet;
    // What cannot be sent for another reason than room would never be.
    if (is_full(channel_.send(message))) return false;
    kept_.pop_front();
  }
  return true;
}

Result<> MemberChannel::send_or_keep(const Message& message, TimePoint now) {
  const auto sent = send(message);
  if (!is_full(sent) || kept_.size() == most_kept) return sent;
  Kept& kept = kept_.emplace_back(message, std::vector(message.packet.begin(), message.packet.end()), now + patience);
  kept.message.packet = {};
  return ok();
}

void MemberChannel::step(TimePoint now) {
  while (!kept_.empty() && now >= kept_.front().until) kept_.pop_front();
  static_cast<void>(send_kept());
}

Result<> MemberChannel::send(const Message& message) {
  if (!send_kept()) return fail(ErrorCode::ResourceExhausted, "peer does not read");
  return channel_.send(message);
}

std::size_t MemberChannel::send_all(std::span<const Message> messages) {
  return send_kept() ? channel_.send_all(messages) : 0;
}

}  // namespace hirosco::supervisor
