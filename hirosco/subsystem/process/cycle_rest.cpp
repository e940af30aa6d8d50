// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/cycle_rest.hpp"

#include <algorithm>

#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/word_wait.hpp"

namespace hirosco {

void rest_until(TimePoint planned, const CycleWait& wait, const Clock& clock) noexcept {
  if (wait.word == nullptr) return sleep_until(planned);
  // A sample that came meanwhile is no reason to ask the system for anything but the rest of the least distance.
  if (clock.now() < wait.earliest) sleep_until(std::min(wait.earliest, planned));
  while (wait_on_word(*wait.word, wait.seen, planned) == WordWait::Woken)
    sleep_until(std::min(clock.now() + wait.least, planned));
}

}  // namespace hirosco
