// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/imager/imager.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "subsystems/imager/image_store.hpp"
#include "subsystems/imager/readout.hpp"
#include "subsystems/imager/sender.hpp"

namespace hirosco {
namespace {

using imager::Readout;
using imager::Sender;
using imager::Taken;
using imager::Trouble;
using imager::Window;

/// Without a packet that is new for so long, the exposure not counted, an image is lost.
constexpr Duration patience = std::chrono::seconds{1};
/// The sensor has to cool down by this much before it is told again that it is hot.
constexpr float again_below_c = 2;

class Imager final : public Subsystem {
  // Structures of imager.xml: same members, same order.
  struct Status {
    std::uint32_t newest;
    std::uint32_t left;
    std::uint32_t lost;
    std::uint32_t wrong_packets;
    float temperature_c;
    std::uint8_t acquiring;
  };
  struct Size {
    std::uint16_t width;
    std::uint16_t height;
  };
  struct Order {
    std::uint32_t image;
    float exposure_ms;
    std::uint16_t x, y, width, height;
    std::uint8_t binning, threshold;
  };
  struct OrderTaken {
    std::uint32_t image;
    std::uint8_t refused;
  };
  struct Health {
    float temperature_c;
    std::uint8_t shutter;
  };
  struct Ask {
    std::uint32_t image;
    std::uint16_t packet;
  };
  struct Packet {
    std::uint32_t image;
    std::uint8_t shutter;
    std::uint16_t packets, packet;
    std::uint32_t start, pixels;
    std::uint16_t octets;
    std::array<std::uint8_t, imager::packet_octets> coded;
  };
  /// IMAGE of imager.xml, as it is lent.
  struct Lent {
    std::uint32_t number;
    std::uint16_t width, height, x, y;
    std::uint8_t binning, shutter;
    float exposure_ms;
    std::array<std::uint8_t, imager::most_pixels> pixel;
  };

  /// What ACQUIRE asked for.
  struct Series {
    Call call;
    float exposure_ms;
    std::uint32_t left;  ///< 0: until STOP
    bool endless;
    Duration period;
    TimePoint next;  ///< begin of the next image
  };

  Result<> offline() override {
    sender_.serve(images_, send_rate_, sending_);
    provide(images_);
    return ok();
  }
  Result<Step> software_init() override {
    publish("STATUS", status_);
    publish("WINDOW", window_);
    publish("SENSOR", sensor_);
    publish("THRESHOLD", threshold_);
    publish("HOT", hot_c_);
    publish("SEND_RATE", send_rate_);
    publish("SENDING", sending_);
    publish("TELL_EACH", tell_each_);
    use_device("CAMERA.COMMAND", command_);
    use_device("CAMERA.STATUS", health_);
    use_device("CAMERA.IMAGE", packets_);
    lend_link("IMAGE", lent_);
    for (EventPort* event : {static_cast<EventPort*>(&taken_), static_cast<EventPort*>(&series_done_),
                             static_cast<EventPort*>(&image_lost_), static_cast<EventPort*>(&shutter_stuck_),
                             static_cast<EventPort*>(&sensor_hot_)})
      use_event(*event);
    on_function("ACQUIRE", [this](float exposure_ms, std::uint32_t images, std::uint32_t period_ms, Call call) {
      return acquire(exposure_ms, images, period_ms, call);
    });
    on_function("STOP", [this]() -> Result<> {
      give_up({ErrorCode::NotPermitted, "ended by STOP"});
      return ok();
    });
    on_function("SET_WINDOW", [this](std::uint16_t x, std::uint16_t y, std::uint16_t width, std::uint16_t height,
                                     std::uint8_t binning) { return set_window({x, y, width, height, binning}); });
    return done;
  }
  Result<> configure(const descriptor::Configuration&) override {
    series_.reset();
    under_way_ = false;
    sender_.forget();
    return ok();
  }
  Result<Step> software_deinit() override {
    sender_.forget();
    return done;
  }

  Result<> pre_operational(const Cycle&) noexcept override { return rest(); }
  Result<> safe_operational(const Cycle&) noexcept override { return rest(); }
  Result<> error_operational(const Cycle&) noexcept override { return rest(); }
  Result<> operational(const Cycle& cycle) noexcept override {
    look_at_camera();
    if (series_ && !command_.alive()) give_up({ErrorCode::Unavailable, "the camera is lost"});
    if (under_way_) read_out(cycle);
    if (series_ && !under_way_ && cycle.planned >= series_->next) begin(cycle);
    packets_.output() = {under_way_ ? readout_.image() : 0U, readout_.ask()};
    return ok();
  }

  /// Outside of Operational nothing is acquired; what is there can be sent.
  Result<> rest() noexcept {
    look_at_camera();
    if (series_) give_up({ErrorCode::NotPermitted, "not Operational any more"});
    return ok();
  }

  Outcome acquire(float exposure_ms, std::uint32_t images, std::uint32_t period_ms, const Call& call) {
    if (series_)
      return refused(Trouble::acquiring, "images of the last request are still to come", status_.load().left);
    if (!command_.alive() || !packets_.alive()) return refused(Trouble::no_camera, "the camera says nothing");
    if ((command_.flags() & device_flag::watchdog_tripped) != 0)
      return refused(Trouble::no_camera, "its watchdog has let go: SafeOperational, then Operational again");
    const Size sensor = sensor_.load();
    if (const char* why = window_.load().problem(sensor.width, sensor.height)) return refused(Trouble::bad_window, why);
    series_ = Series{call, exposure_ms, images, images == 0, std::chrono::milliseconds{period_ms}, TimePoint{}};
    return running;
  }
  Outcome set_window(const Window& window) {
    const Size sensor = sensor_.load();
    if (const char* why = window.problem(sensor.width, sensor.height)) return refused(Trouble::bad_window, why);
    window_.store(window);
    return Result<>{};
  }

  /// An image that is under way is not kept.
  void give_up(const Error& why) noexcept {
    under_way_ = false;
    if (series_) abort(series_->call, why);
    series_.reset();
    show();
  }

  void begin(const Cycle& cycle) noexcept {
    place_ = store_.begin();
    if (place_.empty()) return;  // all are being read: in a later cycle
    series_->next = series_->next == TimePoint{} ? cycle.planned + series_->period
                                                 : std::max(series_->next + series_->period, cycle.planned);
    // A camera that has gone on without us has numbers of before: none is given twice.
    number_ = std::max(number_, command_.input().image) + 1;
    const Window window = window_.load();
    command_.output() = {number_,      series_->exposure_ms, window.x,       window.y,
                         window.width, window.height,        window.binning, threshold_.load()};
    readout_.begin(number_, window.pixels());
    coming_ = {.number = number_, .exposed = cycle.planned, .window = window, .exposure_ms = series_->exposure_ms};
    const auto exposure = std::chrono::microseconds{static_cast<std::int64_t>(1000 * series_->exposure_ms)};
    lost_at_ = cycle.planned + exposure + patience;
    lent_place_ = lent_.lend();
    under_way_ = true;
    show();
  }

  void read_out(const Cycle& cycle) noexcept {
    if (command_.fresh() && command_.input().image == number_ && command_.input().refused != 0)
      return lose(cycle, "the camera refused the order");
    // A link that came or went in between has another place: this image is not lent.
    if (lent_.lend() != lent_place_) lent_place_ = nullptr;
    if (packets_.fresh()) take_packet(cycle);
    if (readout_.complete()) return keep(cycle);
    if (cycle.planned >= lost_at_) lose(cycle, "its packets did not come");
  }
  void take_packet(const Cycle& cycle) noexcept {
    const Packet& packet = packets_.input();
    const imager::PacketHead head{packet.image, packet.packets, packet.packet,
                                  packet.start, packet.pixels,  packet.octets};
    const Readout::Heard heard = readout_.look(head);
    if (heard == Readout::Heard::Nothing) return;
    const auto coded = std::span{packet.coded}.first(heard == Readout::Heard::Wanted ? head.octets : 0U);
    const auto unpacked_into = [&](MutableOctets pixels) {
      return imager::unpack(coded, pixels.subspan(head.start, head.pixels));
    };
    if (heard == Readout::Heard::Wrong || !unpacked_into(place_)) {
      ++wrong_;
      return;
    }
    if (lent_place_ != nullptr) unpacked_into(std::as_writable_bytes(std::span{lent_place_->pixel}));
    readout_.took(head);
    coming_.shutter = packet.shutter;
    lost_at_ = std::max(lost_at_, cycle.planned + patience);
  }
  void keep(const Cycle& cycle) noexcept {
    coming_.temperature_c = health_.input().temperature_c;
    store_.keep(coming_);
    newest_ = coming_.number;
    under_way_ = false;
    const Window& window = coming_.window;
    if (lent_place_ != nullptr) {
      Lent& lent = *lent_place_;
      lent.number = coming_.number;
      lent.width = window.columns();
      lent.height = window.rows();
      lent.x = window.x;
      lent.y = window.y;
      lent.binning = window.binning;
      lent.shutter = coming_.shutter;
      lent.exposure_ms = coming_.exposure_ms;
      lent_.publish();
    }
    if (tell_each_.load() != 0) raise(taken_, coming_.number, window.columns(), window.rows(), coming_.exposure_ms);
    if (coming_.shutter == 0 && !stuck_) raise(shutter_stuck_, coming_.number);
    stuck_ = coming_.shutter == 0;
    go_on(cycle);
  }
  /// One image less; the series goes on without it.
  void lose(const Cycle& cycle, const char* why) noexcept {
    under_way_ = false;
    ++lost_;
    raise(image_lost_, coming_.number, readout_.got(), readout_.packets());
    if (series_ && series_->left == 1) return give_up({ErrorCode::Unavailable, why, coming_.number});
    go_on(cycle);
  }
  void go_on(const Cycle&) noexcept {
    if (series_ && !series_->endless && --series_->left == 0) {
      finish(series_->call);
      raise(series_done_, newest_);
      series_.reset();
    }
    show();
  }

  void look_at_camera() noexcept {
    if (!health_.fresh()) return;
    const float temperature_c = health_.input().temperature_c;
    if (temperature_c > hot_c_.load() && !hot_) raise(sensor_hot_, temperature_c);
    hot_ = temperature_c > hot_c_.load() - (hot_ ? again_below_c : 0);
    show();
  }
  void show() noexcept {
    status_.store({newest_, series_ ? series_->left : 0, lost_, wrong_, health_.input().temperature_c,
                   static_cast<std::uint8_t>(series_ ? 1 : 0)});
  }

  Parameter<Status> status_;
  Parameter<Window> window_;
  Parameter<Size> sensor_;
  Parameter<std::uint8_t> threshold_, tell_each_;
  Parameter<float> hot_c_;
  Parameter<std::uint32_t> send_rate_;
  Parameter<Sender::Sending> sending_;
  Event<std::uint32_t, std::uint16_t, std::uint16_t, float> taken_{"IMAGE_TAKEN"};
  Event<std::uint32_t> series_done_{"SERIES_DONE"};
  Event<std::uint32_t, std::uint16_t, std::uint16_t> image_lost_{"IMAGE_LOST"};
  Event<std::uint32_t> shutter_stuck_{"SHUTTER_STUCK"};
  Event<float> sensor_hot_{"SENSOR_HOT"};
  DevicePort<OrderTaken, Order> command_;
  DevicePort<Health, NoFields> health_;
  DevicePort<Packet, Ask> packets_;
  LoanOutput<Lent> lent_;
  imager::ImageStore store_;
  Sender sender_{store_};
  CustomService images_{"IMAGES"};

  std::optional<Series> series_;
  bool under_way_{false};  ///< an image: ordered, not complete
  Readout readout_;
  MutableOctets place_;  ///< of the image under way
  Lent* lent_place_{nullptr};
  Taken coming_;
  TimePoint lost_at_{};
  std::uint32_t number_{0}, newest_{0}, lost_{0}, wrong_{0};
  bool stuck_{false}, hot_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_imager() { return std::make_unique<Imager>(); }

}  // namespace hirosco
