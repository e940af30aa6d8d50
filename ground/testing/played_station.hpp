// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ground/api/session.hpp"
#include "ground/testing/workshop.hpp"

/// A station of the workshop whose spacecraft, devices and pages the test plays.
namespace hirosco::ground::testing {

/// A page that keeps what it is told; `pending` is what its network has not taken.
class PlayedPage final : public Peer {
 public:
  void send(std::string text) override { messages.push_back(nlohmann::json::parse(text)); }
  [[nodiscard]] std::size_t pending_octets() const override { return pending; }
  void close(std::uint16_t code, const std::string&) override { closed_with.push_back(code); }

  [[nodiscard]] std::vector<std::string> types() const {
    std::vector<std::string> all;
    for (const auto& message : messages) all.push_back(message["type"].get<std::string>());
    return all;
  }
  [[nodiscard]] std::size_t count(const std::string& type) const {
    return static_cast<std::size_t>(std::ranges::count(types(), type));
  }
  /// The newest of a type; null: there is none.
  [[nodiscard]] nlohmann::json last(const std::string& type) const {
    nlohmann::json found;
    for (const auto& message : messages)
      if (message["type"] == type) found = message;
    return found;
  }

  std::vector<nlohmann::json> messages;
  std::size_t pending{0};
  std::vector<int> closed_with;
};

class PlayedStation : public ::testing::Test {
 protected:
  static constexpr Duration batch = 50ms;

  struct AskedDevice {
    std::string device;
    std::string line;
    std::function<void(std::optional<std::string>)> answer;
  };
  /// A moment later, with the batch that is due then.
  void pass(Duration span) {
    for (Duration done{0}; done < span; done += batch) {
      clock.advance(batch);
      session.tick();
    }
  }
  void hears(const std::vector<std::byte>& octets) { EXPECT_TRUE(session.receive(octets)); }
  void runs_at(OnboardTime t, double speed) {
    hears(housekeeping(catalogue, drill_apid, 71, {{"DRILL.SPEED", speed}}, t));
  }
  /// Until nothing but the newest has to be told.
  void calm(std::vector<PlayedPage*> pages) {
    pass(batch);
    for (PlayedPage* one : pages) one->messages.clear();
  }
  [[nodiscard]] static nlohmann::json bore(const char* seat = "", const char* sender = "anna") {
    return {{"subsystem", "DRILL"},
            {"function", "BORE"},
            {"arguments", {{"DEPTH", 2.5}}},
            {"seat", seat},
            {"sender", sender}};
  }
  /// The spacecraft's report of ST[01] on the telecommand that was sent in this place.
  [[nodiscard]] std::vector<std::byte> verdict(std::size_t place, std::uint8_t subtype, OnboardTime t) const {
    const auto telecommand = *pus::TelecommandView::parse(sent.at(place));
    return packet_of(
        {.apid = telecommand.apid(), .service = 1, .subtype = subtype, .destination = telecommand.source(), .time = t},
        in_octets(telecommand.request_id()));
  }

  Catalogue catalogue{workshop()};
  std::unique_ptr<Archive> archive{std::move(*Archive::open(":memory:"))};
  ManualClock clock{opening};
  bool leaves{true};
  std::vector<std::vector<std::byte>> sent;
  std::vector<AskedDevice> asked;
  std::vector<StoredFault> injected;
  Session session{
      {.catalogue = catalogue,
       .archive = *archive,
       .clock = clock,
       .outside = {.send =
                       [this](Octets octets, Way) {
                         sent.emplace_back(octets.begin(), octets.end());
                         return leaves;
                       },
                   .ask_device = [this](const std::string& device, const std::string& line,
                                        auto answer) { asked.push_back({device, line, std::move(answer)}); },
                   .injected = [this] { return std::exchange(injected, {}); }}}};
};

}  // namespace hirosco::ground::testing
