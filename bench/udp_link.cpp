// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Round trip between two processes: 256 octets by a UDP link on the loopback, against a bare connected socket there, and against
// the link in shared memory. Read as a cycle reads, over and over without waiting.
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/data_transfer/address/internet_address.hpp"
#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/link/link_datagram.hpp"
#include "hirosco/data_transfer/link/udp_link.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::bench {
namespace {

constexpr std::uint32_t payload_octets = 256;
constexpr int warm_up_rounds = 2'000;

LinkLayout layout_of(std::uint8_t link) {
  return {.epoch = 1,
          .payload_octets = payload_octets,
          .layout_hash = 1,
          .period = 500us,
          .route = {.link = link, .producer = "127.0.0.1", .consumer = "127.0.0.1", .key = 0}};
}

/// One way, made before the processes part.
struct Way {
  std::unique_ptr<LinkWriter> writer;
  std::unique_ptr<LinkReader> reader;
};

Way by_udp(MemoryProvider& memory, std::uint8_t link) {
  Way way;
  LinkLayout layout = layout_of(link);
  const UdpLink udp;
  way.writer = udp.produce(memory, {}, layout).value();
  layout.route.producer = way.writer->route().producer;
  layout.route.key = way.writer->route().key;
  way.reader = udp.consume(memory, {}, layout).value();
  if (!way.writer->reach(way.reader->route().consumer)) std::exit(EXIT_FAILURE);
  return way;
}

Way by_memory(MemoryProvider& memory) {
  const LatestLink latest;
  const LinkLayout layout = layout_of(1);
  const MemoryHandle shared = latest.establish(memory, layout).value();
  Way way;
  way.writer = latest.produce(memory, shared, layout).value();
  way.reader = latest.consume(memory, shared, layout).value();
  return way;
}

/// Two connected sockets and nothing else, with datagrams as long as those of the link.
struct Bare {
  std::array<FileDescriptor, 2> sockets;
  std::array<std::byte, payload_octets + link_datagram::extra_octets> octets{};
  Bare() {
    std::array<sockaddr_in, 2> at{};
    for (std::size_t i = 0; i < 2; ++i) {
      sockets[i].reset(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
      at[i].sin_family = AF_INET;
      at[i].sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      socklen_t length = sizeof at[i];
      if (::bind(sockets[i].get(), reinterpret_cast<sockaddr*>(&at[i]), length) != 0) std::exit(EXIT_FAILURE);
      (void)::getsockname(sockets[i].get(), reinterpret_cast<sockaddr*>(&at[i]), &length);
    }
    for (std::size_t i = 0; i < 2; ++i)
      if (::connect(sockets[i].get(), reinterpret_cast<sockaddr*>(&at[1 - i]), sizeof at[i]) != 0)
        std::exit(EXIT_FAILURE);
  }
  void send(std::size_t end) { (void)::send(sockets[end].get(), octets.data(), octets.size(), MSG_DONTWAIT); }
  void await(std::size_t end) {
    while (::recv(sockets[end].get(), octets.data(), octets.size(), MSG_DONTWAIT) < 0) {}
  }
};

struct Arena {
  SealedMemory memory;
  std::array<Way, 2> udp{by_udp(memory, 1), by_udp(memory, 2)};
  std::array<Way, 2> shared{by_memory(memory), by_memory(memory)};
  Bare bare;
  std::array<std::byte, payload_octets> payload{};

  /// End 0 writes way 0 and reads way 1, end 1 the reverse.
  void send(std::array<Way, 2>& ways, std::size_t end) { ways[end].writer->write(payload, {}, LinkStatus::Valid); }
  void await(std::array<Way, 2>& ways, std::size_t end) {
    while (ways[1 - end].reader->read(payload).flow != Flow::New) {}
  }
};

bool settle(unsigned cpu) {
  (void)lock_memory();
  (void)pin_to_cpu(cpu);
  return set_fifo_priority(50).has_value();
}

void answer(Arena& arena, int repeats, int rounds) {
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (int i = 0; i < rounds + warm_up_rounds; ++i) {
      arena.bare.await(1);
      arena.bare.send(1);
    }
    for (auto* ways : {&arena.udp, &arena.shared})
      for (int i = 0; i < rounds + warm_up_rounds; ++i) {
        arena.await(*ways, 1);
        arena.send(*ways, 1);
      }
  }
}

template <class Round>
Figures measure(const Clock& clock, int rounds, Round&& round) {
  std::vector<std::int64_t> samples;
  samples.reserve(static_cast<std::size_t>(rounds));
  for (int i = 0; i < warm_up_rounds; ++i) round();
  for (int i = 0; i < rounds; ++i) {
    const TimePoint start = clock.now();
    round();
    samples.push_back((clock.now() - start).count());
  }
  return figures_of(samples, 1.0);
}

int run(int repeats, int rounds) {
  const SystemClock clock;
  Arena arena;
  const pid_t child = ::fork();
  if (child < 0) return EXIT_FAILURE;
  if (child == 0) {
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
    (void)settle(1);
    answer(arena, repeats, rounds);
    ::_exit(EXIT_SUCCESS);
  }
  const bool realtime = settle(0);
  Series bare{"bare socket", {}};
  Series udp{"UDP link, 256 B", {}};
  Series shared{"link in memory", {}};
  for (int repeat = 0; repeat < repeats; ++repeat) {
    bare.repeats.push_back(measure(clock, rounds, [&] {
      arena.bare.send(0);
      arena.bare.await(0);
    }));
    for (auto [series, ways] : {std::pair{&udp, &arena.udp}, std::pair{&shared, &arena.shared}})
      series->repeats.push_back(measure(clock, rounds, [&] {
        arena.send(*ways, 0);
        arena.await(*ways, 0);
      }));
  }
  (void)::waitpid(child, nullptr, 0);
  std::printf("Round trip between two processes by UDP, %d rounds, median of %d repeats, %s\n", rounds, repeats,
              realtime ? "SCHED_FIFO" : "ordinary scheduling (no real-time rights)");
  for (const Series* series : {&bare, &udp, &shared}) series->print("ns");
  udp.print_ratio(bare);
  udp.print_ratio(shared);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 9;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 20'000;
  return hirosco::bench::run(repeats, rounds);
}
