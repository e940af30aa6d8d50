// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/xml/reader.hpp"

/// Links of a URDF file that MuJoCo would refuse one by one, and that are no reason to refuse the robot.
namespace hirosco::simulation {

/// MuJoCo takes each link by itself, and none with an inertia that no body has. Where such a link is fixed to others, all of them together
/// may well be a body: the one that carries them is given the mass and the inertia of all, the others have none. Everything else is left as it is.
/// Realtime: allocates.
void join_impossible_links(xml::Element& robot);

/// A shoulder whose axes meet is three joints in a URDF file, with links of nothing between them, or points. MuJoCo takes no such link, though what
/// they carry is all that has to be moved: each that a joint moves, and that carries another joint, is given next to nothing where it, with
/// what is fixed to it, has no moment about any axis. One that carries none is left as it is, and refused.  Realtime: allocates.
void fill_links_between(xml::Element& robot);

}  // namespace hirosco::simulation
