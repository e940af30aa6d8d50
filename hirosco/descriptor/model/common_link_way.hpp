// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <optional>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/time.hpp"

/// What two ends of a real-time link have in common. Asked by the reader of a mission and by the handshake in flight (decision 20), so that what the
/// one takes the other one does not refuse.
namespace hirosco::descriptor {

/// Whether a mechanism of the platform carries links of this method and kind, and, where `wakes`, its producer wakes a consumer.
using Carried = std::function<bool(LinkMethod, LinkKind, bool wakes)>;

struct LinkWay {
  LinkMethod method{};
  LinkKind kind{};
};

/// The first method of the producer, and kind of it with that, which the consumer has, too, and which are carried together: each alone may be common
/// while nothing carries both.
[[nodiscard]] inline std::optional<LinkWay> first_common_way(const LinkTerms& producer, const LinkTerms& consumer,
                                                             bool wakes, const Carried& carried) {
  const auto has = [](const auto& list, auto value) { return std::ranges::find(list, value) != list.end(); };
  for (const LinkMethod by : producer.methods)
    for (const LinkKind of : producer.kinds)
      if (has(consumer.methods, by) && has(consumer.kinds, of) && carried(by, of, wakes)) return LinkWay{by, of};
  return std::nullopt;
}

/// One period is a whole multiple of the other.
[[nodiscard]] constexpr bool rates_fit(Duration producer, Duration consumer) noexcept {
  const bool positive = producer.count() > 0 && consumer.count() > 0;
  return positive && (producer % consumer == Duration{} || consumer % producer == Duration{});
}

}  // namespace hirosco::descriptor
