// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco {

/// One configuration follows another without a break (docs/adr/0096): all that the cycle needs for it, made by the service loop
/// beforehand. The cycle takes it over at the beginning of one of its steps, whole or not at all; then it is the service loop's again.
struct Reconfiguration {
  const descriptor::Configuration* from{nullptr};
  const descriptor::Configuration* to{nullptr};
  const descriptor::Bumpless* terms{nullptr};  ///< what the outputs are held to in that cycle
  pus::HousekeepingSampler* sampler{nullptr};  ///< of `to`; null: it reports nothing
  /// Room for what the parameters of `to` had before, one for each of its initial values, to go back to.
  std::vector<std::vector<std::byte>> before;

  [[nodiscard]] static Reconfiguration make(const descriptor::Configuration& from, const descriptor::Configuration& to,
                                            const descriptor::Bumpless& terms, const Dictionary& dictionary);
  /// Sets the initial values of `to`; an error has set none.  Realtime: bounded. Thread: the writer's.
  [[nodiscard]] Result<> set_values(Dictionary& dictionary) noexcept;
  /// Takes them back.  Realtime: bounded. Thread: the writer's.
  void restore_values(Dictionary& dictionary) noexcept { restore(dictionary, before.size()); }

 private:
  void restore(Dictionary& dictionary, std::size_t values) noexcept;
};

}  // namespace hirosco
