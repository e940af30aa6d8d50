// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/result.hpp"
#include "supervisor/keeper/kept.hpp"

/// Descriptors of the subsystems, handed over by the supervisor and kept beyond it: the next one inherits them (docs/adr/0093).
namespace hirosco::supervisor {

/// What a supervisor before had handed over, by slot.
using InheritedParts = std::map<std::size_t, std::array<FileDescriptor, kept_roles>>;

/// The keeper's side. Holds what came, by slot; bounded.  Thread: one.
class KeptStore {
 public:
  /// Both ends: the store's and the supervisor's. SystemFailure: no socket.
  [[nodiscard]] static Result<std::pair<FileDescriptor, FileDescriptor>> make_socket();
  /// \param page Where the supervisor is told of what could not be taken, and outlives this; null: nowhere.
  explicit KeptStore(FileDescriptor socket, KeeperPage* page = nullptr) noexcept
      : socket_{std::move(socket)}, page_{page} {}

  /// Takes what has come. What is no message of ours is closed. Of a slot of which not all came, or to which the supervisor could send nothing,
  /// nothing counts any more but the handle that was there: what else was held is of another permit page, and who goes on would believe that.
  /// Does not wait.
  void take() noexcept;
  /// For a supervisor that is started: what it finds where. Of whom the handle alone is held it finds that in each place, and can end it.
  void pass_on(std::vector<ProcessStart::Inherited>& inherited) const;
  /// Nobody goes on: who still runs finds its channel closed.
  void clear() noexcept { slots_ = {}; }
  /// All of it, and of what was handed over last.
  [[nodiscard]] bool holds(std::size_t slot) const noexcept {
    return slots_[slot].front().valid() && !is_of_before(slot);
  }

 private:
  using Slot = std::array<FileDescriptor, kept_roles>;
  void not_taken(std::size_t slot) noexcept;
  /// By the page: what is asked for behind the end of the supervisor, who marks each while it sends it.
  [[nodiscard]] bool is_of_before(std::size_t slot) const noexcept;

  FileDescriptor socket_;
  KeeperPage* page_;
  std::array<Slot, most_kept> slots_;
};

/// The supervisor's side: hands over, and takes back what the one before had handed over.  Thread: one.
class StoreClient {
 public:
  /// -1: there is no keeper, nothing is kept.
  /// \param page Where the keeper finds what could not be sent, and outlives this; null: nowhere.
  explicit StoreClient(int socket, KeeperPage* page = nullptr) noexcept : socket_{socket}, page_{page} {}
  [[nodiscard]] bool has_keeper() const noexcept { return socket_ >= 0; }
  /// Unavailable: the keeper is gone or takes nothing; OutOfRange: there is no such slot. Whether it had room for them it tells later
  /// (KeeperPage::not_taken).
  [[nodiscard]] Result<> keep(std::size_t slot, const std::array<int, kept_roles>& descriptors) noexcept;
  /// It has ended.
  void forget(std::size_t slot) noexcept;
  /// What the supervisor before had handed over, by slot. To be called once, before this process opens anything: the numbers are
  /// free again after that.
  [[nodiscard]] static InheritedParts inherited();

 private:
  int socket_;
  KeeperPage* page_;
};

}  // namespace hirosco::supervisor
