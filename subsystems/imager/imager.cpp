// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/imager/imager.hpp"

#include <algorithm>
#include <optional>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "subsystems/imager/acquisition.hpp"
#include "subsystems/imager/image_store.hpp"
#include "subsystems/imager/sender.hpp"

namespace hirosco {
namespace {

using imager::Acquisition;
using imager::Sender;
using imager::Taken;
using imager::Trouble;
using imager::Window;

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
  struct Health {
    float temperature_c;
    std::uint8_t shutter;
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
    use_device("CAMERA.COMMAND", acquisition_.command());
    use_device("CAMERA.STATUS", health_);
    use_device("CAMERA.IMAGE", acquisition_.packets());
    lend_link("IMAGE", acquisition_.lent());
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
    acquisition_.give_up();
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
    if (series_ && !acquisition_.command().alive()) give_up({ErrorCode::Unavailable, "the camera is lost"});
    if (acquisition_.under_way()) read_out(cycle);
    if (series_ && !acquisition_.under_way() && cycle.planned >= series_->next) begin(cycle);
    acquisition_.ask();
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
    if (!acquisition_.command().alive() || !acquisition_.packets().alive())
      return refused(Trouble::no_camera, "the camera says nothing");
    if ((acquisition_.command().flags() & device_flag::watchdog_tripped) != 0)
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
    acquisition_.give_up();
    if (series_) abort(series_->call, why);
    series_.reset();
    show();
  }

  void begin(const Cycle& cycle) noexcept {
    if (!acquisition_.begin(cycle.planned, window_.load(), series_->exposure_ms, threshold_.load()))
      return;  // all are being read: in a later cycle
    series_->next = series_->next == TimePoint{} ? cycle.planned + series_->period
                                                 : std::max(series_->next + series_->period, cycle.planned);
    show();
  }

  void read_out(const Cycle& cycle) noexcept {
    switch (acquisition_.read_out(cycle.planned, health_.input().temperature_c)) {
      case Acquisition::Fate::UnderWay: return;
      case Acquisition::Fate::Kept: return took(acquisition_.image());
      case Acquisition::Fate::Refused: return lose("the camera refused the order");
      case Acquisition::Fate::Lost: return lose("its packets did not come");
    }
  }
  void took(const Taken& image) noexcept {
    newest_ = image.number;
    if (tell_each_.load() != 0)
      raise(taken_, image.number, image.window.columns(), image.window.rows(), image.exposure_ms);
    if (image.shutter == 0 && !stuck_) raise(shutter_stuck_, image.number);
    stuck_ = image.shutter == 0;
    go_on();
  }
  /// One image less; the series goes on without it.
  void lose(const char* why) noexcept {
    const std::uint32_t number = acquisition_.image().number;
    ++lost_;
    raise(image_lost_, number, acquisition_.readout().got(), acquisition_.readout().packets());
    if (series_ && series_->left == 1) return give_up({ErrorCode::Unavailable, why, number});
    go_on();
  }
  void go_on() noexcept {
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
    status_.store({newest_, series_ ? series_->left : 0, lost_, acquisition_.wrong_packets(),
                   health_.input().temperature_c, static_cast<std::uint8_t>(series_ ? 1 : 0)});
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
  DevicePort<Health, NoFields> health_;
  imager::ImageStore store_;
  Acquisition acquisition_{store_};
  Sender sender_{store_};
  CustomService images_{"IMAGES"};

  std::optional<Series> series_;
  std::uint32_t newest_{0}, lost_{0};
  bool stuck_{false}, hot_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_imager() { return std::make_unique<Imager>(); }

}  // namespace hirosco
