// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/xml/reader.hpp"

/// Links of a URDF file that are fixed to each other: one body, written as several.
namespace hirosco::simulation {

/// MuJoCo takes each link by itself, and none with an inertia that no body has. Where such a link is fixed to others, all of them together
/// may well be a body: the one that carries them is given the mass and the inertia of all, the others have none. Everything else is left as it is.
/// Realtime: allocates.
void join_impossible_links(xml::Element& robot);

}  // namespace hirosco::simulation
