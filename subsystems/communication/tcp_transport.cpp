// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/tcp_transport.hpp"

#include <cstdlib>
#include <string_view>

#include "subsystems/communication/tcp_server.hpp"

namespace hirosco {
namespace {

class TcpTransport final : public GroundTransport {
 public:
  explicit TcpTransport(std::unique_ptr<communication::TcpServer> server) : server_{std::move(server)} {}
  void all_stopped() override { server_->all_stopped(); }
  void step(TimePoint now) override { server_->step(now); }
  [[nodiscard]] std::size_t finish(TimePoint now) override { return server_->finish(now); }
  void telemetry(Octets packet) override { static_cast<void>(server_->telemetry(packet)); }
  [[nodiscard]] const Counters& counters() const override { return server_->counters(); }
  /// What waits for the supervisor is offered to it again every millisecond: it does not say when it has room.
  [[nodiscard]] ServiceWake wake() const override {
    ServiceWake wake{.descriptor = server_->descriptor()};
    if (server_->clients().packets_wait()) wake.pace = 1ms;
    return wake;
  }

 private:
  std::unique_ptr<communication::TcpServer> server_;
};

[[nodiscard]] std::string_view given(const char* variable) {
  const char* text = std::getenv(variable);
  return text != nullptr ? text : "";
}

}  // namespace

Result<std::unique_ptr<GroundTransport>> open_tcp_transport(GroundTraffic& traffic) {
  HIROSCO_TRY_LET(const auto options,
                  communication::TcpServer::at(given(telemetry_address_variable), given(telecommand_address_variable)));
  HIROSCO_TRY_LET(auto server, communication::TcpServer::open(options, traffic));
  return std::make_unique<TcpTransport>(std::move(server));
}

}  // namespace hirosco
