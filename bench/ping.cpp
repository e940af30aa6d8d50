// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// A ping on its way in: read with its checksum, permitted, handed to its service, against its checksum alone. What the service answers is not in it.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/pus/service/service_table.hpp"
#include "hirosco/utilities/crc16.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::bench {
namespace {

using namespace supervisor;

constexpr int calls = 1000;

/// What is handed to it, it counts.
class Counting final : public pus::Service {
 public:
  explicit Counting(std::uint8_t type) : kind_{.type = type, .name = "counting", .requests = {}, .reports = {}} {}
  [[nodiscard]] const pus::ServiceKind& kind() const noexcept override { return kind_; }
  void handle(const pus::TelecommandView&, const pus::Request& request) override { seen += 1U + request.source; }
  std::uint64_t seen{0};

 private:
  pus::ServiceKind kind_;
};

template <class Work>
Figures measure(const Clock& clock, int rounds, Work&& work) {
  std::vector<std::int64_t> samples;
  samples.reserve(static_cast<std::size_t>(rounds));
  for (int round = 0; round < rounds; ++round) {
    const TimePoint begin = clock.now();
    for (int call = 0; call < calls; ++call) work();
    samples.push_back((clock.now() - begin).count());
  }
  return figures_of(samples, 1.0 / calls);
}

int run(int repeats, int rounds) {
  const SystemClock clock;
  static_cast<void>(pin_to_cpu(0));
  const descriptor::Mission mission = supervisor::testing::small_mission();
  const LinkGraph links{mission};
  const auto packet = supervisor::testing::telecommand(supervisor::testing::arm, 17, 1, {});
  std::array<Counting, 6> services{Counting{3}, Counting{5}, Counting{8}, Counting{20}, Counting{128}, Counting{17}};
  pus::ServiceTable table;
  for (Counting& service : services) table.add(service);
  Series checksum{"checksum of a ping", {}}, whole{"ping to its service", {}};
  std::uint64_t kept = 0, refused = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    checksum.repeats.push_back(measure(clock, rounds, [&] {
      Octets octets{packet};
      asm volatile("" : "+r"(octets) : : "memory");
      kept += crc16(octets);
    }));
    whole.repeats.push_back(measure(clock, rounds, [&] {
      Octets octets{packet};
      asm volatile("" : "+r"(octets) : : "memory");
      const auto telecommand = pus::TelecommandView::parse(octets);
      if (!telecommand) return void(++refused);
      const auto decision = decide(
          *telecommand, Origin::ground(),
          {.mission = mission, .mode = mission.modes[0], .links = links, .state = descriptor::State::Operational});
      if (!decision) return void(++refused);
      pus::Service* const service = table.find(telecommand->service());
      if (service == nullptr) return void(++refused);
      service->handle(*telecommand, pus::request_of(*telecommand));
    }));
  }
  if (refused != 0 || services[5].seen == 0 || kept == 1) return EXIT_FAILURE;
  std::printf("A ping of %zu octets, %d rounds of %d, median of %d repeats\n", packet.size(), rounds, calls, repeats);
  checksum.print("ns");
  whole.print("ns");
  whole.print_ratio(checksum);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 9;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 1000;
  return hirosco::bench::run(repeats, rounds);
}
