// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <functional>
#include <span>
#include <thread>
#include <vector>

#include "hirosco/data_transfer/link/queued_link.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"

/// A queued link between two threads and between two processes, with samples that tell themselves whether they are whole; and
/// a producer with a planted bug, which the very same test must find.
namespace hirosco::queueing {
namespace {

constexpr std::uint32_t payload_octets = 16'384;
constexpr std::uint32_t depth = 2;
const LinkLayout layout{7, payload_octets, 0x1234'5678'9ABC'DEF0, 1ms, depth};

/// Every word of sample n is a different function of n, so that a mixture of two samples in one slot cannot pass for one. They are made
/// beforehand: a producer that does nothing but write is nearly always at work in the slot that its consumer is about to lose.
class Samples {
 public:
  Samples() {
    for (std::uint64_t n = 0; n < made_.size(); ++n)
      for (std::uint64_t i = 0; i < payload_octets / 8; ++i) made_[n].push_back((n + i) * 0x9E37'79B9'7F4A'7C15);
  }
  [[nodiscard]] Octets operator[](std::uint64_t n) const { return std::as_bytes(std::span{made_[n % made_.size()]}); }

 private:
  std::array<std::vector<std::uint64_t>, 16> made_;  ///< no multiple of the slots
};

using Produce = std::function<void(std::uint64_t n, Octets payload)>;

/// Samples 1 to `last`, or until told to stop, now and then with a gap, so that reads begin, lie and end everywhere in a write.
void produce(const Produce& write, const Samples& samples, std::uint64_t last, const std::atomic<bool>& stop) {
  for (std::uint64_t n = 1; n <= last && !stop.load(std::memory_order_relaxed); ++n) {
    write(n, samples[n]);
    if (n % 8 == 0)
      for (std::uint64_t i = 0; i < n * 37 % 1024; ++i) static_cast<void>(stop.load());
    if (n % 64 == 0) std::this_thread::yield();
  }
}

struct Tally {
  std::uint64_t received{0};
  std::uint64_t lost{0};
  std::uint64_t torn{0};
  std::uint64_t misnumbered{0};  ///< twice, out of order, or `lost` is not what is missing
};

/// Reads until sample `last`, or the first that is not right. Of three samples two are read late: when the producer is about to
/// overwrite, or has overwritten, what comes next.
Tally consume(LinkReader& reader, LinkView& view, const Samples& samples, std::uint64_t last) {
  Tally tally;
  std::vector<std::byte> seen(payload_octets);
  std::uint64_t before = 0;
  while (before < last && tally.torn + tally.misnumbered == 0) {
    const std::uint64_t late = before % 3 == 0 ? 0 : depth + before % 2;
    for (int waited = 0; view.glance()->count < std::min(before + late, last); ++waited)
      if (waited % 1'000 == 999) std::this_thread::yield();  // on a busy machine it may need this very processor
    const LinkSample sample = reader.read(seen);
    if (sample.flow != Flow::New) {
      std::this_thread::yield();
      continue;
    }
    ++tally.received;
    tally.lost += sample.lost;
    if (!std::ranges::equal(seen, samples[sample.count])) ++tally.torn;
    if (sample.count != before + sample.lost + 1) ++tally.misnumbered;
    before = sample.count;
  }
  return tally;
}

/// Memory as the supervisor makes it, in this process.
struct Shared {
  QueuedLink mechanism;
  SealedMemory provider;
  MemoryHandle memory = mechanism.establish(provider, layout).value();
};

class TrueProducer {
 public:
  explicit TrueProducer(Shared& shared)
      : writer_{shared.mechanism.produce(shared.provider, shared.memory, layout).value()} {}
  void operator()(std::uint64_t, Octets payload) { writer_->write(payload, TimePoint{}, LinkStatus::Valid); }

 private:
  std::shared_ptr<LinkWriter> writer_;
};

/// The planted bug: a slot that is written anew keeps the sequence of the sample before until it is done.
class WrongProducer {
 public:
  explicit WrongProducer(Shared& shared)
      : mapping_{shared.provider.map(shared.memory, Access::ReadWrite).value()},
        writer_{shared.mechanism.produce(shared.provider, shared.memory, layout).value()} {}
  void operator()(std::uint64_t n, Octets payload) {
    using namespace queued_memory;
    const std::size_t slot = slots_at + n % (depth + 1) * slot_octets(payload_octets);
    for (std::size_t at = 0; at < payload_octets; at += 8) {
      std::uint64_t value;
      std::memcpy(&value, payload.data() + at, 8);
      word(slot + payload_in_slot + at).store(value, std::memory_order_release);
      if (at == payload_octets / 2) std::this_thread::yield();
    }
    word(slot + sequence_in_slot).store(2 * n, std::memory_order_release);
    word(newest_at).store(n, std::memory_order_release);
  }

 private:
  std::atomic_ref<std::uint64_t> word(std::size_t at) {
    return std::atomic_ref<std::uint64_t>{*reinterpret_cast<std::uint64_t*>(mapping_.octets.data() + at)};
  }
  Mapping mapping_;
  std::shared_ptr<LinkWriter> writer_;
};

template <class Producer>
Tally between_threads(std::uint64_t last) {
  Shared shared;
  Producer producer{shared};
  const auto reader = shared.mechanism.consume(shared.provider, shared.memory, layout).value();
  const auto view = shared.mechanism.look(shared.provider, shared.memory).value();
  const Samples samples;
  std::atomic<bool> stop{false};
  std::thread thread{[&] { produce(producer, samples, last, stop); }};
  const Tally tally = consume(*reader, *view, samples, last);
  stop = true;
  thread.join();
  return tally;
}

TEST(QueuedLinkStress, BetweenTwoThreadsEverySampleComesWholeOnceInOrderOrIsCountedAsLost) {
  constexpr std::uint64_t last = 20'000;
  const Tally tally = between_threads<TrueProducer>(last);
  EXPECT_EQ(tally.torn, 0u);
  EXPECT_EQ(tally.misnumbered, 0u);
  EXPECT_EQ(tally.received + tally.lost, last);
  EXPECT_GT(tally.received, 0u);
  EXPECT_GT(tally.lost, 0u) << "nobody was overtaken: this tried nothing";
}

TEST(QueuedLinkStress, CatchesAProducerThatDoesNotMarkItsWork) {
  EXPECT_GT(between_threads<WrongProducer>(100'000'000).torn, 0u);
}

TEST(QueuedLinkStress, BetweenTwoProcessesEverySampleComesWholeOnceInOrderOrIsCountedAsLost) {
  constexpr std::uint64_t last = 20'000;
  Shared shared;
  TrueProducer producer{shared};
  const Samples samples;
  std::array<int, 2> ready{};
  ASSERT_EQ(::pipe(ready.data()), 0);
  const pid_t consumer = ::fork();
  ASSERT_GE(consumer, 0);
  if (consumer == 0) {
    const auto reader = shared.mechanism.consume(shared.provider, shared.memory, layout);
    const auto view = shared.mechanism.look(shared.provider, shared.memory);
    if (!reader || !view || ::write(ready[1], "r", 1) != 1) ::_exit(1);
    const Tally tally = consume(**reader, **view, samples, last);
    if (tally.torn != 0) ::_exit(2);
    if (tally.misnumbered != 0 || tally.received + tally.lost != last) ::_exit(3);
    ::_exit(tally.received > 0 ? 0 : 4);
  }
  ::close(ready[1]);
  char is_ready{};
  EXPECT_EQ(::read(ready[0], &is_ready, 1), 1) << "its first sample is sample 1 only if it was there before";
  ::close(ready[0]);
  produce(producer, samples, last, false);
  int status = 0;
  ASSERT_EQ(::waitpid(consumer, &status, 0), consumer);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1 no link, 2 torn, 3 miscounted, 4 nothing came";
}

}  // namespace
}  // namespace hirosco::queueing
