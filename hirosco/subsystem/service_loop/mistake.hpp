// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "hirosco/descriptor/model/location.hpp"

namespace hirosco {

/// What an author did not do as the descriptor says, in words.
struct Mistake {
  std::string text;
  std::optional<descriptor::Location> at{};  ///< in the descriptor, where it is about one place there
  const char* code{"E0406"};  ///< as `hirosco check` tells it (docs/descriptor-errors.md)
  std::string remedy{};  ///< what to do, where the text does not say it
  friend bool operator==(const Mistake& a, const Mistake& b) { return a.text == b.text && a.at == b.at; }
};

}  // namespace hirosco
