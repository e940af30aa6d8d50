// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/foreign_parameters.hpp"

#include <utility>

namespace hirosco {

class ForeignParameters::Port final : public SubscriptionPort {
 public:
  Port(const char* subsystem, ForeignParameters& home, std::vector<std::size_t> entries)
      : SubscriptionPort{subsystem, "", What::Structure, {}}, home_{home}, entries_{std::move(entries)} {}

 private:
  bool take(Octets values) override {
    bool good = true;
    for (const std::size_t entry : entries_) good = home_.take(home_.entries_[entry], values) && good;
    return good;
  }
  ForeignParameters& home_;
  std::vector<std::size_t> entries_;
};

ForeignParameters::ForeignParameters(const descriptor::SubsystemDescriptor& described, Home home)
    : descriptor_{described}, home_{std::move(home)} {}

ForeignParameters::~ForeignParameters() = default;

std::string ForeignParameters::use(Subscriber& subscriber) {
  for (const descriptor::Subscribes& heard : descriptor_.subscribes)
    for (const descriptor::Thing& thing : heard.things) {
      if (thing.kind != descriptor::Thing::Kind::Housekeeping) continue;
      std::vector<std::size_t> entries;
      for (const descriptor::Foreign& foreign : heard.foreign) {
        if (heard.apid == 0)
          return "no mission says who " + heard.subsystem + " is, whose parameter " + foreign.name + " is";
        if (foreign.structure != thing.id) continue;
        const descriptor::Parameter& parameter = descriptor_.parameters[foreign.parameter];
        entries.push_back(entries_.size());
        entries_.push_back({.parameter = foreign.parameter,
                            .offset = foreign.offset,
                            .octets = parameter.octets(),
                            .age = parameter.age});
      }
      if (entries.empty()) continue;
      ports_.push_back(std::make_unique<Port>(heard.subsystem.c_str(), *this, std::move(entries)));
      subscriber.add(*ports_.back(),
                     {heard.apid, pus::st129::Subscribed::What::Structure, static_cast<std::uint16_t>(thing.id)});
    }
  return {};
}

void ForeignParameters::begin(const Dictionary& dictionary) {
  for (Entry& entry : entries_) {
    entry.unknown.resize(entry.octets);
    entry.known = entry.told = false;
    entry.heard = now_;
    static_cast<void>(dictionary.encode(entry.parameter, -1, entry.unknown));  // published: its layout was compared
  }
}

/// A report that is shorter, or has a value that could not be set here, is none: what was known grows old.
bool ForeignParameters::take(Entry& entry, Octets values) {
  if (entry.unknown.empty() || values.size() < entry.offset + entry.octets) return false;
  const Octets value = values.subspan(entry.offset, entry.octets);
  if (!home_.accepts(entry.parameter, value) || !home_.set(entry.parameter, value)) return false;
  entry.heard = now_;
  entry.known = true;
  entry.told = false;
  return true;
}

void ForeignParameters::step(TimePoint now, bool acts) {
  now_ = now;
  for (Entry& entry : entries_) {
    if (entry.unknown.empty() || now - entry.heard <= entry.age) continue;
    if (entry.known && home_.set(entry.parameter, entry.unknown)) entry.known = false;
    if (entry.known || !acts || std::exchange(entry.told, true)) continue;
    home_.tell(entry.parameter);
  }
}

void ForeignParameters::forget() noexcept {
  entries_.clear();
  ports_.clear();
}

}  // namespace hirosco
