// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/slots.hpp"

#include <algorithm>
#include <cmath>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/parameter/number.hpp"

namespace hirosco {
namespace {

static_assert(descriptor::max_device_octets == max_device_payload_octets);

/// Cycles without news are counted up to here, so that a counter never wraps back to "fresh".
constexpr std::uint32_t longest_silence = 1'000'000'000;
/// How long a device may follow an epoch before the commanded one, in silence limits: the guard names it every 5 ms.
constexpr std::uint32_t longest_introduction = 40;

[[nodiscard]] std::endian endian_of(descriptor::ByteOrder order) noexcept {
  return order == descriptor::ByteOrder::Big ? std::endian::big : std::endian::little;
}

[[nodiscard]] std::vector<LayoutField> layout_fields(std::span<const NativeField> native) {
  std::vector<LayoutField> fields;
  for (const NativeField& field : native) fields.push_back({field.type, field.count, field.offset});
  return fields;
}

[[nodiscard]] std::vector<descriptor::Field> outputs_of(const descriptor::Device& device) {
  std::vector<descriptor::Field> fields;
  for (const auto& output : device.output) fields.push_back(output.field);
  return fields;
}

/// The fields of an object that agrees with its declaration, with the lengths that this gives.
[[nodiscard]] std::span<const NativeField> with_lengths(ObjectFields& fields,
                                                        const std::vector<descriptor::Field>& declared,
                                                        MutableOctets object) noexcept {
  for (std::size_t i = 0; i < declared.size(); ++i) fields.set_length(i, declared[i].count, object);
  return fields.all();
}

/// Declared safe values in wire form.
[[nodiscard]] std::vector<std::byte> safe_payload(const descriptor::Device& device, std::endian order) {
  std::vector<std::byte> payload;
  for (const auto& output : device.output) {
    const std::size_t start = payload.size();
    payload.resize(start + output.field.octets());
    OctetWriter writer{MutableOctets{payload}.subspan(start), order};
    for (std::uint16_t i = 0; i < output.field.count; ++i)
      put_number(writer, output.field.type, i < output.safe.size() ? output.safe[i] : 0.0);
  }
  return payload;
}

}  // namespace

std::string layout_difference(std::span<const NativeField> native, const std::vector<descriptor::Field>& declared) {
  if (native.size() != declared.size())
    return "the C++ type has " + std::to_string(native.size()) + " members, the descriptor declares " +
           std::to_string(declared.size()) + " fields";
  for (std::size_t i = 0; i < native.size(); ++i) {
    if (native[i].takes(declared[i].type, declared[i].count)) continue;
    const std::string held =
        native[i].most != 0 ? "at most " + std::to_string(native[i].most) : std::to_string(native[i].count);
    return "field " + declared[i].name + ": C++ has " + std::string{to_text(native[i].type)} + "[" + held +
           "], the descriptor declares " + std::string{to_text(declared[i].type)} + "[" +
           std::to_string(declared[i].count) + "]";
  }
  return {};
}

// --- LinkInputSlot ---------------------------------------------------------------------------------------------------

LinkInputSlot::LinkInputSlot(const descriptor::Requires& terms, LinkInputPort* port, bool realtime) noexcept
    : terms_{&terms}, port_{port}, age_limit_{realtime ? terms.age.realtime : terms.age.reduced} {
  for (std::size_t i = 0; i < terms.fields.size(); ++i)
    port_->layout_.set_length(i, terms.fields[i].count, port_->native_);
  port_->valid_ = false;
  port_->age_cycles_ = 0;
  port_->status_ = LinkStatus::None;
  port_->count_ = 0;
}

Result<> LinkInputSlot::plan(AttachedLink& link) const {
  link.scatter.clear();
  link.wire_offset.clear();
  for (std::size_t wanted = 0; wanted < terms_->fields.size(); ++wanted) {
    std::size_t offset = 0;
    const auto found = std::ranges::find_if(link.agreement.fields, [&](const pus::st128::OfferedField& field) {
      if (field.name == terms_->fields[wanted].name) return true;
      offset += octets_of(field.type) * field.count;
      return false;
    });
    if (found == link.agreement.fields.end()) return fail(ErrorCode::Mismatch, "the agreement lacks a required field");
    const NativeField& place = port_->layout()[wanted];
    if (found->type != place.type || found->count != place.count)
      return fail(ErrorCode::Mismatch, "the agreement has a required field with another type");
    link.scatter.push_back({place.type, place.count, place.offset});
    link.wire_offset.push_back(offset);
  }
  return ok();
}

void LinkInputSlot::attach(AttachedLink* link) noexcept {
  link_ = link;
  port_->age_cycles_ = 0;
  // What an earlier link brought must not pass for a sample of this one.
  port_->count_ = 0;
  port_->received_ = 0;
  port_->lost_ = 0;
  port_->status_ = LinkStatus::None;
  latency_mean_ns_ = 0.0;
  latency_max_ns_ = 0;
}

void LinkInputSlot::detach(const AttachedLink* link) noexcept {
  if (link_ != link) return;
  link_ = nullptr;
  port_->valid_ = false;
  port_->status_ = LinkStatus::None;
}

void LinkInputSlot::read(TimePoint now) noexcept {
  if (link_ == nullptr) {
    port_->valid_ = false;
    return;
  }
  const LinkSample sample = link_->reader->read(link_->payload);
  if (sample.flow == Flow::New) {
    for (std::size_t i = 0; i < link_->scatter.size(); ++i) {
      const LayoutField& field = link_->scatter[i];
      const std::size_t octets = octets_of(field.type) * field.count;
      decode(std::span{&field, 1}, Octets{link_->payload}.subspan(link_->wire_offset[i], octets), port_->native_,
             link_->order);
    }
    port_->age_cycles_ = 0;
    port_->count_ = sample.count;
    ++port_->received_;
    port_->lost_ += sample.lost;
    const std::uint32_t latency_ns = clamped_ns(now - sample.sampled_at);
    latency_max_ns_ = std::max(latency_max_ns_, latency_ns);
    // The first samples weigh as much as they are, so that the mean needs no time to arrive.
    const double weight = std::max(1.0 / static_cast<double>(port_->received_), 1e-3);
    latency_mean_ns_ += weight * (static_cast<double>(latency_ns) - latency_mean_ns_);
  } else if (port_->age_cycles_ < longest_silence) {
    ++port_->age_cycles_;
  }
  port_->status_ = sample.status;
  const bool fresh = port_->age_cycles_ <= age_limit_ * link_->producer_cycles_per_sample;
  const bool reliable = sample.status == LinkStatus::Valid || sample.status == LinkStatus::Degraded;
  port_->valid_ = port_->count_ != 0 && fresh && reliable;
}

void LinkInputSlot::tell(IncomingLink& page) const noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  page.link.store(link_ != nullptr ? link_->id : 0, relaxed);
  page.lost.store(static_cast<std::uint32_t>(port_->lost_), relaxed);
  page.latency_mean_ns.store(static_cast<std::uint32_t>(latency_mean_ns_), relaxed);
  page.latency_max_ns.store(latency_max_ns_, relaxed);
}

// --- LinkOutputSlot --------------------------------------------------------------------------------------------------

LinkOutputSlot::LinkOutputSlot(const descriptor::Subsystem& subsystem, const descriptor::Provides& terms,
                               Dictionary& dictionary)
    : terms_{&terms} {
  for (const descriptor::ParameterRef& reference : terms.parameters) {
    const ParameterCell* cell = dictionary.cell(reference.parameter);
    const auto& layout = cell->fields();
    const auto fields = descriptor::fields_of(subsystem, reference);
    const std::size_t first = reference.member.value_or(0);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const NativeField& native = layout[first + i];
      fields_.push_back({fields[i].name, fields[i].type, fields[i].count});
      sources_.push_back({cell, {native.type, native.count, native.offset}});
    }
  }
  std::size_t octets = 0;
  for (const auto& field : fields_) octets += octets_of(field.type) * field.count;
  for (auto& payload : payloads_) payload.resize(octets);
}

void LinkOutputSlot::attach(AttachedLink* link) noexcept {
  link->next = first_;
  first_ = link;
}

void LinkOutputSlot::detach(AttachedLink* link) noexcept {
  for (AttachedLink** place = &first_; *place != nullptr; place = &(*place)->next)
    if (*place == link) {
      *place = link->next;
      return;
    }
}

void LinkOutputSlot::encode_for(std::endian order) noexcept {
  std::size_t at = 0;
  for (const Source& source : sources_) {
    const std::size_t octets = octets_of(source.field.type) * source.field.count;
    encode(std::span{&source.field, 1}, source.cell->live(), payload(order).subspan(at, octets), order);
    at += octets;
  }
}

void LinkOutputSlot::write(TimePoint now, LinkStatus status) noexcept {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    bool encoded = false;
    for (AttachedLink* link = first_; link != nullptr; link = link->next) {
      if (link->order != order) continue;
      if (!encoded) encode_for(order);
      encoded = true;
      link->writer->write(payload(order), now, status);
    }
  }
}

// --- DeviceSlot ------------------------------------------------------------------------------------------------------

DeviceSlot::DeviceSlot(const descriptor::Device& device, const descriptor::DeviceUse& use, DevicePortBase& port,
                       std::unique_ptr<DataFlow> flow, bool realtime)
    : device_{&device},
      port_{&port},
      flow_{std::move(flow)},
      order_{endian_of(use.endnode.byte_order)},
      silence_limit_{realtime ? use.silence.realtime : use.silence.reduced},
      watchdog_us_{realtime ? use.watchdog_us : use.watchdog_reduced_us},
      input_layout_{layout_fields(with_lengths(port.input_layout_, device.input, port.input_))},
      output_layout_{layout_fields(with_lengths(port.output_layout_, outputs_of(device), port.output_))},
      safe_payload_{safe_payload(device, order_)},
      payload_(std::max(wire_octets(input_layout_), safe_payload_.size())),
      frame_(max_device_frame_octets) {
  port_->alive_ = false;
  port_->fresh_ = false;
  port_->damaged_frames_ = 0;
  port_->settings_ = use.settings;
}

std::string DeviceSlot::difference(const descriptor::Device& device, const DevicePortBase& port) {
  if (auto text = layout_difference(port.input_layout(), device.input); !text.empty()) return "input, " + text;
  auto text = layout_difference(port.output_layout(), outputs_of(device));
  return text.empty() ? text : "output, " + text;
}

void DeviceSlot::read(bool count_silence) noexcept {
  port_->fresh_ = false;
  just_lost_ = false;
  const auto received = flow_->receive(frame_);
  if (received && received->flow == Flow::New) take_frame(Octets{frame_}.first(received->octets));
  if (port_->fresh_) {
    since_good_ = {};
    heard_ = true;
    port_->alive_ = true;
    return;
  }
  if (!heard_ && !count_silence) return;
  hung_up_ = !received && heard_;
  count(since_good_.silent_cycles);
  if (since_good_.silent_cycles == silence_limit_ || (hung_up_ && port_->alive_)) {
    just_lost_ = port_->alive_ || !heard_;
    port_->alive_ = false;
  }
}

void DeviceSlot::take_frame(Octets frame) noexcept {
  const auto status = read_status(frame);
  const bool fits = status && status->payload.size() == wire_octets(input_layout_);
  if (!fits) {
    ++port_->damaged_frames_;
    return count(status ? since_good_.wrong_size : since_good_.damaged);
  }
  decode(input_layout_, status->payload, port_->input_, order_);
  // A frame that answers no newer command is a repetition: a frozen device must not look alive.
  port_->fresh_ = status->sequence != echoed_ || !heard_;
  if (!port_->fresh_) count(since_good_.repeated);
  echoed_ = status->sequence;
  port_->flags_ = status->flags;
  // Its watchdog has let go although it is commanded: it moves nothing any more, whatever its sensors say. Of an epoch
  // before the commanded one that says nothing at first: the guard has yet to name this one to it.
  const bool tripped = (status->flags & device_flag::watchdog_tripped) != 0;
  const std::uint32_t patience = status->epoch < epoch_ ? longest_introduction * silence_limit_ : silence_limit_;
  if (!tripped || active_cycles_ <= patience) return;
  if (port_->fresh_) count(since_good_.let_go);
  port_->fresh_ = false;
}

void DeviceSlot::count(std::uint32_t& cycles) noexcept { cycles = std::min(cycles + 1, longest_silence); }

DeviceSlot::Loss DeviceSlot::loss() const noexcept {
  Loss loss = since_good_;
  using enum descriptor::DeviceLoss;
  std::uint32_t most = 0;
  const auto blame = [&](std::uint32_t frames, descriptor::DeviceLoss reason) {
    if (frames <= most) return;
    most = frames;
    loss.reason = reason;
  };
  blame(loss.damaged, Damaged);
  blame(loss.wrong_size, WrongSize);
  blame(loss.let_go, LetGo);
  blame(loss.repeated, Repeated);
  if (hung_up_) loss.reason = HungUp;
  return loss;
}

void DeviceSlot::keep_in_range(MutableOctets payload) noexcept {
  std::size_t at = 0;
  for (const auto& output : device_->output) {
    const descriptor::Field& field = output.field;
    const std::size_t octets = octets_of(field.type);
    for (std::size_t i = 0; i < field.count; ++i, at += octets) {
      if (!field.minimum && !field.maximum) continue;
      const MutableOctets place = payload.subspan(at, octets);
      OctetReader reader{place, order_};
      const double wanted = get_number(reader, field.type);
      double held = wanted;
      if (std::isnan(wanted)) held = i < output.safe.size() ? output.safe[i] : 0.0;
      if (field.minimum) held = std::max(held, field.minimum->real());
      if (field.maximum) held = std::min(held, field.maximum->real());
      if (held == wanted) continue;
      OctetWriter writer{place, order_};
      put_number(writer, field.type, held);
    }
  }
}

void DeviceSlot::write(std::uint32_t epoch, bool active, bool stopping) noexcept {
  const bool pass = active || !device_->actuator;
  active_cycles_ = active ? std::min(active_cycles_ + 1, longest_silence) : 0;
  epoch_ = epoch;
  Octets payload = safe_payload_;
  if (pass) {
    port_->output_layout_.fit(port_->output_);
    const MutableOctets room = MutableOctets{payload_}.first(safe_payload_.size());
    encode(output_layout_, port_->output_, room, order_);
    keep_in_range(room);
    payload = room;
  }
  const DeviceMode mode = pass ? DeviceMode::Active : stopping ? DeviceMode::Stop : DeviceMode::Off;
  const auto frame = write_command(
      frame_,
      DeviceCommand{
          .mode = mode, .epoch = epoch, .sequence = ++sequence_, .watchdog_us = watchdog_us_, .payload = payload});
  // A device that does not listen is found by its silence, one cycle later: nothing to do here.
  if (frame) static_cast<void>(flow_->send(*frame));
}

}  // namespace hirosco
