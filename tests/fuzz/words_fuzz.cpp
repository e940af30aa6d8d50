// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/address/internet_address.hpp"
#include "hirosco/data_transfer/device/device_network.hpp"
#include "hirosco/data_transfer/device/serial_line.hpp"
#include "hirosco/parameter/exact_number.hpp"
#include "supervisor/guard/safe_answer.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tools/hirosco/flight_lock.hpp"

/// Single words and lines from whatever text comes: addresses, networks, lines, numbers, the lock of a flight and the guard's answer to a stop.
/// What is taken is written and read the same, and an answer says that all have stopped where it says so of each and no other way.
namespace {

using namespace hirosco;
using fuzz::expect;

void check_addresses(std::string_view text) {
  if (const auto address = read_internet_address(text)) {
    fuzz::taken();
    const auto again = read_internet_address(to_text(*address));
    expect(again && *again == *address, "an address is written and read the same");
  }
  if (const auto address = read_device_address(text)) {
    fuzz::taken();
    const auto again = read_device_address(to_text(*address));
    expect(again && *again == *address && address->port != 0, "a device's address is written and read the same");
  }
  if (const auto network = read_device_network(text)) {
    fuzz::taken();
    const auto again = read_device_network(to_text(*network));
    expect(again && *again == *network, "a network is written and read the same");
    expect(network->contains(network->network) && !network->network.loopback(), "a network has its own address");
  }
  const auto networks = read_device_networks(text);
  expect(read_device_networks(words_of(networks)) == networks, "networks are written and read the same");
}

void check_line(std::string_view text) {
  const auto line = read_serial_line(text);
  if (!line) return;
  fuzz::taken();
  const auto again = read_serial_line(line->path + "@" + std::to_string(line->baud));
  expect(again && again->path == line->path && again->baud == line->baud, "a line is written and read the same");
}

void check_number(std::string_view text) {
  const auto number = parse_number(text);
  if (!number) return;
  fuzz::taken();
  const auto again = parse_number(to_string(*number));
  expect(number->is_finite() && again && *again == *number, "a number is written and read the same");
}

void check_lock(std::string_view text) {
  const auto lock = tools::lock_from_text(text);
  if (!lock) return expect(!lock.error().empty(), "why a lock is none is told");
  fuzz::taken();
  const auto again = tools::lock_from_text(tools::lock_text(*lock));
  expect(lock->keeper > 0 && again && again->keeper == lock->keeper && again->limit == lock->limit &&
             again->mission == lock->mission,
         "a lock is written and read the same");
}

/// A message a line.
void check_answer(std::string_view text) {
  using supervisor::SafeAnswer;
  SafeAnswer answer;
  std::vector<std::string> messages;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    messages.emplace_back(line);
    static_cast<void>(answer.take(messages.back()));
  }
  if (messages.empty()) return expect(answer.stop() == SafeAnswer::Stop::Nobody, "nobody said anything");
  const std::string last = messages.back() + "\n";
  messages.pop_back();
  const bool each_stopped = std::ranges::all_of(messages, [](const std::string& each) {
    return each.starts_with(std::string{supervisor::safe_stopped} + " ") &&
           each.size() > supervisor::safe_stopped.size() + 1;
  });
  const bool all = each_stopped && last == supervisor::safe_last_line(messages.size());
  if (all) fuzz::taken();
  expect(!all || answer.stop() == SafeAnswer::Stop::All, "that all have stopped is heard");
  // The count may be written with zeros in front.
  if (answer.stop() == SafeAnswer::Stop::All)
    expect(each_stopped && last.starts_with(supervisor::safe_end) &&
               last.ends_with(std::to_string(messages.size()) + "\n") && answer.why_not_whole().empty(),
           "that all have stopped was said");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  check_addresses(text);
  check_line(text);
  check_number(text);
  check_lock(text);
  check_answer(text);
  return 0;
}
