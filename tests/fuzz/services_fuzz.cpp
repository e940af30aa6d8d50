// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "tests/fuzz/fuzz.hpp"

/// Telecommands of any service to a subsystem that is Operational, with whatever data: each is accepted or refused once, what the subsystem says is
/// of its shape (which the rig sees to), and it still answers. In an input each has its service, its subtype, how many octets of data, and these.
namespace {

using namespace hirosco;
using fuzz::expect;
using testing::Sent;

constexpr int most_telecommands = 8;
constexpr std::uint8_t test_service = 17, are_you_alive = 1;

[[nodiscard]] bool judged_once(const std::string& outcome) {
  const bool accepted = outcome == "1" || outcome.starts_with("1 ");
  // Nothing of ST[01] but an acceptance is told of by "1", and nothing but a refusal by "2".
  const std::string later = outcome.substr(std::min<std::size_t>(outcome.size(), 1));
  return (accepted || outcome.starts_with("2:")) && later.find(" 1") == std::string::npos &&
         later.find(" 2:") == std::string::npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  testing::Probe probe;
  testing::Rig rig{probe, testing::probe_descriptor};
  rig.bring_to(State::Operational);
  std::vector<Sent> sent;
  OctetReader reader{fuzz::octets_of(data, size)};
  for (int count = 0; count < most_telecommands && reader.remaining() != 0; ++count) {
    const auto service = reader.get<std::uint8_t>();
    const auto subtype = reader.get<std::uint8_t>();
    const std::size_t octets = reader.get<std::uint8_t>();
    if (!reader.good()) break;
    sent.push_back(rig.send(service, subtype, reader.get(std::min(octets, reader.remaining()))));
    rig.settle(3);
  }
  sent.push_back(rig.send(test_service, are_you_alive, {}));
  // A change of state may wait for a device that nobody plays here.
  for (int i = 0; i < 5; ++i) {
    rig.settle(3);
    rig.advance(std::chrono::milliseconds{500});
  }
  rig.settle();
  for (const Sent& each : sent) {
    const std::string outcome = rig.outcome(each);
    expect(judged_once(outcome), "a telecommand is accepted or refused, once");
    if (outcome.ends_with(" 7") && each.id != sent.back().id) fuzz::taken();
  }
  expect(rig.outcome(sent.back()).ends_with(" 7") || rig.state() == State::Offline,
         "whoever was asked anything still answers");
  return 0;
}
