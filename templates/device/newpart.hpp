// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <hirosco/subsystem/author/subsystem.hpp>

[[nodiscard]] std::unique_ptr<hirosco::Subsystem> make_newpart();
