// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/last_moment.hpp"

#include <algorithm>

namespace hirosco::simulation {

LastMoment::LastMoment(SimulatedProcesses& processes, SimulatedKeeper& keeper) : keeper_{keeper} {
  for (const auto& process : processes.all()) {
    PermitPage& page = process->newest_permit();
    pages_.push_back({&page, page.epoch, page.stop, page.mode_epoch, page.newest_stop, page.powered.load(), page.go,
                      page.heartbeat});
  }
  const MutableOctets journal = keeper_.journal_memory();
  journal_.assign(journal.begin(), journal.end());
  for (std::size_t i = 0; i < enabled_.size(); ++i) enabled_[i] = keeper_.page().inhibits[i].go;
}

void LastMoment::put_back() {
  for (const Page& then : pages_) {
    then.page->epoch = then.epoch;
    then.page->stop = then.stop;
    then.page->mode_epoch = then.mode_epoch;
    then.page->newest_stop = then.newest_stop;
    then.page->powered = then.powered;
    then.page->go = then.go;
    then.page->heartbeat = then.heartbeat;
  }
  std::ranges::copy(journal_, keeper_.journal_memory().begin());
  for (std::size_t i = 0; i < enabled_.size(); ++i) keeper_.page().inhibits[i].go = enabled_[i];
}

}  // namespace hirosco::simulation
