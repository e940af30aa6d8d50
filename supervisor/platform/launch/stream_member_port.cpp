// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/stream_member_port.hpp"

#include <utility>

namespace hirosco::supervisor {

StreamMemberPort::Wire::Wire(FileDescriptor stream)
    : pages{std::make_shared<Pages>()}, words{pages->vital, pages->permit}, channel{std::move(stream), words} {}

Mapping StreamMemberPort::Wire::vital() const {
  return {pages, {reinterpret_cast<std::byte*>(&pages->vital), sizeof(VitalPage)}};
}

Mapping StreamMemberPort::Wire::permit() const {
  return {pages, {reinterpret_cast<std::byte*>(&pages->permit), sizeof(PermitPage)}};
}

StreamMemberPort::StreamMemberPort(FileDescriptor stream)
    : StreamMemberPort{std::make_unique<Wire>(std::move(stream))} {}

StreamMemberPort::StreamMemberPort(std::unique_ptr<Wire> wire)
    : MemberPort{wire->channel, wire->vital(), wire->permit()}, wire_{std::move(wire)} {}

}  // namespace hirosco::supervisor
