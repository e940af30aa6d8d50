// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/shared_memory.hpp"

namespace hirosco {

/// Device frames between two processes of one computer: a named segment with one mailbox each way that keeps the newest
/// frame. The side that opens first makes the segment, the last one to close removes it; what a dead owner left behind
/// is used again. send and receive make no system call, but for the one that wakes a waiting peer.
class SharedMemoryFlow final : public DataFlow {
 public:
  /// `address`: 1 .. 200 characters, "/" becomes "." (device_memory_name.hpp). AlreadyExists: another live flow has this side.
  /// Realtime: blocks.
  [[nodiscard]] static Result<std::unique_ptr<DataFlow>> open(const std::string& address, FlowSide side,
                                                              FlowHolder holder = FlowHolder::Subsystem);
  ~SharedMemoryFlow() override;
  SharedMemoryFlow(const SharedMemoryFlow&) = delete;
  SharedMemoryFlow& operator=(const SharedMemoryFlow&) = delete;

 private:
  struct Segment;
  struct Mailbox;
  SharedMemoryFlow(std::string path, FileDescriptor file, MappedMemory memory, FlowSide side) noexcept;
  static Result<std::unique_ptr<SharedMemoryFlow>> try_open(const std::string& path, FlowSide side);
  [[nodiscard]] Result<> do_send(Octets frame) noexcept override;
  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override;
  [[nodiscard]] bool do_wait(Duration timeout) noexcept override;
  void take_over() noexcept;
  [[nodiscard]] bool something_to_tell() const noexcept;
  [[nodiscard]] bool peer_hung_up() const noexcept;

  std::string path_;
  FileDescriptor file_;  ///< its lock on one octet is the claim to this side; it goes with the process
  MappedMemory memory_;
  Segment& segment_;
  std::size_t own_;  ///< index of this side: 0 subsystem, 1 device
  std::uint64_t sent_sequence_{0};
  std::uint64_t seen_sequence_{0};
  std::uint64_t peer_at_start_{0};  ///< peer's opening count when this side was opened
};

/// The folder of its frames, which is made before anybody is let in (docs/adr/0169). What the supervisor's side holds lies where nobody is.
void let_in_shared_memory(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_shared_memory(const std::string& address, const Sandbox& sandbox);
/// Of a user of its own: the same folder, shut to all others.
[[nodiscard]] Result<> make_own_memory_folder(const std::string& address, const OwnGroup& own);
inline constexpr OwnFlowAccess own_memory_access{.folder = device_memory_folder, .make_folder = make_own_memory_folder};
inline constexpr FlowAccess shared_memory_access{.let_in = let_in_shared_memory,
                                                 .is_reached = is_reached_by_shared_memory,
                                                 .make_place = make_device_memory_folder,
                                                 .remove_place = remove_device_memory_folder,
                                                 .memory_folder = device_memory_folder,
                                                 .own = &own_memory_access};

}  // namespace hirosco
