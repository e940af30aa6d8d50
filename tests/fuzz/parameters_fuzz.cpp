// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "tests/fuzz/fuzz.hpp"

/// Octets as the data of TC[20,3], on a dictionary with switches, words and numbers: whatever they are, the parameters hold what
/// their C++ types may hold, and a request sets all of its values or none.
namespace hirosco {
namespace {

struct Title {
  Text<6> words;
  std::array<bool, 2> shutters;
};
struct Lamp {
  bool lit;
  Title title;
  double level;
};

using fuzz::expect;

[[nodiscard]] std::vector<ParameterSpec> declared() {
  return {{"LAMP",
           {10, Type::Struct, 1},
           {{"LIT", Type::Bool, 1, 7},
            {"TITLE.WORDS", Type::Text, 6, 7},
            {"TITLE.SHUTTERS", Type::Bool, 2},
            {"LEVEL", Type::Double, 1}},
           true,
           {},
           {{"TITLE", 1, 2, 8}}},
          {"ON", {10, Type::Bool, 2}, {{"ON", Type::Bool, 1}}, false, {}},
          {"NAME", {10, Type::Text, 3}, {{"NAME", Type::Text, 4}}, false, {}},
          {"COUNT", {10, Type::Uint16, 4}, {{"COUNT", Type::Uint16, 1}}, false, {}}};
}

/// Sets at once what the service hands on, as a cycle does, and asks no second time.
class Home final : public pus::ParameterAccess, public pus::TelemetrySink {
 public:
  Home() {
    expect(dictionary_.publish("LAMP", lamp_) && dictionary_.publish("ON", on_) && dictionary_.publish("NAME", name_) &&
               dictionary_.publish("COUNT", count_) && dictionary_.initialise(),
           "the twins are those that are declared");
  }
  std::expected<std::size_t, ErrorCode> read(std::uint32_t, MutableOctets) override {
    return std::unexpected{ErrorCode::Unavailable};
  }
  std::size_t size_of(std::uint32_t id) override {
    const auto place = dictionary_.place_of(id);
    return place ? dictionary_.wire_octets(place->index, place->member) : 0;
  }
  std::expected<void, pus::FailureCode> check_write(std::uint32_t id, Octets value) override {
    const auto place = *dictionary_.place_of(id);
    if (dictionary_.accepts(place.index, place.member, value)) return {};
    return std::unexpected{pus::FailureCode::ValueNotAcceptable};
  }
  std::expected<void, pus::FailureCode> submit_write(std::span<const Write> writes, const pus::Request&) override {
    for (const Write& write : writes) {
      const auto [index, member] = *dictionary_.place_of(write.id);
      static_cast<void>(dictionary_.decode_into(index, member, write.value));
      std::array<std::byte, 32> now{};
      const std::size_t octets = dictionary_.encode(index, member, now);
      all_set_ = all_set_ && std::ranges::equal(write.value, Octets{now}.first(octets));
    }
    return {};
  }
  void report(std::uint8_t, std::uint8_t subtype, std::uint16_t, Octets) override {
    refused_ = refused_ || subtype % 2 == 0;
    completed_ = completed_ || subtype == 7;
  }

  /// Everything that is set, in the order of the dictionary.
  [[nodiscard]] std::vector<std::byte> values() const {
    std::vector<std::byte> all;
    for (std::size_t index = 0; index < dictionary_.size(); ++index) {
      std::array<std::byte, 32> now{};
      const Octets octets = Octets{now}.first(dictionary_.encode(index, -1, now));
      all.insert(all.end(), octets.begin(), octets.end());
    }
    // LIT, TITLE, SHUTTERS, LEVEL; ON; NAME; COUNT
    for (const std::size_t at : {0U, 7U, 8U, 17U})
      expect(std::to_integer<unsigned>(all[at]) <= 1, "a switch is on or off");
    for (const auto& [at, octets] : {std::pair{1U, 6U}, std::pair{18U, 4U}})
      expect(is_fixed_text(Octets{all}.subspan(at, octets)), "words are UTF-8 with zeros behind");
    return all;
  }
  [[nodiscard]] bool all_set() const { return all_set_; }
  [[nodiscard]] bool refused() const { return refused_; }
  [[nodiscard]] bool completed() const { return completed_; }

 private:
  Dictionary dictionary_ = Dictionary::make(declared()).value();
  Parameter<Lamp> lamp_;
  Parameter<bool> on_;
  Parameter<Text<4>> name_;
  Parameter<std::uint16_t> count_;
  bool all_set_{true}, refused_{false}, completed_{false};
};

}  // namespace
}  // namespace hirosco

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hirosco;
  Home home;
  pus::Verification verification{home};
  pus::ParameterService service{home, verification, home};
  const auto before = home.values();
  std::array<std::byte, pus::max_telecommand_octets> buffer;
  const auto packet = pus::write_telecommand(
      buffer, {.apid = 10, .sequence_count = 1, .ack = 0xF, .service = 20, .subtype = 3, .source = 7},
      std::as_bytes(std::span{data, size}));
  if (!packet) return 0;
  const auto telecommand = pus::TelecommandView::parse(*packet);
  service.handle(*telecommand, pus::request_of(*telecommand));
  const auto after = home.values();
  expect(home.refused() != home.completed(), "a request is refused or completed");
  if (home.completed()) fuzz::taken();
  expect(!home.refused() || before == after, "what is refused changes nothing");
  expect(home.all_set(), "what is set is what was sent");
  return 0;
}
