// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// Two files or folders of one file system get each other's names, at once: at no moment is there nobody of either. NotPermitted: they are of
/// another user; SystemFailure: anything else that the system says; Unavailable: this system cannot.  Realtime: blocks.
[[nodiscard]] Result<> exchange_names(const std::string& one, const std::string& other) noexcept;

}  // namespace hirosco
