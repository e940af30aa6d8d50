// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hirosco::supervisor {

/// How a supervisor that goes on for one that died is met by who reads what members say (docs/adr/0093): Adoption, in subsystem_handling/.
class Succession {
 public:
  virtual ~Succession() = default;
  /// What members say waits: this supervisor could not answer yet.
  [[nodiscard]] virtual bool waits() const noexcept = 0;
  /// A member says that it looks at its new permit page.
  virtual void confirmed(std::uint16_t apid) = 0;
};

}  // namespace hirosco::supervisor
