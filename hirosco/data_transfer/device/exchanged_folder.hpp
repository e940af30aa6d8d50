// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hirosco/utilities/result.hpp"

/// Another folder in the place of one of device frames, while processes run (docs/adr/0236). A rule of Landlock is about the folder itself,
/// whatever its name is: who was let in to a folder is where its name leads from then on, and who was let in to the one before is there no more.
namespace hirosco {

/// The folder `spare` gets the place of the folder `place`, with its group, its rights and its frames: who has them open goes on with them, who
/// opens them finds them. The one that had the place is at `spare` then, without frames; what else was in either has gone along with it.
/// NotFound: there is no such folder; Mismatch: one of them is no folder, or has what cannot be taken along in the way of frames; NotPermitted: it
/// belongs to another user; Unavailable: frames came and went so often that none could be taken along. After an error all is as it was, but
/// the rights of the spare one.  Realtime: blocks. Thread: one at a time for each place.
[[nodiscard]] Result<> exchange_memory_folder(const std::string& spare, const std::string& place);

/// Whether a subsystem's side of the frames in this folder is open, whosever it is.  Realtime: blocks.
[[nodiscard]] bool is_open_by_a_subsystem(const std::string& place) noexcept;

/// Nothing is in it, or frames alone.  Realtime: blocks.
[[nodiscard]] bool holds_frames_at_most(const std::string& place) noexcept;

}  // namespace hirosco
