// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/processor_set.hpp"

// POSIX has no processor affinity: a set holds what it is told, and nobody can take it.
namespace hirosco {

ProcessorSet ProcessorSet::of_this_thread() noexcept { return {}; }
ProcessorSet ProcessorSet::of_thread(int /*thread*/) noexcept { return {}; }
Result<> ProcessorSet::take() const noexcept { return fail(ErrorCode::Unavailable, "POSIX has no processor affinity"); }
bool grants_processor(unsigned /*processor*/) noexcept { return false; }

}  // namespace hirosco
