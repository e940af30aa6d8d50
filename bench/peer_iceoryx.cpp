// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// iceoryx 2.0 beside our links: round trip of 256 octets, polled, and samples a second of 64 octets with none lost. Needs a running iox-roudi.
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "bench/figures.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "iceoryx_posh/popo/publisher.hpp"
#include "iceoryx_posh/popo/subscriber.hpp"
#include "iceoryx_posh/runtime/posh_runtime.hpp"

namespace hirosco::bench {
namespace {

constexpr int warm_up_rounds = 2'000;
constexpr std::uint64_t queue_depth = 256;
constexpr std::uint64_t looked_at = 64;  ///< each so many samples how far the other one is

template <std::size_t octets>
struct Sample {
  std::uint64_t number{0};
  std::array<std::byte, octets - sizeof(std::uint64_t)> rest{};
};

/// One of two processes; each publishes what the other one takes.
template <class T>
class Peer {
 public:
  Peer(const char* subject, bool first)
      : publisher_{{"Peers", word(subject), word(first ? "there" : "back")}, publish()},
        subscriber_{{"Peers", word(subject), word(first ? "back" : "there")}, subscribe()} {
    while (!publisher_.hasSubscribers() || subscriber_.getSubscriptionState() != iox::SubscribeState::SUBSCRIBED)
      ::usleep(1000);
  }
  void send(std::uint64_t number) {
    publisher_.loan()
        .and_then([&](auto& sample) {
          sample->number = number;
          sample.publish();
        })
        .or_else([](auto) { std::abort(); });
  }
  /// 0: there is none.
  [[nodiscard]] std::uint64_t take(T& into) {
    std::uint64_t number = 0;
    subscriber_.take().and_then([&](auto& sample) {
      into = *sample;
      number = into.number;
    });
    return number;
  }
  void await(std::uint64_t number, T& into) {
    while (take(into) != number) {}
  }

 private:
  static iox::capro::IdString_t word(const char* text) { return {iox::cxx::TruncateToCapacity, text}; }
  static iox::popo::PublisherOptions publish() {
    iox::popo::PublisherOptions options;
    options.subscriberTooSlowPolicy = iox::popo::ConsumerTooSlowPolicy::WAIT_FOR_CONSUMER;
    return options;
  }
  static iox::popo::SubscriberOptions subscribe() {
    iox::popo::SubscriberOptions options;
    options.queueFullPolicy = iox::popo::QueueFullPolicy::BLOCK_PRODUCER;
    options.queueCapacity = queue_depth;
    return options;
  }
  iox::popo::Publisher<T> publisher_;
  iox::popo::Subscriber<T> subscriber_;
};

void join_roudi() {
  const std::string name = "bench_" + std::to_string(::getpid());
  iox::runtime::PoshRuntime::initRuntime(iox::RuntimeName_t(iox::cxx::TruncateToCapacity, name));
}

bool settle(unsigned cpu) {
  static_cast<void>(pin_to_cpu(cpu));
  return set_fifo_priority(50).has_value();
}

/// The other process does `body` on the second processor.
template <class Body>
pid_t beside(Body&& body) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  static_cast<void>(::prctl(PR_SET_PDEATHSIG, SIGKILL));
  join_roudi();
  body();
  ::usleep(100'000);
  ::_exit(EXIT_SUCCESS);
}

void round_trips(int rounds) {
  using Octets256 = Sample<256>;
  const SystemClock clock;
  const pid_t child = beside([rounds] {
    Peer<Octets256> peer{"latency", false};
    static_cast<void>(settle(1));
    Octets256 sample;
    for (int i = 1; i <= rounds + warm_up_rounds; ++i) {
      peer.await(static_cast<std::uint64_t>(i), sample);
      peer.send(static_cast<std::uint64_t>(i));
    }
  });
  join_roudi();
  Peer<Octets256> peer{"latency", true};
  static_cast<void>(settle(0));
  std::vector<std::int64_t> samples;
  samples.reserve(static_cast<std::size_t>(rounds));
  Octets256 sample;
  for (int i = 1; i <= rounds + warm_up_rounds; ++i) {
    const TimePoint start = clock.now();
    peer.send(static_cast<std::uint64_t>(i));
    peer.await(static_cast<std::uint64_t>(i), sample);
    if (i > warm_up_rounds) samples.push_back((clock.now() - start).count());
  }
  ::waitpid(child, nullptr, 0);
  Series series{"iceoryx, 256 B", {figures_of(samples, 1.0)}};
  series.print("ns");
}

/// Between the two processes.
struct Progress {
  alignas(64) std::atomic<std::uint64_t> taken{0};  ///< by the consumer, samples
  alignas(64) std::atomic<std::int64_t> done_ns{0};
};

/// As in bench/queued_link.cpp: the producer stays within half a queue, so that it never pays for a full one, which iceoryx waits for by
/// system calls.
void rate(std::uint64_t samples) {
  using Octets64 = Sample<64>;
  const SystemClock clock;
  auto* const progress =
      new (::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Progress;
  const pid_t child = beside([=] {
    Peer<Octets64> peer{"rate", false};
    static_cast<void>(settle(1));
    Octets64 sample;
    std::uint64_t received = 0;
    while (sample.number < samples) {
      if (peer.take(sample) == 0) continue;
      ++received;
      if (sample.number % looked_at == 0) progress->taken.store(sample.number, std::memory_order_release);
    }
    if (received != samples) std::abort();
    progress->done_ns.store(SystemClock{}.now().time_since_epoch().count());
  });
  join_roudi();
  Peer<Octets64> peer{"rate", true};
  static_cast<void>(settle(0));
  const std::int64_t begun = clock.now().time_since_epoch().count();
  for (std::uint64_t number = 1; number <= samples; ++number) {
    if (number % looked_at == 0)
      while (number > progress->taken.load(std::memory_order_acquire) + queue_depth / 2) {}
    peer.send(number);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (status != 0) std::exit(EXIT_FAILURE);
  std::printf("%-28s %12.0f samples/s\n", "iceoryx queue",
              static_cast<double>(samples) * 1e9 / static_cast<double>(progress->done_ns.load() - begun));
}

}  // namespace
}  // namespace hirosco::bench

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  const int count = argc > 2 ? std::atoi(argv[2]) : 100'000;
  if (what == "latency") hirosco::bench::round_trips(count);
  else if (what == "rate") hirosco::bench::rate(static_cast<std::uint64_t>(count));
  else std::fprintf(stderr, "bench_peer_iceoryx latency|rate [COUNT]\n");
  std::fflush(stdout);
  std::_Exit(what == "latency" || what == "rate" ? EXIT_SUCCESS : 2);
}
