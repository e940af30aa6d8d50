// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ground/api/application.hpp"
#include "ground/archive/archive.hpp"
#include "ground/link/way.hpp"
#include "ground/model/catalogue.hpp"
#include "ground/model/model.hpp"

/// The ground station without sockets: takes octets and points in time, says what to send. Thread: one.
namespace hirosco::ground {

/// What the session asks of the shell around it.
struct Surroundings {
  /// Sends a telecommand to the spacecraft; false when it certainly does not leave. One that then could not leave after
  /// all comes back by `not_sent`.
  std::function<bool(Octets, Way)> send;
  /// One line to the control socket of a simulated device; the answer comes later, empty when nobody answers.
  std::function<void(const std::string& device, const std::string& line,
                     std::function<void(std::optional<std::string>)>)>
      ask_device;
};

/// Why a request was not done, as an HTTP status.
struct Refusal {
  unsigned status{400};
  std::string text;
};
template <class T>
using Answered = std::expected<T, Refusal>;

class Client;

class Session {
 public:
  struct Parts {
    const Catalogue& catalogue;
    Archive& archive;
    const Clock& clock;
    Surroundings outside;
    std::uint16_t source{0x2000};  ///< of its telecommands (decision 27)
    std::uint16_t first_count{0};
  };
  explicit Session(Parts parts);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // --- the link -----------------------------------------------------------------------------------------------------
  void link_up();
  void link_down();
  /// A telecommand that was to be sent has not left: its sender is told.
  void not_sent(Octets packet);
  /// Octets of the telemetry stream as they come, in pieces of any size. False: this is no telemetry, close the link.
  [[nodiscard]] bool receive(Octets octets);
  /// Batches to the clients, limits of time. Call 20 times a second.
  void tick();

  // --- clients ------------------------------------------------------------------------------------------------------
  /// Client::id of a new client; it is told everything at once. `peer` lives until closed().
  std::string opened(Peer& peer, bool is_operator);
  void received(const Peer& peer, const std::string& text);
  void closed(const Peer& peer);
  /// Whether this client looks at the past: its commands are refused.
  [[nodiscard]] bool in_replay(const std::string& client) const;

  // --- requests (bodies as in ground/api/README.md) -----------------------------------------------------------------
  [[nodiscard]] Answered<nlohmann::json> command(const nlohmann::json& body);
  /// Answers through `done`, at the latest after 2 s.
  void preview(const nlohmann::json& body, std::function<void(Answered<nlohmann::json>)> done);
  void fault(const nlohmann::json& body, std::function<void(Answered<nlohmann::json>)> done);
  [[nodiscard]] nlohmann::json status() const;

  [[nodiscard]] const Catalogue& catalogue() const noexcept { return parts_.catalogue; }
  [[nodiscard]] Archive& archive() const noexcept { return parts_.archive; }
  [[nodiscard]] const Model& model() const noexcept { return model_; }
  /// On-board time now as far as the ground can tell.
  [[nodiscard]] OnboardTime now() const;
  [[nodiscard]] std::size_t client_count() const noexcept { return clients_.size(); }

 private:
  friend class Client;
  struct Open {
    StoredCommand command;  ///< as its last report left it: pages hear of it even when the disk is full
    TimePoint since{};
  };
  struct Prepared {
    const descriptor::Subsystem* subsystem{};
    std::string function;
    std::uint8_t service{};
    std::uint8_t subtype{};
    Way way{Way::InTurn};
    std::string arguments;  ///< a JSON object with the values that are sent
    std::vector<std::byte> data;
  };
  [[nodiscard]] Answered<Prepared> prepare(const nlohmann::json& body) const;
  [[nodiscard]] Answered<std::vector<std::byte>> packet_of(std::uint16_t apid, std::uint8_t service,
                                                           std::uint8_t subtype, std::uint8_t ack, Octets data,
                                                           std::uint16_t count) const;
  void take_packet(Octets octets);
  void count_lost(const pus::TelemetryView& packet);
  void add_gap(OnboardTime from, OnboardTime to);
  void take_verdict(const Verdict& verdict, OnboardTime t);
  /// The copy of a telecommand of another ground, before the reports on it.
  void take_copy(Octets packet, OnboardTime t);
  /// A telecommand of another ground without a copy: known is whom it went to and what became of it.
  [[nodiscard]] Open add_foreign(const Verdict& verdict, OnboardTime t);
  void take_answer(const PermissionAnswer& answer);
  void expire(TimePoint now);
  [[nodiscard]] nlohmann::json link_json() const;
  [[nodiscard]] std::uint16_t next_count();
  void broadcast(const nlohmann::json& message);

  Parts parts_;
  Model model_;
  std::vector<std::byte> stream_;
  bool connected_{false};
  bool fresh_link_{false};
  TimePoint newest_received_{};
  std::uint64_t received_{0}, sent_{0}, lost_{0}, damaged_{0};
  std::map<std::uint16_t, std::pair<std::uint16_t, OnboardTime>> expected_;  ///< by APID: next count, last time
  std::optional<OnboardTime> last_known_;  ///< end of what the archive has before this link

  std::map<std::pair<std::uint16_t, std::uint32_t>, Open> open_commands_;  ///< by destination and request id
  struct Question {
    std::string octets;
    std::function<void(Answered<nlohmann::json>)> done;
    TimePoint since{};
  };
  std::multimap<std::uint32_t, Question> questions_;
  std::uint16_t count_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::uint64_t next_client_{1};
  TimePoint next_housekeeping_{};
};

}  // namespace hirosco::ground
