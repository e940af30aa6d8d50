// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <string>

#include "hirosco/subsystem/run.hpp"
#include "subsystems/communication/communication.hpp"
#include "subsystems/communication/tcp_server.hpp"

/// The process shell of the communication subsystem: TCP sockets below the ground link.
namespace {

using namespace hirosco;

class TcpTransport final : public GroundTransport {
 public:
  explicit TcpTransport(std::unique_ptr<communication::TcpServer> server) : server_{std::move(server)} {}
  void step(TimePoint now) override { server_->step(now); }
  [[nodiscard]] std::size_t finish(TimePoint now) override { return server_->finish(now); }
  void telemetry(Octets packet) override { static_cast<void>(server_->telemetry(packet)); }
  [[nodiscard]] const communication::LinkCounters& counters() const override { return server_->counters(); }

 private:
  std::unique_ptr<communication::TcpServer> server_;
};

[[nodiscard]] std::uint16_t port_of(const char* variable, std::uint16_t fallback) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return fallback;
  const std::string_view digits{text};
  std::uint16_t port = fallback;
  std::from_chars(digits.data(), digits.data() + digits.size(), port);
  return port;
}

Result<std::unique_ptr<GroundTransport>> open_tcp(communication::GroundTraffic& traffic) {
  communication::TcpServer::Options options;
  options.telemetry_port = port_of("HIROSCO_TELEMETRY_PORT", options.telemetry_port);
  options.telecommand_port = port_of("HIROSCO_TELECOMMAND_PORT", options.telecommand_port);
  HIROSCO_TRY_LET(auto server, communication::TcpServer::open(options, traffic));
  return std::make_unique<TcpTransport>(std::move(server));
}

}  // namespace

int main(int argc, char** argv) {
  return run_subsystem(argc, argv, [] { return make_communication(open_tcp); });
}
