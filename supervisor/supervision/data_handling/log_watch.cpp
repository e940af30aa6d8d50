// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/log_watch.hpp"

namespace hirosco::supervisor {

namespace {
constexpr Duration patience = 1s;
}

void LogWatch::provide() {
  own_.on_function("SET_DATABASE", [this](double strategy) -> Outcome {
    auto database = open_database_(static_cast<DatabaseStrategy>(strategy));
    if (!database) return refused(pus::FailureCode::ExecutionError);
    craft_.tell("log switched to " + std::string{database->strategy()});
    craft_.log.switch_to(std::move(database));
    return ok();
  });
}

void LogWatch::watch(TimePoint now) {
  const StoreTrouble trouble = craft_.log.trouble();
  // Somebody who deletes the log in a loop does not fill the console: the text carries the count.
  const bool news = trouble.count != told_troubles_ && (told_troubles_ == 0 || now - told_at_ >= patience);
  if (news) {
    told_troubles_ = trouble.count;
    told_at_ = now;
    craft_.tell(trouble.text, supervisor_apid);
    own_.announce(trouble.fault == StoreFault::Damaged ? "LOG_DAMAGED" : "LOG_STORE");
  }
  const auto waiting_since = telecommands_.waiting_since();
  const bool failing = craft_.log.failure().has_value() || (waiting_since && now - *waiting_since > patience);
  if (failing == failing_) return;
  failing_ = failing;
  craft_.tell(failing ? "log storage fails: telecommands that must be durable are held back" : "log storage works",
              supervisor_apid);
  if (failing && !news) own_.announce("LOG_STORE");
}

}  // namespace hirosco::supervisor
