// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <thread>

#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/author/module.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"

namespace {

using namespace hirosco;

/// The cycle counts what it sees; the archive's loop sorts that, and answers what has been sorted.
class Catalogue final : public Subsystem {
  Result<> offline() override {
    archive_.on_request("COUNT", [this](Call call) -> Result<> { return archive_.report("COUNTED", call, sorted_); });
    // What no author means to do.
    archive_.on_request("HANG", [](std::uint16_t for_ms) -> Result<> {
      std::this_thread::sleep_for(std::chrono::milliseconds{for_ms});
      return ok();
    });
    archive_.on_step([this](TimePoint) { sort(); });
    provide(archive_);
    return ok();
  }

  Result<Step> software_init() override {
    publish("SEEN", seen_);
    publish("SORTED", shown_);
    publish("RATE_HZ", rate_hz_);
    publish("PAGE", page_);
    return done;
  }

  Result<> look() noexcept {
    seen_.store(seen_.load() + 1);
    return ok();
  }
  Result<> safe_operational(const Cycle&) noexcept override { return look(); }
  Result<> operational(const Cycle&) noexcept override { return look(); }
  /// Nothing but a count is remembered, and it goes on.
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    return ok();
  }

  /// In the archive's loop, whole pages: the cycle's values as snapshots, its own by store().
  void sort() {
    std::uint32_t seen = 0, page = 0;
    if (!seen_.snapshot(seen) || !page_.snapshot(page)) return;
    if (page == 0) return;  // no value is its own before it is published
    seen -= seen % page;
    if (seen != sorted_ && archive_.store(shown_, seen)) sorted_ = seen;
  }

  CustomService archive_{"ARCHIVE"};
  Parameter<std::uint32_t> seen_, shown_;
  Parameter<std::uint32_t> page_;  ///< so many are sorted at once; ST[20] sets it, in a loop of its own
  Parameter<double> rate_hz_;
  std::uint32_t sorted_{0};  ///< of the archive's loop alone
};

std::unique_ptr<Subsystem> make_catalogue() { return std::make_unique<Catalogue>(); }

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_catalogue>; }
