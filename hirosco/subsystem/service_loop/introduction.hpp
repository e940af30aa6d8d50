// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/pus/service/service_table.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/cycle/cycle.hpp"
#include "hirosco/subsystem/service_loop/introduced_ports.hpp"
#include "hirosco/subsystem/service_loop/mistake.hpp"
#include "hirosco/subsystem/service_loop/own_loops.hpp"
#include "hirosco/subsystem/service_loop/parameter_values.hpp"
#include "hirosco/subsystem/service_loop/requester.hpp"
#include "hirosco/subsystem/service_loop/subscriber.hpp"

namespace hirosco {

/// How an author introduces its parts in software_init() and offline(), compared with the descriptor: every difference is collected, so
/// that one look tells all of them.  Thread: the service loop.
class Introduction {
 public:
  struct Parts {
    Subsystem& author;
    const descriptor::SubsystemDescriptor& descriptor;
    pus::ServiceHome& home;
    ParameterValues& values;
    CycleLoop& cycle;
    ResourceMeter& resources;
    IntroducedPorts& ports;
    OwnLoops& loops;
    pus::ServiceTable& services;  ///< the author's own come behind the framework's
    Requester& requester;
    Subscriber& subscriber;
    ForeignParameters& foreign;
    ParameterCell& descriptor_in_force;
  };
  explicit Introduction(const Parts& parts) : parts_{parts} {}

  // --- by the author -------------------------------------------------------------------------------------------------
  void provide(CustomService& service);
  void publish(std::string_view name, ParameterCell& parameter);
  void require_link(std::string_view set, LinkInputPort& port);
  void lend_link(std::string_view set, LoanOutputPort& port);
  void use_device(std::string_view name, DevicePortBase& port, std::span<const std::string_view> settings);
  void use_event(EventPort& event);
  void use_request(const RequestPort& request, RequestHandler handler, Duration patience);
  void use_subscription(SubscriptionPort& heard);
  void bind_function(std::string_view name, BoundHandler handler);
  /// For one that announces its events by name: each that it declares counts as used.
  void uses_all_events() noexcept { uses_all_events_ = true; }

  // --- by the framework ----------------------------------------------------------------------------------------------
  /// One round of Software-Init: takes the author's pools, calls software_init(), and after its last publishes what is the framework's and
  /// looks for what was forgotten. Without the pools software_init() is not called.
  [[nodiscard]] Result<Step> step();
  /// All that Software-Init finds, tried in Offline before any flight. Nothing is kept of it.
  [[nodiscard]] std::vector<Mistake> try_all();
  void mistake(std::string problem) { mistake(Mistake{std::move(problem)}); }
  void mistake(Mistake made);
  [[nodiscard]] const std::vector<Mistake>& mistakes() const noexcept { return mistakes_; }
  void forget_mistakes() noexcept { mistakes_.clear(); }
  [[nodiscard]] std::string words_of(const Mistake& mistake) const;
  /// One round of Software-Deinit: calls software_deinit() where software_init() was called, and after its last forgets all and gives the
  /// author's pools back. What blocks of them he holds still is an error. `cycle_rests`: else nothing is forgotten and given back yet.
  [[nodiscard]] Result<Step> undo(bool cycle_rests);
  /// In Offline, while the cycle rests: what undo() left behind, as the cycle did not rest, the author failed or was too late, or held
  /// blocks. An error: he holds some still, which has not been said since they were taken.
  [[nodiscard]] Result<> undo_late();

 private:
  /// Nothing of what the author named is called or looked at any more, and no block of his pools is given.
  void forget();
  [[nodiscard]] Result<> give_pools_back();
  void check();
  [[nodiscard]] std::string short_words_of(const Mistake& mistake) const;

  Parts parts_;
  std::vector<CustomService*> own_services_;
  std::vector<std::uint16_t> used_events_;
  bool uses_all_events_{false};
  bool begun_{false};  ///< software_init() was called since forget()
  bool pools_told_{false};  ///< that they stay
  std::vector<Mistake> mistakes_;  ///< all of them fail the same Software-Init
  std::string text_;  ///< of an error, which does not own its words
};

}  // namespace hirosco
