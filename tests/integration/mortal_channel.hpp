// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "hirosco/data_transfer/channel/channel.hpp"

/// A supervisor that dies before or after a single message that it sends or takes (docs/adr/0093).
namespace hirosco::testing {

/// Counts the moments at which a supervisor may die, and lets it die in one of them.
struct Deaths {
  bool armed{false};
  int at{0};  ///< the moment in which it dies, from 1; 0: in none
  int passed{0};
  std::function<void()> dies;
  std::function<bool()> dying;
  /// Moments count from the message on, taken of a member, of which this says so; empty: from when it is armed.
  std::function<bool(const Message&)> begins;
  /// False: it is dead already.
  [[nodiscard]] bool moment() {
    if (dying && dying()) return false;
    if (!armed || ++passed != at) return true;
    dies();
    return false;
  }
};

class MortalChannel final : public Channel {
 public:
  MortalChannel(std::unique_ptr<Channel> channel, Deaths& deaths) : channel_{std::move(channel)}, deaths_{deaths} {}
  Result<> send(const Message& message) override {
    if (!deaths_.moment()) return ok();
    auto sent = channel_->send(message);
    static_cast<void>(deaths_.moment());
    return sent;
  }
  Result<Found> receive(MessageBuffer& buffer) override {
    if (deaths_.dying && deaths_.dying()) return Found{};
    auto found = channel_->receive(buffer);
    if (found && found->flow != Flow::None && deaths_.begins && deaths_.begins(found->message)) deaths_.armed = true;
    const bool lives = !found || found->flow == Flow::None || deaths_.moment();
    if (!lives) return Found{};
    return found;
  }

 private:
  std::unique_ptr<Channel> channel_;
  Deaths& deaths_;
};

}  // namespace hirosco::testing
