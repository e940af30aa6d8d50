// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hirosco/data_transfer/device/frame_protocol.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/utilities/octets.hpp"

/// The two things a control law reads and writes besides parameters: real-time links and devices. A subsystem's author
/// holds them as members and names them in software_init(); the framework fills and empties them around every cycle.
namespace hirosco {

/// A required set of real-time data, as the cycle sees it.  Thread: the cycle.
class LinkInputPort {
 public:
  /// Connected, fresh and not reported faulty by its producer.
  [[nodiscard]] bool valid() const noexcept { return valid_; }
  /// Own cycles since the newest sample; 0 = new in this cycle.
  [[nodiscard]] std::uint32_t age_cycles() const noexcept { return age_cycles_; }
  [[nodiscard]] LinkStatus status() const noexcept { return status_; }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// Samples that came over the present link, and those that came and went between two cycles.
  [[nodiscard]] std::uint64_t received() const noexcept { return received_; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  [[nodiscard]] std::span<const NativeField> layout() const noexcept { return layout_.all(); }
  /// Which samples it is for.
  [[nodiscard]] LinkKind kind() const noexcept { return kind_; }
  /// Whether it looks at samples that are lent, and keeps none.
  [[nodiscard]] bool lent() const noexcept { return kind_ == LinkKind::Loaned; }

 protected:
  LinkInputPort(LinkKind kind, ObjectFields layout, MutableOctets native) noexcept
      : kind_{kind}, layout_{layout}, native_{native} {}
  LinkInputPort(const LinkInputPort&) = delete;
  LinkInputPort& operator=(const LinkInputPort&) = delete;
  ~LinkInputPort() = default;
  [[nodiscard]] LoanReader* loans() const noexcept { return loans_; }
  [[nodiscard]] const std::byte* places() const noexcept { return places_; }
  [[nodiscard]] std::size_t arrived() const noexcept { return arrived_; }

 private:
  friend class LinkInputSlot;
  LinkKind kind_;
  ObjectFields layout_;
  MutableOctets native_;  ///< where a sample goes; where all are wanted, what each begins as
  LoanReader* loans_{nullptr};  ///< of the attached link, where it lends
  std::byte* places_{nullptr};  ///< of the attached link, where all samples are wanted: objects side by side
  std::size_t arrived_{0};  ///< of them filled in this cycle
  bool valid_{false};
  std::uint32_t age_cycles_{0};
  LinkStatus status_{LinkStatus::None};
  std::uint64_t count_{0};
  std::uint64_t received_{0};
  std::uint64_t lost_{0};
};

/// T: an aggregate with one member per <Field> of the <Requires> element, in their order. A Sized member has its length
/// from the configuration that requires the set.
template <class T>
class LinkInput final : private HasFields<T>, public LinkInputPort {
 public:
  LinkInput() noexcept
      : LinkInputPort{LinkKind::Latest, HasFields<T>::fields(), std::as_writable_bytes(std::span{&value_, 1})} {}
  /// Last whole sample; zeros before the first.
  [[nodiscard]] const T& value() const noexcept { return value_; }

 private:
  T value_{};
};

/// A required set of which every sample is wanted (kind="queued"). T: as of LinkInput. age_cycles(), status() and count() are those of
/// the newest sample, and status() is the worst of all that came in this cycle and of the producer now; lost() counts what
/// the consumer fell too far behind to get, exactly.
template <class T>
class QueueInput final : private HasFields<T>, public LinkInputPort {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignof(std::max_align_t));

 public:
  QueueInput() noexcept
      : LinkInputPort{LinkKind::Queued, HasFields<T>::fields(), std::as_writable_bytes(std::span{&begin_, 1})} {}
  /// Those that came since the last cycle, oldest first; empty: none. At most the descriptor's `depth`; what came while they were
  /// read comes in the next cycle. They are there for this cycle.  Realtime: wait-free.
  [[nodiscard]] std::span<const T> samples() const noexcept {
    return {reinterpret_cast<const T*>(places()), arrived()};
  }

 private:
  T begin_{};  ///< zeros, with the lengths of Sized members
};

/// A required set whose samples are lent (kind="loaned"): images, point clouds. T: as of LinkInput, with arrays of fixed length only.
template <class T>
class LoanInput final : private HasFields<T>, public LinkInputPort {
  static_assert(!HasFields<T>::sized, "a lent sample has arrays of fixed length only");
  static_assert(ParameterStructure<T>, "a lent sample is an aggregate with one member per <Field>");

 public:
  LoanInput() noexcept : LinkInputPort{LinkKind::Loaned, HasFields<T>::fields(), {}} {}
  /// The newest sample as of the beginning of this cycle, in its producer's place; null: none yet, or no link. The place
  /// is made anew after two more publications at least: what was read counts when whole() says so afterwards, and in a
  /// later cycle whole() is asked before reading on: a link that is gone took its memory along.  Realtime: wait-free.
  [[nodiscard]] const T* look() noexcept {
    return loans() == nullptr ? nullptr : reinterpret_cast<const T*>(loans()->look().data());
  }
  /// Whether all that was read since look() is of that one sample. Ask before acting on it.  Realtime: wait-free.
  [[nodiscard]] bool whole() const noexcept { return loans() != nullptr && loans()->whole(); }
};

/// A provided set whose samples are lent, as the cycle sees it.  Thread: the cycle.
class LoanOutputPort {
 public:
  [[nodiscard]] std::span<const NativeField> layout() const noexcept { return layout_; }
  /// Hands the lent place on as a new sample at the end of this cycle, with its time and status; nothing when none is lent.
  /// Realtime: wait-free.
  void publish() noexcept { ready_ = lent_; }

 protected:
  explicit LoanOutputPort(std::span<const NativeField> layout) noexcept : layout_{layout} {}
  LoanOutputPort(const LoanOutputPort&) = delete;
  LoanOutputPort& operator=(const LoanOutputPort&) = delete;
  ~LoanOutputPort() = default;
  [[nodiscard]] std::byte* place() noexcept {
    if (loans_ == nullptr) return nullptr;
    lent_ = true;
    return loans_->lend().data();
  }

 private:
  friend class LinkOutputSlot;
  std::span<const NativeField> layout_;
  LoanWriter* loans_{nullptr};  ///< of the memory that the links have in common
  bool lent_{false};
  bool ready_{false};
};

/// T: an aggregate with one member per <Field> of the <Provides kind="loaned"> element, in their order, with arrays of fixed
/// length only. Its consumers, however many, look at one memory.
template <class T>
class LoanOutput final : private HasFields<T>, public LoanOutputPort {
  static_assert(!HasFields<T>::sized, "a lent sample has arrays of fixed length only");
  static_assert(ParameterStructure<T>, "a lent sample is an aggregate with one member per <Field>");

 public:
  LoanOutput() noexcept : LoanOutputPort{HasFields<T>::fields().all()} {}
  /// Where the next sample is made; null when no link is attached. The same place until it is published or its link is gone:
  /// ask anew in each cycle. It holds an earlier sample, or zeros.  Realtime: wait-free.
  [[nodiscard]] T* lend() noexcept { return reinterpret_cast<T*>(place()); }
};

/// A device, as the cycle sees it.  Thread: the cycle.
class DevicePortBase {
 public:
  /// Connected, and heard of within the silence limit.
  [[nodiscard]] bool alive() const noexcept { return alive_; }
  /// A new frame came in this cycle.
  [[nodiscard]] bool fresh() const noexcept { return fresh_; }
  /// Flags of the newest status frame.
  [[nodiscard]] std::uint16_t flags() const noexcept { return flags_; }
  [[nodiscard]] std::uint32_t damaged_frames() const noexcept { return damaged_frames_; }
  /// Which endnode is in use: 0 the preferred one, then its fall-backs in their order; and how often the cycle has gone over to
  /// one in this configuration.
  [[nodiscard]] std::uint8_t endnode() const noexcept { return endnode_; }
  [[nodiscard]] std::uint32_t fall_backs() const noexcept { return fall_backs_; }
  /// What the configuration says of this device with <Setting name="..." value="..."/>; empty when it says nothing, and
  /// for a name that was not given to use_device(). From configure() on.
  [[nodiscard]] std::string_view setting(std::string_view name) const noexcept {
    for (const descriptor::Setting& setting : settings_)
      if (setting.name == name && reads(name)) return setting.value;
    return {};
  }
  /// Whether its author said so.
  [[nodiscard]] bool reads(std::string_view name) const noexcept {
    return std::ranges::find(reads_, name) != reads_.end();
  }
  /// What this device speaks where a configuration reaches it with framing="raw"; before use_device(). It outlives the port's use.
  void speak(FrameProtocol& protocol) noexcept { protocol_ = &protocol; }
  /// Null: device frames alone.
  [[nodiscard]] FrameProtocol* protocol() const noexcept { return protocol_; }
  void will_read(std::span<const std::string_view> settings) { reads_.assign(settings.begin(), settings.end()); }
  [[nodiscard]] std::span<const NativeField> input_layout() const noexcept { return input_layout_.all(); }
  [[nodiscard]] std::span<const NativeField> output_layout() const noexcept { return output_layout_.all(); }

 protected:
  DevicePortBase(ObjectFields input_layout, MutableOctets input, ObjectFields output_layout,
                 MutableOctets output) noexcept
      : input_layout_{input_layout}, input_{input}, output_layout_{output_layout}, output_{output} {}
  DevicePortBase(const DevicePortBase&) = delete;
  DevicePortBase& operator=(const DevicePortBase&) = delete;
  ~DevicePortBase() = default;

 private:
  friend class DeviceSlot;
  ObjectFields input_layout_;
  MutableOctets input_;
  ObjectFields output_layout_;
  MutableOctets output_;
  std::span<const descriptor::Setting> settings_;
  std::vector<std::string_view> reads_;
  FrameProtocol* protocol_{nullptr};
  bool alive_{false};
  bool fresh_{false};
  std::uint16_t flags_{0};
  std::uint32_t damaged_frames_{0};
  std::uint32_t fall_backs_{0};
  std::uint8_t endnode_{0};
};

/// Of a port in whose direction the descriptor declares nothing.
struct NoFields {};
template <int which>
class HasFields<NoFields, which> {
 protected:
  [[nodiscard]] ObjectFields fields() noexcept { return {std::span<const NativeField>{}, {}}; }
};

/// Input and Output: aggregates with one member per <Field> of the device's <Input> and <Output>, in their order, or NoFields. A
/// Sized member has its length from the first configuration with the device on. Of a device with several endnodes each has a
/// port of its own, use_device("DEVICE.ENDNODE", port).
template <class Input, class Output>
class DevicePort final : private HasFields<Input, 0>, private HasFields<Output, 1>, public DevicePortBase {
 public:
  DevicePort() noexcept
      : DevicePortBase{HasFields<Input, 0>::fields(), std::as_writable_bytes(std::span{&input_, 1}),
                       HasFields<Output, 1>::fields(), std::as_writable_bytes(std::span{&output_, 1})} {}
  /// What the device last said; zeros before the first frame.
  [[nodiscard]] const Input& input() const noexcept { return input_; }
  /// What the device is to do. Reaches an actuator in Operational only: in every other state, and while inhibited, the
  /// framework sends the descriptor's safe values instead (decision 22). What is outside a declared range goes out as
  /// the end of it, and what is no number or without end, whether it has a range or not, as the safe value.
  [[nodiscard]] Output& output() noexcept { return output_; }

 private:
  Input input_{};
  Output output_{};
};

}  // namespace hirosco
