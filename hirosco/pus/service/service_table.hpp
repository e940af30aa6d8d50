// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "hirosco/pus/service/service.hpp"

namespace hirosco::pus {

/// The services of an application process: in the order in which they came, and each by its type, which is what every telecommand asks
/// for.  Realtime: find() is wait-free; add() allocates. Thread: one.
class ServiceTable {
 public:
  ServiceTable() = default;
  ServiceTable(std::initializer_list<Service*> services) {
    for (Service* const service : services) add(*service);
  }
  /// Of two with one type the first is found.
  void add(Service& service) {
    all_.push_back(&service);
    if (Service*& place = by_type_[service.type()]; place == nullptr) place = &service;
  }
  /// Null: there is none of this type.
  [[nodiscard]] Service* find(std::uint8_t type) const noexcept { return by_type_[type]; }
  [[nodiscard]] const std::vector<Service*>& all() const noexcept { return all_; }

 private:
  std::vector<Service*> all_;
  std::array<Service*, 256> by_type_{};
};

}  // namespace hirosco::pus
