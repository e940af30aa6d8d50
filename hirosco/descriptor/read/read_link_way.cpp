// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <optional>
#include <string>

#include "hirosco/data_transfer/address/internet_address.hpp"
#include "hirosco/descriptor/read/detail/mission_link_reader.hpp"

/// How a mission wants a link to travel, and from where to where.
namespace hirosco::descriptor::detail {
namespace {

/// As one would write them.
[[nodiscard]] std::string methods_at_addresses() {
  std::string words;
  for (const LinkMechanism* mechanism : standard_link_mechanisms()) {
    const std::string word = fmt::format("method=\"{}\"", to_text(mechanism->method()));
    if (mechanism->ends_at() == LinkEndsAt::Addresses && words.find(word) == std::string::npos)
      words += (words.empty() ? "" : " or ") + word;
  }
  return words;
}

}  // namespace

void MissionLinkReader::read_way(Attributes& attributes, MissionLink& link) {
  if (const auto* method = attributes.optional("method")) {
    link.method = attributes.word<LinkMethod>(*method, method->value);
    if (link.method && std::ranges::find(standard_link_mechanisms(), *link.method, &LinkMechanism::method) ==
                           standard_link_mechanisms().end()) {
      problems_.not_built_in(*method, method->value, are_built_in(standard_link_mechanisms(), &LinkMechanism::method));
      link.method.reset();
    }
  }
  const auto from = read_link_address(attributes.optional("from_address"), link, link.from_address);
  const auto to = read_link_address(attributes.optional("to_address"), link, link.to_address);
  const auto* const at = attributes.optional(from ? "from_address" : "to_address");
  if (!from && !to) return;
  // An end of which nothing is said stands there.
  const InternetAddress here = read_internet_address("127.0.0.1").value();
  const InternetAddress one = from.value_or(here), other = to.value_or(here);
  if (one.family != other.family || one.loopback() != other.loopback())
    problems_.add(
        *at, "E0344", fmt::format("nothing goes from {} to {}", to_text(one), to_text(other)),
        "both ends IPv4 or both IPv6, both in this computer or both in a network; an end without address is at "
        "127.0.0.1");
}

std::optional<InternetAddress> MissionLinkReader::read_link_address(const xml::Attribute* at, const MissionLink& link,
                                                                    std::string& into) {
  if (at == nullptr) return std::nullopt;
  if (!link.method || ends_of(standard_link_mechanisms(), *link.method) != LinkEndsAt::Addresses) {
    problems_.add(*at, "E0343", fmt::format("'{}' of a link that may travel in memory", at->name),
                  fmt::format("add {}, or leave the address out", methods_at_addresses()));
    return std::nullopt;
  }
  const auto address = read_internet_address(at->value);
  if (!address) {
    problems_.add(*at, "E0217", fmt::format("{} is no address: {}", in_quotes(at->value), address.error().text),
                  "192.0.2.7, 192.0.2.7:4000, 2001:db8::7 or [2001:db8::7]:4000");
    return std::nullopt;
  }
  into = at->value;
  if (address->port != 0) link_addresses_.add(to_text(*address), place(at->value_at), problems_, at->value.size());
  return *address;
}

}  // namespace hirosco::descriptor::detail
