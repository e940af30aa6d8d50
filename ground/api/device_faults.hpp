// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/model/answered.hpp"
#include "ground/model/catalogue.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::ground {

/// What is injected into simulated devices, by clients here and by whoever else: asked for, kept and told, each once. Thread: one.
class DeviceFaults {
 public:
  /// The first two as in Surroundings.
  struct Parts {
    std::function<void(const std::string& device, const std::string& line,
                       std::function<void(std::optional<std::string>)>)>
        ask_device;
    std::function<std::vector<StoredFault>()> injected;
    const Catalogue& catalogue;
    Archive& archive;
    std::function<OnboardTime()> now;
    std::function<void(const nlohmann::json& message)> tell;  ///< to all pages
  };
  explicit DeviceFaults(Parts parts) : parts_{std::move(parts)} {}

  /// Body as in ground/api/README.md.
  void inject(const nlohmann::json& body, std::function<void(Answered<nlohmann::json>)> done);
  /// What others have injected.
  void tick(TimePoint now);

 private:
  void keep(const StoredFault& fault);
  /// One that a client asked for here, and takes it off those that are known.
  [[nodiscard]] bool is_own(const std::string& device, const std::string& line);

  Parts parts_;
  TimePoint next_look_{};
  std::deque<std::pair<std::string, std::string>> own_;  ///< device and line, until that tells of it, too
};

}  // namespace hirosco::ground
