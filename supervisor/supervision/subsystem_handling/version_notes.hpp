// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "hirosco/utilities/octets.hpp"

/// Which versions of programs are in force and on trial, as a supervisor notes it for the next one (docs/adr/0114).
namespace hirosco::supervisor {

/// By APID; empty: the mission's own executable.
using Versions = std::map<std::uint16_t, std::string>;

struct VersionNotes {
  /// One whose version, or text, is there or may be.
  struct OnTrial {
    std::uint16_t apid{};
    std::string wanted;
    std::string before;
  };
  Versions in_force, earlier;
  std::vector<OnTrial> on_trial;
};

inline void write(OctetWriter& writer, const VersionNotes& notes) {
  const auto put = [&](const std::string& text) {
    writer.put(static_cast<std::uint8_t>(text.size())).put(std::as_bytes(std::span{text}));
  };
  for (const Versions* versions : {&notes.in_force, &notes.earlier}) {
    writer.put(static_cast<std::uint16_t>(versions->size()));
    for (const auto& [apid, version] : *versions) {
      writer.put(apid);
      put(version);
    }
  }
  writer.put(static_cast<std::uint16_t>(notes.on_trial.size()));
  for (const auto& each : notes.on_trial) {
    writer.put(each.apid);
    put(each.wanted);
    put(each.before);
  }
}

/// What cannot be read `reader` tells.
[[nodiscard]] inline VersionNotes read_version_notes(OctetReader& reader) {
  const auto get = [&] {
    const Octets text = reader.get(reader.get<std::uint8_t>());
    return std::string{reinterpret_cast<const char*>(text.data()), text.size()};
  };
  VersionNotes notes;
  for (Versions* versions : {&notes.in_force, &notes.earlier})
    for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
      const auto apid = reader.get<std::uint16_t>();
      (*versions)[apid] = get();
    }
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    VersionNotes::OnTrial each{.apid = reader.get<std::uint16_t>(), .wanted = {}, .before = {}};
    each.wanted = get();
    each.before = get();
    notes.on_trial.push_back(std::move(each));
  }
  return notes;
}

}  // namespace hirosco::supervisor
