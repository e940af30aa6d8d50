// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ground/model/catalogue.hpp"

namespace hirosco::ground {

/// The interface document of a mission, as Markdown: every packet that it tells and takes, with the place of each octet, from its
/// descriptors. The same catalogue gives the same octets.
[[nodiscard]] std::string interface_document(const Catalogue& catalogue);

}  // namespace hirosco::ground
