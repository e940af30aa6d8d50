// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/kept_store.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <vector>

/// What the supervisor hands over, so that another one goes on with what runs (docs/adr/0093).
namespace hirosco::supervisor {
namespace {

struct Stored : ::testing::Test {
  std::pair<FileDescriptor, FileDescriptor> ends = std::move(*KeptStore::make_socket());
  int to_store = ends.second.get();
  KeeperPage page;
  KeptStore store{std::move(ends.first), &page};
  StoreClient client{to_store, &page};

  [[nodiscard]] static FileDescriptor file() { return FileDescriptor{::open("/dev/null", O_RDONLY | O_CLOEXEC)}; }
  [[nodiscard]] static std::size_t open_descriptors() {
    std::size_t count = 0;
    for (int number = 0; number < 1024; ++number) count += ::fcntl(number, F_GETFD) >= 0 ? 1 : 0;
    return count;
  }
  static constexpr std::size_t process_role = static_cast<std::size_t>(KeptRole::Process);
  /// Of a slot, in each place.
  [[nodiscard]] bool only_its_handle_is_passed_on(std::size_t slot) const {
    std::vector<ProcessStart::Inherited> inherited;
    store.pass_on(inherited);
    const int first = kept_descriptor(slot, static_cast<KeptRole>(0));
    std::vector<int> ours;
    for (const auto& each : inherited)
      if (each.number >= first && each.number < first + static_cast<int>(kept_roles)) ours.push_back(each.ours);
    return ours.size() == kept_roles && std::ranges::all_of(ours, [&](int each) { return each == ours[process_role]; });
  }
};

TEST_F(Stored, WhatWasHandedOverIsPassedOnAndOutlivesWhoHandedItOver) {
  {
    const FileDescriptor a = file(), b = file(), c = file(), d = file();
    ASSERT_TRUE(client.keep(3, {a.get(), b.get(), c.get(), d.get()}));
  }
  store.take();
  EXPECT_TRUE(store.holds(3));
  EXPECT_FALSE(store.holds(2));
  std::vector<ProcessStart::Inherited> inherited;
  store.pass_on(inherited);
  ASSERT_EQ(inherited.size(), kept_roles);
  for (std::size_t i = 0; i < kept_roles; ++i) {
    EXPECT_EQ(inherited[i].number, kept_descriptor(3, static_cast<KeptRole>(i)));
    EXPECT_GE(::fcntl(inherited[i].ours, F_GETFD), 0);
  }
}

TEST_F(Stored, WhatHasEndedIsGivenBackAndNothingLeaks) {
  const FileDescriptor one = file();
  const auto before = open_descriptors();
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(client.keep(0, {one.get(), one.get(), one.get(), one.get()}));
    store.take();
  }
  EXPECT_EQ(open_descriptors(), before + kept_roles);
  client.forget(0);
  store.take();
  EXPECT_FALSE(store.holds(0));
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(Stored, WhatIsNoMessageOfOursIsClosedAndChangesNothing) {
  const FileDescriptor one = file();
  ASSERT_TRUE(client.keep(0, {one.get(), one.get(), one.get(), one.get()}));
  store.take();
  const auto before = open_descriptors();
  EXPECT_FALSE(client.keep(most_kept, {one.get(), one.get(), one.get(), one.get()}));
  const std::array<std::uint32_t, 2> long_text{};
  for (const std::size_t octets : {std::size_t{1}, std::size_t{3}, std::size_t{8}})
    ASSERT_GT(::send(to_store, long_text.data(), octets, MSG_DONTWAIT), 0);
  const std::uint32_t beyond = most_kept;
  ASSERT_GT(::send(to_store, &beyond, sizeof beyond, MSG_DONTWAIT), 0);
  store.take();
  EXPECT_TRUE(store.holds(0));
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(Stored, WithoutAKeeperNothingIsKeptAndNobodyMinds) {
  StoreClient nobody{-1};
  EXPECT_FALSE(nobody.keep(0, {0, 1, 2, 0}));
  nobody.forget(0);
}

TEST_F(Stored, EachSlotIsPassedOnUnderNumbersOfItsOwn) {
  const FileDescriptor one = file();
  for (const std::size_t slot : {most_kept - 1, std::size_t{0}})
    ASSERT_TRUE(client.keep(slot, {one.get(), one.get(), one.get(), one.get(), one.get()})) << slot;
  store.take();
  std::vector<ProcessStart::Inherited> inherited;
  store.pass_on(inherited);
  ASSERT_EQ(inherited.size(), 2 * kept_roles);
  for (std::size_t i = 0; i < inherited.size(); ++i) {
    const std::size_t slot = i < kept_roles ? 0 : most_kept - 1;
    EXPECT_EQ(inherited[i].number, kept_descriptor(slot, static_cast<KeptRole>(i % kept_roles)));
  }
}

TEST_F(Stored, EachRoleIsTheDescriptorThatWasHandedOverForIt) {
  std::array<std::array<int, 2>, kept_roles> pipes{};
  std::array<int, kept_roles> numbers{};
  for (std::size_t i = 0; i < kept_roles; ++i) {
    ASSERT_EQ(::pipe2(pipes[i].data(), O_CLOEXEC), 0);
    numbers[i] = pipes[i][1];
  }
  ASSERT_TRUE(client.keep(7, numbers));
  store.take();
  std::vector<ProcessStart::Inherited> inherited;
  store.pass_on(inherited);
  ASSERT_EQ(inherited.size(), kept_roles);
  for (std::size_t i = 0; i < kept_roles; ++i) {
    const char written = static_cast<char>('a' + i);
    ASSERT_EQ(::write(inherited[i].ours, &written, 1), 1);
    char read = 0;
    ASSERT_EQ(::read(pipes[i][0], &read, 1), 1);
    EXPECT_EQ(read, written);
    for (const int end : pipes[i]) ::close(end);
  }
}

TEST_F(Stored, WhereNobodyGoesOnAllOfItIsClosed) {
  const FileDescriptor one = file();
  const auto before = open_descriptors();
  for (const std::size_t slot : {std::size_t{0}, std::size_t{5}, most_kept - 1})
    ASSERT_TRUE(client.keep(slot, {one.get(), one.get(), one.get(), one.get(), one.get()}));
  store.take();
  EXPECT_EQ(open_descriptors(), before + 3 * kept_roles);
  store.clear();
  EXPECT_EQ(open_descriptors(), before);
  std::vector<ProcessStart::Inherited> inherited;
  store.pass_on(inherited);
  EXPECT_TRUE(inherited.empty());
}

/// A message of this slot with so many descriptors beside it.
void send_with(int socket, std::uint32_t slot, int descriptor, std::size_t count) {
  iovec text{&slot, sizeof slot};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(16 * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &text;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = CMSG_SPACE(count * sizeof descriptor);
  cmsghdr* const part = CMSG_FIRSTHDR(&header);
  part->cmsg_level = SOL_SOCKET;
  part->cmsg_type = SCM_RIGHTS;
  part->cmsg_len = CMSG_LEN(count * sizeof descriptor);
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(CMSG_DATA(part) + i * sizeof descriptor, &descriptor, sizeof descriptor);
  ASSERT_EQ(::sendmsg(socket, &header, MSG_DONTWAIT), static_cast<ssize_t>(sizeof slot));
}

TEST_F(Stored, WithTooFewOrTooManyDescriptorsAllOfThemAreClosedAndNothingIsKept) {
  const FileDescriptor one = file();
  const auto before = open_descriptors();
  for (const std::size_t count :
       {std::size_t{1}, kept_roles - 1, kept_roles + 1, kept_roles + 4, kept_roles + 5, std::size_t{16}}) {
    send_with(to_store, 2, one.get(), count);
    store.take();
    EXPECT_FALSE(store.holds(2)) << count;
    EXPECT_EQ(open_descriptors(), before) << count;
  }
  send_with(to_store, 2, one.get(), kept_roles);
  store.take();
  EXPECT_TRUE(store.holds(2)) << "as many as there are roles";
}

TEST_F(Stored, OfNoSlotThatThereIsNothingIsSaidNorForgotten) {
  const FileDescriptor one = file();
  const std::array<int, kept_roles> numbers{one.get(), one.get(), one.get(), one.get(), one.get()};
  const auto kept = client.keep(most_kept, numbers);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, ErrorCode::OutOfRange);
  client.forget(most_kept);
  std::uint32_t said = 0;
  EXPECT_LT(::recv(to_store, &said, sizeof said, MSG_DONTWAIT), 0);
  ASSERT_TRUE(client.keep(most_kept - 1, numbers));
  store.take();
  EXPECT_TRUE(store.holds(most_kept - 1));
}

TEST_F(Stored, ASupervisorWaitsForNoKeeperThatTakesNothing) {
  const FileDescriptor one = file();
  const std::array<int, kept_roles> numbers{one.get(), one.get(), one.get(), one.get(), one.get()};
  Result<> kept = client.keep(0, numbers);
  while (kept) kept = client.keep(2, numbers);
  EXPECT_EQ(kept.error().code, ErrorCode::Unavailable);
  store.take();
  EXPECT_TRUE(store.holds(0)) << "what found room";
  EXPECT_TRUE(client.keep(1, numbers));
}

/// Not even a word finds room: it stands still.
TEST_F(Stored, WhatAKeeperThatTakesNothingHoldsOfOneThatWasHandedOverAnewIsOfBeforeUntilItIsSentAgain) {
  const FileDescriptor process = file(), other = file();
  std::array<int, kept_roles> numbers{other.get(), other.get(), other.get(), other.get(), other.get()};
  numbers[process_role] = process.get();
  ASSERT_TRUE(client.keep(5, numbers));
  while (client.keep(2, numbers)) {}
  const std::uint32_t word = most_kept;
  while (::send(to_store, &word, sizeof word, MSG_DONTWAIT) > 0) {}
  ASSERT_FALSE(client.keep(5, numbers));
  store.take();
  EXPECT_FALSE(store.holds(5)) << "another permit page is in force";
  EXPECT_TRUE(only_its_handle_is_passed_on(5));
  ASSERT_TRUE(client.keep(5, numbers));
  store.take();
  EXPECT_TRUE(store.holds(5));
  EXPECT_FALSE(only_its_handle_is_passed_on(5));
}

TEST(StoreClient, OfAKeeperThatIsGoneIsToldSoAndLivesOn) {
  auto ends = std::move(*KeptStore::make_socket());
  StoreClient client{ends.second.get()};
  std::optional<KeptStore> store{std::in_place, std::move(ends.first)};
  store.reset();
  const auto kept = client.keep(0, {STDIN_FILENO, STDIN_FILENO, STDIN_FILENO, STDIN_FILENO, STDIN_FILENO});
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, ErrorCode::Unavailable);
  client.forget(0);
}

/// So many more descriptors may this process open, at most, as long as this lives.
class FewDescriptors {
 public:
  explicit FewDescriptors(int left) {
    EXPECT_EQ(::getrlimit(RLIMIT_NOFILE, &all_), 0);
    const int first_free = FileDescriptor{::open("/dev/null", O_RDONLY | O_CLOEXEC)}.get();
    const rlimit few{.rlim_cur = static_cast<rlim_t>(first_free + left), .rlim_max = all_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  }
  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &all_); }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit all_{};
};

TEST_F(Stored, ForWhomTheKeeperHasNoDescriptorsFreeTheSupervisorIsToldInThePageUntilItTakesALaterOne) {
  const FileDescriptor one = file();
  const std::array<int, kept_roles> numbers{one.get(), one.get(), one.get(), one.get(), one.get()};
  const auto before = open_descriptors();
  for (int left = 0; left < static_cast<int>(kept_roles); ++left) {
    ASSERT_TRUE(client.keep(3, numbers)) << "the supervisor sees nothing of it";
    {
      const FewDescriptors few{left};
      store.take();
    }
    EXPECT_EQ(page.not_taken[3].load(), 1) << left;
    EXPECT_FALSE(store.holds(3)) << left;
    client.forget(3);
    store.take();
    EXPECT_EQ(open_descriptors(), before) << left;
    EXPECT_EQ(page.not_taken[3].load(), 0) << left;
  }
  ASSERT_TRUE(client.keep(3, numbers));
  store.take();
  EXPECT_EQ(page.not_taken[3].load(), 0);
  EXPECT_TRUE(store.holds(3));
  for (std::size_t slot = 0; slot < most_kept; ++slot) EXPECT_EQ(page.not_taken[slot].load(), 0) << slot;
}

/// A later permit page stops what the one that is held permits.
TEST_F(Stored, OfWhatIsHandedOverAnewAndCannotBeTakenNothingOfBeforeCountsButItsHandle) {
  const FileDescriptor process = file(), other = file();
  std::array<int, kept_roles> numbers{other.get(), other.get(), other.get(), other.get(), other.get()};
  numbers[process_role] = process.get();
  const auto before = open_descriptors();
  for (const bool sent : {true, false}) {
    ASSERT_TRUE(client.keep(6, numbers));
    store.take();
    ASSERT_TRUE(store.holds(6));
    if (sent) {
      ASSERT_TRUE(client.keep(6, numbers));
      const FewDescriptors few{0};
      store.take();
    } else {
      ASSERT_FALSE(client.keep(6, {-1, -1, -1, -1, -1})) << "the system refuses what is none";
      store.take();
    }
    EXPECT_FALSE(store.holds(6)) << sent;
    EXPECT_EQ(open_descriptors(), before + (sent ? 1 : kept_roles)) << sent;
    EXPECT_TRUE(only_its_handle_is_passed_on(6))
        << "whoever goes on finds it, without its pages, and ends it: " << sent;
    client.forget(6);
    store.take();
    EXPECT_EQ(open_descriptors(), before);
  }
}

/// In a process of its own, whose numbers are its own. 0: all is as it should be.
int inherits_what_is_whole() {
  const int file = ::open("/dev/null", O_RDONLY);
  if (file < 0 || ::dup2(file, 3) != 3 || ::close_range(4, ~0U, 0) != 0) return 1;
  const auto put = [](std::size_t slot, std::size_t roles) {
    for (std::size_t i = 0; i < roles; ++i) ::dup2(3, kept_descriptor(slot, static_cast<KeptRole>(i)));
  };
  put(0, kept_roles);
  put(most_kept - 1, kept_roles);
  put(5, kept_roles - 1);
  auto found = StoreClient::inherited();
  if (found.size() != 2 || !found.contains(0) || !found.contains(most_kept - 1)) return 2;
  for (const auto& [slot, parts] : found)
    for (std::size_t i = 0; i < kept_roles; ++i) {
      if (parts[i].get() != kept_descriptor(slot, static_cast<KeptRole>(i))) return 3;
      if (::fcntl(parts[i].get(), F_GETFD) != FD_CLOEXEC) return 4;  // whoever is started would have it as well
    }
  found.clear();
  for (const std::size_t slot : {std::size_t{0}, std::size_t{5}, most_kept - 1})
    for (std::size_t i = 0; i < kept_roles; ++i)
      if (::fcntl(kept_descriptor(slot, static_cast<KeptRole>(i)), F_GETFD) >= 0) return 5;
  return 0;
}

TEST(StoreClient, InheritsTheSlotsThatAreWholeUnderTheirNumbersAndNoOthers) {
  const pid_t heir = ::fork();
  if (heir == 0) ::_exit(inherits_what_is_whole());
  int status = 0;
  ASSERT_EQ(::waitpid(heir, &status, 0), heir);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace hirosco::supervisor
