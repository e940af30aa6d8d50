// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/testing/report_shape.hpp"
#include "hirosco/pus/testing/vectors.hpp"

/// A sink that keeps what it is given, which is to be of its shape, and telecommands for services, for tests here and above.
namespace hirosco::pus::testing {

struct Report {
  std::uint8_t service{};
  std::uint8_t subtype{};
  std::uint16_t destination{};
  Bytes data;
  /// "3.25 0001ff": what assertions compare and print.
  [[nodiscard]] std::string text() const {
    const std::string type = std::to_string(service) + "." + std::to_string(subtype);
    return data.empty() ? type : type + " " + to_hex(data);
  }
};

class RecordingSink final : public TelemetrySink {
 public:
  void report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets data) override {
    EXPECT_EQ(unlike_its_shape(service, subtype, data, value_octets), "");
    reports.push_back({service, subtype, destination, Bytes(data.begin(), data.end())});
  }
  /// Texts of all reports since the last call.
  [[nodiscard]] std::vector<std::string> take() {
    std::vector<std::string> texts;
    for (const auto& report : reports) texts.push_back(report.text());
    reports.clear();
    return texts;
  }
  std::vector<Report> reports;
  ValueOctets value_octets;  ///< of those who have parameters
};

inline constexpr std::uint16_t test_source = 7;
inline constexpr const char* test_request_id = "180ac001";  ///< of every telecommand that send() makes

/// Lets the service handle a whole telecommand packet.
inline void handle(Service& service, const Bytes& packet) {
  const auto view = TelecommandView::parse(packet);
  service.handle(view.value(), request_of(view.value()));
}

/// Makes a whole telecommand and lets the service handle it.
inline void send(Service& service, std::uint8_t subtype, Octets data, std::uint8_t ack = ack_all) {
  std::vector<std::byte> buffer(max_telecommand_octets);
  const TelecommandHeader header{10, 1, ack, service.type(), subtype, test_source};
  const auto packet = write_telecommand(buffer, header, data);
  const auto view = TelecommandView::parse(packet.value());
  service.handle(view.value(), request_of(view.value()));
}
inline void send(Service& service, std::uint8_t subtype, std::string_view hex, std::uint8_t ack = ack_all) {
  send(service, subtype, Octets{from_hex(hex)}, ack);
}

}  // namespace hirosco::pus::testing
