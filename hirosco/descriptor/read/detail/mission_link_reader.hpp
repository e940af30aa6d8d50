// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/address/internet_address.hpp"
#include "hirosco/descriptor/read/detail/mission_draft.hpp"

namespace hirosco::descriptor::detail {

/// Two sets that a link is to join, each as one of the configurations has it.
struct LinkEnds {
  const SubsystemDescriptor& producer;
  const Configuration& giving;
  const Provides& provides;
  const SubsystemDescriptor& consumer;
  const Configuration& taking;
  const Requires& requires_;
};

/// What the mechanisms of this platform carry.
[[nodiscard]] bool carried_here(LinkMethod method, LinkKind kind, bool wakes);
/// What a sample of the set has.
[[nodiscard]] std::vector<Field> fields_of_sample(const SubsystemDescriptor& producer, const Provides& set);
/// Why the producer's set cannot feed the consumer's, by this method where there is one; empty when it can. By the words of the
/// handshake in flight, which decides anew.
[[nodiscard]] std::string mismatch(const LinkEnds& ends, std::optional<LinkMethod> method);

/// Reads <Links>: which sets are joined, how they travel, and what the loss of one does.
class MissionLinkReader {
 public:
  explicit MissionLinkReader(MissionDraft& draft) : draft_{draft}, problems_{draft.problems}, mission_{draft.mission} {}
  void read_links(const xml::Element& element);

 private:
  void read_link(const xml::Element& element);
  /// "A.SET" split and its subsystem found.
  [[nodiscard]] const SubsystemDescriptor* read_end(Attributes& attributes, std::string_view name,
                                                    std::string& subsystem, std::string& set);
  void check_link(const xml::Element& element, const SubsystemDescriptor& producer, const SubsystemDescriptor& consumer,
                  const MissionLink& link);
  // read_link_loss.cpp
  void read_loss(Attributes& attributes, const SubsystemDescriptor* consumer, MissionLink& link);
  // read_link_way.cpp
  void read_way(Attributes& attributes, MissionLink& link);
  [[nodiscard]] std::optional<InternetAddress> read_link_address(const xml::Attribute* at, const MissionLink& link,
                                                                 std::string& into);

  MissionDraft& draft_;
  Problems& problems_;
  Mission& mission_;
  Unique link_ids_{"link id", "E0202"};
  Unique link_addresses_{"address of a link", "E0313"};
};

}  // namespace hirosco::descriptor::detail
