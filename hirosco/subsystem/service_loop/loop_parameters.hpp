// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/pus/service/service.hpp"
#include "hirosco/subsystem/service_loop/parameter_values.hpp"

namespace hirosco {

/// The parameters of a subsystem as ST[20] has them in a loop of its own (docs/adr/0200): read as whole snapshots, set by the queue of
/// writes, judged by the state in which the loop handles the request, and once more where they are queued. It is never the writer, whether
/// the cycle runs or rests.
/// Thread: that loop's, under its lock: what the dictionary and the descriptor have does not change meanwhile.
class LoopParameters final : public pus::ParameterAccess {
 public:
  LoopParameters(ParameterValues& values, const pus::ServiceHome& home) : values_{values}, home_{home} {}

  std::expected<std::size_t, ErrorCode> read(std::uint32_t parameter, MutableOctets big_endian) override {
    return values_.read(parameter, big_endian);
  }
  std::size_t size_of(std::uint32_t parameter) override { return values_.size_of(parameter); }
  std::expected<void, pus::FailureCode> check_write(std::uint32_t parameter, Octets value) override {
    return values_.check_write_in(home_.state(), parameter, value);
  }
  std::expected<void, pus::FailureCode> submit_write(std::span<const Write> writes, const pus::Request&) override {
    // The service loop has gone on since: none is told to the cycle until these are queued, and one that was told has to permit them, too.
    const LockGuard lock{values_.judging()};
    for (const Write& write : writes) {
      if (auto still = check_write(write.id, write.value); !still) return still;
      if (!values_.sent_into()) continue;
      if (auto there = values_.check_write_in(*values_.sent_into(), write.id, write.value); !there) return there;
    }
    return values_.queue(writes);
  }

 private:
  ParameterValues& values_;
  const pus::ServiceHome& home_;
};

}  // namespace hirosco
