// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/parameter/write_queue.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "hirosco/subsystem/service_loop/cycle_orders.hpp"
#include "hirosco/subsystem/service_loop/foreign_parameters.hpp"
#include "hirosco/subsystem/service_loop/situation.hpp"
#include "hirosco/utilities/os/mutex.hpp"

namespace hirosco {

class CycleLoop;

/// The parameters of a subsystem and how they are set: by the cycle at its boundary, by the service loop while that rests.
/// Thread: the service loop.
class ParameterValues final : public pus::ParameterAccess {
 public:
  /// `cycle` is asked which it sets itself, later.
  ParameterValues(const descriptor::SubsystemDescriptor& descriptor, const Situation& at, const CycleOrders& orders,
                  const CycleLoop& cycle);

  [[nodiscard]] Dictionary& dictionary() noexcept { return dictionary_; }
  [[nodiscard]] WriteQueue& writes() noexcept { return writes_; }
  /// Of the descriptor: no Software-Init succeeds. Empty: none.
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }

  /// Software-Init has published them: from now on they hold values, not only places for them.
  [[nodiscard]] Result<> initialise();
  [[nodiscard]] bool initialised() const noexcept { return initialised_; }
  /// Before they are taken from the dictionary: what persistent ones begin with next time.
  void remember_persistent();
  /// Sets one, packed and big-endian, at the next boundary of the cycle. False: there is no room now.
  bool set(std::size_t index, Octets big_endian);
  [[nodiscard]] Result<> store(const ParameterCell& parameter, Octets big_endian);
  /// What waits is set now: the cycle rests.
  void apply() { writes_.apply(dictionary_); }
  /// What waits is set if the cycle rests.
  void apply_at_rest();
  /// What is heard of others comes into a parameter as what a telecommand sets, without asking whether one may.
  [[nodiscard]] ForeignParameters::Home foreign_home(std::function<void(std::uint16_t parameter)> tell);

  // --- for ST[20] in a loop of its own (docs/adr/0200), under that loop's lock: also its thread -----------------------
  /// As check_write(), by the state that the loop knows.
  [[nodiscard]] std::expected<void, pus::FailureCode> check_write_in(State state, std::uint32_t parameter,
                                                                     Octets value) const;
  /// As submit_write(), but whoever is the writer sets them: the cycle at its boundary, the service loop in its next step.
  [[nodiscard]] std::expected<void, pus::FailureCode> queue(std::span<const pus::ParameterAccess::Write> writes);
  /// Held by that loop from its last look at the state until it has queued, and by the service loop where it tells the cycle of another
  /// state and where it hears that it is there: what the state before alone permits is queued before that, or not at all. The cycle never
  /// holds it.
  [[nodiscard]] Mutex& judging() noexcept { return judging_; }
  /// Under judging(): the state that the cycle was sent into and is not known to be in. Thread: set by the service loop.
  void send_into(std::optional<State> state) noexcept { sent_into_ = state; }
  [[nodiscard]] std::optional<State> sent_into() const noexcept { return sent_into_; }

  // ParameterAccess; the first two also for that loop.
  std::expected<std::size_t, ErrorCode> read(std::uint32_t parameter, MutableOctets big_endian) override;
  std::size_t size_of(std::uint32_t parameter) override;
  std::expected<void, pus::FailureCode> check_write(std::uint32_t parameter, Octets value) override;
  std::expected<void, pus::FailureCode> submit_write(std::span<const pus::ParameterAccess::Write> writes,
                                                     const pus::Request& request) override;

 private:
  const descriptor::SubsystemDescriptor& descriptor_;
  const Situation& at_;
  const CycleOrders& orders_;
  const CycleLoop& cycle_;
  std::string problem_;  ///< before the dictionary, whose making may fill it
  Dictionary dictionary_;
  WriteQueue writes_{32, 2048};
  Mutex judging_;
  std::optional<State> sent_into_;  ///< under judging_
  bool initialised_{false};
};

}  // namespace hirosco
