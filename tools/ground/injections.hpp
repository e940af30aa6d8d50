// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ground/archive/records.hpp"
#include "hirosco/utilities/time.hpp"

/// What was injected into the simulated devices of a flight, whoever did it: each device writes it beside its control socket.
namespace hirosco::ground {

class Injections {
 public:
  /// From what is written from now on. `clock` outlives it, and counts as those of the devices do.
  Injections(std::filesystem::path folder, std::vector<std::string> devices, const Clock& clock);
  /// Those since the last call, in the order of the devices.
  [[nodiscard]] std::vector<StoredFault> poll();

 private:
  [[nodiscard]] std::filesystem::path file_of(const std::string& device) const {
    return folder_ / (device + ".injected");
  }
  std::filesystem::path folder_;
  std::map<std::string, std::uint64_t> read_;  ///< octets, by device
  const Clock& clock_;
};

}  // namespace hirosco::ground
