// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hirosco {

/// "0.1.0": what CMakeLists.txt says, which is the one place that does.
extern const char version[];

/// "0.1.0 interface 3f2a9c0d17be": the version and what stands in every header that a module and who loads it have in common (an author's, and
/// those of the framework behind an author's class), as it was when this was built. Two parts of one program that differ in it do not agree on what their objects look like.
extern const char interface_version[];

}  // namespace hirosco
