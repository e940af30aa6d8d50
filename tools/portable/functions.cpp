// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Prints a line for each function of the C library that control and physics call: its name and a hash of 100,000 results, octet for octet. Where two
// computers print the same line, the function keeps from nobody that one seed gives one answer on both (docs/adr/0004, 0139). "arithmetic" is IEEE 754's.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace {

/// splitmix64, in [low, high).
class Numbers {
 public:
  double next(double low, double high) {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return low + (high - low) * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53);
  }

 private:
  std::uint64_t state_{1};
};

template <class Function>
void tell(const char* name, double low, double high, Function function) {
  constexpr int results = 100'000;
  Numbers numbers;
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (int i = 0; i < results; ++i) {
    const double x = numbers.next(low, high);
    const double y = numbers.next(low, high);
    hash = (hash ^ std::bit_cast<std::uint64_t>(function(x, y))) * 0x100000001B3ULL;
  }
  std::printf("%s %016llx\n", name, static_cast<unsigned long long>(hash));
}

}  // namespace

int main() {
  tell("arithmetic", -3, 3, [](double x, double y) { return x * y + x - y * 0.1 / (x * x + 1); });
  tell("sqrt", 0, 9, [](double x, double) { return std::sqrt(x); });
  tell("fmod", 0.1, 9, [](double x, double y) { return std::fmod(x, y); });
  tell("sin", -7, 7, [](double x, double) { return std::sin(x); });
  tell("cos", -7, 7, [](double x, double) { return std::cos(x); });
  tell("tan", -1.5, 1.5, [](double x, double) { return std::tan(x); });
  tell("asin", -1, 1, [](double x, double) { return std::asin(x); });
  tell("acos", -1, 1, [](double x, double) { return std::acos(x); });
  tell("atan", -5, 5, [](double x, double) { return std::atan(x); });
  tell("atan2", -3, 3, [](double x, double y) { return std::atan2(x, y); });
  tell("exp", -20, 5, [](double x, double) { return std::exp(x); });
  tell("log", 1e-9, 9, [](double x, double) { return std::log(x); });
  tell("pow", 0.01, 4, [](double x, double y) { return std::pow(x, y); });
  tell("tanh", -3, 3, [](double x, double) { return std::tanh(x); });
  tell("hypot", -3, 3, [](double x, double y) { return std::hypot(x, y); });
  tell("cbrt", -3, 3, [](double x, double) { return std::cbrt(x); });
}
