// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/ways.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco::testing {
namespace {

/// The folders of flights stay, those of tests do not.
class UniqueNames {
 public:
  ~UniqueNames() {
    for (int number = 0; number < next_; ++number) remove_device_memory_folder(name(number));
  }
  std::string next() { return name(next_++); }

 private:
  [[nodiscard]] static std::string name(int number) {
    return "ways-" + std::to_string(::getpid()) + "-" + std::to_string(number);
  }
  std::atomic<int> next_{0};
};

std::string unique_name() {
  static UniqueNames names;
  return names.next();
}

std::string free_port(int kind) {
  const FileDescriptor socket{::socket(AF_INET, kind | SOCK_CLOEXEC, 0)};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t octets = sizeof address;
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), octets), 0);
  EXPECT_EQ(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &octets), 0);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

/// Device frames with one double each way.
class FramesDevice final : public PlayedDevice {
 public:
  explicit FramesDevice(std::unique_ptr<DataFlow> flow) : flow_{std::move(flow)} {}
  std::optional<double> hear() override {
    std::array<std::byte, max_frame_octets> buffer;
    const auto received = flow_->receive(buffer);
    if (!received || received->flow != Flow::New) return std::nullopt;
    const auto command = read_command(Octets{buffer}.first(received->octets));
    if (!command) return std::nullopt;
    newest_.epoch = command->epoch;
    newest_.sequence = command->sequence;
    OctetReader reader{command->payload, std::endian::little};
    return reader.get<double>();
  }
  void say(double value, Harm harm) override {
    std::array<std::byte, 2 * sizeof(double)> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(value);
    newest_.payload = Octets{payload}.first(harm == Harm::WrongSize ? payload.size() : sizeof value);
    std::array<std::byte, max_frame_octets> buffer;
    const std::size_t octets = write_status(buffer, newest_).value().size();
    if (harm == Harm::Damaged) buffer[device_frame_header_octets] ^= std::byte{4};
    static_cast<void>(flow_->send(Octets{buffer}.first(octets)));
  }

 private:
  std::unique_ptr<DataFlow> flow_;
  DeviceStatus newest_{};
};

/// A device that speaks lines.
class LineDevice final : public PlayedDevice {
 public:
  explicit LineDevice(std::unique_ptr<DataFlow> wire) : wire_{std::move(wire)} {}
  std::optional<double> hear() override {
    std::array<std::byte, max_frame_octets> buffer;
    while (true) {
      const auto received = wire_->receive(buffer);
      if (!received || received->flow != Flow::New) break;
      text_.append(reinterpret_cast<const char*>(buffer.data()), received->octets);
    }
    std::optional<double> newest;
    for (auto end = text_.find('\n'); end != text_.npos; end = text_.find('\n')) {
      if (const auto value = LineProtocol::value_in(std::string_view{text_}.substr(0, end), 'S')) newest = value;
      text_.erase(0, end + 1);
    }
    return newest;
  }
  void say(double value, Harm harm) override {
    std::string line = LineProtocol::line('V', value);
    if (harm != Harm::None) line[2] ^= 1;
    static_cast<void>(wire_->send(std::as_bytes(std::span{line})));
  }

 private:
  std::unique_ptr<DataFlow> wire_;
  std::string text_;
};

}  // namespace

std::vector<Way> all_ways() {
  const auto of_system = [] { return std::make_unique<SystemFlowFactory>(std::string{}); };
  const auto named = [](Transfer transfer, const std::string& before = "") {
    return [=] { return FlowAddress{transfer, before + unique_name()}; };
  };
  const auto at_port = [](Transfer transfer, int kind) {
    return [=] { return FlowAddress{transfer, free_port(kind)}; };
  };
  const auto raw = [](auto address) {
    return [=] {
      FlowAddress made = address();
      made.framing = Framing::Raw;
      return made;
    };
  };
  const auto serial = named(Transfer::Serial, "/tmp/hirosco-");
  const auto udp = at_port(Transfer::Udp, SOCK_DGRAM), tcp = at_port(Transfer::Tcp, SOCK_STREAM);
  return {
      {"OneProcess", Framing::Frames, named(Transfer::SharedMemory), [] { return std::make_unique<LocalFlows>(); }},
      {"SharedMemory", Framing::Frames, named(Transfer::SharedMemory), of_system},
      {"Unix", Framing::Frames, named(Transfer::Unix, "/tmp/hirosco-"), of_system},
      {"Udp", Framing::Frames, udp, of_system},
      {"Tcp", Framing::Frames, tcp, of_system},
      {"Serial", Framing::Frames, serial, of_system},
      {"MessageQueue", Framing::Frames, named(Transfer::MessageQueue), of_system},
      {"RawBySerial", Framing::Raw, raw(serial), of_system},
      {"RawByTcp", Framing::Raw, raw(tcp), of_system},
      {"RawByUdp", Framing::Raw, raw(udp), of_system},
  };
}

std::unique_ptr<PlayedDevice> play(const Way& way, FlowFactory& flows, const FlowAddress& address) {
  auto flow = flows.open(address, FlowSide::Device);
  if (!flow) {
    ADD_FAILURE() << way.name << ": " << flow.error().text << " " << flow.error().value;
    return nullptr;
  }
  if (way.framing == Framing::Raw) return std::make_unique<LineDevice>(std::move(*flow));
  return std::make_unique<FramesDevice>(std::move(*flow));
}

}  // namespace hirosco::testing
