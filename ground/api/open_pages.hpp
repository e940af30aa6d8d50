// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "ground/api/application.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::ground {

class Client;
class Session;

/// The pages that are open here, of operators and observers. Thread: one.
class OpenPages {
 public:
  explicit OpenPages(Session& session);
  ~OpenPages();
  OpenPages(const OpenPages&) = delete;
  OpenPages& operator=(const OpenPages&) = delete;

  /// Client::id of a new client; it is told everything at once. `peer` lives until closed(); `seat` as in Authority, "" = none.
  std::string opened(Peer& peer, bool is_operator, const std::string& seat = {});
  void received(const Peer& peer, const std::string& text);
  void closed(const Peer& peer);

  /// To all of them.
  void tell(const nlohmann::json& message);
  /// Where it has changed since it was told.
  void tell_who_is_here();
  void tick(TimePoint now);

  /// {pages: [{client, seat, name, operator, replay}], operators, observers}: who has a page open here; of more than
  /// most_present the first, the counts are of all.
  [[nodiscard]] nlohmann::json present() const;
  static constexpr std::size_t most_present = 32;
  /// As in Authority, those of observers are "".
  [[nodiscard]] std::set<std::string> seats() const;
  /// Whether this client looks at the past: its commands are refused.
  [[nodiscard]] bool in_replay(const std::string& client) const;
  [[nodiscard]] std::size_t count() const noexcept { return clients_.size(); }

 private:
  Session& session_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::uint64_t next_client_{1};
  bool changed_{false};  ///< who has a page open, since it was told
};

}  // namespace hirosco::ground
