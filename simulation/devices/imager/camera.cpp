// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/imager/camera.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "hirosco/utilities/crc32.hpp"
#include "simulation/devices/imager/pack.hpp"

namespace hirosco::simulation {
namespace {

/// Counts a second in each element at 20 C.
constexpr double dark_per_s = 20;
constexpr double doubles_each_c = 10;
constexpr float longest_exposure_ms = 10'000;

}  // namespace

Camera::Camera(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings}, packets_(most_packets) {}

void Camera::advance(Duration cycle) noexcept {
  for (std::size_t i = 0; i < point_.size(); ++i) point_[i] += drift_per_s_[i] * seconds(cycle);
  if (!exposing_) return;
  left_ -= cycle;
  if (left_ > Duration{0}) return;
  exposing_ = false;
  read_out();
}

/// Another order than the last begins an exposure, whatever was under way.
Result<> Camera::take(OctetReader payload) noexcept {
  Order order{.number = payload.get<std::uint32_t>()};
  const auto exposure_ms = payload.get<float>();
  order.window.x = payload.get<std::uint16_t>();
  order.window.y = payload.get<std::uint16_t>();
  order.window.width = payload.get<std::uint16_t>();
  order.window.height = payload.get<std::uint16_t>();
  order.window.binning = payload.get<std::uint8_t>();
  order.threshold = payload.get<std::uint8_t>();
  if (!payload.exhausted()) return fail(ErrorCode::Malformed, "order of the camera: size");
  if (order.number == 0 || order.number == order_.number) return ok();
  refused_ = !order.window.possible() || !(exposure_ms > 0 && exposure_ms <= longest_exposure_ms);
  exposing_ = !refused_;
  if (exposing_) order.exposure_us = static_cast<std::uint32_t>(std::lround(1000 * exposure_ms));
  order_ = order;
  if (!exposing_) return ok();
  left_ = std::chrono::microseconds{order.exposure_us};
  packet_count_ = 0;
  image_ = {};
  const double dark = dark_per_s * std::exp2((temperature_c_ - 20) / doubles_each_c) * order.exposure_us / 1e6;
  shot_ = {.sky = settings().seed,
           .u = static_cast<std::int64_t>(std::floor(point_[0])),
           .v = static_cast<std::int64_t>(std::floor(point_[1])),
           .exposure_us = order.exposure_us,
           .dark_counts = static_cast<std::uint32_t>(std::min(dark, 255.0)),
           .shutter = !stuck_,
           .hot = hot_,
           .noise = noise_,
           .number = order.number,
           .threshold = order.threshold,
           .window = order.window};
  return ok();
}

void Camera::read_out() noexcept {
  image_ = sky_.expose(shot_);
  std::size_t at = 0;
  while (at < image_.size() && packet_count_ < packets_.size()) {
    Packet& packet = packets_[packet_count_++];
    const Packed packed = pack(image_.subspan(at), packet.coded);
    packet.start = static_cast<std::uint32_t>(at);
    packet.pixels = static_cast<std::uint32_t>(packed.pixels);
    packet.octets = static_cast<std::uint16_t>(packed.octets);
    at += packed.pixels;
  }
}

void Camera::write_sensors(OctetWriter& payload) noexcept {
  payload.put(order_.number).put(static_cast<std::uint8_t>(refused_ ? 1 : 0));
}

Result<> Camera::take_at(std::string_view endnode, OctetReader payload) noexcept {
  if (endnode != "IMAGE") return SimulatedDevice::take_at(endnode, payload);
  Asked asked{.number = payload.get<std::uint32_t>()};
  asked.packet = payload.get<std::uint16_t>();
  if (!payload.exhausted()) return fail(ErrorCode::Malformed, "request of a packet: size");
  asked_ = asked;
  return ok();
}

void Camera::write_sensors_at(std::string_view endnode, OctetWriter& payload) noexcept {
  if (endnode == "IMAGE") return write_packet(payload);
  payload.put(static_cast<float>(temperature_c_)).put(static_cast<std::uint8_t>(exposing_ && !stuck_ ? 1 : 0));
}

/// Number 0 and no packet: there is no such image, or not yet.
void Camera::write_packet(OctetWriter& payload) const noexcept {
  const bool there = packet_count_ != 0 && asked_.number == order_.number && asked_.packet < packet_count_;
  static constexpr Packet none{.coded = {}};
  const Packet& packet = there ? packets_[asked_.packet] : none;
  payload.put(there ? order_.number : 0U).put(static_cast<std::uint8_t>(shot_.shutter ? 1 : 0));
  payload.put(static_cast<std::uint16_t>(packet_count_)).put(asked_.packet);
  payload.put(packet.start).put(packet.pixels).put(packet.octets);
  payload.put(std::as_bytes(std::span{packet.coded}).first(packet.octets));
  payload.fill(packet_octets - packet.octets, std::byte{0});
}

Result<> Camera::do_fault(const Words& words) {
  constexpr double farthest = 1e6;
  const auto two = [&](std::array<double, 2>& pair) -> Result<> {
    HIROSCO_TRY(words.expect(3));
    HIROSCO_TRY_LET(const double u, words.number(1, -farthest, farthest));
    HIROSCO_TRY_LET(const double v, words.number(2, -farthest, farthest));
    pair = {u, v};
    return ok();
  };
  const auto count = [&](std::uint32_t& number, double most) -> Result<> {
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(const double value, words.number(1, 0, most));
    number = static_cast<std::uint32_t>(value);
    return ok();
  };
  if (words[0] == "point") return two(point_);
  if (words[0] == "drift") return two(drift_per_s_);
  if (words[0] == "hot") return count(hot_, 10'000);
  if (words[0] == "noise") return count(noise_, 255);
  HIROSCO_TRY(words.expect(2));
  if (words[0] == "temperature") {
    HIROSCO_TRY_LET(temperature_c_, words.number(1, -60, 100));
    return ok();
  }
  if (words[0] != "shutter") return fail(ErrorCode::InvalidArgument, "unknown fault");
  if (words[1] != "stuck" && words[1] != "free") return fail(ErrorCode::InvalidArgument, "shutter stuck or free");
  stuck_ = words[1] == "stuck";
  return ok();
}

std::string Camera::do_truth() const {
  const SensorWindow& window = shot_.window;
  return fmt::format(
      "image={} sky={} u={} v={} exposure_us={} dark={} shutter={} hot={} noise={} threshold={} x={} y={} width={} "
      "height={} "
      "binning={} packets={} crc32={} temperature={:.1f}",
      image_.empty() ? 0 : shot_.number, shot_.sky, shot_.u, shot_.v, shot_.exposure_us, shot_.dark_counts,
      shot_.shutter ? 1 : 0, shot_.hot, shot_.noise, shot_.threshold, window.x, window.y, window.width, window.height,
      window.binning, packet_count_, crc32(std::as_bytes(image_)), temperature_c_);
}

/// Where it looks and how it turns is no fault.
void Camera::do_heal() noexcept {
  stuck_ = false;
  hot_ = noise_ = 0;
  temperature_c_ = 20;
}

}  // namespace hirosco::simulation
