// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>

#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/parameter/write_queue.hpp"

using namespace hirosco;

struct CurrentValues {
  std::int32_t moving;
  double position_rad;
};

int main() {
  const std::vector<ParameterSpec> declared{{"CUR_VALUES",
                                             {10, Type::Struct, 0},
                                             {{"MOVING", Type::Int32, 1}, {"POSITION", Type::Double, 1}},
                                             true,
                                             {0, 0.5}}};
  auto dictionary = Dictionary::make(declared).value();
  Parameter<CurrentValues> current;
  if (const auto published = dictionary.publish("CUR_VALUES", current); !published) {
    std::puts(published.error().c_str());
    return 1;
  }
  if (!dictionary.initialise()) return 1;

  // A request of another thread takes effect at the boundary of the cycle.
  WriteQueue queue{8, 256};
  std::array<std::byte, 8> goal{};
  OctetWriter{goal}.put(0.75);
  const auto position = dictionary.find("CUR_VALUES.POSITION").value();
  if (!queue.enqueue(dictionary, {{{position.index, position.member, goal}}})) return 1;
  std::printf("before the cycle %.2f\n", current.load().position_rad);
  queue.apply(dictionary);
  std::printf("after it %.2f\n", current.load().position_rad);

  Parameter<float> narrow;
  ParameterSpec wide{"LIMIT", {10, Type::Double, 1}, {{"LIMIT", Type::Double, 1}}, false, {}};
  std::puts(compare(wide, narrow).value().explanation.c_str());
  return current.load().position_rad == 0.75 ? 0 : 1;
}
