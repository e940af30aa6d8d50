// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// A rig and what stands behind it: Rig::channels, vital, permit and subsystem are complete here. For tests of the framework; an author has
/// rig.hpp (docs/adr/0187).
