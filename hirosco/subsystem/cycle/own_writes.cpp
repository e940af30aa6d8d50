// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/own_writes.hpp"

namespace hirosco {

OwnWrites::OwnWrites(const descriptor::SubsystemDescriptor& descriptor, const Dictionary& dictionary)
    : descriptor_{descriptor}, dictionary_{dictionary} {
  parameters_ = descriptor_.parameters.size();
  own_writes_ = std::make_unique<std::atomic<std::uint8_t>[]>(parameters_);
}

void OwnWrites::begin() {
  watched_.clear();
  for (std::size_t i = 0; i < parameters_; ++i) {
    own_writes_[i].store(0, std::memory_order_relaxed);
    const ParameterCell* cell = dictionary_.cell(i);
    if (descriptor_.parameters[i].writable() && cell != nullptr)
      watched_.push_back({cell, 0, static_cast<std::uint16_t>(i)});
  }
}

void OwnWrites::note_stores() noexcept {
  for (Watched& watched : watched_) watched.stores = watched.cell->stores();
}

void OwnWrites::note_own_writes() noexcept {
  for (const Watched& watched : watched_) {
    const std::uint8_t own = watched.cell->stores() != watched.stores ? 1 : 0;
    own_writes_[watched.parameter].store(own, std::memory_order_relaxed);
  }
}

}  // namespace hirosco
