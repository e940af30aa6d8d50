// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hirosco/pus/service/service_table.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/service_loop/own_loops.hpp"
#include "hirosco/subsystem/service_loop/parameter_values.hpp"
#include "hirosco/subsystem/service_loop/permit_pages.hpp"
#include "hirosco/subsystem/service_loop/reports.hpp"
#include "hirosco/subsystem/service_loop/requester.hpp"
#include "hirosco/subsystem/service_loop/situation.hpp"
#include "hirosco/subsystem/service_loop/subscriber.hpp"

namespace hirosco {

/// What comes from the supervisor: telecommands to the services that they are for, reports of others, permit pages.
/// Thread: the service loop.
class Incoming {
 public:
  struct Parts {
    Subsystem& author;
    const descriptor::SubsystemDescriptor& descriptor;
    Channel& channel;
    const Situation& at;
    PermitPages& permit;
    OwnLoops& loops;
    ParameterValues& values;
    const pus::ServiceTable& services;
    Requester& requester;
    Subscriber& subscriber;
    Reports& reports;
  };
  explicit Incoming(const Parts& parts) : parts_{parts} {}

  /// Takes what has come, 64 messages at most, while the answers to it have room.
  void receive();

 private:
  void dispatch(const Message& message);
  void follow_mode();

  Parts parts_;
  std::uint32_t mode_epoch_{0};  ///< of the mode that was in force with the newest telecommand
};

}  // namespace hirosco
