// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/value_store.hpp"

#include <thread>
#include <utility>

#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/semaphore.hpp"

namespace hirosco::supervisor {

ValueCopies& DirectValueStore::copies_of(std::string_view subsystem) {
  const auto found = copies_.find(subsystem);
  if (found != copies_.end()) return found->second;
  return copies_.emplace(subsystem, ValueCopies{disk_, folder_ / subsystem}).first->second;
}

void DirectValueStore::keep(std::string_view subsystem, ValueCopy copy) {
  const auto written = copies_of(subsystem).write(copy);
  outcomes_.push_back({std::string{subsystem}, copy.sequence, written ? std::nullopt : std::optional{written.error()}});
}

struct ThreadedValueStore::Work {
  Work(std::unique_ptr<ValueDisk> which, const std::filesystem::path& folder)
      : disk{std::move(which)}, store{*disk, folder} {}

  /// False when its work is over.
  [[nodiscard]] bool step() {
    wake.wait();
    for (;;) {
      std::string subsystem;
      ValueCopy copy;
      {
        const LockGuard lock{mutex};
        if (waiting.empty()) return !stopping;
        auto next = waiting.extract(waiting.begin());
        subsystem = next.key();
        copy = std::move(next.mapped());
      }
      std::vector<KeptOutcome> done;
      {
        const LockGuard lock{disk_mutex};
        store.keep(subsystem, std::move(copy));
        done = store.take_outcomes();
      }
      const LockGuard lock{mutex};
      for (KeptOutcome& each : done) outcomes.push_back(std::move(each));
    }
  }

  std::unique_ptr<ValueDisk> disk;
  Mutex disk_mutex;  ///< of `store`; held as long as the disk takes
  DirectValueStore store;
  Mutex mutex;  ///< of what follows; held for moments
  std::map<std::string, ValueCopy, std::less<>> waiting;
  std::vector<KeptOutcome> outcomes;
  bool stopping{false};
  Semaphore wake;
  Semaphore ended;
  std::thread thread;
};

ThreadedValueStore::ThreadedValueStore(const Clock& clock, std::unique_ptr<ValueDisk> disk,
                                       const std::filesystem::path& folder)
    : clock_{clock}, work_{std::make_shared<Work>(std::move(disk), folder)} {
  work_->thread = std::thread{[work = work_] {
    while (work->step()) {}
    work->ended.post();
  }};
}

ThreadedValueStore::~ThreadedValueStore() {
  {
    const LockGuard lock{work_->mutex};
    work_->stopping = true;
  }
  work_->wake.post();
  if (work_->ended.wait_until(clock_.now() + last_wait)) work_->thread.join();
  else work_->thread.detach();
}

TwoCopies ThreadedValueStore::read(std::string_view subsystem) {
  const LockGuard lock{work_->disk_mutex};
  return work_->store.read(subsystem);
}

void ThreadedValueStore::keep(std::string_view subsystem, ValueCopy copy) {
  {
    const LockGuard lock{work_->mutex};
    work_->waiting.insert_or_assign(std::string{subsystem}, std::move(copy));
  }
  work_->wake.post();
}

std::vector<KeptOutcome> ThreadedValueStore::take_outcomes() {
  const LockGuard lock{work_->mutex};
  return std::exchange(work_->outcomes, {});
}

}  // namespace hirosco::supervisor
